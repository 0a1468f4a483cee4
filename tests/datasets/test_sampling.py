"""Image i is a function of design, seed and i; people keep to their split."""

from __future__ import annotations

import json
from collections import Counter, defaultdict

import pytest

from phantom import library
from phantom.datasets.places import images_of_splits, people_of_splits, place, units
from phantom.datasets.presence import present
from phantom.datasets.sampling import TRIES, case, exposure, findings, healthy

RADIUS = {"type": "uniform", "low": 1.0, "high": 6.0}


def _prepared(design):
    name = design.phantom.name
    return lambda s: library.prepare(name, s.parameters, s.abnormalities)


def test_images_count_views_then_cases_then_people(design):
    wanted = design(people=4, cases_per_person=3, views=[{"preset": "ap"}, {"preset": "pa"}])
    found = [place(wanted, n) for n in range(wanted.images)]
    assert [(p.person, p.case, p.view) for p in found] == [
        (person, case, view) for person in range(4) for case in range(3) for view in range(2)
    ]
    assert [p.key for p in found[:2]] == ["00000000", "00000001"]
    with pytest.raises(IndexError):
        place(wanted, wanted.images)


@pytest.mark.parametrize(
    ("people", "splits", "expected"),
    [
        (10, {"train": 0.8, "validation": 0.1, "test": 0.1}, [8, 1, 1]),
        (7, {"a": 0.5, "b": 0.5}, [4, 3]),
        (100, {"a": 1 / 3, "b": 1 / 3, "c": 1 / 3}, [34, 33, 33]),
        (5, {"a": 3, "b": 2}, [3, 2]),
    ],
)
def test_every_person_is_in_one_split(design, people, splits, expected):
    wanted = design(people=people, splits=splits, cases_per_person=2)
    assert list(people_of_splits(wanted).values()) == expected
    of_person = defaultdict(set)
    for n in range(wanted.images):
        at = place(wanted, n)
        of_person[at.person].add(at.split)
    assert sorted(of_person) == list(range(people))
    assert all(len(found) == 1 for found in of_person.values())


def test_units_are_all_images_once_and_cross_no_split(design):
    for shards in (False, True):
        wanted = design(people=1500, views=[{}, {}], outputs={"shards": shards})
        found = units(wanted)
        assert [n for unit in found for n in unit.images] == list(range(wanted.images))
        splits = images_of_splits(wanted)
        assert all(n in splits[u.split] for u in found for n in (u.images[0], u.images[-1]))
        assert max(len(u.images) for u in found) == (1000 if shards else 2)


def test_shards_are_the_form_of_more_than_ten_thousand_images(design):
    assert not design(people=10_000).sharded
    assert design(people=10_001).sharded


def test_prevalence_is_what_is_asked_and_exclusive_means_one(design):
    wrong = [{"type": "nodule", "prevalence": 0.3}, {"type": "void", "prevalence": 0.5}]
    for exclusive in (False, True):
        wanted = design(people=4000, abnormalities=wrong, exclusive=exclusive)
        found = [present(wanted, place(wanted, n)) for n in range(4000)]
        counts = Counter(k for both in found for k in both)
        for k, share in ((0, 0.3), (1, 0.5)):
            assert abs(counts[k] / 4000 - share) < 4 * (share * (1 - share) / 4000) ** 0.5
        both = sum(len(of) == 2 for of in found) / 4000
        assert both == 0 if exclusive else abs(both - 0.15) < 4 * (0.15 * 0.85 / 4000) ** 0.5


def test_one_more_of_anything_draws_all_else_as_before(design):
    drawn = {"type": "uniform", "low": 15.0, "high": 25.0}
    few = design(
        phantom={"name": "lesioned", "parameters": {"half_mm": drawn}},
        abnormalities=[{"type": "nodule", "prevalence": 0.5, "parameters": {"radius_mm": RADIUS}}],
        vary={"kvp": {"type": "uniform", "low": 50, "high": 70}},
    )
    tree = few.tree()
    tree["phantom"]["parameters"]["age_years"] = {"type": "uniform", "low": 20.0, "high": 30.0}
    tree["abnormalities"].append({"type": "void", "prevalence": 0.5})
    tree["abnormalities"][0]["parameters"]["x_mm"] = {"type": "uniform", "low": -5.0, "high": 5.0}
    tree["vary"]["dose_ugy"] = {"type": "uniform", "low": 1, "high": 3}
    tree["people"] = 50
    many = design(**tree)
    for n in range(10):
        at = place(few, n)
        assert (
            healthy(few, at.person).parameters["half_mm"]
            == (healthy(many, at.person).parameters["half_mm"])
        )
        assert exposure(few, at)["kvp"] == exposure(many, at)["kvp"]
        old, new = findings(few, at), findings(many, at)
        assert [f["radius_mm"] for f in old] == [
            f["radius_mm"] for f in new if f["type"] == "nodule"
        ]


def test_a_person_stays_the_same_and_cases_differ(design):
    wanted = design(
        people=3,
        cases_per_person=4,
        abnormalities=[{"type": "nodule", "prevalence": 1.0, "parameters": {"radius_mm": RADIUS}}],
    )
    found = [case(wanted, place(wanted, n), _prepared(wanted)) for n in range(12)]
    people = [json.dumps(f.subject.parameters) for f in found]
    assert [len({*people[k : k + 4]}) for k in (0, 4, 8)] == [1, 1, 1]
    assert len({*people}) == 3
    assert len({f.subject.abnormalities[0]["radius_mm"] for f in found}) == 12


def test_what_does_not_fit_is_drawn_again(design):
    # The block is 15 to 25 mm half wide: a ball of 10 to 28 mm often does not fit.
    large = {"type": "uniform", "low": 10.0, "high": 28.0}
    wanted = design(
        people=40,
        abnormalities=[{"type": "nodule", "prevalence": 1.0, "parameters": {"radius_mm": large}}],
    )
    redrawn = 0
    for n in range(40):
        at = place(wanted, n)
        found = case(wanted, at, _prepared(wanted))
        (fits,) = found.subject.abnormalities
        assert fits["radius_mm"] <= found.subject.parameters["half_mm"]
        tries = [findings(wanted, at, k)[0]["radius_mm"] for k in range(TRIES)]
        assert fits["radius_mm"] in tries
        redrawn += fits["radius_mm"] != tries[0]
    assert 5 <= redrawn <= 30, "at first it is there as often as it is asked for"


def test_people_have_the_sizes_of_the_population(design):
    wanted = design(people=300, population={"female": 1.0, "age_years": [30, 40]})
    people = [healthy(wanted, n).person for n in range(300)]
    assert {p.sex for p in people} == {"female"}
    assert all(30 <= p.age_years <= 40 for p in people)
    usual = library.mean_person("female", 35.0).height_cm
    assert sum(p.height_cm for p in people) / 300 == pytest.approx(usual, abs=4 * 7.1 / 300**0.5)


def test_without_a_population_the_phantom_is_as_it_is_by_default(design):
    assert healthy(design(population=None), 0).person is None
    assert healthy(design(phantom={"name": "sphere"}), 0).parameters == {}
