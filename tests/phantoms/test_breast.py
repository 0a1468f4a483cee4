"""The breast is as thick, as dense and as mirrored as it says, read back from traced rays."""

from __future__ import annotations

import numpy as np
import pytest

import phantom
from phantom import library
from phantom.errors import InvalidInputError
from phantom.library import Person, Population
from phantom.requests.radiograph import plan

Z = [0.0, 0.0, -1.0]


@pytest.fixture(scope="module")
def breast():
    return library.build("breast")


def _down(solid, x, y):
    """Return {material: (N,) mm} of rays from head to feet through (x, y)."""
    origins = np.stack([x, y, np.full(len(x), 500.0)], axis=1)
    lengths = phantom.path_lengths(solid, origins, np.tile(Z, (len(x), 1)))
    return dict(zip(solid.material_names, lengths.T, strict=True))


def _lattice(solid, step_mm):
    (x0, y0, _), (x1, y1, _) = solid.bounds
    xs, ys = np.arange(x0 + step_mm / 2, x1, step_mm), np.arange(y0 + step_mm / 2, y1, step_mm)
    return tuple(a.ravel() for a in np.meshgrid(xs, ys))


def test_the_mean_woman_has_the_published_thickness_and_skin(breast):
    """59 +- 16 mm compressed (Yaffe 2009); skin 1.45 +- 0.30 mm (Huang 2008)."""
    found = _down(breast, np.array([0.0, 10.0, -20.0]), np.array([-40.0, -30.0, -20.0]))
    assert sum(found.values()) == pytest.approx(np.full(3, 59.0), abs=16.0)
    assert found["skin"] / 2 == pytest.approx(np.full(3, 1.45), abs=0.30)


@pytest.mark.parametrize("asked", [None, 0.05, 0.5])
def test_the_gland_has_its_share_of_the_volume(asked):
    """Σ L dA is the volume; the mean woman's share is 0.19 (Yaffe 2009), SD about 0.1."""
    solid = library.build("breast", glandular=asked, strands=0, lobules=200)
    found = _down(solid, *_lattice(solid, 1.5))
    share = found["gland"].sum() / (found["gland"] + found["fat"]).sum()
    assert share == pytest.approx(0.19 if asked is None else asked, abs=0.015)


def test_ducts_and_ligaments_are_counted_with_the_gland(breast):
    found = _down(breast, *_lattice(breast, 1.5))
    share = found["gland"].sum() / (found["gland"] + found["fat"]).sum()
    assert share == pytest.approx(0.19, abs=0.01)


def test_fat_lies_around_the_gland(breast):
    """Before the chest wall and at the edge, but not behind the nipple, where ducts meet."""
    y = np.linspace(-90.0, -1.0, 60)
    gland = _down(breast, np.zeros_like(y), y)["gland"]
    assert gland[y > -8.0].max() < 3.0 < gland[(y < -80.0)].mean()
    x = np.linspace(-93.0, 93.0, 80)
    gland = _down(breast, x, np.full_like(x, -20.0))["gland"]
    assert gland[np.abs(x) > 85.0].max() < 3.0 < gland[np.abs(x) < 60.0].mean()


@pytest.mark.parametrize("view", ["cc", "mlo"])
def test_the_picture_ends_before_the_chest_wall(view):
    """No air is seen behind a right breast: it reaches the right edge of the detector."""
    asked = {
        "phantom": {"name": "breast", "parameters": {"compression": view}},
        "view": {"preset": view},
        "detector": {"columns": 64, "rows": 64},
        "acquisition": None,
    }
    shown = plan(asked).render()
    assert shown.line_integral[16:48, -1].min() > 3.0
    assert shown.line_integral[:, :16].max() == 0.0
    assert not shown.warnings


@pytest.mark.parametrize("view", ["cc", "mlo"])
def test_fat_is_as_grey_in_a_thick_breast_as_in_a_thin_one(view):
    """The window moves with the thickness: the lowest tenth of its greys stays dark grey."""
    for thickness_mm in (30.0, 45.0, 59.0, 75.0, 90.0):
        given = {"compression": view, "thickness_mm": thickness_mm, "lobules": 200, "strands": 0}
        asked = {
            "phantom": {"name": "breast", "parameters": given},
            "view": {"preset": view},
            "detector": {"columns": 96, "rows": 96},
            "acquisition": None,
        }
        made = plan(asked)
        shown = np.asarray(made.render().presented("signal", made.presentation)) / 255.0
        assert 0.3 < np.quantile(shown[shown > 0.2], 0.1) < 0.55
        assert np.mean(shown > 0.99) < 0.02


def test_all_that_is_not_skin_lies_inside_it(breast):
    x, y = _lattice(breast, 4.0)
    origins = np.stack([x, y, np.full(len(x), 500.0)], axis=1)
    hits = phantom.intervals(breast, origins, np.tile(Z, (len(x), 1)))
    for ray in np.unique(hits.ray):
        mine = np.flatnonzero(hits.ray == ray)
        first = mine[np.argmin(hits.entry_mm[mine])]
        assert hits.leaf_names[hits.leaf[first]] in ("skin", "areola", "nipple")


def test_a_left_breast_is_the_mirror_image_of_a_right_one(breast):
    left = library.build("breast", side="left")
    x, y = _lattice(breast, 7.0)
    right = _down(breast, x, y)
    for name, lengths in _down(left, -x, y).items():
        np.testing.assert_allclose(lengths, right[name], atol=1e-6)


def test_between_plates_turned_for_mlo_it_is_as_thick():
    solid = library.build("breast", compression="mlo", thickness_mm=59, lobules=40, strands=0)
    way = np.array([-1.0, 0.0, -1.0]) / 2**0.5  # the beam of a right breast's mlo at 45 degrees
    start = np.array([0.0, -40.0, 0.0]) - 500.0 * way
    assert phantom.path_lengths(solid, [start], [way]).sum() == pytest.approx(59.0, abs=1e-6)


def test_the_pectoral_muscle_is_seen_in_mlo_only(breast):
    turned = library.build("breast", compression="mlo", lobules=40, strands=0)
    for solid, seen in ((breast, False), (turned, True)):
        view = phantom.preset_view(solid, "mlo", columns=64, rows=64)
        muscle = phantom.radiograph(solid, view).path_lengths[
            ..., solid.material_names.index("muscle")
        ]
        assert bool(np.any(muscle > 0)) is seen
        if seen:  # by the chest wall, at the top (the axilla): right of a right breast's picture
            rows, columns = np.nonzero(muscle)
            assert rows.mean() < 32 < columns.mean()


CLUSTER = {
    "type": "calcification_cluster",
    "number": 12,
    "seed": 3,
    "cluster_mm": 16,
    "diameter_mm": 1.5,
}


@pytest.mark.parametrize(
    ("arrangement", "dimensions"), [("line", 1), ("sheet", 2), ("scattered", 3), ("shell", 3)]
)
def test_calcifications_are_arranged_as_asked(breast, arrangement, dimensions):
    made = library.build(
        "breast",
        [{**CLUSTER, "diameter_mm": 0.5, "arrangement": arrangement}],
        lobules=40,
        strands=0,
    )
    (finding,) = made.document.findings
    assert len(finding.leaves) == 12
    centers = np.array([_center(made, name) for name in finding.leaves]) - finding.center
    spread = np.linalg.svd(centers, compute_uv=False)
    assert int(np.count_nonzero(spread > 1e-6)) == dimensions
    radii = np.linalg.norm(centers, axis=1)
    assert np.all(radii <= 8.0)
    if arrangement == "shell":
        np.testing.assert_allclose(radii, radii[0], atol=1e-6)


def _center(solid, name):
    """Return a sphere's centre, half-way between where rays along x, y and z enter and leave it."""
    leaf = next(s for s in solid.document.solid.solids if getattr(s, "name", None) == name)
    ends = []
    for axis in range(3):
        way = np.eye(3)[axis]
        hits = phantom.intervals(solid, [np.array(leaf.center) - 400.0 * way], [way])
        mine = np.array([hits.leaf_names[k] == name for k in hits.leaf])
        middle = (hits.entry_mm[mine][0] + hits.exit_mm[mine][0]) / 2
        ends.append(leaf.center[axis] - 400.0 + middle)
    return ends


@pytest.mark.parametrize("lesion", [CLUSTER, {"type": "mass", "site": "upper_outer"}])
def test_a_lesion_changes_nothing_beside_itself(breast, lesion):
    made = library.build("breast", [lesion])
    assert made.material_names[: len(breast.material_names)] == breast.material_names
    view = phantom.preset_view(breast, "cc", columns=200, rows=200)
    healthy = phantom.radiograph(breast, view).path_lengths
    ill = phantom.radiograph(made, view).path_lengths
    struck = ill[..., -1] > 0
    assert 0 < np.count_nonzero(struck) < 4000
    np.testing.assert_array_equal(ill[~struck][:, :-1], healthy[~struck])
    np.testing.assert_allclose(ill.sum(axis=-1), healthy.sum(axis=-1), atol=1e-6)


def test_a_mass_has_its_diameter_where_its_finding_says():
    made = library.build(
        "breast",
        [{"type": "mass", "diameter_mm": 9, "spicules": 0, "offset_mm": [3, 4, -5]}],
        lobules=40,
        strands=0,
    )
    (finding,) = made.document.findings
    x, y, _ = finding.center
    assert _down(made, np.array([x]), np.array([y]))["mass-1"] == pytest.approx(9.0, abs=1e-9)


@pytest.mark.parametrize(
    ("given", "path"),
    [
        ({"type": "mass", "offset_mm": [0, 0, 28]}, "/abnormalities/0/offset_mm"),
        ({"type": "mass", "diameter_mm": 80}, "/abnormalities/0/diameter_mm"),
        ({"type": "calcification_cluster", "site": "elbow"}, "/abnormalities/0/site"),
    ],
)
def test_a_lesion_that_does_not_fit_is_refused(given, path):
    with pytest.raises(InvalidInputError) as refusal:
        library.document("breast", {}, [given])
    assert [p.path for p in refusal.value.problems] == [path]


def _generator(index):
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(1, spawn_key=(index,))))


def test_any_woman_gives_a_sound_breast_always_the_same():
    women = Population(female=1.0)
    entry = library.entry("breast")
    for index in range(12):
        drawn = [entry.of_person(women.draw(g), g) for g in (_generator(index), _generator(index))]
        assert drawn[0] == drawn[1]
        given = {**drawn[0].model_dump(), "lobules": 60, "strands": 9}
        assert library.prepare("breast", given).document.parameters["seed"] == drawn[0].seed


def test_a_man_is_refused():
    man = Person(sex="male", height_cm=175.0, weight_kg=80.0)
    with pytest.raises(InvalidInputError, match="expected female"):
        library.entry("breast").of_person(man, _generator(0))


def test_spheres_of_the_stereo_study_lie_in_their_half_ball():
    made = library.build(
        "breast-of-spheres", [{"type": "arrangement", "seed": 2}, {"type": "density", "seed": 1}]
    )
    (low, high) = made.bounds
    np.testing.assert_allclose([low, high], [[-60, -60, -60], [60, 0, 60]], atol=1e-6)
    ring, dense = made.document.findings
    leaves = {getattr(s, "name", None): s for s in made.document.solid.solids}
    centers = np.array([leaves[name].center for name in ring.leaves])
    np.testing.assert_allclose(np.linalg.norm(centers - ring.center, axis=1), 12.0, atol=1e-6)
    assert np.linalg.svd(centers - ring.center, compute_uv=False)[2] < 1e-6
    x, _, z = dense.center
    along = phantom.path_lengths(made, [[x, -300.0, z]], [[0.0, 1.0, 0.0]])[0]
    assert along[-1] == pytest.approx(6.0, abs=1e-9)


def test_an_arrangement_larger_than_the_breast_is_refused():
    with pytest.raises(InvalidInputError) as refusal:
        library.document("breast-of-spheres", {}, [{"type": "arrangement", "ring_mm": 90}])
    assert refusal.value.problems[0].path == "/abnormalities/0/ring_mm"
