"""The net is drawn where its points are seen, and what lies behind a surface is left out."""

import math
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import phantom
from phantom.visible import Camera, CameraPreset
from phantom.visible.drawing import wireframe
from phantom.visible.strokes import covered

SVG = "{http://www.w3.org/2000/svg}"
BALL = {"type": "sphere", "name": "ball", "material": "m", "center": [0, 0, 0], "radius": 20}
TUBE = {
    "type": "generalized_cylinder",
    "name": "tube",
    "material": "m",
    "axis": {"type": "line", "start": [0, 0, -30], "end": [0, 0, 30]},
    "contour": {"type": "circle", "radius": 10},
}
FRONT = Camera(eye=(0, -200, 0), target=(0, 0, 0), columns=120, rows=120)


def document(solid):
    return phantom.load(
        {
            "format": "phantom/1",
            "name": "test",
            "materials": {"m": {"attenuation_per_mm": 0.01}},
            "solid": solid,
        }
    )


def runs(drawing, kind=None):
    return [run for stroke in drawing.strokes if kind in (None, stroke.kind) for run in stroke.runs]


def test_rings_of_a_tube_lie_where_the_camera_sees_their_points():
    drawing = wireframe(document(TUBE), FRONT, rings=4, lines=6)
    assert [s.kind for s in drawing.strokes] == ["ring"] * 4 + ["line"] * 6
    angle = np.linspace(0, 2 * np.pi, 1000)
    for stroke, z in zip(drawing.strokes, (-30, -10, 10, 30), strict=False):
        ring = np.stack([10 * np.cos(angle), 10 * np.sin(angle), np.full(1000, z)], axis=-1)
        seen, _ = FRONT.project(ring)
        for point in stroke.runs[0]:
            assert np.linalg.norm(seen - point, axis=1).min() < 0.05


def test_of_a_sphere_only_the_near_half_is_drawn_without_hidden_lines():
    shape = document(BALL)
    whole = wireframe(shape, FRONT, rings=9, lines=12)
    front = wireframe(shape, FRONT, rings=9, lines=12, hidden_lines=False)

    def length(drawing):
        return sum(np.linalg.norm(np.diff(run, axis=0), axis=1).sum() for run in runs(drawing))

    # Poles are points: of nine sections seven are rings.
    assert len([s for s in whole.strokes if s.kind == "ring"]) == 7
    assert len([s for s in whole.strokes if s.kind == "line"]) == 12
    # From 200 mm one sees 45 % of a sphere of 20 mm, which looks a little larger than the rest.
    assert 0.45 < length(front) / length(whole) < 0.5
    # Nothing is drawn beyond the outline, where the cone of sight touches the sphere.
    outline = 20 / math.sqrt(200**2 - 20**2) / FRONT.pitch
    away = np.hypot(*(np.concatenate(runs(front)) - (FRONT.columns - 1) / 2).T)
    assert away.max() == pytest.approx(outline, abs=0.05)


def test_what_stands_before_a_leaf_hides_its_lines():
    ball = {**BALL, "center": [0, -60, 0], "name": "near"}
    shape = document({"type": "union", "solids": [ball, TUBE]})
    front = wireframe(shape, FRONT, hidden_lines=False)
    near, _ = FRONT.project(np.array([[0.0, -60, 0]]))
    radius = 20 / math.sqrt(140**2 - 20**2) / FRONT.pitch
    inside = [
        np.linalg.norm(point - near[0]) < radius - 0.2
        for stroke in front.strokes
        if stroke.leaf == "tube"
        for run in stroke.runs
        for point in run
    ]
    assert inside
    assert not any(inside)
    alone = wireframe(shape, FRONT, hidden_lines=False, hide=["near"])
    assert {s.leaf for s in alone.strokes} == {"tube"}


def test_the_rim_of_a_face_that_is_seen_is_drawn_all_round():
    camera = Camera(eye=(0, -150, 150), target=(0, 0, 0), columns=160, rows=160)
    front = wireframe(document(TUBE), camera, rings=5, lines=4, hidden_lines=False)
    whole = wireframe(document(TUBE), camera, rings=5, lines=4)

    def length(drawing, ring):
        rings = [s for s in drawing.strokes if s.kind == "ring"]
        return sum(np.linalg.norm(np.diff(r, axis=0), axis=1).sum() for r in rings[ring].runs)

    assert length(front, 4) == pytest.approx(length(whole, 4), rel=1e-3)
    assert length(front, 2) == pytest.approx(0.5 * length(whole, 2), rel=0.1)


def test_cuts_end_lines_and_leave_edges():
    cut = {"point": [0, 0, 5], "normal": [0, 0, 1]}
    drawing = wireframe(document({**BALL, "cuts": [cut]}), FRONT)
    (rim,) = [s for s in drawing.strokes if s.kind == "edge"]
    highest = FRONT.project(np.array([[0.0, -math.sqrt(375), 5.0]]))[0][0, 1]
    farthest = FRONT.project(np.array([[0.0, math.sqrt(375), 5.0]]))[0][0, 1]
    assert min(run[:, 1].min() for run in rim.runs) == pytest.approx(highest, abs=0.1)
    assert max(run[:, 1].max() for run in rim.runs) == pytest.approx(farthest, abs=0.1)
    top = min(run[:, 1].min() for run in runs(drawing))
    assert top >= min(highest, farthest) - 0.1


def test_a_box_is_its_twelve_edges():
    box = {"type": "box", "name": "box", "material": "m", "center": [0, 0, 0], "size": [30, 20, 40]}
    shape = document(box)
    camera = CameraPreset(preset="three_quarter", columns=100, rows=100)
    assert len(wireframe(shape, camera).strokes) == 12
    assert len(wireframe(shape, camera, hidden_lines=False).strokes) == 9


def test_a_wall_that_a_difference_has_cut_is_drawn_by_the_leaf_that_cut_it():
    notch = {"type": "sphere", "name": "notch", "center": [0, -20, 0], "radius": 10}
    shape = document({"type": "difference", "solids": [BALL, notch]})
    assert {s.leaf for s in wireframe(shape, FRONT).strokes} == {"ball"}
    front = wireframe(shape, FRONT, hidden_lines=False)
    seen = [r for s in front.strokes if s.leaf == "notch" for r in s.runs]
    assert seen
    # The notch meets the ball 17.5 mm before the middle, in a circle of 9.68 mm.
    middle = (FRONT.columns - 1) / 2
    rim = 9.6825 / (200 - 17.5) / FRONT.pitch
    away = np.hypot(*(np.concatenate(seen) - middle).T)
    assert away.max() == pytest.approx(rim, abs=0.3)


def test_a_drawing_as_svg_has_a_path_for_every_line_and_a_group_for_every_leaf():
    fan = phantom.library.build("fan")
    camera = CameraPreset(preset="front", columns=200, rows=150)
    drawing = wireframe(fan, camera, rings=7, lines=5)
    root = ElementTree.fromstring(drawing.svg())
    assert root.get("viewBox") == "0 0 200 150"
    groups = [g for g in root.iter(f"{SVG}g") if g.get("data-leaf")]
    assert [g.get("data-leaf") for g in groups] == ["hub", "blade-1", "blade-2", "blade-3"]
    blades = [[p.get("class") for p in g.iter(f"{SVG}path")] for g in groups[1:]]
    assert blades == [["ring"] * 7 + ["line"] * 5] * 3
    hub = [p.get("class") for p in groups[0].iter(f"{SVG}path")]
    assert hub.count("edge") == 2
    # The numbers are those of the strokes, half a pixel on: SVG counts from a pixel's corner.
    first = next(groups[1].iter(f"{SVG}path")).get("d")
    x, y = (float(word.lstrip("M")) for word in first.split()[:2])
    stroke = next(s for s in drawing.strokes if s.leaf == "blade-1")
    assert (x, y) == pytest.approx(stroke.runs[0][0] + 0.5, abs=0.006)


def test_lines_cover_pixels_by_the_share_that_they_lie_on():
    level = covered([np.array([[2.0, 5.25], [17.0, 5.25]])], 11, 20, 1.0)
    assert level[5, 5:15] == pytest.approx(0.75, abs=0.01)
    assert level[6, 5:15] == pytest.approx(0.25, abs=0.01)
    assert level[[0, 3, 8, 10]].max() == 0
    wide = covered([np.array([[2.0, 5.0], [17.0, 5.0]])], 11, 20, 3.0)
    assert wide[4:7, 5:15] == pytest.approx(1.0, abs=0.01)
    assert wide[[3, 7], 5:15].max() == pytest.approx(0.0, abs=0.02)


def test_a_drawing_is_ink_on_paper():
    drawing = wireframe(document(TUBE), FRONT, ink=(0.2, 0.1, 0.0), background=(0.9, 1.0, 0.8))
    rgb = drawing.rgb.reshape(-1, 3)
    assert rgb[0] == pytest.approx([0.9, 1.0, 0.8])
    assert rgb.min(axis=0) == pytest.approx([0.2, 0.1, 0.0], abs=0.05)
    assert b'fill="#f3ffe7"' in drawing.svg()


@pytest.mark.parametrize(
    ("asked", "path"),
    [
        ({"rings": 1}, "/rings"),
        ({"lines": 2000}, "/lines"),
        ({"line_width_px": 0.0}, "/line_width_px"),
        ({"hide": ["nothing"]}, "/hide/0"),
    ],
)
def test_what_cannot_be_is_refused(asked, path):
    with pytest.raises(phantom.InvalidInputError) as caught:
        wireframe(document(BALL), **asked)
    assert [p.path for p in caught.value.problems] == [path]
