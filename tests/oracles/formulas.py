"""Formulas at random as text, and a slow reading of their trees with any mathematics module."""

from __future__ import annotations

import math
import operator
from typing import Any

from hypothesis import strategies as st

from phantom.document.expressions import (
    FUNCTIONS,
    Call,
    Conditional,
    Constant,
    Negation,
    Operation,
    Variable,
)

SIGNS: dict[str, Any] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "**": operator.pow,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}

numbers = st.sampled_from(["0", "1", "2", "0.5", ".25", "3.", "1e1", "7E-2"])
arithmetic = st.sampled_from(["+", "-", "*", "/", "**", "**"])
comparisons = st.sampled_from(["<", "<=", ">", ">=", "==", "!="])


def _longer(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    called = st.sampled_from(sorted(FUNCTIONS)).flatmap(
        lambda name: st.builds(
            lambda arguments: f"{name}({' , '.join(arguments)})",
            st.lists(inner, min_size=FUNCTIONS[name][0], max_size=min(3, FUNCTIONS[name][1])),
        )
    )
    conditional = st.tuples(inner, inner, comparisons, inner, inner).map(
        lambda t: f"{t[0]} if {t[1]} {t[2]} {t[3]} else {t[4]}"
    )
    return (
        inner.map(lambda t: f"({t})")
        | inner.map(lambda t: f"- {t}")
        | st.tuples(inner, arithmetic, inner).map(" ".join)
        | called
        | conditional
    )


texts = st.recursive(numbers | st.sampled_from(["u", "x", "pi"]), _longer, max_leaves=25)
"""Formulas in u and x, most of them, with parentheses only here and there."""


def _tame(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    one = [
        "sin({0})",
        "cos({0})",
        "tan(sin({0}))",
        "exp(sin({0}))",
        "sqrt(2 + cos({0}))",
        "log(3 + sin({0}))",
        "asin(0.9 * sin({0}))",
        "acos(0.9 * cos({0}))",
        "({0})**2",
        "({0})**3",
        "(2 + sin({0}))**-2",
        "(2 + cos({0}))**1.5",
        "-({0})",
    ]
    two = [
        "({0}) + ({1})",
        "({0}) - ({1})",
        "sin({0}) * ({1})",
        "({0}) / (3 + sin({1}))",
        "atan2({0}, 2 + sin({1}))",
        "hypot({0}, {1}, 1)",
        "(2 + sin({0}))**cos({1})",
    ]
    return st.builds(str.format, st.sampled_from(one), inner) | st.builds(
        str.format, st.sampled_from(two), inner, inner
    )


tame_texts = st.recursive(st.sampled_from(["u", "2*u", "u - 0.3", "1.7"]), _tame, max_leaves=6)
"""Smooth formulas in u, defined everywhere and well-conditioned."""


def by_hand(node: Any, functions: Any, **variables: Any) -> Any:
    """The value of a tree, with the numbers and functions of ``math`` or ``mpmath.mp``."""

    def value(inner: Any) -> Any:
        return by_hand(inner, functions, **variables)

    match node:
        case Constant(number):
            return number if functions is math else functions.mpf(number)
        case Variable(name):
            return variables[name]
        case Negation(operand):
            return -value(operand)
        case Operation(sign, left, right):
            return SIGNS[sign](value(left), value(right))
        case Conditional(condition, then, otherwise):
            operands = [value(operand) for operand in condition.operands]
            links = zip(condition.operators, operands, operands[1:], strict=False)
            return value(then if all(SIGNS[sign](a, b) for sign, a, b in links) else otherwise)
        case Call("hypot", arguments):
            return functions.sqrt(sum(value(a) ** 2 for a in arguments))
        case Call("abs" | "min" | "max" as name, arguments):
            return {"abs": abs, "min": min, "max": max}[name](*map(value, arguments))
        case Call(name, arguments):
            return getattr(functions, name)(*map(value, arguments))
    raise AssertionError(node)
