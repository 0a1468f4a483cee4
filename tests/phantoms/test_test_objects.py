"""The test objects hold what their parameters say, read back from traced rays."""

from __future__ import annotations

import math

import numpy as np
import pytest

import phantom
from phantom import library
from phantom.errors import InvalidInputError
from phantoms import shepp_logan_3d

Y = [0.0, 1.0, 0.0]
"""The direction of the ``ap`` beam, in a parallel one."""


def _through(solid, places_mm):
    """Return (N, M) path lengths of rays along y through (x, z) places."""
    origins = [[x, -2000.0, z] for x, z in places_mm]
    return phantom.path_lengths(solid, origins, [Y] * len(origins))


def _refused(name, **parameters):
    with pytest.raises(InvalidInputError) as refusal:
        library.build(name, **parameters)
    return {(p.path, p.kind) for p in refusal.value.problems}


def test_holes_of_the_contrast_detail_plate_fall_in_a_geometric_series():
    plate = library.build("contrast-detail", rows=4, columns=5, smallest_mm=0.5, largest_mm=8.0)
    sizes = {n: [8.0 * (0.5 / 8.0) ** (k / (n - 1)) for k in range(n)] for n in (4, 5)}
    centres = [((c - 2) * 15.0, (1.5 - r) * 15.0) for r in range(4) for c in range(5)]
    pmma, air = _through(plate, centres).T
    depths = np.repeat(sizes[4], 5)
    np.testing.assert_allclose(air, depths, atol=1e-9)
    np.testing.assert_allclose(pmma, 10.0 - depths, atol=1e-9)
    for column, diameter in enumerate(sizes[5]):
        x, z = centres[column]
        inside, outside = x + 0.499 * diameter, x + 0.501 * diameter
        assert np.all((_through(plate, [(inside, z), (outside, z)])[:, 1] > 0) == [True, False])


def test_a_hole_deeper_than_the_plate_is_refused():
    assert _refused("contrast-detail", thickness_mm=5) == {
        ("/parameters/largest_mm", "does_not_fit")
    }


def test_bars_stand_at_their_frequency():
    chart = library.build("line-pairs", pairs_per_mm=[0.5, 2.0], bars=3)
    # 5 mm of bars 1 mm wide, a gap of 3 mm, 1.25 mm of bars 0.25 mm wide: 9.25 mm in all.
    spans = [(-4.125 + 2 * k, 1.0) for k in range(3)]
    spans += [(-4.625 + 8.125 + 0.5 * k, 0.25) for k in range(3)]
    for middle, width in spans:
        at = [middle + s * width / 2 for s in (-1.001, -0.999, 0.0, 0.999, 1.001)]
        lead = _through(chart, [(x, 0.0) for x in at])[:, 1]
        np.testing.assert_allclose(lead, [0, 0.05, 0.05, 0.05, 0], atol=1e-12)


def test_the_chart_turns_by_its_angle():
    chart = library.build("line-pairs", pairs_per_mm=[1.0], bars=2, angle_deg=90.0)
    # Bars of 0.5 mm at x = -0.75..-0.25 and 0.25..0.75 now lie along x, at these z.
    lead = _through(chart, [(0.0, 0.5), (0.0, -0.5), (0.0, 0.0), (5.0, 0.5)])[:, 1]
    np.testing.assert_allclose(lead, [0.05, 0.05, 0.0, 0.05], atol=1e-12)


def test_the_edge_passes_through_the_middle_at_its_angle():
    edge = library.build("slanted-edge", angle_deg=3.0)
    slope = math.tan(math.radians(3.0))
    z = np.array([-40.0, -10.0, 0.0, 25.0])
    for aside, length in ((0.01, 1.0), (-0.01, 0.0)):
        found = _through(edge, [(slope * h + aside, h) for h in z])[:, 0]
        np.testing.assert_allclose(found, length, atol=1e-9)


def test_spheres_are_denser_than_the_block_by_their_contrast():
    block = library.build("low-contrast-spheres", diameters_mm=[10, 5], contrasts=[0.2, -0.1])
    lengths = _through(block, [(x, z) for z in (12.0, -12.0) for x in (-12.0, 12.0)])
    np.testing.assert_allclose(lengths[:, 0], [40, 45, 40, 45], atol=1e-9)
    np.testing.assert_allclose(lengths[:2, 1], [10, 5], atol=1e-9)
    np.testing.assert_allclose(lengths[2:, 2], [10, 5], atol=1e-9)
    view = phantom.preset_view(block, "ap", columns=8, rows=8)
    water, denser, lighter = phantom.radiograph(
        block, view, beam=phantom.Beam(kvp=70)
    ).attenuation_per_mm.T
    np.testing.assert_allclose(denser / water, 1.2, rtol=1e-9)
    np.testing.assert_allclose(lighter / water, 0.9, rtol=1e-9)


def test_a_sphere_larger_than_the_block_is_refused():
    assert _refused("low-contrast-spheres", diameters_mm=[4, 60]) == {
        ("/parameters/diameters_mm/1", "does_not_fit")
    }


def test_every_bead_is_seen_where_its_landmark_projects():
    beads = library.build("beads", beads=7, cylinder=None)
    view = phantom.preset_view(beads, "ap", columns=601, rows=601)
    image = phantom.radiograph(beads, view)
    matrix = np.asarray(image.projection_matrix)
    source = np.asarray(view.source)
    for k in range(7):
        share = k / 6
        turn = 2 * math.pi * 1.5 * share
        center = np.array([50 * math.cos(turn), 50 * math.sin(turn), 120 * (0.5 - share)])
        assert beads.document.landmarks[f"bead-{k + 1:03d}"] == pytest.approx(tuple(center))
        column, row, scale = matrix @ [*center, 1.0]
        through = image.path_lengths[round(row / scale), round(column / scale), 0]
        # At most half a pixel beside the centre, whose chord is the diameter.
        aside = np.linalg.norm(center - source) / 1150.0 * image.view.detector.pitch_mm
        assert 2 * math.sqrt(1.5**2 - aside**2 / 2) <= through <= 3.0 + 1e-9


def test_beads_that_touch_are_refused():
    assert _refused("beads", beads=400, turns=1) == {("/parameters/diameter_mm", "does_not_fit")}


@pytest.mark.parametrize("seed", [0, 5])
def test_depth_targets_stand_where_their_landmarks_say(seed):
    targets = library.build("stereo-targets", seed=seed)
    marks = targets.document.landmarks
    signs = [p for name, p in marks.items() if name.startswith("plus")]
    threads = [p for name, p in marks.items() if name.startswith("fibril")]
    for found in (signs, threads):
        depths = sorted(-y for _, y, _ in found)
        np.testing.assert_allclose(depths, np.linspace(-20.0, 20.0, len(found)), atol=1e-9)
    rays = [[x, -2000.0, z] for x, _, z in signs]
    hits = phantom.intervals(targets, rays, [Y] * len(rays))
    for ray, (_, y, _) in enumerate(signs):
        mine = hits.ray == ray
        ends = [
            (float(a), float(b))
            for a, b, leaf in zip(
                hits.entry_mm[mine], hits.exit_mm[mine], np.array(hits.leaf)[mine], strict=True
            )
            if hits.leaf_names[leaf].startswith("plus")
        ]
        for entry, leave in ends:
            assert (entry, leave) == pytest.approx((2000.0 + y - 0.5, 2000.0 + y + 0.5), abs=1e-6)


def test_no_target_at_all_is_refused():
    assert _refused("stereo-targets", rows=0, fibrils=0) == {
        ("/parameters/fibrils", "out_of_range")
    }
    assert _refused("stereo-targets", depth_mm=100) == {("/parameters/slab_mm", "does_not_fit")}


def test_shepp_logan_is_the_sum_of_its_ellipsoids():
    """Grey values add up: the line integral is Σ grey · chord over the table's ten ellipsoids."""
    head = library.build("shepp-logan-3d", semi_axis_mm=100.0, attenuation_per_mm=0.02)
    rng = np.random.default_rng(3)
    origins = rng.normal(size=(3000, 3))
    origins *= 300.0 / np.linalg.norm(origins, axis=1, keepdims=True)
    aims = rng.uniform((-60.0, -60.0, -80.0), (60.0, 60.0, 40.0), size=(3000, 3))
    directions = aims - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    lengths = phantom.path_lengths(head, origins, directions)
    mu = np.array([m.attenuation_per_mm for m in head.document.materials.values()])
    expected = sum(part.grey * _chord(part, origins, directions) for part in shepp_logan_3d.TABLE)
    np.testing.assert_allclose(lengths @ mu, 0.02 * expected, atol=1e-8)


def _chord(part, origins, directions):
    """Return (N,) mm of rays within an ellipsoid of the table, whose y points to the face."""
    turn = math.radians(part.turn_deg)
    axes = np.array(
        [[math.cos(turn), math.sin(turn), 0], [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    to_table = np.diag([1.0, -1.0, 1.0]) / 100.0
    p = ((origins @ to_table) - part.center) @ axes.T / part.semi_axes
    d = (directions @ to_table) @ axes.T / part.semi_axes
    a, b, c = (d * d).sum(1), (p * d).sum(1), (p * p).sum(1) - 1
    return 2 * np.sqrt(np.maximum(b * b - a * c, 0)) / a
