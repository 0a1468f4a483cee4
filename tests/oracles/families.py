"""Random generalized cylinders of every family, as plain trees; all fit in a ball of 130 mm."""

import numpy as np

AXES = (
    "line",
    "spline",
    "closed spline",
    "bspline 2",
    "bspline 3",
    "bspline 4",
    "arc",
    "closed arc",
    "helix",
)
CONTOURS = ("circle", "ellipse", "superellipse", "polygon", "spline", "polar")
SWEEPS = ("none", "constant", "scale", "two scales", "rotate", "shear", "offset", "all")
FRAMES = ("rotation_minimizing", "frenet", "up")


def axis(kind, rng):
    """An axis whose radius of curvature is some 50 mm or more."""
    wiggle = rng.uniform(-1, 1, (6, 3)) * [8, 8, 3]
    if kind == "line":
        return {
            "type": "line",
            "start": [*wiggle[0] - [0, 0, 50]],
            "end": [*wiggle[1] + [9, 5, 50]],
        }
    if kind == "spline":
        points = np.stack([0 * np.arange(4), 0 * np.arange(4), np.linspace(-70, 70, 4)], axis=1)
        return {"type": "spline", "points": (points + wiggle[:4]).tolist()}
    if kind == "closed spline":
        angle = 2 * np.pi * np.arange(6) / 6
        points = 75 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        return {"type": "spline", "points": (points + 0.5 * wiggle).tolist(), "closed": True}
    if kind.startswith("bspline"):
        heights = np.linspace(-70, 70, 6)
        points = np.stack([0.004 * heights**2, 0 * heights, heights], axis=1)
        points = points + wiggle * [1, 1, 1]
        return {"type": "bspline", "control_points": points.tolist(), "degree": int(kind[-1])}
    radius = rng.uniform(55, 75)
    turn = rng.uniform(0, 2 * np.pi)
    start = [radius * np.cos(turn), radius * np.sin(turn), 0.0]
    if kind == "helix":
        turns, pitch = rng.uniform(0.4, 1.6) * rng.choice([-1, 1]), rng.uniform(70, 90)
        center = [0, 0, 0]
        return {
            "type": "helix",
            "center": center,
            "axis": [0, 0, 2.0],
            "start": [start[0] * 0.6, start[1] * 0.6, float(rng.uniform(-70, -40))],
            "pitch": float(pitch * rng.choice([-0.2, 1]) if abs(turns) < 0.8 else pitch),
            "turns": float(turns),
        }
    angle = 360.0 * rng.choice([-1, 1]) if kind == "closed arc" else rng.uniform(40, 300)
    return {
        "type": "arc",
        "center": [0, 0, 0],
        "normal": [0, 0, 1],
        "start": start,
        "angle_deg": float(angle),
    }


def contour(kind, rng):
    """A contour of some 10 to 14 mm."""
    size = rng.uniform(8, 12)
    other = size * rng.uniform(0.6, 1.1)
    if kind == "circle":
        return {"type": "circle", "radius": size}
    if kind == "ellipse":
        return {"type": "ellipse", "semi_axes": [size, other]}
    if kind == "superellipse":
        exponent = float(rng.choice([2, 2.5, 3, 4, 7.3, 20]))
        return {"type": "superellipse", "semi_axes": [size, 0.8 * other], "exponent": exponent}
    if kind == "polygon":
        count = rng.integers(3, 7)
        angle = np.sort(2 * np.pi * (np.arange(count) + rng.uniform(-0.2, 0.2, count)) / count)
        points = size * rng.uniform(0.8, 1.1, (count, 1)) * _ring(angle) + rng.uniform(-2, 2, 2)
        return {
            "type": "polygon",
            "points": points.tolist(),
            "corner_radius": float(rng.uniform(0.5, 1.5)),
        }
    count = rng.integers(5, 10)
    radii = size * rng.uniform(0.75, 1.15, count)
    if kind == "polar":
        return {"type": "polar", "radii": radii.tolist()}
    points = radii[:, None] * _ring(2 * np.pi * np.arange(count) / count) + rng.uniform(-2, 2, 2)
    return {"type": "spline", "points": points[:: rng.choice([-1, 1])].tolist()}


def _ring(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _knots(rng, low, high, closed):
    count = int(rng.integers(2, 6))
    u = np.concatenate([[0.0], np.sort(rng.uniform(0.1, 0.9, count - 2)), [1.0]])
    if count > 3:  # far enough apart to stay calm
        u = np.linspace(0, 1, count)
    values = rng.uniform(low, high, count)
    if closed:
        values[-1] = values[0]
    return {"knots": [[float(a), float(b)] for a, b in zip(u, values, strict=True)]}


def sweep(kind, rng, closed):
    """A linear sweep; on a closed axis it comes back to where it started."""
    turn = _knots(rng, -60, 60, closed)
    if closed and rng.random() < 0.5:
        turn = {"knots": [[0, 10], [1, 370]]}
    return {
        "none": {},
        "constant": {
            "scale": [float(rng.choice([-1.1, 0.9])), 1.2],
            "rotate_deg": 33,
            "shear": -0.3,
            "offset": [2, -3],
        },
        "scale": {"scale": _knots(rng, 0.7, 1.3, closed)},
        "two scales": {"scale": [_knots(rng, 0.7, 1.3, closed), _knots(rng, 0.7, 1.3, closed)]},
        "rotate": {"rotate_deg": turn},
        "shear": {"shear": _knots(rng, -0.4, 0.4, closed)},
        "offset": {"offset": [_knots(rng, -5, 5, closed), _knots(rng, -5, 5, closed)]},
        "all": {
            "scale": [_knots(rng, 0.7, 1.2, closed), 0.9],
            "rotate_deg": turn,
            "shear": _knots(rng, -0.3, 0.3, closed),
            "offset": [_knots(rng, -4, 4, closed), 1.5],
        },
    }[kind]


def generalized_cylinder(rng, kinds):
    """A leaf of the four kinds (axis, contour, sweep, frame)."""
    way = axis(kinds[0], rng)
    closed = kinds[0].startswith("closed")
    frame = kinds[3]
    if frame == "up":
        # Across every axis above: lines, splines and helices climb, rings lie flat.
        flat = kinds[0] in ("closed spline", "arc", "closed arc")
        frame = {"up": [0.1, 0.2, 3.0] if flat else [1.0, 0.3, 0.1]}
        if kinds[0] == "helix":
            frame = {"up": [0.05, 0.0, 1.0]}
    return {
        "type": "generalized_cylinder",
        "axis": way,
        "contour": contour(kinds[1], rng),
        "sweep": {"type": "linear", **sweep(kinds[2], rng, closed)},
        "frame": frame,
    }


def allowed(kinds):
    """Frenet frames are for axes that bend everywhere, without jumps."""
    return kinds[3] != "frenet" or kinds[0] in ("arc", "closed arc", "helix")
