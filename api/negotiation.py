"""Which of the forms on offer a caller wants (RFC 9110, section 12.5.1)."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus

from api.problems import RefusedError

Range = tuple[str, frozenset[str]]
"""A media type in lower case, and its parameters, ``name=value``."""


def _parsed(text: str) -> tuple[Range, float]:
    """Return a media range and its weight: 1 where it has none, 0 where it is unreadable."""
    media_type, *parameters = (part.strip().lower() for part in text.split(";"))
    kept, quality = set(), 1.0
    for parameter in parameters:
        name, _, value = (part.strip() for part in parameter.partition("="))
        if name == "q":
            try:
                quality = min(max(float(value), 0.0), 1.0)
            except ValueError:
                quality = 0.0
        elif name:
            kept.add(f"{name}={value.strip(chr(34))}")
    return (media_type, frozenset(kept)), quality


def _weight(offer: str, ranges: Sequence[tuple[Range, float]]) -> float:
    """Return the weight that the most specific matching range gives the offer."""
    (media_type, parameters), _ = _parsed(offer)
    names = (media_type, f"{media_type.split('/')[0]}/*", "*/*")
    found = [
        (-names.index(wanted), len(needed), quality)
        for (wanted, needed), quality in ranges
        if wanted in names and needed <= parameters
    ]
    return max(found)[2] if found else 0.0


def negotiate(accept: str | None, offers: Sequence[str]) -> str:
    """Return the media type to answer with; the first offer wins a tie.

    A range without parameters, ``image/tiff``, fits every offer of that type, and one with
    parameters, ``image/tiff;dtype=float32``, those that have them.

    Raises
    ------
    RefusedError
        406, with the offers, where the caller accepts none of them.
    """
    ranges = [_parsed(part) for part in (accept or "*/*").split(",") if part.strip()]
    weights = [_weight(offer, ranges) for offer in offers]
    best = max(weights)
    if best <= 0.0:
        detail = f"found Accept: {(accept or '')[:200]!r}, expected one of {', '.join(offers)}"
        raise RefusedError(HTTPStatus.NOT_ACCEPTABLE, detail)
    return offers[weights.index(best)]
