"""A tree to a model, with every problem in our words and at its place in the input."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sized
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from phantom.document.base import TAG
from phantom.document.raw import Walk
from phantom.document.words import MOST_PROBLEMS, arranged, counted, found
from phantom.errors import InvalidInputError, Problem, pointer

ModelT = TypeVar("ModelT", bound=BaseModel)
Parts = tuple[str | int, ...]


def validate_model(model_class: type[ModelT], tree: object) -> ModelT:
    """Return the model that a plain tree describes.

    Raises
    ------
    InvalidInputError
        With every problem, its path the JSON pointer of the field in ``tree``.
    """
    model, problems = judge(model_class, tree)
    if model is None or problems:
        raise InvalidInputError(arranged(problems))
    return model


def judge(
    model_class: type[ModelT],
    tree: object,
    more: Callable[[Any], Iterable[Problem]] | None = None,
) -> tuple[ModelT | None, list[Problem]]:
    """Return the model, None if there is none, and the problems.

    ``more`` looks further at a tree that is odd in no way but may fit no model.
    """
    walk = Walk().over(tree)
    if walk.fatal:
        return None, walk.problems
    problems, model = list(walk.problems), None
    told = {problem.path for problem in problems}
    try:
        model = model_class.model_validate(tree)
    except ValidationError as error:
        problems += [p for p in translated(error, tree) if p.path not in told]
    if more is not None:
        told = {problem.path for problem in problems}
        problems += [p for p in more(tree) if p.path not in told]
    return model, problems


def translated(error: ValidationError, tree: object) -> list[Problem]:
    """Return pydantic's errors as problems."""
    problems, short = [], {}
    # The rest of very many problems is counted, not worded.
    for detail in error.errors(include_url=False)[: 2 * MOST_PROBLEMS]:
        parts = plain_parts(detail, tree)
        if detail["type"] == "missing" and parts and isinstance(parts[-1], int):
            # A missing element of a fixed-length array: told once, for the array.
            short[parts[:-1]] = (len(detail["input"]), parts[-1] + 1)
        else:
            problems += problems_of(detail, parts)
    for parts, (count, wanted) in short.items():
        problems.append(_wrong_length(parts, count, str(wanted)))
    return problems


def plain_parts(detail: ErrorDetails, tree: object) -> Parts:
    """Return an error's location without the tags of unions, as the input has it."""
    location, parts = detail["loc"], list[str | int]()
    node: Any = tree
    if location and location[-1] == "[key]" and detail["type"].startswith("string_"):
        location = location[:-1]
    for index, part in enumerate(location):
        if isinstance(part, str) and part.startswith(TAG):
            continue
        inside = _holds(node, part)
        if inside:
            node = node[part]
        # A step that is not in the input is a field left out, or the tag of a union not of ours.
        left_out = detail["type"] == "missing" or "problems" in detail.get("ctx", {})
        if inside or (left_out and index == len(location) - 1):
            parts.append(part)
    return tuple(parts)


def _holds(node: Any, part: str | int) -> bool:
    if isinstance(node, Mapping):
        return part in node
    return isinstance(node, list | tuple) and isinstance(part, int) and part < len(node)


def problems_of(detail: ErrorDetails, parts: Parts) -> list[Problem]:
    """Return the problems that one error of pydantic stands for."""
    kind, value, context = detail["type"], detail["input"], detail.get("ctx", {})
    if "problems" in context:
        base = parts[:-1] if context["whole"] else parts
        return [Problem(pointer(base + tuple(at)), kind, text) for at, text in context["problems"]]
    if kind in _CHOICES:
        return [_choice(kind, parts, value, detail["msg"])]
    if kind in ("too_short", "too_long"):
        bound = "min_length" if kind == "too_short" else "max_length"
        limit = context[bound]
        count = len(value) if isinstance(value, Sized) else context["actual_length"]
        if kind == "too_short" and count >= limit:
            return []  # pydantic counts without the elements it refused
        words = f"at {'least' if kind == 'too_short' else 'most'} {limit}"
        return [_wrong_length(parts, count, words)]
    if kind in _LIMITS:
        words, key = _LIMITS[kind]
        message = f"found {found(value)}; expected {words} {context[key]:g}"
        return [Problem(pointer(parts), "out_of_range", message)]
    if kind == "literal_error":
        message = f"found {found(value)}; expected {context['expected']}"
        return [Problem(pointer(parts), "unknown_value", message)]
    if kind == "missing":
        return [Problem(pointer(parts), "missing", "missing; expected this field")]
    if kind == "extra_forbidden":
        return [Problem(pointer(parts), "unknown_field", "found a field that is not known here")]
    if kind in ("string_too_short", "string_too_long"):
        bound = "min_length" if kind == "string_too_short" else "max_length"
        words = "least" if kind == "string_too_short" else "most"
        expected = f"at {words} {counted(context[bound], 'character')}"
        length = counted(len(value), "character") if isinstance(value, str) else found(value)
        return [Problem(pointer(parts), "wrong_length", f"found {length}; expected {expected}")]
    if kind in _TYPES:
        own_kind, expected = _TYPES[kind]
        return [Problem(pointer(parts), own_kind, f"found {found(value)}; expected {expected}")]
    message = detail["msg"].removeprefix("Value error, ")[:200]
    return [Problem(pointer(parts), "invalid", message)]


def _wrong_length(parts: Parts, count: int, expected: str) -> Problem:
    message = f"found {counted(count, 'value')}; expected {expected}"
    return Problem(pointer(parts), "wrong_length", message)


def _choice(kind: str, parts: Parts, value: object, expected: str) -> Problem:
    """Say why no member of a union fits; ``expected`` lists what would have."""
    if kind == "unknown_type" and isinstance(value, Mapping):
        parts = (*parts, "type")
        if "type" not in value:
            return Problem(pointer(parts), "missing", f"missing; expected one of {expected}")
        message = f"found {found(value['type'])}; expected one of {expected}"
        return Problem(pointer(parts), kind, message)
    if kind == "material_kind" and isinstance(value, Mapping):
        keys = [key for key in ("attenuation_per_mm", "reference", "composition") if key in value]
        message = f"found {' and '.join(keys) or 'none of them'}; expected {expected}"
        return Problem(pointer(parts), kind, message)
    if kind in ("unknown_type", "material_kind"):
        kind, expected = "not_an_object", f"an object with {_CHOICES[kind]}{expected}"
    return Problem(pointer(parts), kind, f"found {found(value)}; expected {expected}")


_CHOICES = {
    "unknown_type": "a type of ",
    "material_kind": "",
    "wrong_shape": "",
    "not_a_number": "",
}
_LIMITS = {
    "greater_than": ("more than", "gt"),
    "greater_than_equal": ("at least", "ge"),
    "less_than": ("less than", "lt"),
    "less_than_equal": ("at most", "le"),
}
_TYPES = {
    "float_type": ("not_a_number", "a number"),
    "float_parsing": ("not_a_number", "a number"),
    "finite_number": ("not_finite", "a finite number"),
    "int_type": ("not_an_integer", "a whole number"),
    "int_from_float": ("not_an_integer", "a whole number"),
    "int_parsing": ("not_an_integer", "a whole number"),
    "int_parsing_size": ("out_of_range", "a smaller whole number"),
    "string_type": ("not_a_string", "a string"),
    "string_unicode": ("lone_surrogate", "text without lone surrogates"),
    "bool_type": ("not_a_boolean", "true or false"),
    "bool_parsing": ("not_a_boolean", "true or false"),
    "dict_type": ("not_an_object", "an object"),
    "model_type": ("not_an_object", "an object"),
    "model_attributes_type": ("not_an_object", "an object"),
    "tuple_type": ("not_an_array", "an array"),
    "list_type": ("not_an_array", "an array"),
    "union_tag_invalid": ("unknown_type", "a known type"),
    "union_tag_not_found": ("missing", "a type"),
    "recursion_loop": ("too_deep", "a flatter tree"),
}
