"""Masks, thickness, boxes and depths of leaves, against the naive twin and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.errors import CancelledError, InvalidInputError
from phantom.imaging import Detector, View, ground_truth, truth_trace
from phantom.imaging.truth import KINDS
from phantom.scene import Phantom, load
from tests.oracles.naive import Twin


def ball(name: str | None, center: Any, radius: float, material: str = "m") -> dict[str, Any]:
    named = {} if name is None else {"name": name}
    return {"type": "sphere", "center": center, "radius": radius, "material": material, **named}


def document(solid: dict[str, Any], **more: Any) -> dict[str, Any]:
    materials = {name: {"attenuation_per_mm": 0.01} for name in ("m", "bone", "metal")}
    return {"format": "phantom/1", "materials": materials, "solid": solid, **more}


def knee_like() -> dict[str, Any]:
    """Leaves that are partly cut away: drilled, cut off, replaced, limited and overlapped."""
    drilled = {
        "type": "difference",
        "solids": [
            {
                "type": "cylinder",
                "name": "shaft",
                "start": [-6, 0, -30],
                "end": [8, 3, 30],
                "radius": 9,
                "material": "bone",
                "cuts": [{"point": [0, 0, 14], "normal": [0.2, 0, 1]}],
            },
            ball("drill", [0, -9, 2], 7, "metal"),
        ],
    }
    limited = {
        "type": "intersection",
        "solids": [
            {
                "type": "box",
                "name": "plate",
                "center": [14, -2, -6],
                "size": [10, 18, 20],
                "material": "metal",
            },
            ball("limit", [14, 0, -6], 10),
        ],
    }
    body = {
        "type": "ellipsoid",
        "name": "body",
        "center": [0, 0, 0],
        "semi_axes": [26, 20, 28],
        "material": "m",
    }
    replaced = {"type": "replace", "solids": [body, drilled, limited]}
    return document(
        {"type": "overlap", "solids": [replaced, ball("density", [5, 4, 12], 6, "metal")]}
    )


SOURCE = np.array([30.0, -400.0, 20.0])


def tilted(columns: int = 31, rows: int = 27, pitch: tuple[float, float] = (2.6, 3.1)) -> View:
    """From the front and the side, on a tilted detector that cuts part of the body off."""
    right = np.array([1.0, 0.1, 0.05])
    right /= np.linalg.norm(right)
    down = np.array([0.0, 0.15, -1.0])
    down -= (down @ right) * right
    down /= np.linalg.norm(down)
    return View(
        source=tuple(SOURCE),
        detector=Detector(
            center=(4.0, 60.0, -7.0),
            right=tuple(right),
            down=tuple(down),
            columns=columns,
            rows=rows,
            pitch_mm=pitch,
        ),
    )


def parallel() -> View:
    detector = tilted().detector
    return View(source=None, direction=(0.1, 1.0, -0.05), detector=detector)


def rays_of(view: View) -> tuple[Any, Any, Any]:
    """Origins, unit directions and distances of the pixels' centres, row by row."""
    d = view.detector
    columns, rows = np.meshgrid(np.arange(d.columns), np.arange(d.rows))
    x = (columns.ravel() - (d.columns - 1) / 2) * d.pitch_xy_mm[0]
    y = (rows.ravel() - (d.rows - 1) / 2) * d.pitch_xy_mm[1]
    pixels = np.array(d.center) + x[:, None] * np.array(d.right) + y[:, None] * np.array(d.down)
    if view.source is not None:
        origins = np.tile(np.array(view.source), (len(pixels), 1))
    else:
        along = np.array(view.direction) / np.linalg.norm(view.direction)
        origins = pixels - 300 * along
    spans = pixels - origins
    lengths = np.linalg.norm(spans, axis=1)
    return origins, spans / lengths[:, None], lengths


def seen_by_the_twin(tree: dict[str, Any], view: View) -> dict[str, Any]:
    """Thickness and first entry points of every leaf, by sampling and bisection alone."""
    twin = Twin(tree)
    origins, along, ends = rays_of(view)
    shape = (view.detector.rows, view.detector.columns)
    chords = twin.chords(origins, along, (0.0, 700.0), samples=1500)
    thickness = np.zeros((len(twin.leaves), len(ends)))
    first = np.full((len(twin.leaves), len(ends), 3), np.nan)
    for ray, pieces in enumerate(chords):
        for near, far, state in pieces:
            end = min(far, ends[ray])
            if end <= near:
                continue
            for leaf in np.flatnonzero(state):
                if thickness[leaf, ray] == 0:
                    first[leaf, ray] = origins[ray] + near * along[ray]
                thickness[leaf, ray] += end - near
    return {
        leaf["name"]: (thickness[i].reshape(shape), first[i].reshape(*shape, 3))
        for i, leaf in enumerate(twin.leaves)
    }


@pytest.fixture(params=[tilted, parallel], ids=["point source", "parallel"])
def view(request: pytest.FixtureRequest) -> View:
    made: View = request.param()
    return made


@pytest.mark.parametrize("band_numbers", [2**25, 500])
def test_masks_thickness_boxes_and_depths_are_the_naive_twins(
    view: View, band_numbers: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(truth_trace, "BAND_NUMBERS", band_numbers)
    tree = knee_like()
    expected = seen_by_the_twin(tree, view)
    truth = ground_truth(load(tree), view)
    assert [leaf.name for leaf in truth.leaves] == ["body", "shaft", "plate", "density"]
    towards = np.cross(view.detector.right, view.detector.down)
    ahead = np.array(view.direction) if view.source is None else view.detector.center - SOURCE
    towards *= np.sign(towards @ ahead)
    start = np.array(view.detector.center) if view.source is None else SOURCE
    for leaf in truth.leaves:
        thickness, entry = expected[leaf.name]
        np.testing.assert_array_equal(leaf.mask, thickness > 0)
        np.testing.assert_allclose(leaf.thickness_mm, thickness, rtol=0, atol=1e-7)
        rows, columns = np.nonzero(thickness)
        assert leaf.box == (columns.min(), rows.min(), columns.max(), rows.max())
        assert leaf.area_px == len(rows)
        depth = (entry - start) @ towards
        np.testing.assert_allclose(leaf.entry_depth_mm, depth, rtol=0, atol=1e-7)


def test_what_a_leaf_lost_is_not_in_its_mask() -> None:
    """A ball drilled right through along the beam is a ring; one behind the drill is whole."""
    beam = View(
        source=None,
        direction=(0, 1, 0),
        detector=Detector(
            center=(0, 100, 0), right=(1, 0, 0), down=(0, 0, -1), columns=41, rows=41, pitch_mm=1
        ),
    )
    drill = {"type": "cylinder", "start": [0, -30, 0], "end": [0, 20, 0], "radius": 4.5}
    ring = {"type": "difference", "solids": [ball("ring", [0, 0, 0], 15.3), drill]}
    truth = ground_truth(
        load(document({"type": "union", "solids": [ring, ball("whole", [0, 40, 0], 8.5)]})), beam
    )
    x, y = np.meshgrid(np.arange(41) - 20, np.arange(41) - 20)
    radius = np.hypot(x, y)
    np.testing.assert_array_equal(truth["ring"].mask, (radius > 4.5) & (radius < 15.3))
    np.testing.assert_array_equal(truth["whole"].mask, radius < 8.5)


@pytest.mark.parametrize("point_source", [True, False])
def test_centroid_and_volume_of_a_ball_are_the_balls(point_source: bool) -> None:
    detector = Detector(
        center=(3, 300, 5), right=(1, 0, 0), down=(0, 0, -1), columns=400, rows=400, pitch_mm=0.25
    )
    view = View(
        source=(-10, -400, 8) if point_source else None,
        direction=None if point_source else (0.02, 1, 0.01),
        detector=detector,
    )
    truth = ground_truth(load(document(ball("ball", [2, -30, 4], 18))), view, ["centroids"])
    leaf = truth["ball"]
    np.testing.assert_allclose(leaf.centroid_mm, (2, -30, 4), rtol=0, atol=5e-3)
    assert leaf.volume_mm3 == pytest.approx(4 / 3 * np.pi * 18**3, rel=2e-4)
    assert leaf.entry_depth_mm is None
    (pixel,) = truth.centroids_px
    assert pixel is not None
    if point_source:
        # Similar triangles from the source at (-10, -400, 8) through (2, -30, 4) to y = 300.
        x = -10 + 12 * 700 / 370
        z = 8 - 4 * 700 / 370
        expected = ((x - 3) / 0.25 + 199.5, (5 - z) / 0.25 + 199.5)
        np.testing.assert_allclose(pixel, expected, rtol=0, atol=0.1)


def test_a_leaf_behind_the_detector_or_beside_the_field_is_told_as_unseen() -> None:
    solids = [
        ball("here", [0, 0, 0], 5),
        ball("beside", [500, 0, 0], 5),
        ball("far", [0, 90, 0], 5),
    ]
    truth = ground_truth(load(document({"type": "union", "solids": solids})), tilted())
    assert truth["here"].box is not None
    for name in ("beside", "far"):
        leaf = truth[name]
        assert (leaf.box, leaf.area_px, leaf.centroid_mm) == (None, 0, None)
        assert leaf.thickness_mm.shape == (27, 31)
        assert not leaf.mask.any()


def test_leaves_without_a_name_and_those_that_never_surface_are_left_out() -> None:
    solids = [
        ball("named", [0, 0, 0], 5),
        ball(None, [9, 0, 0], 5),
        {
            "type": "difference",
            "solids": [ball("kept", [-9, 0, 0], 5), ball("gone", [-9, 0, 0], 2)],
        },
    ]
    truth = ground_truth(load(document({"type": "union", "solids": solids})), tilted())
    assert [leaf.name for leaf in truth.leaves] == ["named", "kept"]


def test_landmarks_are_where_their_rays_meet_the_detector() -> None:
    detector = Detector(
        center=(0, 200, 0), right=(1, 0, 0), down=(0, 0, -1), columns=101, rows=81, pitch_mm=2
    )
    view = View(source=(0, -800, 0), detector=detector)
    landmarks = {
        "middle": [0, 0, 0],
        "near": [10, -300, 20],
        "out": [200, 0, 0],
        "behind": [0, -900, 0],
    }
    truth = ground_truth(
        load(document(ball(None, [0, 0, 0], 5), landmarks=landmarks)), view, ["landmarks"]
    )
    assert truth.leaves == ()
    assert truth.landmarks["middle"].pixel == pytest.approx((50, 40))
    # From y = -800 to -300 is 500 of 1000: twice as far out.
    assert truth.landmarks["near"].pixel == pytest.approx((50 + 20 / 2, 40 - 40 / 2))
    assert truth.landmarks["out"].pixel == pytest.approx((50 + 250 / 2, 40))
    assert truth.landmarks["behind"].pixel is None
    inside = {name: mark.in_field for name, mark in truth.landmarks.items()}
    assert inside == {"middle": True, "near": True, "out": False, "behind": False}


def test_what_was_not_asked_for_is_not_told(balls: Phantom) -> None:
    truth = ground_truth(balls, tilted(), ["boxes"])
    told = truth.told()
    assert told["kinds"] == ["boxes"]
    assert "landmarks" not in told
    assert [set(leaf) for leaf in told["leaves"]] == [{"name", "material", "area_px", "box"}] * 2
    assert truth["large"].entry_depth_mm is None
    assert truth["large"].centroid_mm is None


def test_an_unknown_kind_is_a_problem(balls: Phantom) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        ground_truth(balls, tilted(), ["masks", "labels"])
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("/truth/1", "unknown_value")]


def test_a_cancelled_trace_gives_nothing(balls: Phantom) -> None:
    with pytest.raises(CancelledError):
        ground_truth(balls, tilted(), KINDS, cancelled=lambda: True)


def test_maps_cannot_be_written_to(balls: Phantom) -> None:
    leaf = ground_truth(balls, tilted())["large"]
    for array in (leaf.thickness_in_box_mm, leaf.thickness_mm, leaf.entry_in_box_mm):
        assert array is not None
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1
