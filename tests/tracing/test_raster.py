"""The batched raster against rays traced one by one.

The scalar way is held to the oracles; this holds the batched one to the scalar way, on rays that
the oracles would not reach: every pixel of whole pictures, end-on and from inside too.
"""

import json

import numpy as np
import pytest

import phantom
from phantom.tracing import path_lengths, raster, raster_bands
from tests.oracles import documents, families, families_new

AGREE_MM = 1e-8
"""Both trace the same surface; a grazing chord carries the rounding of w many times over."""


def turned(rng):
    """Return three random directions at right angles."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.diag(r))


def compare(scene, axes, *, distance=400.0, size=(45, 150), field=120.0, parallel=False, at=None):
    """Trace both ways; return the batched lengths and the scalar ones."""
    along, right, down = axes
    rows, columns = size
    middle = np.asarray(scene.bounds).mean(axis=0) if at is None else np.asarray(at, dtype=float)
    pitch = field / columns
    source = None if parallel else middle - distance * along
    first = middle + 200 * along - 0.5 * pitch * ((columns - 1) * right + (rows - 1) * down)
    batched = raster(
        scene,
        source=source,
        direction=along if parallel else None,
        first_pixel=first,
        column_step=pitch * right,
        row_step=pitch * down,
        columns=columns,
        rows=rows,
    )
    i, j = (a.ravel() for a in np.mgrid[:rows, :columns])
    targets = first + pitch * (j[:, None] * right + i[:, None] * down)
    if parallel:
        origins = targets - 5000 * along
        ahead = path_lengths(scene, origins, np.broadcast_to(along, origins.shape))
        beyond = path_lengths(scene, targets, np.broadcast_to(along, origins.shape))
    else:
        origins = np.broadcast_to(source, targets.shape)
        ahead = path_lengths(scene, origins, targets - source)
        beyond = path_lengths(scene, targets, targets - source)
    scalar = (ahead - beyond).reshape(rows, columns, -1)
    return batched, scalar


def agree(scene, axes, **more):
    batched, scalar = compare(scene, axes, **more)
    np.testing.assert_allclose(batched, scalar, rtol=0, atol=AGREE_MM)
    # All but a few pixels at outlines agree to the rounding of two path lengths.
    assert np.mean(np.abs(batched - scalar) > 1e-10) < 0.01


def load(solid, names=("m",)):
    return phantom.load(
        {
            "format": "phantom/1",
            "name": "test",
            "materials": {name: {"attenuation_per_mm": 0.02} for name in names},
            "solid": json.loads(json.dumps(solid)),
        }
    )


def round_or_drawn(rng):
    """Return a random generalized cylinder of the families of 1993's kinds."""
    every = [
        (a, c, s, f)
        for a in families.AXES
        for c in families.CONTOURS
        for s in families.SWEEPS
        for f in families.FRAMES
        if families.allowed((a, c, s, f))
    ]
    kinds = every[rng.integers(len(every))]
    return load({"material": "m", **families.generalized_cylinder(rng, kinds)})


def of_any_kind(rng):
    """Return a random generalized cylinder of every family there is."""
    while True:
        kinds = families_new.any_kinds(rng)
        if not families_new.allowed(kinds):
            continue
        try:
            return load({"material": "m", **families_new.generalized_cylinder(rng, kinds)})
        except phantom.InvalidDocumentError:
            continue


@pytest.mark.parametrize("seed", range(8))
def test_random_generalized_cylinders(seed):
    rng = np.random.default_rng([30, seed])
    agree(round_or_drawn(rng), turned(rng))


@pytest.mark.parametrize("seed", range(8))
def test_random_contours_sweeps_and_frames_of_every_kind(seed):
    rng = np.random.default_rng([31, seed])
    agree(of_any_kind(rng), turned(rng), size=(24, 140))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("parallel", [False, True], ids=["point", "parallel"])
def test_random_trees(seed, parallel):
    rng = np.random.default_rng([32, seed])
    scene = phantom.load(documents.document(documents.tree(rng, 3)))
    agree(scene, turned(rng), parallel=parallel, field=60.0)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(100, 500))
def test_hundreds_of_random_pictures(seed):
    """From any side, from near and far, from one point and parallel."""
    rng = np.random.default_rng([34, seed])
    drawn = (round_or_drawn, of_any_kind)[seed % 2](rng)
    distance = float(10.0 ** rng.uniform(1.5, 4.0))
    agree(drawn, turned(rng), distance=distance, parallel=seed % 3 == 0, size=(24, 140))


VIEWS = {
    "side": ((0, 0, -1), (1, 0, 0), (0, -1, 0)),
    "end-on": ((0, 1, 0), (1, 0, 0), (0, 0, -1)),
    "across": ((1, 0, 0), (0, 1, 0), (0, 0, -1)),
}


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("parallel", [False, True], ids=["point", "parallel"])
def test_the_knee_like_scene_along_the_axes(view, parallel):
    scene = phantom.load("bench/knee-like.json")
    axes = tuple(np.array(a, dtype=float) for a in VIEWS[view])
    # Rays at right angles to the axes: many lie in section planes or along a box's sides.
    agree(scene, axes, distance=1000.0, size=(60, 300), field=250.0, parallel=parallel)


def test_a_source_and_pixels_inside_the_solids():
    scene = phantom.load("bench/knee-like.json")
    rng = np.random.default_rng(33)
    for _ in range(3):
        agree(scene, turned(rng), distance=30.0, field=300.0, at=(-40.0, 20.0, 6.0))


def test_more_solids_in_a_row_than_a_tile_has_room_for():
    grid = np.stack(np.meshgrid(np.arange(40), np.arange(3)), axis=-1).reshape(-1, 2)
    solids = [
        {"type": "sphere", "center": [3 * x - 60, 3 * y, 0], "radius": 1.4, "material": "m"}
        for x, y in grid.tolist()
    ]
    scene = load({"type": "union", "solids": solids})
    agree(scene, tuple(np.eye(3)[[2, 0, 1]]), size=(20, 128), field=130.0)


def test_the_number_of_threads_and_the_bands_change_no_bit():
    scene = phantom.load("bench/knee-like.json")
    given = {
        "source": np.array([0.0, -1000.0, 0.0]),
        "direction": None,
        "first_pixel": np.array([-150.0, 500.0, 150.0]),
        "column_step": np.array([1.5, 0.0, 0.0]),
        "row_step": np.array([0.0, 0.0, -1.5]),
        "columns": 200,
        "rows": 200,
    }
    one = raster(scene, workers=1, **given)
    for workers in (2, 5):
        assert np.array_equal(one, raster(scene, workers=workers, **given))


def test_bands_are_the_rows_of_the_whole_picture():
    scene = phantom.load("bench/knee-like.json")
    given = {
        "source": np.array([0.0, -1000.0, 0.0]),
        "direction": None,
        "first_pixel": np.array([-150.0, 500.0, 150.0]),
        "column_step": np.array([0.5, 0.0, 0.0]),
        "row_step": np.array([0.0, 0.0, -5.0]),
        "columns": 600,
        "rows": 61,
    }
    seen = np.full((61, 600, len(scene.material_names)), np.nan)

    def each(first, lengths):
        seen[first : first + lengths.shape[1]] = np.moveaxis(lengths, 0, -1)

    raster_bands(scene, each, **given)
    assert np.array_equal(seen, raster(scene, **given))
