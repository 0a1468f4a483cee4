"""Kinks of a formula are found to the last bit."""

from __future__ import annotations

import pytest

from phantom.geometry.formulas import Formula
from phantom.geometry.kinks import kinks


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("sin(u) + u**2", []),
        ("abs(u - 0.3)", [0.3]),
        ("max(u, 1/3)", [1 / 3]),
        ("min(u, 1 - u, 0.4)", [0.4, 0.5, 0.6]),
        ("u if u < 0.7 else 1.4 - u", [0.7]),
        ("1 if 0.2 < u < 0.6 else u", [0.2, 0.6]),
        ("abs(u)", []),
        ("abs(1 - u)", []),
        ("abs(3)*u", []),
        ("abs(sin(pi*10*u))", [k / 10 for k in range(1, 10)]),
        ("max(u**2, 0)", []),
        ("abs(sqrt(u - 0.5) - 0.1) if u > 0.5 else 0", [0.5, 0.51]),
    ],
)
def test_kinks_are_where_a_choice_turns(text: str, places: list[float]) -> None:
    found = kinks(Formula.of(text, "u"), "u", 0.0, 1.0)
    assert found.tolist() == pytest.approx(places, abs=1e-14)


def test_kinks_lie_inside_any_range() -> None:
    found = kinks(Formula.of("abs(u - 1e6)", "u"), "u", -1e7, 1e7)
    assert found.tolist() == [1e6]
