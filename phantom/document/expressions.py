"""What a formula says, as an immutable tree; parsed from text, evaluated elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Constant:
    """A number."""

    value: float


@dataclass(frozen=True, slots=True)
class Variable:
    """A named variable."""

    name: str


@dataclass(frozen=True, slots=True)
class Negation:
    """``-operand``."""

    operand: Expression


@dataclass(frozen=True, slots=True)
class Operation:
    """``left operator right``, the operator one of ``+ - * / **``."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Call:
    """A function of its arguments, as many as ``FUNCTIONS`` allows."""

    function: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Comparison:
    """Operands with ``< <= > >= == !=`` between them; true where every neighbouring pair is."""

    operators: tuple[str, ...]
    operands: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Conditional:
    """``then if condition else otherwise``."""

    condition: Comparison
    then: Expression
    otherwise: Expression


Expression = Constant | Variable | Negation | Operation | Call | Conditional

FUNCTIONS: dict[str, tuple[int, int]] = {
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "sqrt", "exp", "log", "abs"), (1, 1)),
    "atan2": (2, 2),
    "min": (2, 100),
    "max": (2, 100),
    "hypot": (2, 100),
}
"""The fewest and the most arguments of every function that a formula may call."""


def parts(expression: Expression) -> tuple[Expression, ...]:
    """Return the expressions that an expression is made of, its condition's operands included."""
    match expression:
        case Negation(operand):
            return (operand,)
        case Operation(_, left, right):
            return (left, right)
        case Call(_, arguments):
            return arguments
        case Conditional(condition, then, otherwise):
            return (*condition.operands, then, otherwise)
        case _:
            return ()


def walk(expression: Expression) -> Iterator[Expression]:
    """Yield an expression and all below it."""
    stack = [expression]
    while stack:
        node = stack.pop()
        yield node
        stack.extend(reversed(parts(node)))
