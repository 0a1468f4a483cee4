"""What cannot be made is refused before the first image, with every reason at its place."""

from __future__ import annotations

import pickle

import pytest

from phantom import library
from phantom.datasets import forecast, make, quick, read_design
from phantom.datasets.checks import check, check_room, expected_bytes
from phantom.datasets.sampling import healthy
from phantom.datasets.storage import LocalFolder
from phantom.errors import InvalidInputError, Problem, UnknownPhantomError

UNIFORM = {"type": "uniform", "low": 1.0, "high": 2.0}


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"abnormalities": [{"type": "nodule", "prevalence": 1.2}]}, "/abnormalities/0/prevalence"),
        (
            {"abnormalities": [{"type": "nodule", "prevalence": -0.1}]},
            "/abnormalities/0/prevalence",
        ),
        ({"abnormalities": [{"type": "crack", "prevalence": 0.5}]}, "/abnormalities/0/type"),
        (
            {
                "exclusive": True,
                "abnormalities": [
                    {"type": "nodule", "prevalence": 0.7},
                    {"type": "void", "prevalence": 0.7},
                ],
            },
            "/abnormalities",
        ),
        (
            {
                "abnormalities": [
                    {
                        "type": "nodule",
                        "prevalence": 0.5,
                        "parameters": {"radius_mm": {**UNIFORM, "high": 500.0}},
                    }
                ]
            },
            "/abnormalities/0/parameters/radius_mm",
        ),
        (
            {"phantom": {"name": "lesioned", "parameters": {"half_mm": {**UNIFORM, "low": -3.0}}}},
            "/phantom/parameters/half_mm",
        ),
        (
            {"phantom": {"name": "lesioned", "parameters": {"colour": 3}}},
            "/phantom/parameters/colour",
        ),
        (
            {"exact_prevalence": True, "abnormalities": [{"type": "nodule", "prevalence": 0.33}]},
            "/abnormalities/0/prevalence",
        ),
        ({"exact_prevalence": True}, "/exact_prevalence"),
        ({"splits": {"train": 0.8, "test": 0.1}}, "/splits"),
        ({"splits": {"train": 8, "test": 1}}, "/splits"),
        ({"splits": {"Train": 1.0}}, "/splits/Train"),
        ({"splits": {"truth": 1.0}}, "/splits/truth"),
        ({"splits": {"train": 0.99, "test": 0.01}}, "/people"),
        ({"people": 0}, "/people"),
        ({"people": 100_000_000, "cases_per_person": 3}, "/people"),
        ({"vary": {"kvp": {**UNIFORM}}}, "/vary/kvp"),
        ({"vary": {"colour": 3}}, "/vary/colour"),
        (
            {"phantom": {"name": "lesioned", "parameters": {"half_mm": {"type": "gauss"}}}},
            "/phantom/parameters/half_mm",
        ),
        ({"twins": True}, "/twins"),
        ({"outputs": {"visibility": True}}, "/outputs/visibility"),
        (
            {
                "abnormalities": [{"type": "nodule", "prevalence": 0.5}],
                "outputs": {"visibility": True},
                "presentation": {
                    "mode": "stretch",
                    "gsdf": {"l_min_cd_m2": 1.0, "l_max_cd_m2": 300.0},
                },
            },
            "/presentation",
        ),
        ({"phantom": {"name": "sphere"}, "population": {"female": 0.5}}, "/population"),
        ({"views": []}, "/views"),
        ({"outputs": {"form": "tiff"}}, "/outputs/form"),
        ({"surprise": 1}, "/surprise"),
    ],
)
def test_impossible_designs_are_refused(design, given, expected):
    with pytest.raises(InvalidInputError) as refusal:
        check(design(**given))
    assert expected in [p.path for p in refusal.value.problems], refusal.value.problems


def test_a_refusal_travels_to_another_process_with_its_problems():
    told = InvalidInputError([Problem("/people", "too_few", "found 0; expected more")])
    again = pickle.loads(pickle.dumps(told))
    assert again.problems == told.problems
    assert str(again) == "/people: found 0; expected more"


def test_an_unknown_phantom_is_refused(design):
    with pytest.raises(InvalidInputError, match="expected one of the library's phantoms"):
        check(design(phantom={"name": "unicorn"}))
    with pytest.raises(UnknownPhantomError):
        quick("unicorn", 3)


@pytest.mark.parametrize(
    ("values", "cases", "refused"), [([10.0, 11.0, 12.0], 3, False), ([10.0, 11.0], 3, True)]
)
def test_no_more_cases_than_combinations(design, values, cases, refused):
    choice = {"type": "choice", "values": values}
    wanted = design(
        phantom={"name": "sphere", "parameters": {"radius_mm": choice}},
        acquisition={"quantum_noise": "off"},
        people=cases,
        splits={"train": 1.0},
    )
    if not refused:
        check(wanted)
        return
    with pytest.raises(InvalidInputError, match="3 cases, but no more than 2 that differ"):
        check(wanted)


def test_noise_makes_any_number_of_cases_differ(design):
    check(design(phantom={"name": "sphere"}, people=50))


def test_every_problem_is_told_at_once(design):
    wrong = [{"type": "crack", "prevalence": 0.5}]
    with pytest.raises(InvalidInputError) as refusal:
        check(design(splits={"train": 0.5}, abnormalities=wrong))
    assert {p.path for p in refusal.value.problems} == {"/splits", "/abnormalities/0/type"}


def test_a_disk_too_small_is_refused_before_the_first_image(design, tmp_path, monkeypatch):
    wanted = design(people=1000, detector={"columns": 256, "pitch_mm": 0.3})
    needed = expected_bytes(wanted, check(wanted))
    for free, refused in ((needed - 1, True), (needed + 1, False)):
        monkeypatch.setattr(LocalFolder, "free_bytes", lambda _, free=free: free)
        if refused:
            with pytest.raises(InvalidInputError, match="MB free"):
                make(wanted, tmp_path / "set")
            assert not (tmp_path / "set").exists()
        else:
            check_room(wanted, check(wanted), LocalFolder(tmp_path))


def test_what_is_there_already_is_not_written_over(design, tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(InvalidInputError, match=r"letter\.txt"):
        make(design(), tmp_path)
    with pytest.raises(InvalidInputError, match="found a file"):
        make(design(), tmp_path / "letter.txt")


def test_a_dry_run_tells_what_would_be_made(design):
    wrong = [{"type": "nodule", "prevalence": 0.5}]
    wanted = design(people=40, views=[{"preset": "ap"}, {"preset": "pa"}], abnormalities=wrong)
    found = forecast(wanted, workers=2, clock=iter(range(100)).__next__)
    assert (found.images, found.people) == (80, 40)
    assert found.splits == {"train": (32, 64), "validation": (4, 8), "test": (4, 8)}
    assert 8 <= found.abnormal["nodule"] <= 32
    # By this clock an image takes one second.
    assert found.seconds == pytest.approx(40)
    assert found.bytes == pytest.approx(80 * found.image_bytes, rel=0.01)


def test_a_quick_design_draws_what_has_no_people_about_its_defaults():
    chosen = quick("knee-1993", 20, parameters={"side": "left"}, seed=4)
    drawn = chosen.phantom.parameters
    assert drawn["side"] == "left"
    assert drawn["bicondylar_width_mm"].mean == 88.6
    assert drawn["bicondylar_width_mm"].high == 110.0
    check(chosen)


@pytest.mark.parametrize("name", sorted(library.names()))
def test_a_quick_design_of_every_phantom_can_be_made(name):
    """Whoever is drawn: a breast is a woman's, and measures go with each other."""
    chosen = quick(name, 40, side=64)
    check(chosen)
    of = [healthy(chosen, person) for person in range(40)]
    if name == "breast":
        assert {subject.person.sex for subject in of} == {"female"}


def test_men_are_refused_where_the_phantom_is_a_womans():
    breast = {"phantom": {"name": "breast"}, "people": 10, "detector": {"columns": 64}}
    check(read_design({**breast, "population": {"age_years": [50, 70]}}))
    with pytest.raises(InvalidInputError) as refusal:
        check(read_design({**breast, "population": {"female": 0.5}}))
    assert [p.path for p in refusal.value.problems] == ["/population/female"]


def test_a_quick_design_has_people_and_half_of_them_ill_where_the_phantom_can():
    chosen = quick("lesioned", 20)
    assert chosen.phantom.parameters == {}
    assert sum(asked.prevalence for asked in chosen.abnormalities) == pytest.approx(0.5)
    check(chosen)
