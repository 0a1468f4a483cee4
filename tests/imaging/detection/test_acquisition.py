"""What may be asked of an exposure, and what is refused where."""

from __future__ import annotations

from typing import Any

import pytest

from phantom.document.validation import validate_model
from phantom.errors import InvalidInputError, prefixed
from phantom.imaging.detection import Absorber, Acquisition, Blur, DetectorModel, FocalSpot

REFUSED: list[tuple[dict[str, Any], str, str]] = [
    ({"detector_air_kerma_ugy": -1}, "/detector_air_kerma_ugy", "out_of_range"),
    ({"detector_air_kerma_ugy": 0}, "/detector_air_kerma_ugy", "out_of_range"),
    ({"mas": 0.0}, "/mas", "out_of_range"),
    ({"mas": 1.0, "detector_air_kerma_ugy": 1.0}, "/mas", "contradiction"),
    ({"falloff": "cubic"}, "/falloff", "unknown_value"),
    ({"flat_field": True}, "/flat_field", "no_effect"),
    ({"focal_spot": {"size_mm": [0, 1]}}, "/focal_spot/size_mm/0", "out_of_range"),
    ({"focal_spot": {"size_mm": [1, 1], "points": [5, 0]}}, "/focal_spot/points/1", "out_of_range"),
    ({"focal_spot": {}}, "/focal_spot/size_mm", "missing"),
    ({"scatter": {"air_gap_mm": -3}}, "/scatter/air_gap_mm", "out_of_range"),
    (
        {"grid": {"primary_transmission": 0, "scatter_transmission": 0.1}},
        "/grid/primary_transmission",
        "out_of_range",
    ),
    (
        {"grid": {"primary_transmission": 0.7, "scatter_transmission": 1.1}},
        "/grid/scatter_transmission",
        "out_of_range",
    ),
    ({"samples_per_pixel": [0, 1]}, "/samples_per_pixel/0", "out_of_range"),
    ({"quantum_noise": "loud"}, "/quantum_noise", "unknown_value"),
    ({"detector": {"swank_factor": 1.2}}, "/detector/swank_factor", "out_of_range"),
    (
        {"detector": {"response": "photon_counting", "swank_factor": 0.9}},
        "/detector/swank_factor",
        "no_effect",
    ),
    (
        {"detector": {"blur": {"half_frequency_per_mm": 0}}},
        "/detector/blur/half_frequency_per_mm",
        "out_of_range",
    ),
    (
        {"detector": {"blur": {"shape": "box", "half_frequency_per_mm": 1}}},
        "/detector/blur/shape",
        "unknown_value",
    ),
    ({"detector": {"electronic_noise": -1}}, "/detector/electronic_noise", "out_of_range"),
    (
        {"detector": {"digitizer": {"bits": 0, "codes_per_signal": 1}}},
        "/detector/digitizer/bits",
        "out_of_range",
    ),
    (
        {"detector": {"digitizer": {"codes_per_signal": 0}}},
        "/detector/digitizer/codes_per_signal",
        "out_of_range",
    ),
    (
        {"detector": {"absorber": {"material": "lead", "thickness_mg_cm2": 60}}},
        "/detector/absorber/material",
        "unknown_value",
    ),
    (
        {"detector": {"absorber": {"material": "cesium_iodide", "thickness_mg_cm2": -60}}},
        "/detector/absorber/thickness_mg_cm2",
        "out_of_range",
    ),
    ({"dose": 3}, "/dose", "unknown_field"),
]


@pytest.mark.parametrize(("fields", "path", "kind"), REFUSED)
def test_what_cannot_be_is_refused_with_its_path(
    fields: dict[str, Any], path: str, kind: str
) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Acquisition(**fields)
    found = [(p.path, p.kind) for p in refusal.value.problems]
    assert found == [("/acquisition" + path, kind)]
    with pytest.raises(InvalidInputError) as refusal:
        validate_model(Acquisition, fields)
    assert prefixed("/acquisition", refusal.value.problems) == tuple(
        prefixed("/acquisition", refusal.value.problems)
    )
    assert [(p.path, p.kind) for p in refusal.value.problems] == [(path, kind)]


def test_parts_refuse_with_the_paths_they_have_in_a_request() -> None:
    for build, path in (
        (lambda: FocalSpot(size_mm=(-1, 1)), "/acquisition/focal_spot/size_mm/0"),
        (
            lambda: Blur(half_frequency_per_mm=-1),
            "/acquisition/detector/blur/half_frequency_per_mm",
        ),
        (lambda: DetectorModel(gain_per_kev=0), "/acquisition/detector/gain_per_kev"),
        (
            lambda: Absorber(material="cesium_iodide", thickness_mg_cm2=0),
            "/acquisition/detector/absorber/thickness_mg_cm2",
        ),
    ):
        with pytest.raises(InvalidInputError) as refusal:
            build()
        assert [p.path for p in refusal.value.problems] == [path]


def test_every_field_has_a_title_a_unit_and_a_meaning() -> None:
    schema = Acquisition.model_json_schema()
    models = [schema, *schema["$defs"].values()]
    assert len(models) == 8
    for model in models:
        for field in model["properties"].values():
            assert field["title"]
            assert field["unit"]
            assert field["description"].endswith(f"Unit: {field['unit']}.")
