"""Phong's light on solids whose first hits and normals are known in closed form."""

import json
import math

import numpy as np
import pytest

import phantom
from phantom.errors import CancelledError, InvalidDocumentError, InvalidInputError
from tests.oracles import documents

LOOK = {"color": [0.9, 0.5, 0.2], "ambient": 0.15, "diffuse": 0.5, "specular": 0.3, "exponent": 12}
COLOR = np.array(LOOK["color"])


def loaded(solid, **more):
    materials = {"bone": {"attenuation_per_mm": 0.05}, "soft": {"attenuation_per_mm": 0.02}}
    tree = {"format": "phantom/1", "name": "t", "materials": materials, "solid": solid}
    return phantom.load({**tree, **more})


def ball(radius=20.0, center=(0.0, 0.0, 0.0), **more):
    return {"type": "sphere", "center": list(center), "radius": radius, "material": "bone",
            "appearance": LOOK, **more}  # fmt: skip


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def grid(camera):
    """Lines of sight through the middle of every pixel."""
    return camera.rays(np.arange(camera.columns)[None, :], np.arange(camera.rows)[:, None])


def met(origins, directions, radius=20.0, center=(0.0, 0.0, 0.0)):
    """Distances to a sphere's front, nan for a miss."""
    away = origins - np.asarray(center)
    b = (away * directions).sum(axis=-1)
    with np.errstate(invalid="ignore"):
        return -b - np.sqrt(b**2 - (away**2).sum(axis=-1) + radius**2)


def phong(normal, to_eye, lights, ambient=(1.0, 1.0, 1.0)):
    """The paper's sum, for lights (L, colour)."""
    total = LOOK["ambient"] * np.broadcast_to(np.array(ambient), normal.shape).copy()
    for to_light, color in lights:
        half = unit(to_eye + to_light)
        diffuse = np.maximum((normal * to_light).sum(axis=-1), 0.0)
        shine = np.maximum((half * normal).sum(axis=-1), 0.0) ** LOOK["exponent"]
        total += (LOOK["diffuse"] * diffuse + LOOK["specular"] * shine)[..., None] * color
    return COLOR * total


PERSPECTIVE = phantom.Camera(
    eye=(90, -120, 50), target=(3, 1, -2), field_of_view_deg=25, columns=90, rows=70
)
PARALLEL = phantom.Camera(
    eye=(0, -100, 30), target=(0, 0, 0), parallel_width_mm=50, columns=70, rows=90
)


@pytest.mark.parametrize("camera", [PERSPECTIVE, PARALLEL], ids=["perspective", "parallel"])
def test_a_sphere_has_phongs_light_at_every_pixel(camera):
    sun = phantom.DirectionalLight(to_light=(1, -1, 2), color=(1, 0.9, 0.8), intensity=0.7)
    lamp = phantom.PointLight(position=(-60, -80, 10), color=(0.2, 0.4, 1.0))
    lighting = phantom.Lighting(ambient=(0.5, 0.6, 0.7), lights=(sun, lamp))
    sky = (0.05, 0.1, 0.2)
    picture = phantom.render(
        loaded(ball()), camera, lighting=lighting, background=sky, samples_per_pixel=1
    )
    origins, directions = grid(camera)
    distance = met(origins, directions)
    hit = np.isfinite(distance)
    assert 0.1 < hit.mean() < 0.9
    points = (origins + distance[..., None] * directions)[hit]
    lights = [
        (
            np.broadcast_to(unit(np.array([1.0, -1, 2])), points.shape),
            0.7 * np.array([1, 0.9, 0.8]),
        ),
        (unit(np.array([-60.0, -80, 10]) - points), np.array([0.2, 0.4, 1.0])),
    ]
    expected = np.broadcast_to(np.array(sky), (*hit.shape, 3)).copy()
    expected[hit] = phong(points / 20, -directions[hit], lights, (0.5, 0.6, 0.7))
    np.testing.assert_allclose(picture.rgb, expected, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(picture.coverage, hit)


def test_without_lights_only_the_ambient_light_is_left():
    dark = phantom.Lighting(ambient=(1, 0.5, 0.25), lights=())
    picture = phantom.render(loaded(ball()), PARALLEL, lighting=dark, samples_per_pixel=1)
    hit = picture.coverage == 1
    expected = 0.15 * COLOR * np.array([1, 0.5, 0.25])
    np.testing.assert_allclose(
        picture.rgb[hit], np.broadcast_to(expected, (hit.sum(), 3)), rtol=1e-14
    )
    assert np.all(picture.rgb[~hit] == 0)


def test_a_light_may_move_with_the_camera():
    """A lamp at the eye lights a flat wall as a light along the line of sight does."""
    wall = {
        "type": "box",
        "center": [0, 0, 0],
        "size": [30, 2, 30],
        "material": "bone",
        "appearance": LOOK,
    }
    for light in (
        phantom.DirectionalLight(to_light=(0, 0, 1), fixed_to="camera"),
        phantom.DirectionalLight(to_light=(0, -1, 0)),
        phantom.PointLight(position=(0, 0, 0), fixed_to="camera"),
        phantom.PointLight(position=(0, -500, 0)),
    ):
        camera = phantom.Camera(
            eye=(0, -500, 0), target=(0, 0, 0), field_of_view_deg=0.5, columns=9, rows=9
        )
        picture = phantom.render(
            loaded(wall), camera, lighting=phantom.Lighting(lights=(light,)), samples_per_pixel=1
        )
        expected = COLOR * (0.15 + 0.5 + 0.3)
        np.testing.assert_allclose(picture.rgb[4, 4], expected, rtol=0, atol=1e-12)


def test_samples_of_a_pixel_are_averaged():
    """Every third pixel of a picture three times as fine lies where a sample does."""
    fine = PARALLEL.model_copy(update={"columns": 210, "rows": 270})
    shape = loaded(ball())
    coarse = phantom.render(shape, PARALLEL, samples_per_pixel=3)
    single = phantom.render(shape, fine, samples_per_pixel=1)
    mean = single.rgb.reshape(90, 3, 70, 3, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(coarse.rgb, mean, rtol=0, atol=1e-12)
    covered = single.coverage.reshape(90, 3, 70, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(coarse.coverage, covered, rtol=0, atol=1e-12)


@pytest.mark.parametrize("point", [False, True], ids=["sun", "lamp"])
def test_a_sphere_casts_its_shadow_on_a_floor(point):
    floor = {
        "type": "box",
        "center": [0, 0, -31],
        "size": [200, 200, 2],
        "material": "soft",
        "appearance": LOOK,
    }
    shape = loaded({"type": "union", "solids": [ball(), floor]})
    camera = phantom.Camera(
        eye=(0, 0, 400),
        target=(0, 0, 0),
        up=(0, 1, 0),
        parallel_width_mm=190,
        columns=120,
        rows=120,
    )
    place = np.array([40.0, 15, 90])
    light = (
        phantom.PointLight(position=tuple(place))
        if point
        else phantom.DirectionalLight(to_light=tuple(place))
    )
    lighting = phantom.Lighting(lights=(light,), shadows=True)
    picture = phantom.render(shape, camera, lighting=lighting, samples_per_pixel=1)
    origins, directions = grid(camera)
    on_floor = ~np.isfinite(met(origins, directions))
    points = origins + 430 * directions
    toward = unit(place - points) if point else np.broadcast_to(unit(place), points.shape)
    # How near the way to the light comes to the sphere's middle.
    nearest = np.linalg.norm(np.cross(points, toward), axis=-1)
    clear = on_floor & (np.abs(nearest - 20) > 1e-6)
    lit = clear & (nearest > 20)
    dark = clear & (nearest < 20)
    assert min(lit.sum(), dark.sum()) > 200
    up = np.broadcast_to(np.array([0.0, 0, 1]), points.shape)
    expected = phong(up, -directions, [(toward, np.ones(3))])
    np.testing.assert_allclose(picture.rgb[lit], expected[lit], rtol=0, atol=1e-9)
    shadow = np.broadcast_to(0.15 * COLOR, (dark.sum(), 3))
    np.testing.assert_allclose(picture.rgb[dark], shadow, rtol=0, atol=1e-12)


def test_a_camera_in_a_solid_sees_its_wall_lit_from_within():
    shell = {
        "type": "difference",
        "solids": [ball(30), {"type": "sphere", "center": [0, 0, 0], "radius": 2}],
    }
    camera = phantom.Camera(
        eye=(0, -10, 0), target=(0, -30, 0), field_of_view_deg=40, columns=20, rows=20
    )
    lamp = phantom.Lighting(lights=(phantom.PointLight(position=(0, 0, 0), fixed_to="camera"),))
    picture = phantom.render(loaded(shell), camera, lighting=lamp, samples_per_pixel=1)
    assert np.all(picture.coverage == 1)
    origins, directions = grid(camera)
    b = (origins * directions).sum(axis=-1)
    distance = -b + np.sqrt(b**2 - (origins**2).sum(axis=-1) + 900)
    inward = -(origins + distance[..., None] * directions) / 30
    expected = phong(inward, -directions, [(-directions, np.ones(3))])
    np.testing.assert_allclose(picture.rgb, expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("seed", [1, 2, 5, 6])
def test_a_pixel_shows_the_phantom_where_x_rays_meet_it(seed, scale):
    """Of random solids, from a micrometre to kilometres in size."""
    solid = documents.tree(np.random.default_rng(seed), 3)
    tree = documents.document({"type": "transformed", "scale": scale, "solid": solid})
    shape = phantom.load(json.loads(json.dumps(tree)))
    word = phantom.visible.CAMERA_NAMES[seed]
    camera = phantom.preset_camera(shape.bounds, word, columns=64, rows=48, parallel=seed % 2 == 1)
    picture = phantom.render(shape, camera, samples_per_pixel=1)
    origins, directions = (rays.reshape(-1, 3) for rays in grid(camera))
    lengths = phantom.path_lengths(shape, origins, directions).sum(axis=1).reshape(48, 64)
    assert (lengths > 0).sum() > 20
    np.testing.assert_array_equal(picture.coverage > 0, lengths > 0)
    assert np.isfinite(picture.rgb).all()


def test_coefficients_that_add_to_more_than_1_are_refused():
    with pytest.raises(InvalidDocumentError) as refused:
        loaded(ball(appearance={**LOOK, "diffuse": 0.6}))
    (problem,) = refused.value.problems
    assert problem.path == "/solid/appearance"
    assert "1.05" in problem.message


def test_bones_are_seen_where_the_flesh_is_hidden():
    bone = ball(8, appearance={**LOOK, "color": [1, 1, 1]})
    flesh = ball(20, material="soft")
    shape = loaded({"type": "replace", "solids": [flesh, bone]})
    whole = phantom.render(shape, PARALLEL, samples_per_pixel=1)
    bones = phantom.render(shape, PARALLEL, samples_per_pixel=1, hide=["soft"])
    alone = phantom.render(loaded(bone), PARALLEL, samples_per_pixel=1)
    np.testing.assert_allclose(bones.rgb, alone.rgb, rtol=0, atol=1e-9)
    assert whole.coverage.sum() > 5 * bones.coverage.sum()


def test_a_preset_fits_what_is_shown():
    shape = loaded({"type": "replace", "solids": [ball(20, material="soft"), ball(2)]})
    for name in phantom.visible.CAMERA_NAMES:
        preset = phantom.CameraPreset(preset=name, columns=60, rows=40)
        for hide in ((), ("soft",)):
            covered = phantom.render(shape, preset, hide=hide, samples_per_pixel=1).coverage
            # Nothing touches the picture's edge, and the solid fills much of its height.
            assert not np.any(covered[[0, -1]])
            assert not np.any(covered[:, [0, -1]])
            assert covered.any(axis=1).mean() > 0.5


def test_what_lies_behind_the_camera_is_not_seen():
    camera = phantom.Camera(eye=(0, 50, 0), target=(0, 90, 0), columns=16, rows=16)
    picture = phantom.render(loaded(ball()), camera, background=(0.5, 0.5, 0.5))
    assert np.all(picture.rgb == 0.5)
    assert picture.metadata()["warnings"] == ["nothing of the phantom is in the picture"]


def test_the_picture_does_not_depend_on_the_number_of_threads():
    shape = phantom.library.build("knee-1993")
    camera = phantom.CameraPreset(preset="three_quarter", columns=96, rows=96)
    one, three = (phantom.render(shape, camera, workers=n).rgb for n in (1, 3))
    np.testing.assert_array_equal(one, three)


def test_samples_out_of_range_are_refused():
    for samples in (0, 9):
        with pytest.raises(InvalidInputError) as refused:
            phantom.render(loaded(ball()), PARALLEL, samples_per_pixel=samples)
        assert refused.value.problems[0].path == "/samples_per_pixel"


def test_a_render_can_be_stopped():
    with pytest.raises(CancelledError):
        phantom.render(loaded(ball()), PERSPECTIVE, cancelled=lambda: True)


def test_the_paper_s_stretch_is_one_mapping_for_all_colours():
    picture = phantom.render(loaded(ball()), PARALLEL)
    for bits in (8, 16):
        levels = picture.levels(phantom.Tone(mode="stretch", bits=bits))
        full = 2**bits - 1
        assert levels.min() == 0
        assert levels.max() == full
        np.testing.assert_allclose(
            levels / full, picture.rgb / picture.rgb.max(), atol=0.5 / full + 1e-12
        )


def test_srgb_levels_are_those_of_the_standard():
    """IEC 61966-2-1: middle grey, the foot of the curve, its ends and what is beyond."""
    light = np.array([0.0, 0.001, 0.0031308, 0.2140, 0.5, 1.0, 1.7])
    levels = phantom.visible.tone.toned(light[None, :, None].repeat(3, axis=2), phantom.Tone())
    np.testing.assert_array_equal(levels[0, :, 0], [0, 3, 10, 127, 188, 255, 255])


@pytest.mark.parametrize("tilt_deg", [0.0, 30.0])
def test_a_ray_of_light_at_a_right_angle_leaves_only_the_shine(tilt_deg):
    """Where the light grazes, N.L is 0 and H.N is cos 45 degrees of the eye's tilt."""
    wall = {
        "type": "box",
        "center": [0, 0, -5],
        "size": [99, 99, 10],
        "material": "bone",
        "appearance": LOOK,
    }
    tilt = math.radians(tilt_deg)
    eye = (300 * math.sin(tilt), 0, 300 * math.cos(tilt))
    camera = phantom.Camera(eye=eye, target=(0, 0, 0), up=(0, 1, 0), columns=3, rows=3)
    light = phantom.DirectionalLight(to_light=(1, 0, 0))
    picture = phantom.render(
        loaded(wall), camera, lighting=phantom.Lighting(lights=(light,)), samples_per_pixel=1
    )
    half = unit(np.array([1 + math.sin(tilt), 0, math.cos(tilt)]))
    expected = COLOR * (0.15 + 0.3 * half[2] ** 12)
    np.testing.assert_allclose(picture.rgb[1, 1], expected, rtol=0, atol=1e-12)
