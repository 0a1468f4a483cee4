"""A formula's text cut into tokens: numbers, names and signs, each with its column."""

from __future__ import annotations

import re
from typing import NamedTuple

from phantom.document.base import LARGEST_NUMBER
from phantom.document.words import quoted

_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z_0-9]*)"
    r"|(?P<sign>\*\*|<=|>=|==|!=|[-+*/()<>,])"
)
_SPACE = re.compile(r"[ \t\r\n]*")


class FormulaError(ValueError):
    """A text is no formula; ``column`` counts characters from 1."""

    def __init__(self, message: str, column: int) -> None:
        self.column = column
        super().__init__(message)


class Token(NamedTuple):
    """One token: its kind (number, name, sign or end), its text and the column it starts at."""

    kind: str
    text: str
    column: int

    @property
    def shown(self) -> str:
        """The token in quotes, or ``the end``."""
        return quoted(self.text) if self.text else "the end"


def tokens(text: str) -> list[Token]:
    """Cut a text into tokens; the last one is the end.

    Raises
    ------
    FormulaError
        At a character that starts no token, or a number too large to be one.
    """
    found: list[Token] = []
    place = _SPACE.match(text).end()  # type: ignore[union-attr]
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            character = quoted(text[place])
            if not text[place].isascii():
                character += f" (U+{ord(text[place]):04X})"
            expected = "numbers, names, + - * / ** ( ) , or a comparison"
            expected = "** for a power" if text[place] == "^" else expected
            message = f"found {character} at column {place + 1}; expected {expected}"
            raise FormulaError(message, place + 1)
        token = Token(str(match.lastgroup), match.group(), place + 1)
        if token.kind == "number" and float(token.text) > LARGEST_NUMBER:
            message = f"found {token.shown} at column {token.column}; expected at most 1e18"
            raise FormulaError(message, token.column)
        found.append(token)
        place = _SPACE.match(text, match.end()).end()  # type: ignore[union-attr]
    found.append(Token("end", "", len(text) + 1))
    return found
