"""Two eyes in visible light: where they stand, what they see, and one light for both."""

from __future__ import annotations

import io
import json
import math

import numpy as np
import OpenEXR
import pytest
from PIL import Image

import phantom
from phantom.encode import encode_pair
from phantom.errors import InvalidInputError
from phantom.scene import load
from phantom.visible import Camera, DirectionalLight, Lighting, PointLight, Tone, render_pair

BALLS = {"near": (10.0, -60.0, 8.0), "middle": (0.0, 0.0, 0.0), "far": (-12.0, 50.0, -9.0)}
RADIUS_MM, DISTANCE_MM, PIXELS = 5.0, 800.0, 301
FLAT = Lighting(ambient=(1.0, 1.0, 1.0), lights=())


@pytest.fixture(scope="module")
def balls():
    """Three balls at known depths, each of a colour of its own and lit from everywhere."""
    colors = {"near": [1.0, 0.0, 0.0], "middle": [0.0, 1.0, 0.0], "far": [0.0, 0.0, 1.0]}
    solids = [
        {
            "type": "sphere",
            "name": name,
            "center": list(at),
            "radius": RADIUS_MM,
            "material": "m",
            "appearance": {"color": colors[name], "ambient": 1.0, "diffuse": 0.0, "specular": 0.0},
        }
        for name, at in BALLS.items()
    ]
    return load(
        {
            "format": "phantom/1",
            "materials": {"m": {"attenuation_per_mm": 0.02}},
            "solid": {"type": "overlap", "solids": solids},
            "landmarks": {name: list(at) for name, at in BALLS.items()},
        }
    )


def camera(**fields: object) -> Camera:
    usual = {"field_of_view_deg": 12.0, "columns": PIXELS, "rows": 201}
    if "parallel_width_mm" in fields:
        del usual["field_of_view_deg"]
    return Camera(eye=(0, -DISTANCE_MM, 0), target=(0, 0, 0), **{**usual, **fields})


def middles(picture) -> dict[str, np.ndarray]:
    """The centre of mass of each ball's colour."""
    found = {}
    for channel, name in enumerate(("near", "middle", "far")):
        weight = picture.rgb[..., channel]
        rows, columns = np.indices(weight.shape)
        found[name] = np.array([(weight * columns).sum(), (weight * rows).sum()]) / weight.sum()
    return found


def column(name: str, eye_mm: float) -> float:
    """Where a pinhole at ``eye_mm`` along the rows sees a ball, its window slid, by hand."""
    x, y, _ = BALLS[name]
    pitch = 2 * math.tan(math.radians(6)) / PIXELS
    seen, of_target = (x - eye_mm) / (DISTANCE_MM + y), -eye_mm / DISTANCE_MM
    return (seen - of_target) / pitch + (PIXELS - 1) / 2


def test_a_shift_shows_each_ball_where_the_pinhole_does(balls) -> None:
    pair = render_pair(balls, camera(), lighting=FLAT, baseline_mm=60, samples_per_pixel=4)
    for picture, eye_mm in ((pair.left, -30.0), (pair.right, 30.0)):
        assert picture.camera.eye[0] == pytest.approx(eye_mm)
        for name, at in middles(picture).items():
            assert at[0] == pytest.approx(column(name, eye_mm), abs=0.05)
    for name in BALLS:
        mark = next(d for d in pair.disparities if (d.kind, d.name) == ("landmark", name))
        expected = column(name, -30) - column(name, 30)
        assert mark.pixels == pytest.approx((expected, expected), abs=1e-9)
        assert mark.vertical_px <= 1e-9
    assert pair.disparity("near").pixels[0] > 0 > pair.disparity("far").pixels[1]
    assert pair.eyes.baseline_mm == pytest.approx(60)


def test_a_rotation_keeps_the_target_and_goes_the_way_of_the_eyes(balls) -> None:
    pair = render_pair(
        balls, camera(), lighting=FLAT, method="rotate", angle_deg=6, samples_per_pixel=4
    )
    assert pair.left.camera.eye[0] < 0 < pair.right.camera.eye[0]
    assert pair.eyes.angle_deg == pytest.approx(6)
    left, right = middles(pair.left), middles(pair.right)
    assert left["middle"][0] == pytest.approx(right["middle"][0], abs=0.05)
    assert left["near"][0] - right["near"][0] > 5
    assert left["far"][0] - right["far"][0] < -5
    for name in BALLS:
        line = pair.epipolar_matrix @ [*left[name], 1.0]
        away = line @ [*right[name], 1.0] / math.hypot(line[0], line[1])
        assert abs(away) < 0.05


@pytest.mark.parametrize("fields", [{}, {"parallel_width_mm": 200.0}, {"shift_px": 31.5}])
def test_the_matrix_is_the_projection(fields) -> None:
    one = camera(**fields)
    points = np.random.default_rng(7).uniform(-90, 90, (50, 3))
    seen = np.column_stack([points, np.ones(50)]) @ one.matrix.T
    expected, depth = one.project(points)
    np.testing.assert_allclose(seen[:, :2] / seen[:, 2:], expected, atol=1e-9)
    if not one.parallel_width_mm:
        np.testing.assert_allclose(seen[:, 2], depth)


@pytest.mark.parametrize("fields", [{}, {"parallel_width_mm": 200.0}])
def test_a_slid_window_sees_along_the_rays_of_its_pixels(fields) -> None:
    one = camera(shift_px=17.25, **fields)
    origins, ways = one.rays(np.array([3.0, 250.0]), np.array([10.0, 99.0]))
    seen, _ = one.project(origins + 700 * ways)
    np.testing.assert_allclose(seen, [[3, 10], [250, 99]], atol=1e-9)


def test_the_lamps_of_the_camera_stay_for_both_eyes(balls) -> None:
    """A lamp at the camera's side that went with each eye would light two different scenes."""
    head = Lighting(
        lights=(
            PointLight(position=(200, 0, 0), fixed_to="camera"),
            DirectionalLight(to_light=(1, 0, 0), fixed_to="camera"),
        )
    )
    pair = render_pair(balls, camera(), lighting=head, method="rotate", angle_deg=20)
    for picture in (pair.left, pair.right):
        point, directional = picture.told["lighting"]["lights"]
        assert point["fixed_to"] == directional["fixed_to"] == "world"
        np.testing.assert_allclose(point["position"], [200, -DISTANCE_MM, 0], atol=1e-9)
        np.testing.assert_allclose(directional["to_light"], [1, 0, 0], atol=1e-12)


def test_one_stretch_serves_both() -> None:
    tone = Tone(mode="stretch")
    knee = phantom.library.build("knee-1993")
    light = Lighting(lights=(DirectionalLight(to_light=(-1, 0, 0)),))
    small = phantom.CameraPreset(preset="front", columns=64, rows=64)
    pair = render_pair(knee, small, lighting=light, method="rotate", angle_deg=110)
    both = np.concatenate([pair.left.rgb, pair.right.rgb])
    assert pair.left.rgb.max() != pair.right.rgb.max()
    share = (both - both.min()) / (both.max() - both.min())
    levels = pair.levels(tone)
    found = np.concatenate([levels["left"], levels["right"]])
    np.testing.assert_array_equal(found, np.rint(share * 255))


def test_what_is_hidden_does_not_count(balls) -> None:
    pair = render_pair(balls, camera(), hide=("near",), baseline_mm=60)
    assert [d.name for d in pair.disparities if d.kind == "leaf"] == ["middle", "far"]
    assert pair.comfort.crossed_deg < 0.1


def test_the_default_can_be_fused_and_auto_is_the_largest() -> None:
    knee = phantom.library.build("knee-1993")
    small = phantom.CameraPreset(preset="front", columns=64, rows=64)
    assert render_pair(knee, small).comfort.level == "comfortable"
    coarse = phantom.Screen(pixel_pitch_mm=4.0)
    pair = render_pair(knee, small, baseline_mm="auto", screen=coarse)
    assert max(pair.comfort.crossed_deg, pair.comfort.uncrossed_deg) == pytest.approx(1, abs=0.01)


def test_the_files_of_a_pair(balls, tmp_path) -> None:
    pair = render_pair(balls, camera(columns=60, rows=40), baseline_mm=60)
    levels = pair.levels()
    files = encode_pair(pair, "color", None, layout="all")
    assert list(files) == [
        "left.png", "right.png", "side-by-side.png", "cross-eyed.png", "anaglyph.png", "pair.exr",
    ]  # fmt: skip

    def image(name: str) -> np.ndarray:
        return np.asarray(Image.open(io.BytesIO(files[name].data)))

    np.testing.assert_array_equal(image("left.png"), levels["left"])
    crossed = np.concatenate([levels["right"], levels["left"]], axis=1)
    np.testing.assert_array_equal(image("cross-eyed.png"), crossed)
    anaglyph = image("anaglyph.png")
    np.testing.assert_array_equal(anaglyph[..., 0], levels["left"][..., 0])
    np.testing.assert_array_equal(anaglyph[..., 1:], levels["right"][..., 1:])
    (tmp_path / "pair.exr").write_bytes(files["pair.exr"].data)
    parts = OpenEXR.File(str(tmp_path / "pair.exr"), separate_channels=True).parts
    assert [part.header["view"] for part in parts] == ["left", "right"]
    red = parts[1].channels["R"].pixels
    np.testing.assert_array_equal(red, pair.right.rgb[..., 0].astype(np.float32))
    told = json.loads(json.dumps(pair.metadata(), allow_nan=False))
    assert told["stereo"]["baseline_mm"] == pytest.approx(60)
    assert told["images"]["left"]["camera"] != told["images"]["right"]["camera"]


@pytest.mark.parametrize("mono", ["same_image", "single"])
def test_the_mono_arm_is_one_picture(balls, mono) -> None:
    pair = render_pair(balls, camera(columns=40, rows=30), mono=mono)
    assert pair.left is pair.right
    assert pair.left.camera == pair.camera
    assert pair.comfort.level == "flat"
    assert tuple(pair.images) == (("mono",) if mono == "single" else ("left", "right"))


@pytest.mark.parametrize(
    ("at", "fields", "paths"),
    [
        ({}, {"dose": "split"}, ["/stereo/dose"]),
        ({}, {"zero_parallax": "detector"}, ["/stereo/zero_parallax"]),
        ({}, {"baseline_mm": 0}, ["/stereo/baseline_mm"]),
        ({"parallel_width_mm": 100.0}, {}, ["/stereo/method"]),
        (
            {"parallel_width_mm": 100.0},
            {"method": "rotate", "zero_parallax": {"plane_mm": 10}},
            ["/stereo/zero_parallax/plane_mm"],
        ),
    ],
)
def test_what_visible_light_does_not_have_is_refused(balls, at, fields, paths) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        render_pair(balls, camera(columns=20, rows=20, **at), **fields)
    assert [p.path for p in refusal.value.problems] == paths


def test_parallel_lines_of_sight_can_be_turned(balls) -> None:
    at = camera(columns=60, rows=40, parallel_width_mm=100.0)
    pair = render_pair(balls, at, method="rotate", angle_deg=5)
    assert pair.eyes.baseline_mm is None
    assert pair.eyes.angle_deg == pytest.approx(5, abs=0.5)
    assert pair.disparity("near").pixels[0] > 0 > pair.disparity("far").pixels[1]
