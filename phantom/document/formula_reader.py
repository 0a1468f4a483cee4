"""The tokens of a formula as they are read, with the limits on what may come of them."""

from __future__ import annotations

from typing import NamedTuple, NoReturn

from phantom.document.expressions import Comparison, Constant, Expression, Negation
from phantom.document.formula_tokens import FormulaError, Token

MOST_NODES = 500
DEEPEST_FORMULA = 100
LARGEST_EXPONENT = 64


class Part(NamedTuple):
    """A parsed stretch of the text, the column it starts at and how deep its tree is."""

    node: Expression | Comparison
    column: int
    depth: int


class Reader:
    """Reads tokens from the left, once, and keeps what it makes of them within limits."""

    def __init__(self, cut: list[Token], variables: tuple[str, ...]) -> None:
        self.tokens, self.variables = cut, variables
        self.next, self.nodes, self.open = 0, 0, 0

    @property
    def here(self) -> Token:
        """The token not yet read."""
        return self.tokens[self.next]

    def take(self) -> Token:
        """Read one token."""
        token = self.here
        self.next += 1
        return token

    def expect(self, text: str, among: str) -> None:
        """Read a token that must be this one."""
        if self.here.text != text:
            self.refuse(among)
        self.next += 1

    def refuse(self, expected: str) -> NoReturn:
        """Refuse the token not yet read."""
        self.refuse_at(self.here.column, self.here.shown, expected)

    @staticmethod
    def refuse_at(column: int, found: str, expected: str) -> NoReturn:
        """Refuse what was found at a column."""
        raise FormulaError(f"found {found} at column {column}; expected {expected}", column)

    def made(self, node: Expression | Comparison, column: int, *inner: Part) -> Part:
        """Return a new part of the tree, or refuse a tree too large or too deep."""
        self.nodes += 1
        if self.nodes > MOST_NODES:
            self.refuse_at(column, f"more than {MOST_NODES} operations and values", "fewer")
        depth = 1 + max((part.depth for part in inner), default=0)
        self.check_depth(depth, column)
        return Part(node, column, depth)

    def check_depth(self, depth: int, column: int) -> None:
        """Refuse what is nested too deep; each term of a sum is one level above those before."""
        if depth > DEEPEST_FORMULA:
            self.refuse_at(column, f"operations nested deeper than {DEEPEST_FORMULA}", "fewer")

    def number(self, part: Part) -> Expression:
        """Return a part that must be a number, not a comparison."""
        if isinstance(part.node, Comparison):
            expected = "a number; a comparison stands only between if and else"
            self.refuse_at(part.column, "a comparison", expected)
        return part.node

    def check_exponent(self, exponent: Expression, column: int) -> None:
        """Refuse a number that is too large an exponent."""
        while isinstance(exponent, Negation):
            exponent = exponent.operand
        if isinstance(exponent, Constant) and exponent.value > LARGEST_EXPONENT:
            found = f"the exponent {exponent.value:g}"
            self.refuse_at(column, found, f"at most {LARGEST_EXPONENT}")
