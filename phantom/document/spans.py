"""Where along its axis a sweep must be told: at both ends, wherever those are."""

from __future__ import annotations

from collections.abc import Iterator

from phantom.document.curves import Axis
from phantom.document.formula_curves import FormulaAxis
from phantom.document.profiles import KnotProfile, Profile
from phantom.document.sweeps import LinearSweep, MatrixSweep, MorphSweep, Sweep

Place = tuple[str | int, ...]


def parameter_range(axis: Axis) -> tuple[float, float]:
    """Return the first and the last u of an axis."""
    return axis.range if isinstance(axis, FormulaAxis) else (0.0, 1.0)


def profiles(sweep: Sweep) -> Iterator[tuple[Place, Profile]]:
    """Yield the profiles of a sweep, each with its place below it."""
    if isinstance(sweep, LinearSweep):
        if isinstance(sweep.scale, tuple):
            yield from ((("scale", i), value) for i, value in enumerate(sweep.scale))
        else:
            yield ("scale",), sweep.scale
        yield ("rotate_deg",), sweep.rotate_deg
        yield ("shear",), sweep.shear
        yield from ((("offset", i), value) for i, value in enumerate(sweep.offset))
    if isinstance(sweep, MatrixSweep):
        for i, row in enumerate(sweep.matrix):
            yield from ((("matrix", i, j), value) for j, value in enumerate(row))


def told_places(sweep: Sweep) -> Iterator[tuple[str, list[tuple[Place, float]]]]:
    """Yield each run of u that a sweep is told at: what it is made of, and (place, u) in order."""
    for place, value in profiles(sweep):
        if isinstance(value, KnotProfile):
            yield "knot", [((*place, "knots", i, 0), u) for i, (u, _) in enumerate(value.knots)]
    if isinstance(sweep, MorphSweep):
        yield (
            "contour",
            [(("contours", i, "at"), part.at) for i, part in enumerate(sweep.contours)],
        )


def span_problems(sweep: Sweep, axis: Axis) -> Iterator[tuple[Place, str]]:
    """Yield what of a sweep does not span its axis exactly, each with its place below it."""
    start, end = parameter_range(axis)
    for noun, told in told_places(sweep):
        for name, (place, u), wanted in (("first", told[0], start), ("last", told[-1], end)):
            if u != wanted:
                message = f"found u = {u:.17g}; expected the {name} {noun} at exactly {wanted:.17g}"
                yield place, message
