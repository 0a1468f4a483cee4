"""The loops over lanes are packed: several lanes an instruction, and never a call in between.

A compiler that no longer packs them would cost four times the speed and change no result, so no
other test would notice.
"""

import platform

import numba
import pytest
from llvmlite.binding import get_host_cpu_features

from phantom.kernels import glances, lanes, roots, round_tubes, slots, spans, verdicts
from phantom.kernels.registers import LoopCompiler

pytestmark = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="reads the names of x86's registers"
)

FLOATS, INT, FLOAT = numba.float64[::1], numba.int64, numba.float64
MATRIX = numba.types.Array(numba.float64, 2, "C", readonly=False)
TENSOR = numba.types.Array(numba.float64, 3, "C", readonly=False)

LOOPS = {
    "evaluate": (
        lanes.evaluate_circle,
        (FLOATS, INT, FLOATS),
        {"vfmadd": 120, "vdivpd": 3},
    ),
    "evaluate tables": (
        lanes.evaluate_jets,
        (FLOATS, INT, FLOATS),
        {"vfmadd": 120, "vdivpd": 2},
    ),
    "one look": (
        round_tubes.probe,
        (FLOATS, INT, FLOATS),
        {"vfmadd": 120, "vdivpd": 2},
    ),
    "judge one look": (
        glances.judge_glance,
        (FLOATS, INT, MATRIX, TENSOR, INT),
        {"vsqrtpd": 2, "vdivpd": 2},
    ),
    "both ends": (
        round_tubes.chords,
        (FLOATS, INT, FLOATS, FLOAT),
        {"vfmadd": 250, "vdivpd": 4, "vsqrtpd": 1},
    ),
    "collect": (
        lanes.collect,
        (FLOATS, MATRIX, INT, MATRIX, INT, INT, INT, INT),
        {"vdivpd": 3},
    ),
    "judge": (
        verdicts.judge,
        (FLOATS, INT, MATRIX, TENSOR, INT),
        {"vsqrtpd": 2, "vdivpd": 3},
    ),
    "judge closer": (
        verdicts.judge_closer,
        (FLOATS, INT, MATRIX, FLOATS, FLOAT),
        {"vsqrtpd": 2, "vgather": 8},
    ),
    "cells of a contour": (
        lanes.find_cells,
        (FLOATS, INT, numba.int64[::1], INT, INT, FLOATS, INT, INT, INT),
        {"vdivpd": 1, "gather": 2},
    ),
    "a contour": (
        lanes.fixed_cells,
        (FLOATS, INT, FLOATS, INT, MATRIX),
        {"vfmadd": 8, "vgather": 8},
    ),
    "first guess": (roots.first_guess, (FLOATS, INT), {"vsqrtpd": 1, "vdivpd": 3}),
    "newton": (roots.newton, (FLOATS, INT), {"vdivpd": 2}),
    "ellipsoids": (
        slots.ellipsoids,
        (FLOATS, MATRIX, FLOAT, FLOAT, FLOAT, MATRIX, INT, INT, INT, INT, INT, INT),
        {"vsqrtpd": 1, "vdivpd": 1},
    ),
    "lengths": (spans.reach, (MATRIX, INT, INT, FLOATS), {"vsqrtpd": 1}),
}


def machine_code(kernel, signature):
    # Compiled anew: numba keeps no listing of what it loads from its cache.
    options = {k: v for k, v in kernel.targetoptions.items() if k in ("fastmath", "error_model")}
    fresh = numba.njit(nogil=True, pipeline_class=LoopCompiler, _nrt=False, **options)(
        kernel.py_func
    )
    fresh.compile(signature)
    return fresh.inspect_asm(fresh.signatures[0])


@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_over_lanes_uses_wide_registers(name):
    if not get_host_cpu_features().get("avx2"):
        pytest.skip("this processor has no AVX2")
    kernel, signature, least = LOOPS[name]
    lines = machine_code(kernel, signature).splitlines()
    wide = [line for line in lines if "%ymm" in line or "%zmm" in line]
    for instruction, count in least.items():
        found = sum(instruction in line for line in wide)
        assert found >= count, f"{found} packed {instruction}, expected {count} or more"
