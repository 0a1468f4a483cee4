"""From a request to a plan: defaults, limits, and what makes two requests the same."""

from __future__ import annotations

import copy
import dataclasses

import pytest

from phantom import library
from phantom.encode import format_named
from phantom.errors import InvalidInputError
from phantom.imaging import Acquisition
from phantom.requests.limits import Limits
from phantom.requests.radiograph import plan

SPHERE = {"phantom": {"name": "sphere"}}
DOCUMENT = {
    "format": "phantom/1",
    "materials": {"a": {"attenuation_per_mm": 1}},
    "solid": {"type": "sphere", "center": [5, 6, 7], "radius": 4, "material": "a"},
}
NAMED = {
    **DOCUMENT,
    "solid": {
        "type": "overlap",
        "solids": [{**DOCUMENT["solid"], "name": name} for name in ("a", "b", "c")],
    },
}


def paths(refusal) -> list[str]:
    return [p.path for p in refusal.value.problems]


def test_everything_but_the_phantom_has_a_default():
    planned = plan(SPHERE)
    technique = library.entry("sphere").technique
    assert planned.beam.energy_kev == technique.energy_kev
    assert planned.presentation.polarity == technique.polarity
    assert planned.chosen["view"] == "ap"
    assert planned.chosen["source_detector_mm"] == technique.source_detector_mm
    with pytest.raises(InvalidInputError) as refusal:
        plan({})
    assert paths(refusal) == ["/phantom"]


def test_a_detector_is_square_unless_its_rows_are_given():
    assert plan(SPHERE | {"detector": {"columns": 7}}).view.detector.rows == 7
    assert plan(SPHERE | {"detector": {"columns": 7, "rows": 3}}).view.detector.rows == 3


def test_defaults_written_out_make_the_same_request():
    planned = plan(SPHERE)
    written = {
        "phantom": {"name": "sphere", "parameters": {"radius_mm": 25}},
        "view": {"preset": "ap", "source_detector_mm": 1150, "object_detector_mm": 100},
        "detector": {"columns": 1024, "rows": 1024},
        "beam": {"energy_kev": 60},
        "quantity": "signal",
        "presentation": {"mode": "stretch", "polarity": "bones_white", "bits": 8},
    }
    assert plan(written).fingerprint() == planned.fingerprint()


def test_a_tube_written_out_makes_the_same_request():
    short = plan(SPHERE | {"beam": {"kvp": 70}})
    written = {"kvp": 70.0, "anode": "tungsten", "filtration_mm": {"aluminium": 2.5}}
    assert plan(SPHERE | {"beam": written}).fingerprint() == short.fingerprint()
    assert short.fingerprint() != plan(SPHERE).fingerprint()
    words = {name: short.chosen[name] for name in ("kvp", "anode", "filtration")}
    assert words == {"kvp": 70, "anode": "tungsten", "filtration": "aluminium=2.5"}
    assert "energy_kev" not in short.chosen


@pytest.fixture
def breast(monkeypatch):
    """The sphere, X-rayed as a breast is in one view and as a knee in all others."""
    entry = dataclasses.replace(
        library.entry("sphere"),
        technique=library.Technique(kvp=65.0),
        techniques={
            "cc": library.Technique(
                kvp=28.0,
                anode="tungsten",
                filtration_mm={"rhodium": 0.05},
                source_detector_mm=650.0,
                object_detector_mm=50.0,
            )
        },
    )
    monkeypatch.setattr(library, "entry", lambda _: entry)


@pytest.fixture
def windowed(monkeypatch):
    """The sphere, shown in a window of its own in every view."""
    technique = library.Technique(window=(1.5, 3.0))
    entry = dataclasses.replace(library.entry("sphere"), technique=technique)
    monkeypatch.setattr(library, "entry", lambda _: entry)


@pytest.mark.usefixtures("windowed")
def test_a_phantom_with_a_window_is_shown_in_it_unless_asked_otherwise():
    def shown(**wanted):
        p = plan(SPHERE | {"presentation": wanted}).presentation
        return p.mode, p.scope, p.window_center, p.window_width

    fixed = ("window", "fixed", 1.5, 3.0)
    assert shown() == shown(bits=16) == shown(scope="fixed") == shown(mode="window") == fixed
    assert shown(mode="stretch") == ("stretch", "image", None, None)
    assert shown(scope="image") == ("stretch", "image", None, None)
    assert shown(percentiles=[5, 95])[:2] == ("percentile", "image")
    assert shown(window_center=1, window_width=1) == ("window", "fixed", 1, 1)


def test_a_window_may_move_with_a_length_of_the_phantom(monkeypatch):
    technique = library.Technique(window=(1.5, 3.0), window_follows=("radius_mm", 20.0, 0.05))
    entry = dataclasses.replace(library.entry("sphere"), technique=technique)
    monkeypatch.setattr(library, "entry", lambda _: entry)
    for radius_mm, center in ((20.0, 1.5), (30.0, 2.0), (14.0, 1.2)):
        sphere = {"phantom": {"name": "sphere", "parameters": {"radius_mm": radius_mm}}}
        shown = plan(sphere).presentation
        assert (shown.window_center, shown.window_width) == (pytest.approx(center), 3.0)


def test_a_window_that_nobody_gave_is_asked_for_before_anything_is_traced():
    with pytest.raises(InvalidInputError) as refusal:
        plan(SPHERE | {"presentation": {"scope": "fixed"}})
    assert paths(refusal) == ["/presentation/window_center"]


def test_drive_levels_are_no_p_values_and_so_no_dicom():
    display = {"l_min_cd_m2": 1, "l_max_cd_m2": 300, "response": [[0, 1], [255, 300]]}
    planned = plan(SPHERE | {"presentation": {"gsdf": display}})
    planned.check_format(format_named("png"))
    with pytest.raises(InvalidInputError) as refusal:
        planned.check_format(format_named("dicom"))
    assert paths(refusal) == ["/presentation/gsdf/response"]


def test_kinds_of_ground_truth_are_a_set():
    one = plan(SPHERE | {"truth": ["boxes", "masks", "boxes"]})
    assert one.truth == ("masks", "boxes")
    assert one.fingerprint() == plan(SPHERE | {"truth": ["masks", "boxes"]}).fingerprint()
    with pytest.raises(InvalidInputError) as refusal:
        plan(SPHERE | {"truth": ["masks", "labels"]})
    assert paths(refusal) == ["/truth/1"]


def test_ground_truth_too_large_to_hold_is_refused_before_it_is_traced():
    pixels = 64 * 64
    small = {"detector": {"columns": 64}, "phantom": {"document": NAMED}}
    limits = Limits(result_bytes=pixels * 8 * 5)
    plan(small, limits=limits)
    with pytest.raises(InvalidInputError) as refusal:
        plan(small | {"truth": ["masks"]}, limits=limits)
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("/truth", "too_large")]


@pytest.mark.usefixtures("breast")
def test_the_technique_is_that_of_the_phantom_and_the_view():
    beam = plan(SPHERE).beam
    assert (beam.kvp, beam.anode, beam.filtration_mm) == (65, "tungsten", {"aluminium": 2.5})
    cc = SPHERE | {"view": {"preset": "cc"}}
    assert plan(cc).beam.filtration_mm == {"rhodium": 0.05}
    assert plan(cc).chosen["source_detector_mm"] == 650
    other_voltage = plan(cc | {"beam": {"kvp": 32}}).beam
    assert (other_voltage.kvp, other_voltage.filtration_mm) == (32, {"rhodium": 0.05})
    other_anode = plan(cc | {"beam": {"kvp": 28, "anode": "molybdenum"}}).beam
    assert other_anode.filtration_mm == {"molybdenum": 0.03}
    single = plan(cc | {"beam": {"energy_kev": 20}}).beam
    assert (single.energy_kev, single.kvp, single.filtration_mm) == (20, None, None)
    unsaid = plan(cc | {"beam": {"energy_kev": None, "kvp": None}}).beam
    assert unsaid.kvp == 28


def test_any_difference_makes_another_request():
    requests = [
        SPHERE,
        SPHERE | {"view": {"preset": "pa"}},
        SPHERE | {"beam": {"energy_kev": 61}},
        SPHERE | {"quantity": "transmission"},
        SPHERE | {"presentation": {"bits": 16}},
        SPHERE | {"presentation": {"mode": "equalise"}},
        SPHERE | {"truth": ["masks"]},
        SPHERE | {"truth": ["boxes"]},
        SPHERE | {"presentation": {"percentiles": [2, 98]}},
        SPHERE | {"presentation": {"gsdf": {"l_min_cd_m2": 1, "l_max_cd_m2": 300}}},
        SPHERE | {"detector": {"columns": 1023}},
        {"phantom": {"name": "sphere", "parameters": {"radius_mm": 25.000001}}},
        {"phantom": {"document": DOCUMENT}},
    ]
    assert len({plan(request).fingerprint() for request in requests}) == len(requests)


def test_a_request_is_left_as_it_was():
    request = {"phantom": {"document": DOCUMENT}, "detector": {"columns": 4}}
    before = copy.deepcopy(request)
    plan(request)
    assert request == before


def test_problems_of_every_part_are_told_at_once():
    request = {
        "phantom": {"document": {**DOCUMENT, "extra": 1, "materials": {"a": {}}}},
        "view": {"preset": "ap", "source_detector_mm": -1},
        "detector": {"columns": 0},
        "beam": {"energy_kev": float("nan")},
        "presentation": {"bits": 12},
        "extra": 1,
    }
    with pytest.raises(InvalidInputError) as refusal:
        plan(request)
    assert paths(refusal) == [
        "/beam/energy_kev",
        "/detector/columns",
        "/extra",
        "/phantom/document/extra",
        "/phantom/document/materials/a",
        "/presentation/bits",
        "/view/source_detector_mm",
    ]


@pytest.mark.parametrize(
    ("subject", "path"),
    [
        ("sphere", "/phantom"),
        ({}, "/phantom/name"),
        ({"name": 3}, "/phantom/name"),
        ({"name": ""}, "/phantom/name"),
        ({"name": "nobody"}, "/phantom/name"),
        ({"name": "sphere", "parameters": []}, "/phantom/parameters"),
        ({"name": "sphere", "parameters": {"name": 1}}, "/phantom/parameters/name"),
        ({"name": "sphere", "colour": 1}, "/phantom/colour"),
        ({"document": 3}, "/phantom/document"),
        ({"document": DOCUMENT, "name": "sphere"}, "/phantom/name"),
    ],
)
def test_a_phantom_that_is_none_is_told_in_its_place(subject, path):
    with pytest.raises(InvalidInputError) as refusal:
        plan({"phantom": subject})
    assert paths(refusal) == [path]


POSE = {"center": [0, 200, 0], "right": [1, 0, 0], "down": [0, 0, -1]}


@pytest.mark.parametrize(
    ("view", "path"),
    [
        ("ap", "/view"),
        ({"preset": "ap", "source": [0, 0, 0]}, "/view/source"),
        ({"source": [0, -500, 0]}, "/view/detector"),
        ({"detector": POSE}, "/view/source"),
        ({"source": None, "detector": POSE}, "/view/direction"),
        ({"source": [0, -500, 0], "direction": [0, 1, 0], "detector": POSE}, "/view/direction"),
        ({"source": [0, 200, 0], "detector": POSE}, "/view/source"),
        ({"source": [0, -500, 0], "detector": {**POSE, "down": [1, 0, 0]}}, "/view/detector/down"),
        ({"source": [0, 0, 0], "detector": POSE}, "/detector/pitch_mm"),
        ({"source_detector_mm": 50, "object_detector_mm": 60}, "/view/object_detector_mm"),
        ({"source_detector_mm": 20}, "/view/source_detector_mm"),
    ],
)
def test_a_view_that_is_none_is_told_in_its_place(view, path):
    with pytest.raises(InvalidInputError) as refusal:
        plan(SPHERE | {"view": view})
    assert paths(refusal) == [path]


@pytest.mark.parametrize(
    ("limits", "detector"),
    [(Limits(pixels=99), {"columns": 10}), (Limits(result_bytes=100 * 5 * 8 - 1), {"columns": 10})],
)
def test_the_cost_is_counted_first(limits, detector):
    with pytest.raises(InvalidInputError) as refusal:
        plan(SPHERE | {"detector": detector}, limits=limits)
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("/detector", "too_large")]
    assert plan(SPHERE | {"detector": {"columns": 9}}, limits=limits)


DOSE = {"detector_air_kerma_ugy": 1.0}


def test_an_exposure_makes_another_request_and_so_does_its_seed():
    requests = [
        SPHERE,
        SPHERE | {"acquisition": {}},
        SPHERE | {"acquisition": DOSE},
        SPHERE | {"acquisition": DOSE, "noise": {"seed": 1}},
        SPHERE | {"acquisition": DOSE, "noise": {"case": 1}},
        SPHERE | {"acquisition": DOSE | {"scatter": {}}},
        SPHERE | {"acquisition": DOSE | {"detector": {"response": "photon_counting"}}},
    ]
    assert len({plan(request).fingerprint() for request in requests}) == len(requests)
    same = [{"acquisition": {}}, {"acquisition": {"samples_per_pixel": [1, 1]}, "noise": {}}]
    assert len({plan(SPHERE | request).fingerprint() for request in same}) == 1


def test_a_seed_without_an_exposure_is_told_to_do_nothing():
    made = plan(SPHERE | {"detector": {"columns": 4}, "noise": {"seed": 3}}).render()
    assert any("seed has no effect" in warning for warning in made.warnings)
    assert plan(SPHERE | {"detector": {"columns": 4}}).render().warnings == ()


@pytest.mark.parametrize(
    ("limits", "acquisition"),
    [
        (
            Limits(exposure_rays=100 * 4 * 6 - 1),
            {"focal_spot": {"size_mm": [1, 1], "points": [2, 3]}},
        ),
        # One material: its path lengths and three sums, for each of 400 samples.
        (Limits(result_bytes=8 * 400 * 4), {}),
    ],
)
def test_an_exposure_that_costs_too_much_is_refused(limits, acquisition):
    request = SPHERE | {
        "detector": {"columns": 10},
        "acquisition": {**DOSE, "samples_per_pixel": [2, 2], **acquisition},
    }
    with pytest.raises(InvalidInputError) as refusal:
        plan(request, limits=limits)
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("/acquisition", "too_large")]
    plan(request)


def test_drawing_every_bin_holds_an_image_a_bin():
    request = SPHERE | {"detector": {"columns": 10}, "beam": {"kvp": 120}}
    limits = Limits(result_bytes=8 * 100 * 60)
    plan(request | {"acquisition": {"quantum_noise": "compound"}}, limits=limits)
    with pytest.raises(InvalidInputError) as refusal:
        plan(request | {"acquisition": {"quantum_noise": "per_bin"}}, limits=limits)
    assert paths(refusal) == ["/acquisition"]


def test_an_acquisition_without_a_dose_has_the_techniques_and_is_whole():
    planned = plan({"phantom": {"name": "hand"}, "acquisition": {"samples_per_pixel": [2, 2]}})
    usual = library.entry("hand").technique_of("pa").air_kerma_ugy
    assert usual is not None
    assert planned.acquisition == Acquisition(
        detector_air_kerma_ugy=usual, samples_per_pixel=(2, 2)
    )
