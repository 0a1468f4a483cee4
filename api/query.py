"""A query string as the request that it stands for."""

from __future__ import annotations

from collections.abc import Iterable

from starlette.datastructures import QueryParams

from phantom.errors import InvalidInputError, Problem
from phantom.requests.words import PARAMETERS, WORDS, abnormality, parameters, request_tree

ABNORMALITY = "abnormality"


def radiograph_tree(name: str, query: QueryParams) -> tuple[dict[str, object], tuple[Problem, ...]]:
    """Return the request that ``/v1/radiographs/{name}?view=ap&parameters.radius_mm=30`` means.

    What is wrong with the phantom is written ``abnormality=TYPE,NAME=VALUE``, as often as needed.
    With the request come the problems of the query itself.
    """
    own, rest = _split(query)
    wrong = [abnormality(text) for word, text in rest if word == ABNORMALITY]
    subject: dict[str, object] = {"name": name, "parameters": parameters(own)}
    if wrong:
        subject["abnormalities"] = wrong
    return request_tree(subject, [pair for pair in rest if pair[0] != ABNORMALITY])


def phantom_of(query: QueryParams) -> dict[str, object]:
    """Return the phantom that ``?phantom=NAME&parameters.radius_mm=30`` means."""
    own, rest = _split(query)
    names = [value for key, value in rest if key == "phantom"]
    unknown = [key for key, _ in rest if key != "phantom"]
    if unknown or len(names) != 1:
        message = f"found {unknown or names}; expected one phantom, by its name"
        raise InvalidInputError([Problem("/phantom", "unknown_field", message[:200])])
    return {"name": names[0], "parameters": parameters(own)}


def _split(query: QueryParams) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
    """Return the phantom's own parameters, and the other words."""
    pairs: Iterable[tuple[str, str]] = query.multi_items()
    own, rest = [], []
    for key, value in pairs:
        if key.startswith(PARAMETERS):
            own.append((key.removeprefix(PARAMETERS), value))
        else:
            rest.append((key, value))
    return own, rest


DESCRIBED = [
    {"name": word, "in": "query", "schema": {"type": "string"}, "description": f"/{'/'.join(path)}"}
    for word, path in (*WORDS.items(), (ABNORMALITY, ("phantom", "abnormalities")))
]
"""The words for OpenAPI, each with the field of the request that it sets."""
