"""Flat words of a query or a command line, and the request they mean."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phantom.errors import InvalidInputError
from phantom.requests.forms import scalar
from phantom.requests.words import WORDS, parameters, request_tree


@given(st.integers(-(10**18), 10**18) | st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_survives_being_written(number):
    assert scalar(str(number)) == number


@pytest.mark.parametrize("text", ["NaN", "inf", "-Infinity", "1e999", "9" * 5000, "ap", "", "0x1F"])
def test_what_is_no_finite_number_stays_text(text):
    assert scalar(text) == text


def test_truth_and_json_are_read():
    assert scalar("true") is True
    assert scalar("[1, 2.5]") == [1, 2.5]
    with pytest.raises(InvalidInputError):
        scalar("{")


def test_words_stand_where_the_request_has_them():
    tree, problems = request_tree(
        {"name": "sphere"},
        [("view", "pa"), ("columns", "512"), ("energy_kev", "70.5"), ("bits", "16"),
         ("quantity", "signal"), ("source_detector_mm", "900")],
    )  # fmt: skip
    assert problems == ()
    assert tree == {
        "phantom": {"name": "sphere"},
        "view": {"preset": "pa", "source_detector_mm": 900},
        "detector": {"columns": 512},
        "beam": {"energy_kev": 70.5},
        "presentation": {"bits": 16},
        "quantity": "signal",
    }


@pytest.mark.parametrize(
    ("text", "filters"),
    [
        ("aluminium=2.5", {"aluminium": 2.5}),
        ("aluminium = 3, copper=0.1", {"aluminium": 3, "copper": 0.1}),
        ('{"copper": 0.1}', {"copper": 0.1}),
        ("none", {}),
    ],
)
def test_filters_are_materials_with_a_thickness(text, filters):
    tree, problems = request_tree({}, [("kvp", "70"), ("filtration", text)])
    assert problems == ()
    assert tree["beam"] == {"kvp": 70, "filtration_mm": filters}


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("copper", ("/beam/filtration_mm", "not_a_pair")),
        ("=2", ("/beam/filtration_mm", "not_a_pair")),
        ("copper=1,", ("/beam/filtration_mm", "not_a_pair")),
        ("copper=1,copper=1", ("/beam/filtration_mm/copper", "given_twice")),
    ],
)
def test_filters_that_are_none_are_told(text, problem):
    _, problems = request_tree({}, [("filtration", text)])
    assert [(p.path, p.kind) for p in problems] == [problem]


def test_unknown_and_repeated_words_are_all_told():
    _, problems = request_tree({}, [("colour", "1"), ("bits", "8"), ("bits", "16"), ("~/", "")])
    assert [(p.path, p.kind) for p in problems] == [
        ("/colour", "unknown_field"),
        ("/presentation/bits", "given_twice"),
        ("/~0~1", "unknown_field"),
    ]
    with pytest.raises(InvalidInputError, match="twice"):
        parameters([("a", "1"), ("a", "2")])


def test_every_word_has_its_own_place():
    assert len(set(WORDS.values())) == len(WORDS)


def test_an_acquisition_may_be_said_in_words():
    tree, problems = request_tree(
        {},
        [("dose_ugy", "2.5"), ("scatter", "true"), ("grid", "0.7,0.1"), ("focal_spot_mm", "0.6"),
         ("samples", "[2, 3]"), ("seed", "18446744073709551615"), ("case", "4")],
    )  # fmt: skip
    assert problems == ()
    assert tree["acquisition"] == {
        "detector_air_kerma_ugy": 2.5,
        "scatter": {},
        "grid": {"primary_transmission": 0.7, "scatter_transmission": 0.1},
        "focal_spot": {"size_mm": [0.6, 0.6]},
        "samples_per_pixel": [2, 3],
    }
    assert tree["noise"] == {"seed": 2**64 - 1, "case": 4}


def test_words_add_to_an_acquisition_in_json_in_any_order():
    whole = ("acquisition", '{"mas": 2, "focal_spot": {"points": [3, 3]}}')
    words = [whole, ("scatter", "false"), ("grid", "none"), ("focal_spot_mm", "1")]
    for order in (words, words[::-1]):
        tree, problems = request_tree({}, order)
        assert problems == ()
        assert tree["acquisition"] == {
            "mas": 2,
            "scatter": None,
            "grid": None,
            "focal_spot": {"points": [3, 3], "size_mm": [1, 1]},
        }


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ([("grid", "0.7")], ("/acquisition/grid", "not_a_pair")),
        ([("mas", "2"), ("acquisition", '{"mas": 3}')], ("/acquisition/mas", "given_twice")),
        ([("acquisition", '{"mas": 3}'), ("mas", "2")], ("/acquisition/mas", "given_twice")),
        ([("view", "pa"), ("view", '{"preset": "ap"}')], ("/view/preset", "given_twice")),
    ],
)
def test_words_of_an_acquisition_that_are_none_are_told(words, problem):
    _, problems = request_tree({}, words)
    assert [(p.path, p.kind) for p in problems] == [problem]
