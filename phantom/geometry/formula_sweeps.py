"""Sweeps given by formulas with their inverses (paper section III.A, the alternative).

The forward map alone is traced, as a table of radii about each section's centroid; the inverse is
checked against it over the whole range of u and v, which shows the sweep to be invertible there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.changing import EVENLY
from phantom.geometry.contours import outline_samples
from phantom.geometry.formulas import Formula
from phantom.geometry.outlines import Outline
from phantom.geometry.refusal import RefusalError
from phantom.geometry.star import chart_rays, kinks, pseudo_angle
from phantom.geometry.vectors import plane_cross

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_AROUND = 768
_INVERSE = 1e-9


@dataclass(frozen=True)
class FormulaSections:
    """Sections of a contour under ``[x', y'] = forward(x, y, u)``."""

    outline: Outline  # in mm, in the contour plane
    forward: tuple[Formula, Formula]
    breaks: Floats

    @property
    def marks(self) -> Floats:
        """The ends of the charts: corners are refused, for they would move."""
        return np.arange(0.0, 9.0, 2.0)

    def centers(self, u: Floats) -> Floats:
        """Return the centroids of the sections."""
        return _centroids(self.placed(u))

    def corners(self, u: Floats) -> tuple[Floats, Floats]:
        """There are none."""
        return np.zeros(0), np.zeros((0, len(u)))

    def placed(self, u: Floats) -> Floats:
        """Return samples of the sections, ``(n, V, 2)``."""
        points = outline_samples(self.outline, _AROUND)[0]
        return self.mapped(points[None, :, 0], points[None, :, 1], u[:, None])

    def mapped(self, x: Floats, y: Floats, u: Floats) -> Floats:
        """Return where points of the contour plane go at u, ``(..., 2)`` mm, all broadcast."""
        shape = np.broadcast_shapes(x.shape, y.shape, u.shape)
        x, y, u = (np.broadcast_to(a, shape).ravel() for a in (x, y, u))
        columns = [np.broadcast_to(f.values(x=x, y=y, u=u), x.shape) for f in self.forward]
        return np.stack(columns, axis=-1).reshape(*shape, 2)

    def watched(self, start: Floats, end: Floats) -> Floats:
        """Return T where a section may change least smoothly over ranges of u, ``(n, T)``.

        The joints of the contour's pieces, which move round as u goes on, at a few u of each.
        """
        breaks = self.outline.breaks
        joints = self.outline.derivatives(breaks[:-1], np.arange(len(breaks) - 1))[0]
        u = (start[:, None] + np.array([0.25, 0.5, 0.75]) * (end - start)[:, None]).ravel()
        seen = self.mapped(joints[None, :, 0], joints[None, :, 1], u[:, None])
        seen = seen - self.centers(u)[:, None]
        moving = pseudo_angle(seen.reshape(-1, 2)).reshape(len(start), -1)
        fixed = np.broadcast_to(EVENLY, (len(start), len(EVENLY)))
        return np.concatenate([fixed, moving], axis=1)

    def radii(self, T: Floats, u: Floats) -> Floats:
        """Solve for the contour's point on the ray of each pseudo-angle, by safeguarded secants."""
        breaks = self.outline.breaks
        each = max(4, int(np.ceil(_AROUND / (len(breaks) - 1))))
        distinct, which = np.unique(u, return_inverse=True)
        sampled = self.placed(distinct)
        centers = _centroids(sampled)
        seen = sampled - centers[:, None]
        turn = np.sign(plane_cross(seen, np.roll(seen, -1, axis=1)).sum(axis=1))
        shape = np.broadcast_shapes((*T.shape, 1), (*u.shape[:-1], 1, u.shape[-1]))
        at = np.broadcast_to(T[..., None], shape).ravel()
        owner = np.broadcast_to(which.reshape(u.shape)[..., None, :], shape).ravel()
        before = _samples_before(seen, turn, at, owner)
        after = (before + 1) % seen.shape[1]
        rays, sense = chart_rays(at), turn[owner]
        piece = before // each
        step = np.diff(breaks)[piece] / each
        low = breaks[piece] + (before % each) * step
        high = low + step
        f_low = sense * plane_cross(rays, seen[owner, before])
        f_high = sense * plane_cross(rays, seen[owner, after])
        side = np.zeros(len(at), dtype=np.intp)
        found, left = np.zeros(len(at)), np.arange(len(at))
        for _ in range(60):
            rise = f_high - f_low
            v = (low * f_high - high * f_low) / np.where(rise != 0, rise, 1.0)
            v = np.where((rise != 0) & (v >= low) & (v <= high), v, 0.5 * (low + high))
            plane = self.outline.derivatives(v, piece)[0]
            point = self.mapped(plane[:, 0], plane[:, 1], distinct[owner]) - centers[owner]
            f = sense * plane_cross(rays, point)
            size = np.linalg.norm(point, axis=-1)
            found[left] = size
            # The radius is off by the square of this, and by its rounding.
            on = np.abs(f) > 1e-12 * size * np.linalg.norm(rays, axis=-1)
            if not on.any():
                break
            under = f <= 0
            # Illinois: an end that stays twice counts half, so that both close in.
            f_high = np.where(under & (side == -1), 0.5 * f_high, f_high)
            f_low = np.where(~under & (side == 1), 0.5 * f_low, f_low)
            side = np.where(under, -1, 1)
            low, f_low = np.where(under, v, low), np.where(under, f, f_low)
            high, f_high = np.where(under, high, v), np.where(under, f_high, f)
            left, owner, piece, rays, sense, side = (
                x[on] for x in (left, owner, piece, rays, sense, side)
            )
            low, high, f_low, f_high = (x[on] for x in (low, high, f_low, f_high))
        return found.reshape(shape)


def _centroids(points: Floats) -> Floats:
    """Return the centroids of polygons ``(n, V, 2)``."""
    following = np.roll(points, -1, axis=1)
    cross = plane_cross(points, following)
    total = cross.sum(axis=1)
    return np.asarray(((points + following) * cross[..., None]).sum(axis=1) / (3 * total[:, None]))


def _samples_before(seen: Floats, turn: Floats, T: Floats, owner: Ints) -> Ints:
    """Return the last sample before each ray, going round in the section's own direction."""
    count = seen.shape[1]
    at = pseudo_angle(seen.reshape(-1, 2)).reshape(len(seen), count)
    order = np.argsort(at, axis=1)
    # All sections in one increasing row, 10 apart.
    row = np.take_along_axis(at, order, axis=1) + 10.0 * np.arange(len(seen))[:, None]
    place = np.searchsorted(row.ravel(), T + 10.0 * owner, side="right") - 1 - count * owner
    below = order[owner, place]
    return np.asarray(np.where(turn[owner] > 0, below, (below - 1) % count), dtype=np.intp)


def formula_sections(
    sweep: doc.FormulaSweep, outline: Outline, span: tuple[float, float]
) -> FormulaSections:
    """Read a formula sweep, or refuse it.

    Raises
    ------
    RefusalError
        Below ``/sweep``: no finite value, a pair that does not invert, a section that its centroid
        does not see whole; at ``/contour`` where the contour has corners.
    """
    if len(kinks(outline)):
        raise RefusalError(
            "/contour",
            "sharp_corner",
            "the contour has a corner; expected a smooth one under a sweep by formulas",
        )
    forward = tuple(Formula.of(text, "x", "y", "u") for text in sweep.forward)
    breaks = np.linspace(*span, 9)
    sections = FormulaSections(outline, (forward[0], forward[1]), breaks)
    u = np.linspace(*span, 129)
    placed = sections.placed(u)
    bad = np.argwhere(~np.isfinite(placed))
    if len(bad):
        n, _, axis = bad[0]
        raise RefusalError(
            f"/sweep/forward/{axis}",
            "undefined",
            f"the formula has no finite value at u = {u[n]:.6g}; expected one at every u",
        )
    _check_inverse(sweep, sections, placed, u)
    _check_star(sections, placed, u)
    return sections


def _check_inverse(
    sweep: doc.FormulaSweep, sections: FormulaSections, placed: Floats, u: Floats
) -> None:
    points = outline_samples(sections.outline, _AROUND)[0]
    all_u = np.repeat(u, placed.shape[1])
    x, y = placed.reshape(-1, 2).T
    size = float(np.abs(points).max())
    for axis, text in enumerate(sweep.inverse):
        back = np.broadcast_to(Formula.of(text, "x", "y", "u").values(x=x, y=y, u=all_u), x.shape)
        off = np.abs(back.reshape(len(u), -1) - points[:, axis])
        off = np.where(np.isfinite(off), off, np.inf)
        n, v = np.unravel_index(int(np.argmax(off)), off.shape)
        if off[n, v] > _INVERSE * size:
            raise RefusalError(
                f"/sweep/inverse/{axis}",
                "not_inverse",
                f"at u = {u[n]:.6g} the contour's ({points[v][0]:.6g}, {points[v][1]:.6g}) mm "
                f"comes back {off[n, v]:.3g} mm off; expected the inverse of forward",
            )


def _check_star(sections: FormulaSections, placed: Floats, u: Floats) -> None:
    seen = placed - sections.centers(u)[:, None]
    sides = plane_cross(seen, np.roll(seen, -1, axis=1))
    sides = sides * np.sign(sides.sum(axis=1))[:, None]
    turns = np.abs(
        np.sum(np.arctan2(sides, np.einsum("nvi,nvi->nv", seen, np.roll(seen, -1, axis=1))), axis=1)
    )
    worst = int(np.argmin(sides.min(axis=1)))
    if sides[worst].min() <= 0 or np.any(turns > 3 * np.pi):
        raise RefusalError(
            "/sweep",
            "not_star_shaped",
            f"at u = {u[worst]:.6g} the section's centroid does not see all of it; "
            "expected star-shaped sections under a sweep by formulas",
        )
