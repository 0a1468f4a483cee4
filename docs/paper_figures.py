"""Draw figures 3 and 4 of the 1993 paper for one ray through the deformed object.

Run from the project's root: ``uv run python docs/paper_figures.py``. The ray meets the normal plane
of every u in one point: together they are the curve rho(u), in the plane of n and b. It crosses the
contour c(u, v) of its own u where the ray crosses the surface (figure 3). The inverse sweep takes
rho(u) to phi(u) and every contour to the first one, cs(v): a morph's inverse stretches each
direction theta by r(theta, u_i) / r(theta, u) (figure 4). The crossings marked are the engine's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

import phantom
from phantom.geometry.star import chart_rays, pseudo_angle
from phantom.geometry.swept import swept_shapes

Floats = NDArray[np.float64]

IMAGES = Path("docs/images")
CONTOURS_AT = np.linspace(0.5, 3.0, 5)
# The ray goes through the middle of the section at this u, leaning from t toward n and b.
THROUGH_U = 1.06
LEAN = (0.62, 0.22)
NUMBER: dict[str, Any] = {
    "color": "tab:red",
    "fontsize": 8,
    "bbox": {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.5},
}


@dataclass(frozen=True)
class Sweep:
    """The deformed object as the paper's functions of u."""

    plane: Callable[[Floats], tuple[Floats, Floats]]  # a(u) (n, 3); t, n, b as rows (n, 3, 3)
    radii: Callable[[Floats, Floats], Floats]  # r(T, u) for pairs
    points: Callable[[float], Floats]  # c(u, .) (k, 2)
    span: tuple[float, float]


def sweep_of(leaf: Any) -> Sweep:
    shape: Any = swept_shapes(leaf)[0][0]
    sections, breaks = shape.changing, shape.curve.breaks

    def plane(u: Floats) -> tuple[Floats, Floats]:
        piece = np.clip(np.searchsorted(breaks, u, side="right") - 1, 0, len(breaks) - 2)
        found = shape.sections(u, piece)
        t = found.first / np.linalg.norm(found.first, axis=1)[:, None]
        n, b = np.moveaxis(found.spread / shape.unit, 2, 0)
        return found.axis, np.stack([t, n, b], axis=1)

    def radii(T: Floats, u: Floats) -> Floats:
        return np.array([sections.radii(T[i : i + 1], u[i : i + 1])[0, 0] for i in range(len(u))])

    def points(u: float) -> Floats:
        T = np.linspace(0.0, 8.0, 2001)
        rays = chart_rays(T)
        directions = rays / np.linalg.norm(rays, axis=1)[:, None]
        return np.asarray(sections.radii(T, np.array([u])) * directions)

    return Sweep(plane, radii, points, (float(breaks[0]), float(breaks[-1])))


@dataclass(frozen=True)
class Ray:
    """A ray among the normal planes of a sweep."""

    sweep: Sweep
    origin: Floats
    direction: Floats

    def distances(self, u: Floats) -> Floats:
        """Return w(u) in mm: how far along the ray it meets the normal plane of u."""
        at, axes = self.sweep.plane(u)
        t = axes[:, 0]
        return np.asarray(np.einsum("ni,ni->n", t, at - self.origin) / (t @ self.direction))

    def rho(self, u: Floats) -> Floats:
        """Return the points of the ray in the normal planes, along n and b."""
        at, axes = self.sweep.plane(u)
        points = self.origin + self.distances(u)[:, None] * self.direction - at
        return np.asarray(np.einsum("nij,nj->ni", axes[:, 1:], points))

    def phi(self, u: Floats) -> Floats:
        """Return rho(u) after the inverse sweep."""
        rho = self.rho(u)
        T = pseudo_angle(rho)
        first = np.full(len(u), self.sweep.span[0])
        return np.asarray(rho * (self.sweep.radii(T, first) / self.sweep.radii(T, u))[:, None])

    def parameter(self, distance: float) -> float:
        """Return u of the normal plane that the ray meets at a distance."""
        return float(
            brentq(lambda u: self.distances(np.array([u]))[0] - distance, *self.sweep.span)
        )


def scene() -> tuple[Ray, Floats]:
    """Return the ray, and u where the engine says that it enters and leaves the object."""
    loaded = phantom.library.build("deformed")
    sweep = sweep_of(loaded.document.solid)
    at, axes = (found[0] for found in sweep.plane(np.array([THROUGH_U])))
    direction = axes[0] + LEAN[0] * axes[1] + LEAN[1] * axes[2]
    direction /= np.linalg.norm(direction)
    ray = Ray(sweep, at - 500.0 * direction, direction)
    found = phantom.intervals(loaded, ray.origin[None], direction[None])
    crossings = np.sort(np.concatenate([found.entry_mm, found.exit_mm]))
    return ray, np.array([ray.parameter(float(w)) for w in crossings])


def _axes(title: str, reach: float) -> tuple[Any, Any]:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.4, 6.4), dpi=100, layout="constrained")
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", title=title)
    axes.set(xlabel="along n (mm)", ylabel="along b (mm)")
    axes.grid(color="0.93")
    axes.set_axisbelow(True)
    return figure, axes


def _ray_curve(axes: Any, name: str, of: Callable[[Floats], Floats], span: Any) -> None:
    """Draw a curve of u with an arrow's head toward growing u and marks at the contours' u."""
    points = of(np.linspace(*span, 1200))
    axes.plot(*points.T, color="tab:red", linewidth=2, label=f"{name}(u)")
    marks = of(CONTOURS_AT)
    axes.plot(*marks.T, "o", color="tab:red", markersize=4)
    for u, (x, y) in zip(CONTOURS_AT, marks, strict=True):
        axes.annotate(f"{u:g}", (x, y), (5, -11), textcoords="offset points", **NUMBER)


def figure_3(ray: Ray, crossings: Floats) -> Any:
    from matplotlib import colormaps

    figure, axes = _axes("ρ(u) of one ray among the contours c(u, v)", 55.0)
    colors = colormaps["viridis"](np.linspace(0.0, 0.85, len(CONTOURS_AT)))
    for u, color in zip(CONTOURS_AT, colors, strict=True):
        axes.plot(*ray.sweep.points(u).T, color=color, label=f"c({u:g}, v)")
    for index, u in enumerate(crossings):
        label = "c(u, v) where ρ(u) crosses it" if index == 0 else None
        axes.plot(*ray.sweep.points(u).T, color="0.55", linewidth=1, linestyle="--", label=label)
    _ray_curve(axes, "ρ", ray.rho, ray.sweep.span)
    axes.plot(*ray.rho(crossings).T, "o", color="black", label="the engine's crossings", zorder=5)
    axes.legend(loc="upper left", fontsize=8)
    return figure


def figure_4(ray: Ray, crossings: Floats) -> Any:
    figure, axes = _axes("φ(u), the ray after the inverse sweep, and cs(v)", 55.0)
    axes.plot(*ray.sweep.points(ray.sweep.span[0]).T, color="tab:blue", label="cs(v)")
    _ray_curve(axes, "φ", ray.phi, ray.sweep.span)
    axes.plot(*ray.phi(crossings).T, "o", color="black", label="the engine's crossings", zorder=5)
    axes.legend(loc="upper left", fontsize=8)
    return figure


def main() -> None:
    ray, crossings = scene()
    for name, draw in (("figure-3.png", figure_3), ("figure-4.png", figure_4)):
        draw(ray, crossings).savefig(IMAGES / name, metadata={"Software": None})
        print(f"wrote {IMAGES / name}")
    print("the ray crosses the surface at u =", ", ".join(f"{u:.4f}" for u in crossings))


if __name__ == "__main__":
    main()
