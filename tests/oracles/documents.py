"""Random trees of solids as plain documents; all fit in a ball of 100 mm about the origin."""

import numpy as np

MATERIALS = ("bone", "soft", "metal")
OPERATORS = ("union", "intersection", "difference", "overlap", "replace")


def document(solid, definitions=None):
    """A document of a solid, with three materials."""
    return {
        "format": "phantom/1",
        "name": "random",
        "materials": {m: {"attenuation_per_mm": 0.01} for m in MATERIALS},
        "definitions": definitions or {},
        "solid": solid,
    }


def leaf(rng, kind=None):
    """A random leaf within 50 mm of the origin."""
    kind = kind or rng.choice(list(_LEAVES))
    solid = {"type": kind, "material": str(rng.choice(MATERIALS)), **_LEAVES[kind](rng)}
    if rng.random() < 0.25:
        cut = {"point": _point(rng, 8), "normal": rng.standard_normal(3).tolist()}
        solid["cuts"] = [*solid.get("cuts", []), cut]
    return solid


def tree(rng, depth, names=()):
    """A random tree of operators, transforms and instances."""
    if depth == 0 or rng.random() < 0.15:
        if names and rng.random() < 0.3:
            return {"type": "instance", "of": str(rng.choice(names))}
        return leaf(rng)
    if rng.random() < 0.2:
        return {"type": "transformed", "solid": tree(rng, depth - 1, names), **motion(rng)}
    count = int(rng.choice([2, 2, 2, 3, 4]))
    parts = [tree(rng, depth - 1, names) for _ in range(count)]
    return {"type": str(rng.choice(OPERATORS)), "solids": parts}


def motion(rng):
    """A similarity that keeps things in the ball: by parts, or as a matrix, mirrors included."""
    turn = {"axis": rng.standard_normal(3).tolist(), "angle_deg": float(rng.uniform(-180, 180))}
    if rng.random() < 0.5:
        turn["about"] = _point(rng, 6)
    if rng.random() < 0.6:
        given = {"scale": float(rng.uniform(0.8, 1.1)), "rotate": turn, "translate": _point(rng, 8)}
        keep = rng.choice(list(given), size=rng.integers(1, 4), replace=False)
        return {k: given[k] for k in given if k in keep}
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    q *= rng.uniform(0.8, 1.1)
    return {"matrix": [[*row, float(rng.uniform(-6, 6))] for row in q.tolist()]}


def _point(rng, reach):
    return rng.uniform(-reach, reach, 3).tolist()


def _ends(rng):
    center, along = rng.uniform(-10, 10, 3), rng.standard_normal(3)
    along *= rng.uniform(10, 28) / np.linalg.norm(along)
    return {"start": (center - along).tolist(), "end": (center + along).tolist()}


def _elliptic(rng):
    semi = rng.uniform(5, 16, 2).tolist()
    return {**_ends(rng), "semi_axes": semi, "up": rng.standard_normal(3).tolist()}


def _double_cone(rng):
    k = rng.standard_normal(3)
    k /= np.linalg.norm(k)
    apex = rng.uniform(-8, 8, 3)
    cuts = [
        {"point": (apex + s * rng.uniform(10, 25) * k).tolist(), "normal": (s * k).tolist()}
        for s in (-1, 1)
    ]
    slope = float(rng.uniform(0.3, 1))
    return {"apex": apex.tolist(), "axis": (2 * k).tolist(), "slope": slope, "cuts": cuts}


def _quadric(rng):
    """(x - c).A.(x - c) <= 1 for a random positive A."""
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    a = q @ np.diag(rng.uniform(8, 25, 3) ** -2.0) @ q.T
    c = rng.uniform(-10, 10, 3)
    g = -2 * a @ c
    pairs = [2 * a[0, 1], 2 * a[1, 2], 2 * a[2, 0]]
    return {
        "coefficients": [*np.diag(a).tolist(), *map(float, pairs), *g.tolist(), c @ a @ c - 1.0]
    }


def _cylinder(rng):
    return _elliptic(rng) if rng.random() < 0.4 else {**_ends(rng), "radius": rng.uniform(5, 16)}


def _cone(rng):
    radii = rng.uniform(4, 18, 2)
    if rng.random() < 0.3:
        radii[rng.integers(2)] = 0.0
    return {**_ends(rng), "start_radius": radii[0], "end_radius": radii[1]}


def _tube(rng):
    """A short bent bone."""
    points = np.linspace(-1, 1, 4)[:, None] * rng.uniform(-1, 1, 3)
    points *= 28 / max(np.linalg.norm(points[0]), 1e-9)
    points = points + rng.uniform(-3, 3, (4, 3))
    contours = [
        {"type": "circle", "radius": rng.uniform(5, 9)},
        {"type": "superellipse", "semi_axes": rng.uniform(5, 9, 2).tolist(), "exponent": 3.5},
        {"type": "polar", "radii": rng.uniform(6, 9, 6).tolist()},
    ]
    return {
        "axis": {"type": "spline", "points": points.tolist()},
        "contour": contours[rng.integers(3)],
        "sweep": {
            "type": "linear",
            "scale": {"knots": [[0, 1.2], [0.5, 0.8], [1, 1.1]]},
            "rotate_deg": {"knots": [[0, 0], [1, rng.uniform(-90, 90)]]},
        },
    }


_LEAVES = {
    "sphere": lambda rng: {"center": _point(rng, 15), "radius": rng.uniform(8, 25)},
    "ellipsoid": lambda rng: {
        "center": _point(rng, 15),
        "semi_axes": rng.uniform(6, 28, 3).tolist(),
    },
    "box": lambda rng: {"center": _point(rng, 15), "size": rng.uniform(10, 45, 3).tolist()},
    "cylinder": _cylinder,
    "cone": _cone,
    "double_cone": _double_cone,
    "quadric": _quadric,
    "generalized_cylinder": _tube,
}
