"""Random generalized cylinders of every kind: formulas, matrices, morphs, corners, any outline."""

import json

import numpy as np

from tests.oracles import families

NEW_AXES = ("formula helix", "formula wave", "closed formula")
NEW_CONTOURS = (
    "sharp polygon",
    "sharp star",
    "polar formula",
    "formula",
    "kidney formula",
    "C spline",
    "C polygon",
    "sharp C",
    "spiral",
)
NEW_SWEEPS = ("formula scale", "formula all", "matrix", "morph", "sharp morph", "formula sweep")
AXES = families.AXES + NEW_AXES
CONTOURS = families.CONTOURS + NEW_CONTOURS
SWEEPS = families.SWEEPS + NEW_SWEEPS
FRAMES = families.FRAMES
SMOOTH = ("circle", "ellipse", "superellipse", "spline", "polar", "polar formula", "formula")


def allowed(kinds):
    """Frenet frames where the axis bends everywhere; formula sweeps of smooth star shapes."""
    axis, contour, sweep, frame = kinds
    if frame == "frenet" and axis not in ("arc", "closed arc", "helix", "formula helix"):
        return False
    if sweep in ("morph", "sharp morph"):
        return contour == "circle"
    return sweep != "formula sweep" or contour in SMOOTH


def any_kinds(rng):
    """Kinds at random, at least one of them new."""
    while True:
        kinds = tuple(str(rng.choice(k)) for k in (AXES, CONTOURS, SWEEPS, FRAMES))
        if kinds[2].endswith("morph"):
            kinds = (kinds[0], "circle", *kinds[2:])
        new = set(kinds) & {*NEW_AXES, *NEW_CONTOURS, *NEW_SWEEPS}
        if new and allowed(kinds):
            return kinds


def axis(kind, rng):
    """An axis whose radius of curvature is some 50 mm or more."""
    if kind not in NEW_AXES:
        return families.axis(kind, rng)
    phase, size = rng.uniform(0, 6), rng.uniform(58, 75)
    if kind == "formula helix":
        low = float(rng.uniform(-1, 1))
        return {
            "type": "formula",
            "x": f"{size!r}*cos(u)",
            "y": f"{size!r}*sin(u)",
            "z": f"12*u + {rng.uniform(1, 3)!r}*sin(u + {phase!r})",
            "range": [low, low + float(rng.uniform(1, 4))],
        }
    if kind == "formula wave":
        return {
            "type": "formula",
            "x": f"{rng.uniform(3, 9)!r}*sin(0.045*u + {phase!r})",
            "y": f"0.02*u + {rng.uniform(2, 5)!r}*cos(0.05*u)",
            "z": "u + exp(-(u/40)**2)",
            "range": [-60, 55],
        }
    return {
        "type": "formula",
        "x": f"({size!r} + 4*cos(3*u + {phase!r}))*cos(u)",
        "y": f"({size!r} + 4*cos(3*u + {phase!r}))*sin(u)",
        "z": f"{rng.uniform(2, 6)!r}*sin(2*u)",
        "range": [0, 2 * np.pi],
        "closed": True,
    }


def contour(kind, rng):
    """A contour of some 10 to 14 mm."""
    if kind not in NEW_CONTOURS:
        return families.contour(kind, rng)
    size = rng.uniform(8, 12)
    if kind == "sharp polygon":
        return {**families.contour("polygon", rng), "corner_radius": 0}
    if kind == "sharp star":
        count = int(rng.integers(3, 7))
        radii = np.where(np.arange(2 * count) % 2, rng.uniform(0.45, 0.8), 1.0) * size
        points = radii[:, None] * _ring(np.pi * np.arange(2 * count) / count + rng.uniform(0, 6))
        return {"type": "polygon", "points": points.tolist(), "corner_radius": 0}
    if kind == "polar formula":
        lobes, depth = int(rng.integers(2, 6)), rng.uniform(0.05, 0.3)
        phase = rng.uniform(0, 6)
        return {
            "type": "polar",
            "formula": f"{size!r}*(1 + {depth!r}*cos({lobes}*theta + {phase!r}))",
        }
    if kind == "formula":
        return {
            "type": "formula",
            "x": f"{size!r}*cos(v) + {rng.uniform(-1, 1)!r}*cos(2*v)",
            "y": f"{0.8 * size!r}*sin(v) + {rng.uniform(-1, 1)!r}*cos(2*v)",
            "range": [0, 2 * np.pi],
        }
    if kind == "kidney formula":
        around, radius = rng.uniform(0.9, 2.3), f"({rng.uniform(6, 9)!r} + 3.2*sin(v))"
        shift = rng.uniform(-6, 3)
        return {
            "type": "formula",
            "x": f"{radius}*cos({around!r}*cos(v)) + {shift!r}",
            "y": f"{radius}*sin({around!r}*cos(v))",
            "range": [0, 2 * np.pi],
        }
    if kind == "spiral":
        return {"type": "spline", "points": spiral(rng.uniform(1.2, 1.8), 14, 2.0, 4.4, 3.2)}
    points = letter_c(rng.uniform(0.4, 1.2), 14, rng.uniform(11, 13), rng.uniform(3, 6))
    if kind == "C spline":
        return {"type": "spline", "points": points}
    radius = 0 if kind == "sharp C" else float(rng.uniform(0.1, 0.5))
    return {"type": "polygon", "points": points, "corner_radius": radius}


def letter_c(gap, count, radius, width):
    """Points round a C open by twice ``gap`` about +x."""
    angle = np.linspace(gap, 2 * np.pi - gap, count)
    ring = _ring(angle)
    return [*(radius * ring).tolist(), *((radius - width) * ring[::-1]).tolist()]


def spiral(turns, a_turn, width, pitch, inner):
    """Points out and back along a spiral band."""
    angle = np.linspace(0, 2 * np.pi * turns, int(a_turn * turns))
    radius = (inner + pitch * angle / (2 * np.pi))[:, None]
    ring = _ring(angle)
    return [*((radius + width) * ring).tolist(), *(radius * ring)[::-1].tolist()]


def _ring(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def sweep(kind, rng, span, closed):
    """A sweep over the axis's u; on a closed axis it comes back to where it started."""
    low, high = span
    s = f"((u - {low!r})/{high - low!r})"
    wave = f"sin(2*pi*{s})" if closed else f"sin({rng.uniform(1, 4)!r}*{s})"

    def knots(least, most):
        given = families._knots(rng, least, most, closed)["knots"]
        u = [low + s * (high - low) for s, _ in given]
        u[-1] = high
        return {"knots": [[a, b] for a, (_, b) in zip(u, given, strict=True)]}

    if kind == "formula scale":
        return {"type": "linear", "scale": {"formula": f"1 + {rng.uniform(-0.3, 0.2)!r}*{wave}"}}
    if kind == "formula all":
        return {
            "type": "linear",
            "scale": [{"formula": f"1 + 0.15*{wave}"}, knots(0.8, 1.1)],
            "rotate_deg": {"formula": f"40*{wave}**2"},
            "shear": {"formula": f"0.3*{wave}"},
            "offset": [{"formula": f"2*{wave}"}, 1.0],
        }
    if kind == "matrix":
        rows = [
            [{"formula": f"1 + 0.2*{wave}"}, float(rng.uniform(-0.3, 0.3)), 0],
            [knots(-0.3, 0.3), float(rng.uniform(0.8, 1.1)), 0],
            [knots(-3, 3), {"formula": f"2*{wave}"}, 1],
        ]
        return {"type": "linear", "matrix": rows}
    if kind in ("morph", "sharp morph"):
        kinds = ("circle", "ellipse", "superellipse", "polar", "polar formula", "polygon")
        if kind == "sharp morph":
            kinds = ("sharp polygon", "sharp star", "circle", "polar formula")
        count = int(rng.integers(2, 5))
        at = np.linspace(low, high, count).tolist()
        stops = [{"at": u, "contour": contour(str(rng.choice(kinds)), rng)} for u in at]
        if closed:
            stops[-1]["contour"] = stops[0]["contour"]
        return {"type": "morph", "contours": stops}
    if kind == "formula sweep":
        grow = f"(1 + 0.2*{wave})"
        bow = f"{rng.uniform(-0.012, 0.012)!r}*{wave}"
        return {
            "type": "formula",
            "forward": [f"x + {bow}*y**2", f"y*{grow}"],
            "inverse": [f"x - {bow}*(y/{grow})**2", f"y/{grow}"],
        }
    old = {"type": "linear", **families.sweep(kind, rng, closed)}
    return _stretched(old, low, high)


def _stretched(tree, low, high):
    """The knots of [0, 1] brought to the axis's own range."""
    if isinstance(tree, list):
        return [_stretched(t, low, high) for t in tree]
    if not isinstance(tree, dict):
        return tree
    if "knots" in tree:
        u = [low + s * (high - low) for s, _ in tree["knots"]]
        u[-1] = high
        return {"knots": [[a, b] for a, (_, b) in zip(u, tree["knots"], strict=True)]}
    return {k: _stretched(v, low, high) for k, v in tree.items()}


def generalized_cylinder(rng, kinds):
    """A leaf of the four kinds (axis, contour, sweep, frame), as plain JSON."""
    way = axis(kinds[0], rng)
    closed = kinds[0].startswith("closed")
    frame = kinds[3]
    if frame == "up":
        flat = kinds[0] in ("closed spline", "arc", "closed arc", "closed formula")
        frame = {"up": [0.1, 0.2, 3.0] if flat else [1.0, 0.3, 0.1]}
        if "helix" in kinds[0]:
            frame = {"up": [0.05, 0.0, 1.0]}
    span = tuple(float(u) for u in way.get("range", (0.0, 1.0)))
    leaf = {"type": "generalized_cylinder", "axis": way, "frame": frame}
    leaf["sweep"] = sweep(kinds[2], rng, span, closed)
    if leaf["sweep"]["type"] != "morph":
        leaf["contour"] = contour(kinds[1], rng)
    return json.loads(json.dumps(leaf, default=float))
