"""A view that cannot be is refused, with every problem at its place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from phantom.document import validate_model
from phantom.errors import InvalidInputError
from phantom.imaging import Detector, View

DETECTOR: dict[str, Any] = {
    "center": [0, 500, 0],
    "right": [1, 0, 0],
    "down": [0, 0, -1],
    "columns": 64,
    "rows": 32,
    "pitch_mm": 0.5,
}
SOURCE = [0, -1000, 0]


def problems_of(**view: Any) -> list[tuple[str, str]]:
    with pytest.raises(InvalidInputError) as refusal:
        View(**view)
    return [(problem.path, problem.kind) for problem in refusal.value.problems]


REFUSED = [
    ("pitch_mm", 0, "out_of_range"),
    ("pitch_mm", -0.5, "out_of_range"),
    ("pitch_mm", 1e9, "out_of_range"),
    ("pitch_mm", math.nan, "not_finite"),
    ("pitch_mm", "0.5", "not_a_number"),
    ("columns", 0, "out_of_range"),
    ("columns", 16385, "out_of_range"),
    ("columns", 64.5, "not_an_integer"),
    ("rows", -1, "out_of_range"),
    ("right", [0, 0, 0], "zero_vector"),
    ("down", [0, 0, 0], "zero_vector"),
    ("down", [1, 0, -1], "not_orthogonal"),
    ("center", [0, 500], "wrong_length"),
]


@pytest.mark.parametrize(("field", "value", "kind"), REFUSED)
def test_a_bad_field_of_the_detector_is_told_by_its_path(field: str, value: Any, kind: str) -> None:
    found = problems_of(source=SOURCE, detector={**DETECTOR, field: value})
    assert found == [(f"/view/detector/{field}", kind)]


def test_each_pitch_of_a_pair_has_its_own_path() -> None:
    found = problems_of(source=SOURCE, detector={**DETECTOR, "pitch_mm": [0.5, 0]})
    assert found == [("/view/detector/pitch_mm/1", "out_of_range")]


def test_too_many_pixels_are_refused_before_anything_is_made() -> None:
    found = problems_of(source=SOURCE, detector={**DETECTOR, "columns": 16384, "rows": 16384})
    assert found == [("/view/detector/rows", "too_large")]


def test_every_problem_is_told_at_once() -> None:
    found = problems_of(
        source=[0, math.inf, 0], detector={**DETECTOR, "pitch_mm": 0, "rows": 0, "colour": 1}
    )
    assert sorted(found) == [
        ("/view/detector/colour", "unknown_field"),
        ("/view/detector/pitch_mm", "out_of_range"),
        ("/view/detector/rows", "out_of_range"),
        ("/view/source/1", "not_finite"),
    ]


def test_a_source_in_the_plane_of_the_detector_is_refused() -> None:
    found = problems_of(source=[300, 500, 20], detector=DETECTOR)
    assert found == [("/view/source", "source_in_plane")]


def test_a_parallel_beam_needs_a_direction_across_the_detector() -> None:
    at = "/view/direction"
    assert problems_of(source=None, detector=DETECTOR) == [(at, "missing")]
    found = problems_of(source=None, detector=DETECTOR, direction=[1, 0, 1])
    assert found == [(at, "grazing_beam")]
    found = problems_of(source=None, detector=DETECTOR, direction=[0, 0, 0])
    assert found == [(at, "zero_vector")]
    found = problems_of(source=SOURCE, detector=DETECTOR, direction=[0, 1, 0])
    assert found == [(at, "contradiction")]


def test_a_detector_of_its_own_and_a_request_say_the_same() -> None:
    with pytest.raises(InvalidInputError) as alone:
        Detector(**{**DETECTOR, "pitch_mm": 0})
    with pytest.raises(InvalidInputError) as asked:
        validate_model(View, {"source": SOURCE, "detector": {**DETECTOR, "pitch_mm": 0}})
    (ours,), (theirs,) = alone.value.problems, asked.value.problems
    assert ours.path == "/view" + theirs.path == "/view/detector/pitch_mm"
    assert (ours.kind, ours.message) == (theirs.kind, theirs.message)


def test_vectors_need_not_be_unit_and_arrays_will_do() -> None:
    detector = Detector(
        **{**DETECTOR, "center": np.array([0, 500.0, 0]), "right": np.array([1e-3, 0, 0])}
    )
    view = View(source=np.array([0.0, -1000, 0]), detector=detector)
    assert view.detector.axes[0].tolist() == [1, 0, 0]
    assert view.source == (0, -1000, 0)
    assert view.detector.pitch_xy_mm == (0.5, 0.5)


def test_a_view_cannot_be_changed() -> None:
    view = View(source=SOURCE, detector=DETECTOR)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="frozen"):
        view.source = None
