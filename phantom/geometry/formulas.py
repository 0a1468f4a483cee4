"""Formulas of a document on numpy arrays, with exact derivatives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import factorial

import numpy as np
from numpy.typing import NDArray

from phantom.document.expressions import (
    Call,
    Comparison,
    Conditional,
    Constant,
    Expression,
    Negation,
    Operation,
    Variable,
    parts,
    walk,
)
from phantom.document.formula_text import parse_formula
from phantom.geometry import jets

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_COMPARE = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "==": np.equal,
    "!=": np.not_equal,
}
_CHOOSING = ("abs", "min", "max")


class Formula:
    """An expression ready to be evaluated.

    Nothing is raised and no warning given where a formula is undefined: the values there are NaN
    or infinite. A branch not taken does not matter, wherever it is undefined.
    """

    def __init__(self, expression: Expression) -> None:
        self.expression = expression
        nodes = list(walk(expression))
        self.variables = frozenset(node.name for node in nodes if isinstance(node, Variable))
        self.is_smooth = not any(
            isinstance(node, Conditional) or (isinstance(node, Call) and node.function in _CHOOSING)
            for node in nodes
        )

    @classmethod
    def of(cls, text: str, *variables: str) -> Formula:
        """Parse the text of a formula in the named variables."""
        return cls(parse_formula(text, variables))

    def values(self, **arrays: Floats) -> Floats:
        """Return the values, in the shape the arrays broadcast to."""
        return np.asarray(self._evaluated(0, None, arrays).of(self.expression)[0])

    def derivatives(self, order: int, variable: str, **arrays: Floats) -> Floats:
        """Return ``(order + 1, ...)``: the values and the derivatives by one variable.

        At a kink of ``abs``, ``min`` or ``max`` they are the derivatives to its right; in a
        conditional, those of the branch that is taken.
        """
        result = self._evaluated(order, variable, arrays).of(self.expression).copy()
        for k in range(2, order + 1):
            result[k] *= factorial(k)
        return result

    def branches(self, **arrays: Floats) -> Bools:
        """Return ``(choices, ...)``: how each abs, min, max and conditional is decided.

        Where a row changes along a variable the formula may have a kink or a jump.
        """
        evaluation = self._evaluated(0, None, arrays)
        shape = evaluation.of(self.expression).shape[1:]
        return np.array(evaluation.decided, dtype=bool).reshape(-1, *shape)

    def _evaluated(
        self, order: int, variable: str | None, arrays: dict[str, Floats]
    ) -> _Evaluation:
        shape = np.broadcast_shapes(*(np.shape(array) for array in arrays.values()))
        known = {}
        for name, array in arrays.items():
            known[name] = np.zeros((order + 1, *shape))
            known[name][0] = array
            if name == variable and order > 0:
                known[name][1] = 1.0
        return _Evaluation(np.zeros((order + 1, *shape)), variable, known)


def first_bad(values: Floats, u: Floats) -> float | None:
    """Return the first u at which any of the values ``(..., n)`` is not finite, None if all are."""
    bad = ~np.isfinite(values).reshape(-1, len(u)).all(axis=0)
    return float(u[np.argmax(bad)]) if bad.any() else None


@dataclass
class _Evaluation:
    """One walk over an expression; ``decided`` gathers what the choices came to."""

    zero: Floats
    variable: str | None
    known: dict[str, Floats]
    decided: list[Bools] = field(default_factory=list)

    def of(self, node: Expression) -> Floats:
        """Return the jet of an expression."""
        with np.errstate(all="ignore"):
            return self._jet(node)[0]

    def _jet(self, node: Expression) -> tuple[Floats, bool]:
        """Return the jet of a node and whether the variable is in it."""
        inner = [self._jet(part) for part in parts(node)]
        varies = any(v for _, v in inner)
        jet = self._made(node, [j for j, _ in inner], [v for _, v in inner])
        if isinstance(node, Variable):
            varies = node.name == self.variable
        if not varies:
            # The rate of a constant is 0, also at the edge of a domain, as in sqrt(0).
            jet = jets.constant_like(self.zero, jet[0])
        return jet, varies

    def _made(self, node: Expression, inner: list[Floats], varies: list[bool]) -> Floats:
        match node:
            case Constant(value):
                return jets.constant_like(self.zero, value)
            case Variable(name):
                return self.known[name]
            case Negation():
                return -inner[0]
            case Operation("**"):
                if varies[1]:
                    return jets.general_power(inner[0], inner[1])
                return jets.power(inner[0], inner[1][0])
            case Operation(operator):
                return _ARITHMETIC[operator](inner[0], inner[1])
            case Conditional(condition):
                return self._chosen(condition, inner[:-2], inner[-2], inner[-1])
            case Call("abs"):
                positive = jets.leading(inner[0]) >= 0
                self.decided.append(positive)
                return np.where(positive, inner[0], -inner[0])
            case Call("min" | "max" as function):
                sign = 1.0 if function == "max" else -1.0
                best = inner[0]
                for other in inner[1:]:
                    stays = (sign * jets.leading(best - other) >= 0) | np.isnan(best[0])
                    self.decided.append(stays)
                    best = np.where(stays, best, other)
                return best
            case Call(function):
                return _CALLS[function](*inner)

    def _chosen(
        self, condition: Comparison, operands: list[Floats], then: Floats, otherwise: Floats
    ) -> Floats:
        """Return the branch taken; where an operand is undefined, so is the result."""
        values = [operand[0] for operand in operands]
        pairs = zip(condition.operators, values, values[1:], strict=False)
        holds = np.logical_and.reduce([_COMPARE[sign](a, b) for sign, a, b in pairs])
        self.decided.append(holds)
        undefined = np.logical_or.reduce([np.isnan(value) for value in values])
        return np.where(undefined, np.nan, np.where(holds, then, otherwise))


_ARITHMETIC: dict[str, Callable[[Floats, Floats], Floats]] = {
    "+": np.add,
    "-": np.subtract,
    "*": jets.product,
    "/": jets.quotient,
}
_CALLS: dict[str, Callable[..., Floats]] = {
    "sin": lambda a: jets.sin_cos(a)[0],
    "cos": lambda a: jets.sin_cos(a)[1],
    "tan": jets.tan,
    "asin": jets.asin,
    "acos": jets.acos,
    "atan2": jets.atan2,
    "sqrt": jets.sqrt,
    "exp": jets.exp,
    "log": jets.log,
    "hypot": jets.hypot,
}
