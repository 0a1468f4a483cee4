"""Evaluations of G a hit ray and time to build, for solids of every family.

Run with ``python bench/evaluations.py`` from the root of the project, on an idle machine.
"""

import statistics
import time

import numpy as np

import phantom
from phantom.kernels import rays as kernels

RAYS = 20_000
BUILDS, LONGEST_S = 5, 6.0
SHORTEST_MM, PIECES = 1e-3, 256

BONE = {"type": "spline", "points": [[0, 0, 0], [5, 3, 60], [0, 0, 120]]}
LINE = {"type": "line", "start": [0, 0, 0], "end": [0, 0, 60]}
RING = {"type": "arc", "center": [0, 0, 0], "normal": [0, 0, 1], "start": [60, 0, 0]}
CLOSED_RING = {**RING, "angle_deg": 360}
THETA = 2 * np.pi * np.arange(20) / 20
SQUARE = [[15, 15], [-15, 15], [-15, -15], [15, -15]]
WAIST = {"knots": [[0, 20], [0.3, 12], [0.7, 12], [1, 22]]}


def circle(radius):
    return {"type": "circle", "radius": radius}


def polygon(points, radius):
    return {"type": "polygon", "points": points, "corner_radius": radius}


def star(count=5, outer=20, inner=9):
    angle = np.pi * np.arange(2 * count) / count
    radius = np.where(np.arange(2 * count) % 2, inner, outer)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1).tolist()


def letter_c(count=24, radius=20, width=6, gap=0.5):
    return band(np.linspace(gap, 2 * np.pi - gap, count), radius, radius - width)


def spiral(turns=3, a_turn=60, width=3, pitch=8):
    angle = np.linspace(0, 2 * np.pi * turns, a_turn * turns)
    radius = 10 + pitch * angle / (2 * np.pi)
    return band(angle, radius, radius - width)


def band(angle, outer, inner):
    ring = np.stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([(outer * ring).T, (inner * ring).T[::-1]]).tolist()


KIDNEY = {
    "type": "formula",
    "x": "(12 + 5*sin(v))*cos(1.3*cos(v)) - 6",
    "y": "(12 + 5*sin(v))*sin(1.3*cos(v))",
    "range": [0, 2 * np.pi],
}
MORPH = [
    {"at": 0, "contour": {"type": "polar", "formula": "14*(1+0.3*cos(5*theta))"}},
    {"at": 0.5, "contour": circle(10)},
    {"at": 1, "contour": polygon([[9, 9], [-9, 9], [-9, -9], [9, -9]], 3)},
]
FAMILIES = {
    "torus": {"axis": CLOSED_RING, "contour": circle(20)},
    "torus, kappa r = 0.9": {"axis": CLOSED_RING, "contour": circle(54)},
    "torus, kappa r = 0.99": {"axis": CLOSED_RING, "contour": circle(59.4)},
    "bone": {
        "axis": BONE,
        "contour": circle(1),
        "sweep": {"type": "linear", "scale": WAIST},
    },
    "helix of a formula": {
        "axis": {
            "type": "formula",
            "x": "40*cos(u)",
            "y": "40*sin(u)",
            "z": "5*u",
            "range": [0, 9],
        },
        "contour": circle(10),
    },
    "truncated ellipsoid of a formula": {
        "axis": LINE,
        "contour": {"type": "ellipse", "semi_axes": [20, 12]},
        "sweep": {"type": "linear", "scale": {"formula": "sqrt(1-(1.96*u-0.98)**2)"}},
    },
    "superellipse, n = 4": {
        "axis": BONE,
        "contour": {"type": "superellipse", "semi_axes": [15, 10], "exponent": 4},
    },
    "superellipse, n = 20": {
        "axis": BONE,
        "contour": {"type": "superellipse", "semi_axes": [15, 10], "exponent": 20},
    },
    "five-lobe star": {
        "axis": BONE,
        "contour": {"type": "polar", "radii": (15 * (1 + 0.3 * np.cos(5 * THETA))).tolist()},
    },
    "five-lobe star of a formula": {
        "axis": BONE,
        "contour": {"type": "polar", "formula": "15*(1+0.3*cos(5*theta))"},
    },
    "rounded square": {"axis": BONE, "contour": polygon(SQUARE, 3)},
    "rounded square, twisted": {
        "axis": BONE,
        "contour": polygon(SQUARE, 3),
        "sweep": {"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, 90]]}},
    },
    "sharp square, twisted": {
        "axis": BONE,
        "contour": polygon(SQUARE, 0),
        "sweep": {"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, 90]]}},
    },
    "sharp star": {"axis": BONE, "contour": polygon(star(), 0)},
    "matrix sweep": {
        "axis": BONE,
        "contour": circle(10),
        "sweep": {
            "type": "linear",
            "matrix": [
                [{"formula": "1+0.3*u"}, 0.2, 0],
                [0, 1, 0],
                [{"knots": [[0, 0], [1, 5]]}, 2, 1],
            ],
        },
    },
    "formula sweep": {
        "axis": BONE,
        "contour": {"type": "ellipse", "semi_axes": [12, 9]},
        "sweep": {
            "type": "formula",
            "forward": ["x+0.01*u*y**2", "y*(1+0.2*u)"],
            "inverse": ["x-0.01*u*(y/(1+0.2*u))**2", "y/(1+0.2*u)"],
        },
    },
    "morph": {"axis": BONE, "sweep": {"type": "morph", "contours": MORPH}},
    "kidney": {"axis": BONE, "contour": KIDNEY},
    "C": {"axis": BONE, "contour": {"type": "spline", "points": letter_c()}},
    "C, rounded polygon": {"axis": BONE, "contour": polygon(letter_c(), 0.5)},
    "spiral": {"axis": LINE, "contour": {"type": "spline", "points": spiral()}},
}


def load(leaf):
    document = {
        "format": "phantom/1",
        "name": "bench",
        "materials": {"m": {"attenuation_per_mm": 0.01}},
        "solid": {"type": "generalized_cylinder", "material": "m", **leaf},
    }
    return phantom.load(document)


def lines(rng, radius, center):
    """Isotropic random lines that meet a ball."""
    directions = rng.standard_normal((RAYS, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    a = np.cross(directions, rng.standard_normal((RAYS, 3)))
    a /= np.linalg.norm(a, axis=1)[:, None]
    shift = radius * np.sqrt(rng.random(RAYS))
    return center + shift[:, None] * a - 3 * radius * directions, directions


def figures(leaf):
    """Segments, ms to build, evaluations a hit ray, microseconds a ray."""
    shape, times = load(leaf), []
    while len(times) < BUILDS and sum(times) < LONGEST_S:
        start = time.perf_counter()
        load(leaf)
        times.append(time.perf_counter() - start)
    scene = shape.compiled.scene
    rng = np.random.default_rng(0)
    origins, directions = lines(rng, scene.leaf_radius[0], scene.leaf_center[0])
    out, counter = np.zeros((RAYS, 1)), np.zeros(1, dtype=np.int64)
    start = time.perf_counter()
    far = np.full(RAYS, np.inf)
    kernels.path_lengths(scene, origins, directions, far, SHORTEST_MM, PIECES, out, counter)
    spent = time.perf_counter() - start
    evaluations = counter[0] / np.count_nonzero(out)
    return len(scene.origins), 1e3 * statistics.median(times), evaluations, 1e6 * spent / RAYS


def main():
    figures(FAMILIES["torus"])
    print("| solid | segments | build, ms | evaluations a hit ray | us a ray |")
    print("|---|---|---|---|---|")
    for name, leaf in FAMILIES.items():
        segments, build, evaluations, spent = figures(leaf)
        print(
            f"| {name} | {segments} | {build:.0f} | {evaluations:.1f} | {spent:.1f} |", flush=True
        )


if __name__ == "__main__":
    main()
