"""A formula's text to an expression: precedence climbing over an allow-list of words.

Python's precedence, but a smaller language: comparisons stand only between ``if`` and ``else``.
The text is never handed to an evaluator of Python code.
"""

from __future__ import annotations

import math

from phantom.document.expressions import (
    FUNCTIONS,
    Call,
    Comparison,
    Conditional,
    Constant,
    Expression,
    Negation,
    Operation,
    Variable,
)
from phantom.document.formula_reader import Part, Reader
from phantom.document.formula_tokens import FormulaError, Token, tokens
from phantom.document.words import counted

LONGEST_FORMULA = 2_000

_CONDITIONAL, _COMPARISON, _SUM, _PRODUCT, _UNARY, _POWER = range(6)
_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")
_LEVELS = {
    "if": _CONDITIONAL,
    **dict.fromkeys(_COMPARISONS, _COMPARISON),
    **dict.fromkeys("+-", _SUM),
    **dict.fromkeys("*/", _PRODUCT),
    "**": _POWER,
}


def parse_formula(text: str, variables: tuple[str, ...]) -> Expression:
    """Return what a formula in the given variables says.

    Raises
    ------
    FormulaError
        Where the text is no formula, or one too long, too deep or with too large an exponent;
        the message gives the column, what was found and what was expected.
    """
    if len(text) > LONGEST_FORMULA:
        message = f"found {len(text)} characters; expected at most {LONGEST_FORMULA}"
        raise FormulaError(message, LONGEST_FORMULA + 1)
    return _Parser(tokens(text), variables).whole()


class _Parser(Reader):
    """Reads numbers joined by operators, as tightly bound as Python binds them."""

    def whole(self) -> Expression:
        """Read all tokens as one number."""
        result = self.number(self.part(_CONDITIONAL))
        if self.here.kind != "end":
            self.refuse("an operator or the end")
        return result

    def part(self, lowest: int) -> Part:
        """Read the longest part made by operators that bind at least as tightly as ``lowest``."""
        self.open += 1
        self.check_depth(self.open, self.here.column)
        left = self.value()
        while _LEVELS.get(self.here.text, -1) >= lowest:
            left = self.extended(left, self.take())
        self.open -= 1
        return left

    def extended(self, left: Part, operator: Token) -> Part:
        """Read what an operator joins to the part on its left."""
        level = _LEVELS[operator.text]
        first = self.number(left)
        if level == _CONDITIONAL:
            return self.conditional(left, first)
        if level == _COMPARISON:
            return self.comparison(left, operator)
        # A power takes a sign on its right and is read from the right: 2**-a**b.
        right = self.part(_UNARY if level == _POWER else level + 1)
        second = self.number(right)
        if level == _POWER:
            self.check_exponent(second, right.column)
        return self.made(Operation(operator.text, first, second), left.column, left, right)

    def conditional(self, left: Part, then: Expression) -> Part:
        """Read ``condition else otherwise`` after ``then if``."""
        condition = self.part(_COMPARISON)
        if not isinstance(condition.node, Comparison):
            self.refuse_at(condition.column, "a number", "a comparison, such as u < 0.5")
        self.expect("else", "else")
        otherwise = self.part(_CONDITIONAL)
        node = Conditional(condition.node, then, self.number(otherwise))
        return self.made(node, left.column, left, condition, otherwise)

    def comparison(self, left: Part, operator: Token) -> Part:
        """Read a comparison from its first operator on; a chain holds where each link does."""
        operators, operands = [operator.text], [left, self.part(_SUM)]
        while self.here.text in _COMPARISONS:
            operators.append(self.take().text)
            operands.append(self.part(_SUM))
        values = tuple(self.number(operand) for operand in operands)
        return self.made(Comparison(tuple(operators), values), left.column, *operands)

    def value(self) -> Part:
        """Read a number, a name, a call, a part in parentheses or one with a minus before it."""
        token = self.here
        if token.kind == "number":
            self.next += 1
            return self.made(Constant(float(token.text)), token.column)
        if token.kind == "name":
            return self.named(token)
        if token.text == "-":
            self.next += 1
            operand = self.part(_UNARY)
            return self.made(Negation(self.number(operand)), token.column, operand)
        if token.text == "(":
            self.next += 1
            inner = self.part(_CONDITIONAL)
            self.expect(")", "an operator or )")
            return inner._replace(column=token.column)
        return self.refuse("a number, a name, - or (")

    def named(self, token: Token) -> Part:
        """Read a variable, ``pi`` or the call of a function."""
        if token.text in self.variables or token.text == "pi":
            self.next += 1
            node = Constant(math.pi) if token.text == "pi" else Variable(token.text)
            return self.made(node, token.column)
        if token.text not in FUNCTIONS:
            names = ", ".join((*self.variables, "pi"))
            self.refuse(f"{names} or a function: {' '.join(FUNCTIONS)}")
        self.next += 1
        self.expect("(", f"( after {token.text}")
        arguments = [self.part(_CONDITIONAL)]
        while self.here.text == ",":
            self.next += 1
            arguments.append(self.part(_CONDITIONAL))
        self.expect(")", "an operator, a comma or )")
        fewest, most = FUNCTIONS[token.text]
        if not fewest <= len(arguments) <= most:
            found = f"{counted(len(arguments), 'argument')} of {token.text}"
            expected = str(fewest) if fewest == most else f"{fewest} to {most}"
            self.refuse_at(token.column, found, expected)
        values = tuple(self.number(argument) for argument in arguments)
        return self.made(Call(token.text, values), token.column, *arguments)
