"""The paper's subdivision finds the engine's roots, but for those that its sampling loses."""

from dataclasses import astuple, dataclass

import numpy as np
import pytest

import phantom
from tests.oracles import families_new, rays
from tests.oracles.paper import Paper

MATCH_MM = 1e-2
"""Farther than this a root of the paper is another root. Its epsilon is not a distance along the
ray: near a section that the ray is parallel to, w runs fast with u."""

BONE = {"type": "spline", "points": [[0, 0, 0], [5, 3, 60], [0, 0, 120]]}
SOLIDS = {
    "straight": {
        "axis": {"type": "line", "start": [0, 0, 0], "end": [0, 0, 100]},
        "contour": {"type": "superellipse", "semi_axes": [20, 12], "exponent": 3},
    },
    "torus": {
        "axis": {
            "type": "arc",
            "center": [0, 0, 0],
            "normal": [0, 0, 1],
            "start": [60, 0, 0],
            "angle_deg": 360,
        },
        "contour": {"type": "circle", "radius": 20},
    },
    "bone": {
        "axis": BONE,
        "contour": {"type": "ellipse", "semi_axes": [12, 9]},
        "sweep": {
            "type": "linear",
            "scale": {"knots": [[0, 1.2], [0.5, 0.8], [1, 1.1]]},
            "rotate_deg": {"knots": [[0, 0], [1, 90]]},
        },
    },
    "coil": {
        "axis": {
            "type": "formula",
            "x": "40*cos(u)",
            "y": "40*sin(u)",
            "z": "6*u",
            "range": [0, 5],
        },
        "contour": {"type": "polar", "formula": "10*(1 + 0.25*cos(3*theta))"},
    },
    "letter": {
        "axis": BONE,
        "contour": {"type": "spline", "points": families_new.letter_c(0.7, 14, 12.0, 5.0)},
    },
}
KINDS = ("random", "nearly along a section", "in a section", "grazing")


@dataclass
class Count:
    """What was traced, and what of it the paper's subdivision does not find."""

    rays: int = 0
    rays_whole: int = 0
    """Rays on which it finds every root, and no other, within ``MATCH_MM``."""
    roots: int = 0
    lost: int = 0
    lost_short: int = 0
    """Of the lost, those of chords under 1 mm."""
    invented: int = 0
    moved: int = 0
    """Roots of rays on which it finds as many as there are, but farther off than ``MATCH_MM``."""
    worst_mm: float = 0.0
    """Along the ray, where all are found."""

    def __add__(self, other):
        sums = [a + b for a, b in zip(astuple(self), astuple(other), strict=True)]
        return Count(*sums[:-1], max(self.worst_mm, other.worst_mm))


def lines(kind, shape, paper, rng, count):
    center = shape.compiled.scene.leaf_center[0]
    radius = float(shape.compiled.scene.leaf_radius[0])
    origins, directions = rays.through_ball(rng, count, radius, center)
    s = rng.uniform(0.05, 0.95, count)
    axis = paper.solid.axis
    places, tangents = axis(s), axis.tangent(s)
    if kind == "random":
        near = places + rng.normal(0, 6, (count, 3))
        origins = near - 3 * radius * directions
    elif kind != "grazing":
        lean = 10.0 ** rng.uniform(-6, -2, count) if kind.startswith("nearly") else 0.0 * s
        across = rays.unit(directions - (directions * tangents).sum(axis=1)[:, None] * tangents)
        shift = rays.unit(np.cross(tangents, across)) * rng.uniform(-8, 8, count)[:, None]
        directions = rays.unit(across + lean[:, None] * tangents)
        origins = places + shift - 3 * radius * directions
    else:
        origins = _tangent(shape, places, directions, radius, rng)
    return origins, directions


def _tangent(shape, places, directions, radius, rng):
    """Rays moved sideways, by halves, to 1e-4 ... 1e-1 mm inside a silhouette."""
    side = rays.unit(np.cross(directions, rng.standard_normal(directions.shape)))
    low, high = np.zeros(len(side)), np.full(len(side), 2 * radius)
    start = places - 3 * radius * directions
    for _ in range(45):
        middle = 0.5 * (low + high)
        hit = phantom.path_lengths(shape, start + middle[:, None] * side, directions)[:, 0] > 0
        low, high = np.where(hit, middle, low), np.where(hit, high, middle)
    return start + (low - 10.0 ** rng.uniform(-4, -1, len(side)))[:, None] * side


def count_losses(leaf, kind, count, seed=0):
    """Trace rays of a kind with both; the engine's roots are those that are looked for."""
    document = {
        "format": "phantom/1",
        "name": "paper",
        "materials": {"m": {"attenuation_per_mm": 0.01}},
        "solid": {"type": "generalized_cylinder", "material": "m", **leaf},
    }
    shape, paper = phantom.load(document), Paper(document["solid"])
    origins, directions = lines(kind, shape, paper, np.random.default_rng(seed), count)
    pieces = phantom.intervals(shape, origins, directions)
    total = Count()
    for i in range(count):
        mine = pieces.ray == i
        chords = np.column_stack([pieces.entry_mm[mine], pieces.exit_mm[mine]])
        wanted, found = chords.ravel(), paper.roots(origins[i], directions[i])
        found = found[found > 0]
        total += _matched(wanted, np.repeat(np.diff(chords, axis=1)[:, 0], 2), found)
    return total


def _matched(wanted, chord, found):
    gap = np.abs(wanted[:, None] - found)
    if len(wanted) == len(found):
        moved = np.abs(wanted - found)
        far = int(np.count_nonzero(moved > MATCH_MM))
        worst = 0.0 if far else float(moved.max(initial=0.0))
        return Count(1, int(far == 0), len(wanted), moved=far, worst_mm=worst)
    rest, lost = list(range(len(found))), []
    for k in range(len(wanted)):
        best = min(rest, key=lambda j: gap[k, j], default=None)
        if best is None or gap[k, best] > MATCH_MM:
            lost.append(chord[k])
        else:
            rest.remove(best)
    short = sum(c < 1 for c in lost)
    return Count(1, 0, len(wanted), len(lost), short, len(rest))


@pytest.mark.parametrize("name", SOLIDS)
@pytest.mark.parametrize("kind", KINDS)
def test_the_paper_agrees_where_it_finds_all_roots(name, kind):
    found = count_losses(SOLIDS[name], kind, 4)
    assert found.roots > 0
    assert found.rays_whole > 0
    assert found.worst_mm < MATCH_MM


def test_random_rays_through_a_bone_lose_next_to_nothing():
    found = count_losses(SOLIDS["bone"], "random", 25, seed=1)
    assert found.lost <= 0.02 * found.roots


def table(count=100):
    """Print the table of docs/methods/paper_twin.md: ``python -m tests.tracing.test_paper``."""
    print(
        "| solid | rays | traced | whole | roots "
        "| lost | of short chords | invented | moved | worst mm |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, leaf in SOLIDS.items():
        for kind in KINDS:
            c = count_losses(leaf, kind, count, seed=2)
            print(
                f"| {name} | {kind} | {c.rays} | {c.rays_whole} | {c.roots} | {c.lost} | "
                f"{c.lost_short} | {c.invented} | {c.moved} | {c.worst_mm:.1e} |",
                flush=True,
            )


if __name__ == "__main__":
    table()
