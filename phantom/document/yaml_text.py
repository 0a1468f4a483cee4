"""YAML text to a plain tree, built from PyYAML's events with a stack of our own.

Only what JSON can say is taken: no tags, no merge keys, and scalars by the JSON-like core schema
of YAML 1.2 (``no`` is text, ``1e-3`` a number). Aliases share their value.
"""

from __future__ import annotations

import re
from typing import Any, NoReturn

import yaml

from phantom.document.raw import DEEPEST_VALUE, RepeatedKeys
from phantom.document.words import HugeInteger, found, quoted
from phantom.errors import InvalidInputError, Problem

_INTEGER = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_WORDS: dict[str, object] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
# Twenty times faster where PyYAML was built with libyaml; only its events are used.
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_UNSET: Any = object()


def decode_yaml(text: str) -> object:
    """Decode one YAML document into a tree that the walk can judge.

    Raises
    ------
    InvalidInputError
        The text is not YAML, holds more than one document, uses tags, or is nested too deep.
    """
    builder = _Builder()
    try:
        for event in yaml.parse(text, Loader=_LOADER):
            builder.take(event)
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        _refuse("invalid_yaml", f"found no YAML at line {line}: {str(error.problem)[:80]}")
    except (yaml.YAMLError, RecursionError) as error:
        _refuse("invalid_yaml", f"found no YAML: {type(error).__name__}")
    return None if builder.root is _UNSET else builder.root


def _refuse(kind: str, message: str) -> NoReturn:
    raise InvalidInputError([Problem("", kind, message)])


class _Builder:
    """Puts values where they belong as events come in."""

    def __init__(self) -> None:
        self.root: Any = _UNSET
        self.open: list[list[Any]] = []  # [container, pending key or _UNSET]
        self.anchors: dict[str, Any] = {}

    def take(self, event: yaml.Event) -> None:
        """Take the next event."""
        if isinstance(event, yaml.ScalarEvent):
            self.check_tag(event, event.tag)
            plain = not event.style and event.tag is None
            self.anchor(event, self.put(event.value, plain=plain))
        elif isinstance(event, yaml.AliasEvent):
            if event.anchor is None or event.anchor not in self.anchors:
                _refuse("invalid_yaml", f"found the alias {found(event.anchor)} without its anchor")
            self.put(self.anchors[event.anchor])
        elif isinstance(event, yaml.MappingStartEvent | yaml.SequenceStartEvent):
            self.check_tag(event, event.tag)
            mapping = isinstance(event, yaml.MappingStartEvent)
            container: Any = RepeatedKeys() if mapping else []
            self.anchor(event, self.put(container))
            self.open.append([container, _UNSET])
            if len(self.open) > DEEPEST_VALUE + 1:
                _refuse("too_deep", f"found values nested deeper than {DEEPEST_VALUE}")
        elif isinstance(event, yaml.MappingEndEvent | yaml.SequenceEndEvent):
            self.open.pop()

    def anchor(self, event: Any, value: object) -> None:
        """Remember an anchored value."""
        if event.anchor is not None:
            self.anchors[event.anchor] = value

    def put(self, value: Any, *, plain: bool = False) -> object:
        """Put a value (a plain scalar is still text) into the innermost open container."""
        if not self.open:
            if self.root is not _UNSET:
                _refuse("invalid_yaml", "found a second document; expected one")
            self.root = scalar(value) if plain else value
            return self.root
        frame = self.open[-1]
        container, key = frame
        if isinstance(container, list):
            container.append(scalar(value) if plain else value)
            return container[-1]
        if key is _UNSET:
            if not isinstance(value, str):
                _refuse("bad_key", "found a key that is not text; expected a string")
            frame[1] = value
            return value
        if key in container:
            container.repeated.append(key)
        container[key] = scalar(value) if plain else value
        frame[1] = _UNSET
        return container[key]

    @staticmethod
    def check_tag(event: Any, tag: str | None) -> None:
        """Refuse tags: they name types, and a document has none to name."""
        if tag is not None and tag != "!":
            line = event.start_mark.line + 1
            _refuse("invalid_yaml", f"found the tag {quoted(tag)} at line {line}; expected none")


def scalar(text: str) -> object:
    """Return what a plain scalar stands for."""
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text):
        return int(text) if len(text) <= 400 else HugeInteger(len(text.lstrip("+-")))
    if _FLOAT.fullmatch(text):
        return float(text)
    return text
