"""Curves and outlines given by formulas, with exact derivatives and one-sided values at kinks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.formulas import Formula, first_bad
from phantom.geometry.kinks import kinks
from phantom.geometry.refusal import RefusalError

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_AXIS_PIECES = 8
_CONTOUR_PIECES = 16
_CLOSED = 1e-9
LARGEST_MM = 1e7


def formula_breaks(
    formulas: list[Formula], name: str, start: float, end: float, parts: int
) -> Floats:
    """Cut a range evenly, and where a formula changes its branch."""
    found = [np.linspace(start, end, parts + 1)]
    found += [kinks(formula, name, start, end) for formula in formulas]
    breaks = np.unique(np.concatenate(found))
    keep = np.append(True, np.diff(breaks) > 1e-12 * (end - start))
    breaks = breaks[keep]
    breaks[-1] = end
    return np.asarray(breaks)


def _within(breaks: Floats, u: Floats, piece: Ints) -> Floats:
    """Move parameters a few roundings inside their piece, so that the right branch is taken."""
    low, high = breaks[piece], breaks[piece + 1]
    hair = 1e-15 * (np.abs(low) + np.abs(high))
    return np.asarray(np.clip(u, low + hair, high - hair))


def check_values(formula: Formula, name: str, breaks: Floats, path: str) -> None:
    """Refuse a formula that is undefined or absurdly large somewhere on its range."""
    fractions = np.linspace(0, 1, 65)
    u = (breaks[:-1, None] + fractions * np.diff(breaks)[:, None]).ravel()
    values = np.broadcast_to(formula.values(**{name: u}), u.shape)
    bad = first_bad(values, u)
    if bad is not None:
        raise RefusalError(
            path,
            "undefined",
            f"the formula has no finite value at {name} = {bad:.6g}; expected one at every {name}",
        )
    worst = int(np.argmax(np.abs(values)))
    if abs(values[worst]) > LARGEST_MM:
        raise RefusalError(
            path,
            "out_of_range",
            f"the formula gives {values[worst]:.4g} at {name} = {u[worst]:.6g}; "
            f"expected at most {LARGEST_MM:g}",
        )


@dataclass(frozen=True)
class FormulaCurve:
    """An axis by three formulas in u."""

    formulas: tuple[Formula, Formula, Formula]
    breaks: Floats
    closed: bool

    def derivatives(self, u: Floats, piece: Ints, order: int) -> Floats:
        """Evaluate by Taylor series."""
        u = _within(self.breaks, u, piece)
        columns = [
            np.broadcast_to(f.derivatives(order, "u", u=u), (order + 1, len(u)))
            for f in self.formulas
        ]
        return np.stack(columns, axis=-1)


def formula_curve(axis: doc.FormulaAxis) -> FormulaCurve:
    """Read a formula axis.

    Raises
    ------
    RefusalError
        Below ``/axis``: no finite value somewhere, or an axis said to be closed that is not.
    """
    formulas = tuple(Formula.of(text, "u") for text in (axis.x, axis.y, axis.z))
    breaks = formula_breaks(list(formulas), "u", *axis.range, _AXIS_PIECES)
    for name, formula in zip("xyz", formulas, strict=True):
        check_values(formula, "u", breaks, f"/axis/{name}")
    curve = FormulaCurve((formulas[0], formulas[1], formulas[2]), breaks, axis.closed)
    if axis.closed:
        ends = curve.derivatives(breaks[[0, -1]], np.array([0, len(breaks) - 2]), 0)[0]
        gap = float(np.linalg.norm(ends[1] - ends[0]))
        size = max(1.0, float(np.abs(ends).max()))
        if gap > _CLOSED * size:
            raise RefusalError(
                "/axis/closed",
                "open_axis",
                f"the axis ends {gap:.4g} mm from where it starts; expected it to close",
            )
    return curve


@dataclass(frozen=True)
class FormulaOutline:
    """A closed contour by two formulas in v."""

    x: Formula
    y: Formula
    breaks: Floats

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Evaluate by Taylor series."""
        v = _within(self.breaks, v, piece)
        columns = [
            np.broadcast_to(f.derivatives(2, "v", v=v), (3, len(v))) for f in (self.x, self.y)
        ]
        return np.stack(columns, axis=-1)


def formula_outline(contour: doc.FormulaContour) -> FormulaOutline:
    """Read a formula contour, or refuse it where it is undefined or does not close."""
    x, y = Formula.of(contour.x, "v"), Formula.of(contour.y, "v")
    breaks = formula_breaks([x, y], "v", *contour.range, _CONTOUR_PIECES)
    for name, formula in (("x", x), ("y", y)):
        check_values(formula, "v", breaks, f"/contour/{name}")
    outline = FormulaOutline(x, y, breaks)
    ends = outline.derivatives(breaks[[0, -1]], np.array([0, len(breaks) - 2]))[0]
    gap = float(np.linalg.norm(ends[1] - ends[0]))
    if gap > _CLOSED * max(1.0, float(np.abs(ends).max())):
        raise RefusalError(
            "/contour",
            "open_contour",
            f"the contour ends {gap:.4g} mm from where it starts; expected a closed curve",
        )
    return outline


@dataclass(frozen=True)
class PolarFormulaOutline:
    """r(theta) by a formula; v is theta in radians."""

    radius: Formula
    breaks: Floats

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Turn r and its derivatives into those of the point."""
        inside = _within(self.breaks, v, piece)
        r, r1, r2 = (
            np.broadcast_to(d, v.shape)[:, None]
            for d in self.radius.derivatives(2, "theta", theta=inside)
        )
        out = np.stack([np.cos(v), np.sin(v)], axis=-1)
        across = np.stack([-np.sin(v), np.cos(v)], axis=-1)
        return np.stack([r * out, r1 * out + r * across, (r2 - r) * out + 2 * r1 * across])


def polar_formula_outline(formula_text: str) -> PolarFormulaOutline:
    """Read r(theta), or refuse it where it is undefined or not periodic."""
    formula = Formula.of(formula_text, "theta")
    breaks = formula_breaks([formula], "theta", 0.0, 2 * np.pi, _CONTOUR_PIECES)
    check_values(formula, "theta", breaks, "/contour/formula")
    first, last = np.broadcast_to(formula.values(theta=breaks[[0, -1]]), (2,))
    if abs(first - last) > _CLOSED * max(1.0, abs(first)):
        raise RefusalError(
            "/contour/formula",
            "open_contour",
            f"r(0) = {first:.6g} and r(2 pi) = {last:.6g} mm differ; expected a periodic radius",
        )
    return PolarFormulaOutline(formula, breaks)
