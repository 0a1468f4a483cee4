"""Formulas have the values that Python's floats give them and derivatives exact to rounding."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from phantom.document.formula_text import parse_formula
from phantom.document.formula_tokens import FormulaError
from phantom.geometry.formulas import Formula, first_bad
from tests.oracles.formulas import by_hand, tame_texts, texts

PLACES = st.floats(-3, 3).map(lambda u: round(u, 3))
OUTSIDE = (ValueError, ZeroDivisionError, OverflowError, TypeError)


def in_python(node: Any, **variables: float) -> float | None:
    """The value by Python's own floats; None where Python raises or leaves the real numbers."""
    try:
        value = by_hand(node, math, **variables)
    except OUTSIDE:
        return None
    return float(value) if isinstance(value, float) and math.isfinite(value) else None


@given(texts, PLACES, PLACES)
@settings(max_examples=300, deadline=None)
def test_values_are_those_of_pythons_floats(text: str, u: float, x: float) -> None:
    try:
        node = parse_formula(text, ("u", "x"))
    except FormulaError:  # an open conditional within a condition, as in Python
        assume(False)
    expected = in_python(node, u=u, x=x)
    assume(expected is not None)
    with mpmath.workdps(40):
        try:
            exact = by_hand(node, mpmath.mp, u=mpmath.mpf(u), x=mpmath.mpf(x))
            well_conditioned = abs(exact - expected) <= 1e-11 * max(1, abs(expected))
        except OUTSIDE:
            well_conditioned = False
    assume(well_conditioned)
    [value] = Formula(node).values(u=np.array([u]), x=np.array([x]))
    assert value == pytest.approx(expected, rel=1e-9, abs=1e-9)


def exact_derivatives(text: str, u: float, order: int = 3) -> list[float]:
    node = parse_formula(text, ("u",))
    with mpmath.workdps(40):
        series = mpmath.taylor(lambda t: by_hand(node, mpmath.mp, u=t), mpmath.mpf(u), order)
        return [float(mpmath.re(c) * math.factorial(k)) for k, c in enumerate(series)]


SMOOTH = [
    ("3", 0.2),
    ("u", -1.5),
    ("2*u - u/3 + 1", 0.7),
    ("(u - 1)*(u + 2)*u", 0.3),
    ("(u*u + 1)/(u - 3)", 0.4),
    ("sin(3*u)", 1.1),
    ("cos(u**2)", -0.8),
    ("tan(u/2)", 2.5),
    ("asin(u)", -0.999),
    ("asin(u/3)", 1.2),
    ("acos(u)", 0.6),
    ("acos(u**2)", 0.99),
    ("atan2(u, 2)", 0.5),
    ("atan2(sin(u), cos(u))", 3.0),
    ("atan2(sin(u), cos(u))", -2.0),
    ("atan2(1, u)", -0.4),
    ("atan2(-1, u**3)", 0.9),
    ("sqrt(1 - u)", 0.999),
    ("sqrt(u)", 2.0),
    ("exp(-u**2/2)", 1.3),
    ("log(1 + u)", -0.9),
    ("log(u**2)", -2.0),
    ("abs(u)", -2.0),
    ("abs(sin(u))*u", 4.0),
    ("min(u, u**2, 3)", 0.4),
    ("max(u, u**2, 3)", 2.0),
    ("hypot(u, 1)", 0.0),
    ("hypot(u, 2*u, cos(u))", 0.5),
    ("u**3", 0.0),
    ("u**3", -1.3),
    ("u**0", 0.0),
    ("u**1", 0.0),
    ("u**(6/2)", -2.0),
    ("u**-2", -0.7),
    ("u**64", -1.01),
    ("u**2.5", 1.7),
    ("(u*u - 1)**3", 1.0),
    ("2**u", -0.5),
    ("u**u", 1.4),
    ("(1 + u)**sin(u)", 0.6),
    ("u**2 if u < 0.5 else 1 - u", 0.4),
    ("u**2 if u < 0.5 else 1 - u", 0.6),
    ("log(u) if u > 0 else u**3", -1.0),
    ("log(u) if 0 < u < 2 else u**3", 1.0),
    ("14 - 9*exp(-(6*(u - 0.5))**2)", 0.31),
    ("(5 + 2*cos(5*u))*cos(u)", 2.2),
]


@pytest.mark.parametrize(("text", "u"), SMOOTH, ids=[f"{t} at {u}" for t, u in SMOOTH])
def test_derivatives_are_those_found_with_forty_digits(text: str, u: float) -> None:
    found = Formula.of(text, "u").derivatives(3, "u", u=np.array([u]))[:, 0]
    assert found == pytest.approx(exact_derivatives(text, u), rel=2e-12, abs=1e-12)


@given(tame_texts, PLACES)
@settings(max_examples=60, deadline=None)
def test_derivatives_of_any_smooth_formula(text: str, u: float) -> None:
    found = Formula.of(text, "u").derivatives(3, "u", u=np.array([u]))[:, 0]
    assert found == pytest.approx(exact_derivatives(text, u), rel=1e-8, abs=1e-8)


def test_derivatives_by_one_variable_hold_the_others_fixed() -> None:
    x, u = np.meshgrid(np.linspace(0.5, 2, 7), np.linspace(0, 1, 5))
    formula = Formula.of("x**3*sin(u) + x**u", "x", "u")
    by_x = formula.derivatives(2, "x", x=x, u=u)
    assert by_x.shape == (3, 5, 7)
    assert np.allclose(by_x[1], 3 * x**2 * np.sin(u) + u * x ** (u - 1), rtol=1e-14)
    assert np.allclose(by_x[2], 6 * x * np.sin(u) + u * (u - 1) * x ** (u - 2), rtol=1e-14)
    by_u = formula.derivatives(1, "u", x=x, u=u)
    assert np.allclose(by_u[1], x**3 * np.cos(u) + x**u * np.log(x), rtol=1e-14)


def test_orders_agree_with_one_another_and_with_the_values() -> None:
    u = np.linspace(-1, 1, 11)
    formula = Formula.of("exp(sin(3*u)) / (2 + u**3) + abs(u)", "u")
    seven = formula.derivatives(7, "u", u=u)
    for order in range(7):
        assert np.array_equal(formula.derivatives(order, "u", u=u), seven[: order + 1])
    assert np.array_equal(formula.values(u=u), seven[0])


def test_a_constant_takes_the_shape_of_the_arrays() -> None:
    formula = Formula.of("sqrt(0) + 2*pi", "u")
    found = formula.derivatives(2, "u", u=np.zeros((2, 3)))
    assert np.array_equal(found[0], np.full((2, 3), 2 * np.pi))
    assert not found[1:].any()


def test_at_a_kink_the_derivative_is_the_one_to_the_right() -> None:
    at = np.zeros(1)
    for text, slope in (("abs(u)", 1), ("abs(-3*u)", 3), ("min(u, -u)", -1), ("max(u, 0)", 1)):
        assert Formula.of(text, "u").derivatives(1, "u", u=at)[1, 0] == slope
    # Where two sides agree in value and slope the second derivative decides.
    assert Formula.of("max(u**2, 0)", "u").derivatives(2, "u", u=at)[2, 0] == 2


def test_an_edge_of_a_domain_spoils_only_the_derivatives_that_do_not_exist() -> None:
    found = Formula.of("u**2.5", "u").derivatives(3, "u", u=np.zeros(1))[:, 0]
    assert found.tolist() == [0, 0, 0, math.inf]
    found = Formula.of("1 + sqrt(u)", "u").derivatives(1, "u", u=np.zeros(1))[:, 0]
    assert found.tolist() == [1, math.inf]


@pytest.mark.parametrize(
    ("text", "bad"),
    [
        ("1/u", 0.0),
        ("log(u)", -1.0),
        ("sqrt(u)", -1.0),
        ("asin(u)", None),
        ("acos(2*u)", -1.0),
        ("u**0.5", -1.0),
        ("u**u", -0.5),
        ("exp(1000*u)", 1.0),
        ("max(1, sqrt(u))", -1.0),
        ("min(sqrt(u), 1)", -1.0),
        ("1 if sqrt(u) < 1 else 2", -1.0),
        ("1 if 0 < sqrt(u) < 1 else 2", -1.0),
        ("sqrt(u) if u >= 0 else 0", None),
        ("1/u if u != 0 else 1", None),
        ("1e18*1e18", None),
        ("(1e18**20)*u", -1.0),
    ],
)
def test_the_first_place_where_a_formula_is_undefined(text: str, bad: float | None) -> None:
    u = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    formula = Formula.of(text, "u")
    assert first_bad(formula.values(u=u), u) == bad
    assert formula.derivatives(3, "u", u=u).shape == (4, 5)


def test_branches_change_where_a_formula_may_have_a_kink() -> None:
    u = np.array([-1.0, -0.25, 0.25, 1.0])
    formula = Formula.of("abs(u) + max(u, 0.5) + (1 if -0.5 < u < 0.5 else 0)", "u")
    assert not formula.is_smooth
    assert formula.branches(u=u).astype(int).tolist() == [
        [0, 0, 1, 1],
        [0, 0, 0, 1],
        [0, 1, 1, 0],
    ]
    assert Formula.of("sin(u)", "u").is_smooth
    assert Formula.of("sin(u)", "u").branches(u=u).shape == (0, 4)


def test_places_do_not_know_of_one_another() -> None:
    u = np.linspace(0, 1, 1000)
    formula = Formula.of("exp(-u)*cos(40*u)", "u")
    every = formula.derivatives(3, "u", u=u)
    for k in (0, 500):
        alone = formula.derivatives(3, "u", u=u[k : k + 1])
        assert np.allclose(every[:, k], alone[:, 0], rtol=1e-13)
