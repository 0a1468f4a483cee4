"""Linear sweeps: how the section turns, stretches, shears and shifts along the axis.

The column map of the document, ``R H D [x, y] + offset``; its inverse takes a point of the
section plane back to the initial contour (paper section III.A).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry import tolerances
from phantom.geometry.formula_curves import check_values, formula_breaks
from phantom.geometry.formulas import Formula
from phantom.geometry.refusal import RefusalError
from phantom.geometry.splines import Cubics, not_a_knot

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class FormulaProfile:
    """A profile by a formula in u, with the places where it changes its branch."""

    formula: Formula
    x: Floats  # like the knots of a spline

    def __call__(self, u: Floats) -> Floats:
        """Return the values at u."""
        return np.broadcast_to(self.formula.values(u=u), u.shape)


Profile = float | Cubics | FormulaProfile
Span = tuple[float, float]


def profile(value: doc.Profile, span: Span, path: str) -> Profile:
    """Turn a profile of a document into a number, a C2 cubic through knots, or a formula of u."""
    if isinstance(value, doc.KnotProfile):
        knots = np.array(value.knots, dtype=np.float64)
        return not_a_knot(knots[:, 0], knots[:, 1])
    if isinstance(value, doc.FormulaProfile):
        formula = Formula.of(value.formula, "u")
        breaks = formula_breaks([formula], "u", *span, 8)
        check_values(formula, "u", breaks, f"{path}/formula")
        return FormulaProfile(formula, breaks)
    return float(value)


def _at(values: Profile, u: Floats) -> Floats:
    if isinstance(values, float):
        return np.full(u.shape, values)
    return np.asarray(values(u), dtype=np.float64)


@dataclass(frozen=True)
class LinearSweep:
    """A linear sweep as six profiles of u."""

    scale: tuple[Profile, Profile]
    rotate_deg: Profile
    shear: Profile
    offset: tuple[Profile, Profile]
    span: Span

    @property
    def breaks(self) -> Floats:
        """Parameters where a derivative of a profile may jump, both ends included."""
        return _breaks((*self.scale, self.rotate_deg, self.shear, *self.offset), self.span)

    @property
    def is_round(self) -> bool:
        """Whether circles stay circles about the axis, so that turning them changes nothing."""
        return (
            self.scale[0] is self.scale[1]
            and self.shear == 0.0
            and self.offset[0] == 0.0
            and self.offset[1] == 0.0
        )

    def maps(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the column matrices ``(n, 2, 2)`` and the offsets ``(n, 2)`` in mm at u."""
        sx, sy = _at(self.scale[0], u), _at(self.scale[1], u)
        angle = np.radians(_at(self.rotate_deg, u))
        shear = _at(self.shear, u)
        cos, sin = np.cos(angle), np.sin(angle)
        # H D = [[sx, shear * sy], [0, sy]], then the turn R from n toward b.
        hd_xy = shear * sy
        matrix = np.empty((*u.shape, 2, 2))
        matrix[..., 0, 0] = cos * sx
        matrix[..., 1, 0] = sin * sx
        matrix[..., 0, 1] = cos * hd_xy - sin * sy
        matrix[..., 1, 1] = sin * hd_xy + cos * sy
        return matrix, np.stack([_at(self.offset[0], u), _at(self.offset[1], u)], axis=-1)


@dataclass(frozen=True)
class MatrixSweep:
    """The paper's row-vector form, ``[x y 1] S(u)``, by the six entries that are not constant."""

    entries: tuple[tuple[Profile, Profile], ...]  # three rows of two
    span: Span
    is_round = False

    @property
    def breaks(self) -> Floats:
        """Parameters where a derivative of an entry may jump, both ends included."""
        return _breaks(tuple(entry for row in self.entries for entry in row), self.span)

    def maps(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the column matrices ``(n, 2, 2)`` and the offsets ``(n, 2)`` in mm at u."""
        rows = np.stack([np.stack([_at(e, u) for e in row], axis=-1) for row in self.entries])
        # A row vector times S is the transpose of S times a column.
        return np.ascontiguousarray(np.moveaxis(rows[:2], 0, 2)), rows[2]


AnyLinear = LinearSweep | MatrixSweep


def _breaks(profiles: tuple[Profile, ...], span: Span) -> Floats:
    knots = [p.x for p in profiles if not isinstance(p, float)]
    return np.unique(np.concatenate([np.array(span), *knots]))


def linear_sweep(sweep: doc.LinearSweep | doc.MatrixSweep, span: Span = (0.0, 1.0)) -> AnyLinear:
    """Turn a linear sweep of a document into profiles over the axis's range, or refuse it.

    Raises
    ------
    RefusalError
        At ``/sweep``, where the map is singular or nearly so, with u and the figure; below it,
        where a formula has no value.
    """
    result: AnyLinear
    if isinstance(sweep, doc.MatrixSweep):
        rows = [
            tuple(profile(entry, span, f"/sweep/matrix/{i}/{j}") for j, entry in enumerate(row[:2]))
            for i, row in enumerate(sweep.matrix)
        ]
        result = MatrixSweep(tuple((row[0], row[1]) for row in rows), span)
    else:
        if isinstance(sweep.scale, tuple):
            scale = (
                profile(sweep.scale[0], span, "/sweep/scale/0"),
                profile(sweep.scale[1], span, "/sweep/scale/1"),
            )
        else:
            both = profile(sweep.scale, span, "/sweep/scale")
            scale = (both, both)
        offset = [profile(o, span, f"/sweep/offset/{i}") for i, o in enumerate(sweep.offset)]
        result = LinearSweep(
            scale,
            profile(sweep.rotate_deg, span, "/sweep/rotate_deg"),
            profile(sweep.shear, span, "/sweep/shear"),
            (offset[0], offset[1]),
            span,
        )
    _check_invertible(result)
    return result


def _check_invertible(result: AnyLinear) -> None:
    """Refuse a sweep that is singular, nearly so, or absurdly large."""
    breaks = result.breaks
    u = np.concatenate([np.linspace(a, b, 65) for a, b in itertools.pairwise(breaks)])
    matrix, _ = result.maps(u)
    stretches = np.linalg.svd(matrix, compute_uv=False)
    largest = float(stretches[:, 0].max())
    if not 1e-9 <= largest <= 1e9:
        raise RefusalError(
            "/sweep",
            "out_of_range",
            f"the sweep stretches by {largest:.3g} at most; expected 1e-09 to 1e+09",
        )
    ratio = stretches[:, 1] / largest
    # A change of orientation between two samples is a zero in between, however steep.
    determinant = np.linalg.det(matrix)
    flips = np.flatnonzero(determinant[:-1] * determinant[1:] < 0)
    worst = int(flips[0]) if len(flips) else int(np.argmin(ratio))
    if len(flips) or ratio[worst] < tolerances.SINGULAR_SWEEP:
        figure = 0.0 if len(flips) else ratio[worst]
        raise RefusalError(
            "/sweep",
            "singular_sweep",
            f"the sweep is singular near u = {u[worst]:.6g}: its smallest stretch is {figure:.3g} "
            f"of the largest along the axis; expected at least {tolerances.SINGULAR_SWEEP:g}",
        )
