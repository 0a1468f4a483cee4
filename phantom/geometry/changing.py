"""Sections that change shape along the axis: morphs, and sweeps given by formulas.

Every section is star-shaped about a point of its plane, so it is a radius r(T, u) there, with T the
pseudo-angle of :mod:`phantom.geometry.star`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.contours import Contour, plane_outline, star
from phantom.geometry.refusal import RefusalError
from phantom.geometry.simple import check_simple
from phantom.geometry.splines import Cubics, not_a_knot
from phantom.geometry.star import chart_rays, kinks, monotone_cells, radii

Floats = NDArray[np.float64]

EVENLY = 8.0 * np.arange(48) / 48 + 0.01
"""Pseudo-angles spread evenly, and off the half-axes."""


class Sections(Protocol):
    """The section of every u as a radius about a centre."""

    @property
    def breaks(self) -> Floats:
        """Parameters u where a derivative by u may jump, both ends included."""

    @property
    def marks(self) -> Floats:
        """Pseudo-angles where a derivative by T may jump, from 0 to 8."""

    def centers(self, u: Floats) -> Floats:
        """Return the centres ``(n, 2)`` in mm in the plane of n and b."""

    def watched(self, start: Floats, end: Floats) -> Floats:
        """Return T where the change over ranges of u is to be looked at, ``(n or 1, T)``."""

    def radii(self, T: Floats, u: Floats) -> Floats:
        """Return the radii ``(..., T, u)`` in mm at ``T (..., T)`` and ``u (..., u)``."""

    def corners(self, u: Floats) -> tuple[Floats, Floats]:
        """Return T ``(k,)`` of the corners, and the jumps ``(k, u)`` of h's slope per |phi|."""


@dataclass(frozen=True)
class Morph:
    """r(T, u) for each T by the profile through the contours' radii (document.md)."""

    places: Floats  # (c,)
    contours: tuple[Contour, ...]
    cardinal: Cubics  # the splines through 1 at one place and 0 at the others

    @property
    def breaks(self) -> Floats:
        """Where the contours stand."""
        return self.places

    @property
    def marks(self) -> Floats:
        """The breaks of every contour, and the ends of the charts."""
        found = [np.arange(0.0, 9.0, 2.0)]
        for contour in self.contours:
            if contour.outline is not None:
                starts, ends, _ = monotone_cells(contour.outline)
                found += [starts, ends]
        marks = np.unique(np.concatenate(found))
        return np.asarray(marks[np.append(np.diff(marks) > 1e-12, True)])

    def centers(self, u: Floats) -> Floats:
        """Morphs are about the origin."""
        return np.zeros((len(u), 2))

    def watched(self, start: Floats, end: Floats) -> Floats:
        """Anywhere, and the joints of the contours' pieces: tips change most."""
        joints = self.marks[:-1]
        return np.concatenate([EVENLY, joints, np.nextafter(joints[1:], 0.0)])[None]

    def radii(self, T: Floats, u: Floats) -> Floats:
        """Blend the contours' own radii."""
        distinct, which = np.unique(T, return_inverse=True)
        own = np.stack([_radii(contour, distinct) for contour in self.contours], axis=-1)
        return np.asarray(own[which.reshape(T.shape)] @ np.swapaxes(self._weights(u), -1, -2))

    def corners(self, u: Floats) -> tuple[Floats, Floats]:
        """Blend the corners too: a contour's jump is ``-2 dr' / r^3`` of its own radius."""
        found = []
        for index, contour in enumerate(self.contours):
            if contour.outline is None:
                continue
            scale = contour.matrix[0, 0]
            for T, jump in kinks(contour.outline):
                own = float(_radii(contour, np.array([T]))[0])
                found.append((T, index, -0.5 * jump * own**3 / scale**2))
        if not found:
            return np.zeros(0), np.zeros((0, len(u)))
        T = np.array([f[0] for f in found])
        weights = self._weights(u)
        turn = np.array([f[2] * weights[:, f[1]] for f in found])
        return T, np.asarray(-2 * turn / self.radii(T, u) ** 3)

    def _weights(self, u: Floats) -> Floats:
        """Return how much of each contour there is at u, ``(n, c)``."""
        return np.asarray(self.cardinal(u))


def _radii(contour: Contour, T: Floats) -> Floats:
    """Return the radius in mm at pseudo-angles."""
    if contour.outline is None:
        return np.full(len(T), contour.matrix[0, 0])
    return np.asarray(radii(contour.outline, chart_rays(T)) * contour.matrix[0, 0])


def morph(sweep: doc.MorphSweep) -> Morph:
    """Read a morph, or refuse a contour that is not star-shaped about the origin.

    Raises
    ------
    RefusalError
        Below ``/sweep/contours``.
    """
    found = []
    for index, section in enumerate(sweep.contours):
        path = f"/sweep/contours/{index}"
        try:
            outline = plane_outline(section.contour)
            check_simple(outline)
            placed = star(outline, np.zeros(2))
        except RefusalError as refusal:
            problem = refusal.problem
            raise RefusalError(path + problem.path, problem.kind, problem.message) from None
        if placed is None:
            raise RefusalError(
                f"{path}/contour",
                "not_star_shaped",
                "the origin does not see the whole contour; expected it to, in a morph",
            )
        found.append(placed)
    places = np.array([s.at for s in sweep.contours], dtype=np.float64)
    cardinal = not_a_knot(places, np.eye(len(places)))
    result = Morph(places, tuple(found), cardinal)
    _check_positive(result)
    return result


def _check_positive(sections: Morph) -> None:
    """Refuse a morph whose blended radius swings to 0 between its contours."""
    u = np.concatenate(
        [np.linspace(a, b, 65) for a, b in zip(sections.places, sections.places[1:], strict=False)]
    )
    T = np.linspace(0, 8, 256, endpoint=False)
    found = sections.radii(T, u)
    least, most = found.min(axis=0), found.max(axis=0)
    worst = int(np.argmin(least))
    if least[worst] <= 1e-3 * most.max():
        raise RefusalError(
            "/sweep",
            "singular_sweep",
            f"the section shrinks to a radius of {least[worst]:.4g} mm at u = {u[worst]:.6g}; "
            f"expected at least 0.001 of its largest, {most.max():.4g} mm",
        )
