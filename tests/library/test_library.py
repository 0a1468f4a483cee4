"""The library of phantoms, and its test objects."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import phantom
from phantom import library
from phantom.errors import InvalidInputError, UnknownPhantomError
from phantom.imaging import PRESETS


def test_the_library_is_listed_by_name():
    assert {"deformed", "fan", "knee-1993", "sphere", "step-wedge"} <= set(library.names())
    assert list(library.names()) == sorted(library.names())


@pytest.mark.parametrize("name", library.names())
def test_every_phantom_is_sound_as_it_comes(name):
    entry = library.entry(name)
    assert entry.name == name
    assert entry.title
    assert entry.summary
    assert set(entry.views) <= set(PRESETS)
    built = library.build(name)
    assert built.document.name == name
    assert np.isfinite(built.bounds).all()


def test_an_unknown_phantom_is_told_with_the_known_ones():
    for call in (library.entry, library.document, library.build):
        with pytest.raises(UnknownPhantomError, match="step-wedge") as refusal:
            call("nobody")
        assert refusal.value.problems[0].path == "/name"


def test_every_bad_parameter_is_told():
    with pytest.raises(InvalidInputError) as refusal:
        library.build("sphere", radius_mm="wide", material="cheese", name="x")
    found = {(p.path, p.kind) for p in refusal.value.problems}
    assert found == {
        ("/parameters/radius_mm", "not_a_number"),
        ("/parameters/material", "unknown_reference"),
        ("/parameters/name", "unknown_field"),
    }


@settings(deadline=None)
@given(radius=st.floats(0.1, 200.0), offset=st.floats(-1.1, 1.1))
def test_a_sphere_of_any_radius_is_crossed_along_its_chord(radius, offset):
    ball = library.build("sphere", radius_mm=radius)
    origin = [[-500.0, offset * radius, 0.0]]
    length = phantom.path_lengths(ball, origin, [[1.0, 0.0, 0.0]])[0, 0]
    # Near the edge a chord is as uncertain as the root of the distance left to it.
    expected = 2 * radius * np.sqrt(max(1 - offset**2, 0.0))
    assert abs(length**2 - expected**2) <= 1e-9 * radius**2


@settings(deadline=None)
@given(
    steps=st.integers(1, 50),
    height=st.floats(0.01, 50.0),
    length=st.floats(0.1, 100.0),
    width=st.floats(0.1, 400.0),
    place=st.floats(0.01, 0.99),
)
def test_each_step_is_one_height_thicker_than_the_last(steps, height, length, width, place):
    wedge = library.build(
        "step-wedge", steps=steps, step_height_mm=height, step_length_mm=length, width_mm=width
    )
    x = (np.arange(steps) + place - steps / 2) * length
    origins = np.stack([x, np.full(steps, -2000.0), np.zeros(steps)], axis=1)
    thickness = phantom.path_lengths(wedge, origins, np.tile([0.0, 1.0, 0.0], (steps, 1)))[:, 0]
    np.testing.assert_allclose(thickness, (np.arange(steps) + 1) * height, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(wedge.bounds.mean(axis=0), 0, atol=1e-9)


def test_a_ray_along_the_steps_crosses_all_that_are_tall_enough():
    wedge = library.build("step-wedge", steps=5, step_height_mm=2.0, step_length_mm=10.0)
    foot = 5.0  # half of the tallest step, on the side of the detector
    heights = np.array([1.0, 3.0, 5.0, 7.0, 9.0])
    origins = np.stack([np.full(5, -200.0), foot - heights, np.zeros(5)], axis=1)
    lengths = phantom.path_lengths(wedge, origins, np.tile([1.0, 0.0, 0.0], (5, 1)))[:, 0]
    np.testing.assert_allclose(lengths, [50, 40, 30, 20, 10], rtol=1e-9)


def test_every_step_is_a_leaf_of_its_own():
    wedge = library.build("step-wedge", steps=3)
    assert wedge.leaf_names == ("step-01", "step-02", "step-03")


def test_importing_the_package_loads_nothing_heavy():
    check = (
        "import sys, phantom\n"
        "heavy = {'numpy', 'numba', 'scipy', 'pydantic', 'OpenImageIO', 'xraylib', 'fastapi'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
        "assert set(phantom.__all__) <= set(dir(phantom))\n"
    )
    subprocess.run([sys.executable, "-c", check], check=True)


def test_every_public_name_is_there():
    for name in phantom.__all__:
        assert getattr(phantom, name) is not None
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = phantom.no_such_name
