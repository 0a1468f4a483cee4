"""What is measured: documents and views."""

import json
from pathlib import Path

import numpy as np

import phantom
from bench import chest_like
from bench.floor import CENTER, DOWN, ELLIPSOIDS, RIGHT, SOURCE, WIDTH_MM

KNEE_LIKE = Path(__file__).with_name("knee-like.json")
KNEE_VIEWS = {
    "ap": ("ap", {}),
    "left lateral": ("left_lateral", {}),
    "right lateral": ("right_lateral", {}),
    "oblique 30°": ("lao", {"angle_deg": 30.0}),
    "oblique 60°": ("rpo", {"angle_deg": 60.0}),
}
AXIAL = "along the bones"
THETA = 2 * np.pi * np.arange(20) / 20
SQUARE = np.pi * (np.arange(16) + 0.5) / 8
CONTOURS = {
    "circle": {"type": "circle", "radius": 1.0},
    "ellipse": {"type": "ellipse", "semi_axes": [1.0, 0.8]},
    "superellipse, n = 4": {"type": "superellipse", "semi_axes": [1.0, 0.8], "exponent": 4},
    "five-lobe star": {"type": "polar", "radii": (1 + 0.2 * np.cos(5 * THETA)).tolist()},
    "spline of 16 points": {
        "type": "spline",
        "points": np.stack(
            [(1 + 0.1 * np.cos(2 * SQUARE)) * f(SQUARE) for f in (np.cos, np.sin)], axis=1
        ).tolist(),
    },
}


def knee_like(operator="replace"):
    """The knee-like tree: two bent tubes, a thin one, three ellipsoids, soft tissue."""
    tree = json.loads(KNEE_LIKE.read_text(encoding="utf-8"))
    tree["solid"]["type"] = operator
    return tree


def tubes(contour):
    """The three tubes of the knee-like scene with another contour, less soft tissue."""
    tree = knee_like("union")
    chosen = [s for s in tree["solid"]["solids"] if s["type"] == "generalized_cylinder"]
    tree["solid"]["solids"] = [{**s, "contour": CONTOURS[contour]} for s in chosen]
    return tree


def many_tubes(count):
    """A row of bent tubes side by side, each a leaf of its own."""
    step = 250.0 / count
    solids = [
        {
            "type": "generalized_cylinder",
            "name": f"tube-{k}",
            "material": "bone",
            "axis": {
                "type": "spline",
                "points": [[x, -100, 0], [x + 0.2 * step, 0, 8], [x, 100, 0]],
            },
            "contour": {"type": "circle", "radius": 0.35 * step},
        }
        for k in range(count)
        for x in (-125.0 + (k + 0.5) * step,)
    ]
    return _bones(solids)


def bent_tube(waves):
    """One tube whose axis swings to and fro: more swings, more segments."""
    z = np.linspace(-120, 120, 8 * waves + 1)
    x = 25.0 / waves**1.5 * np.sin(2 * np.pi * waves * (z + 120) / 240)
    solid = {
        "type": "generalized_cylinder",
        "name": "tube",
        "material": "bone",
        "axis": {"type": "spline", "points": np.stack([x, z, 0 * z], axis=1).tolist()},
        "contour": {"type": "circle", "radius": 4.0},
    }
    return _bones([solid])


def _bones(solids):
    solid = solids[0] if len(solids) == 1 else {"type": "union", "solids": solids}
    materials = {"bone": {"attenuation_per_mm": 0.05}}
    return {"format": "phantom/1", "name": "bench", "materials": materials, "solid": solid}


def ellipsoids():
    """The floor's seven ellipsoids as a document; their chords add up."""
    solids = [
        {
            "type": "ellipsoid",
            "name": f"e{k}",
            "material": "bone",
            "center": e[:3].tolist(),
            "semi_axes": e[3:].tolist(),
        }
        for k, e in enumerate(ELLIPSOIDS)
    ]
    tree = _bones(solids)
    tree["solid"]["type"] = "overlap"
    return tree


def side_view(side=1024):
    return _view(SOURCE, CENTER, RIGHT, DOWN, side)


def end_on_view(side=1024):
    return _view((0, -1000, 0), (0, 500, 0), (1, 0, 0), (0, 0, -1), side)


def _view(source, center, right, down, side):
    detector = phantom.Detector(
        center=tuple(map(float, center)),
        right=tuple(map(float, right)),
        down=tuple(map(float, down)),
        columns=side,
        rows=side,
        pitch_mm=WIDTH_MM / side,
    )
    return phantom.View(source=tuple(map(float, source)), detector=detector)


def knee_view(shape, name, side=1024):
    """A view of a knee: a preset of KNEE_VIEWS, or from above along the bones."""
    if name == AXIAL:
        x, y, z = map(float, shape.isocentre)
        return _view((x, y, z + 950), (x, y, z - 200), (1, 0, 0), (0, 1, 0), side)
    preset, words = KNEE_VIEWS[name]
    return phantom.preset_view(shape, preset, columns=side, rows=side, **words)


def chest():
    return chest_like.document()


def rays(view):
    """(N, 3) source of every pixel's ray and (N, 3) from there to the pixel, rows first."""
    detector = view.detector
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    row, column = np.indices((detector.rows, detector.columns)).reshape(2, -1, 1)
    across = pitch_x * (column - (detector.columns - 1) / 2) * right
    pixels = np.asarray(detector.center) + across
    pixels += pitch_y * (row - (detector.rows - 1) / 2) * down
    source = np.asarray(view.source)
    return np.broadcast_to(source, pixels.shape), pixels - source
