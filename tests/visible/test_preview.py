"""A preview sees what the exact renderer sees, but for the tolerance of its triangles."""

import math

import numpy as np
import pytest

import phantom
from phantom.tessellation import tessellate
from phantom.tracing.shown import shown_leaves
from phantom.visible import Camera, CameraPreset, DirectionalLight, Lighting
from phantom.visible.previewing import preview
from phantom.visible.rendering import render, view_of
from phantom.visible.zbuffer import ZBuffer, facets
from tests.oracles import documents


def document(solid, **materials):
    return phantom.load(
        {
            "format": "phantom/1",
            "name": "test",
            "materials": {"m": {"attenuation_per_mm": 0.01}, **materials},
            "solid": solid,
        }
    )


BALL = {"type": "sphere", "name": "ball", "material": "m", "center": [2, -3, 1], "radius": 20}


def depths(shape, camera, tolerance, samples=1):
    """The t of every pixel on meshes, and the length that one of t has, in mm."""
    model = facets(tessellate(shape, tolerance), tolerance)
    view = view_of(shape, camera, samples)
    raster = ZBuffer(shape, model, camera, view, shown_leaves(shape), samples)
    rows = raster.rows(0, camera.rows * samples)
    row, column = np.indices(rows.t.shape)
    way = view[3] + row[..., None] * view[4] + column[..., None] * view[5]
    start = view[0] + row[..., None] * view[1] + column[..., None] * view[2]
    return rows, start, way


@pytest.mark.parametrize("lens", [{"field_of_view_deg": 30.0}, {"parallel_width_mm": 60.0}])
def test_the_depth_of_a_sphere_is_its_closed_form_within_the_tolerance(lens):
    shape, tolerance = document(BALL), 0.05
    camera = Camera(eye=(80, -60, 40), target=(0, 0, 0), columns=96, rows=80, **lens)
    rows, start, way = depths(shape, camera, tolerance)
    unit = way / np.linalg.norm(way, axis=-1, keepdims=True)
    off = np.array(BALL["center"]) - start
    nearest = np.einsum("ijk,ijk->ij", off, unit)
    miss2 = (off**2).sum(axis=-1) - nearest**2
    hit = rows.t < math.inf
    # Rays that pass the sphere by more than the tolerance miss; the mesh lies inside of it.
    assert not hit[miss2 > 400].any()
    assert hit[miss2 < (20 - tolerance) ** 2].all()
    inner = hit & (miss2 < 19.0**2)
    exact = nearest - np.sqrt(np.maximum(400 - miss2, 0))
    found = rows.t * np.linalg.norm(way, axis=-1)
    cosine = np.sqrt(np.maximum(400 - miss2, 0)) / 20
    assert np.all((found - exact)[inner] >= -1e-9)
    assert np.all((found - exact)[inner] * cosine[inner] <= 1.05 * tolerance)
    normals = (start + rows.t[..., None] * way - BALL["center"])[inner]
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    assert np.einsum("ij,ij->i", normals, rows.normals[inner]).min() > 0.999


def test_every_ray_enters_a_mesh_as_often_as_it_leaves_it():
    """Pixels that look right at corners and along edges of boxes, too."""
    from phantom.kernels import zbuffer as kernels

    box = {"type": "box", "material": "m", "center": [0, 0, 0], "size": [16, 16, 16]}
    shape = document(box)
    camera = Camera(eye=(0, -100, 0), target=(0, 0, 0), parallel_width_mm=32.0, columns=33, rows=33)
    model = facets(tessellate(shape, 1.0), 1.0)
    view = view_of(shape, camera, 1)
    # One pixel a mm: rays run within the sides of the box and through its edges.
    view[0] = [-16, -100, 16]
    view[1], view[2] = [0, 0, -1], [1, 0, 0]
    raster = ZBuffer(shape, model, camera, view, shown_leaves(shape), 1)
    heads = np.empty((33, 33), dtype=np.int64)
    links, owners = np.empty(9999, dtype=np.int64), np.empty(9999, dtype=np.int64)
    lengths = np.empty(9999)
    fields = np.tile(np.array([0, 33, 0, 33]), (12, 1))
    count = kernels.crossings(raster._corners, fields, view, 0, heads, links, lengths, owners)
    balance, crossed = np.zeros((33, 33), dtype=int), np.zeros((33, 33), dtype=int)
    for pixel in np.ndindex(33, 33):
        at = heads[pixel]
        while at >= 0:
            balance[pixel] += 1 - 2 * (owners[at] % 2)
            crossed[pixel] += 1
            at = links[at]
    assert count == crossed.sum()
    assert not balance.any()
    # Of the 17 lines of pixels from side to side, 16: one of two opposite sides is taken.
    assert set(np.unique(crossed)) == {0, 2}
    assert (crossed > 0).sum() == 16 * 16


@pytest.mark.parametrize("seed", range(6))
def test_operators_and_hidden_leaves_are_those_of_the_exact_picture(seed):
    rng = np.random.default_rng(seed)
    while True:
        try:
            shape = phantom.load(documents.document(documents.tree(rng, 3)))
        except phantom.InvalidDocumentError:
            continue
        if len(shape.leaf_names) > 2:
            break
    hide = ["soft"] if seed % 2 else []
    camera = CameraPreset(preset="three_quarter", columns=96, rows=96)
    lighting = Lighting(lights=())
    near = preview(shape, camera, tolerance_mm=0.02, hide=hide, lighting=lighting)
    exact = render(shape, camera, samples_per_pixel=1, hide=hide, lighting=lighting)
    # Ambient light alone: a pixel tells which material is seen there, and nothing else.
    other = np.abs(near.rgb - exact.rgb).max(axis=-1) > 1e-9
    assert other.mean() < 0.01
    # Those that differ lie where what is seen changes.
    outline = np.zeros_like(other)
    for axis in (0, 1):
        for way in (1, -1):
            outline |= np.any(exact.rgb != np.roll(exact.rgb, way, axis=axis), axis=-1)
            outline |= np.any(near.rgb != np.roll(near.rgb, way, axis=axis), axis=-1)
    assert not (other & ~outline).any()


def test_light_is_that_of_the_exact_picture_on_a_sphere():
    shape = document(BALL)
    camera = Camera(eye=(80, -60, 40), target=(2, -3, 1), columns=64, rows=64)
    lighting = Lighting(lights=(DirectionalLight(to_light=(1, 0, 1)),))
    near = preview(shape, camera, lighting=lighting, tolerance_mm=0.005)
    exact = render(shape, camera, lighting=lighting, samples_per_pixel=1)
    both = (near.coverage > 0) & (exact.coverage > 0)
    assert both.sum() > 0.98 * (exact.coverage > 0).sum()
    assert np.abs(near.rgb - exact.rgb)[both].max() < 0.02


def test_from_inside_a_solid_its_wall_is_seen():
    shape = document(
        {
            "type": "difference",
            "solids": [BALL, {"type": "sphere", "center": [2, -3, 1], "radius": 12}],
        }
    )
    for eye in ((2, -3, 1), (2, -3, 17)):
        camera = Camera(eye=eye, target=(40, 0, 0), columns=32, rows=32, field_of_view_deg=90)
        near = preview(shape, camera, tolerance_mm=0.01)
        exact = render(shape, camera, samples_per_pixel=1)
        assert near.coverage.all()
        assert exact.coverage.all()
        assert np.abs(near.rgb - exact.rgb).max() < 0.05


def test_samples_smooth_the_outline():
    shape = document(BALL)
    camera = Camera(eye=(0, -150, 0), target=(2, -3, 1), columns=48, rows=48)
    share = preview(shape, camera, samples_per_pixel=4, tolerance_mm=0.01).coverage
    exact = render(shape, camera, samples_per_pixel=4).coverage
    assert ((share > 0) & (share < 1)).any()
    assert np.abs(share - exact).max() <= 2 / 16


def test_the_tessellation_is_kept_with_the_phantom_until_another_is_asked_for():
    shape = document(BALL)
    coarse = preview(shape, tolerance_mm=1.0).told["triangles"]
    model = shape.kept("facets", lambda: None)
    preview(shape, CameraPreset(preset="top"), tolerance_mm=1.0)
    assert shape.kept("facets", lambda: None) is model
    assert preview(shape, tolerance_mm=0.1).told["triangles"] > coarse


@pytest.mark.parametrize(
    ("asked", "path"),
    [
        ({"tolerance_mm": 0.0}, "/tolerance_mm"),
        ({"samples_per_pixel": 0}, "/samples_per_pixel"),
        ({"hide": ["nothing"]}, "/hide/0"),
    ],
)
def test_what_cannot_be_is_refused(asked, path):
    with pytest.raises(phantom.InvalidInputError) as caught:
        preview(document(BALL), **asked)
    assert [p.path for p in caught.value.problems] == [path]
