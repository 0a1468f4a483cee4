"""A material is exactly one of three kinds, and its numbers are those of matter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from phantom.errors import Problem

Judge = Callable[[object], list[Problem]]


@pytest.mark.parametrize(
    "material",
    [
        {"attenuation_per_mm": 0},
        {"reference": "cortical_bone_icru44"},
        {"reference": "soft_tissue_icru44", "density_g_cm3": 1.06},
        {"composition": {"C": 0.6, "O": 0.32, "H": 0.08}, "density_g_cm3": 1.19},
        {"composition": {"C": 0.6, "O": 0.32, "H": 0.081}, "density_g_cm3": 1.19},
    ],
)
def test_the_three_kinds_are_read(
    material: Any, sphere: Any, written: Any, problems: Judge
) -> None:
    assert problems(written(sphere(material="m"), materials={"m": material})) == []


KINDS = "expected exactly one of attenuation_per_mm, reference, composition"


@pytest.mark.parametrize(
    ("material", "below", "kind", "said"),
    [
        ({}, "", "material_kind", "found none of them; " + KINDS),
        ({"density_g_cm3": 1}, "", "material_kind", "found none of them"),
        (
            {"reference": "water", "attenuation_per_mm": 1},
            "",
            "material_kind",
            "found attenuation_per_mm and reference; " + KINDS,
        ),
        ("bone", "", "not_an_object", "found 'bone'; expected an object with exactly one of"),
        ({"attenuation_per_mm": -1}, "/attenuation_per_mm", "out_of_range", "at least 0"),
        ({"attenuation_per_mm": None}, "/attenuation_per_mm", "not_a_number", "found null"),
        (
            {"attenuation_per_mm": 1, "density_g_cm3": 1},
            "/density_g_cm3",
            "unknown_field",
            "not known",
        ),
        ({"reference": "cheese"}, "/reference", "unknown_reference", "found 'cheese'; expected"),
        ({"reference": "water", "density_g_cm3": 0}, "/density_g_cm3", "out_of_range", "found 0"),
        ({"composition": {"H": 1}}, "/density_g_cm3", "missing", "missing"),
        (
            {"composition": {"H": 0.5, "O": 0.45}, "density_g_cm3": 1},
            "/composition",
            "fraction_sum",
            "add to 0.95; expected 1",
        ),
        (
            {"composition": {"Xx": 1}, "density_g_cm3": 1},
            "/composition/Xx",
            "unknown_element",
            "found 'Xx'",
        ),
        (
            {"composition": {"H": -0.1, "O": 1.1}, "density_g_cm3": 1},
            "/composition/H",
            "out_of_range",
            "found -0.1",
        ),
    ],
)
def test_a_bad_material_is_refused_at_its_place(
    material: Any, below: str, kind: str, said: str, sphere: Any, written: Any, problems: Judge
) -> None:
    found = problems(written(sphere(material="m"), materials={"m": material}))
    assert (found[0].path, found[0].kind) == ("/materials/m" + below, kind)
    assert said in found[0].message
