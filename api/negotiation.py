"""Which of the forms on offer a caller wants (RFC 9110, section 12.5.1)."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus

from api.problems import RefusedError


def _quality(parameters: Sequence[str]) -> float:
    """Return the weight that a media range has: 1 where it has none, 0 where it is unreadable."""
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip().lower() == "q":
            try:
                return min(max(float(value), 0.0), 1.0)
            except ValueError:
                return 0.0
    return 1.0


def _ranges(accept: str) -> list[tuple[str, float]]:
    found = []
    for part in accept.split(","):
        media_range, *parameters = part.split(";")
        if media_range.strip():
            found.append((media_range.strip().lower(), _quality(parameters)))
    return found


def _weight(offer: str, ranges: Sequence[tuple[str, float]]) -> float:
    """Return the weight that the most specific matching range gives the offer."""
    for wanted in (offer, f"{offer.split('/')[0]}/*", "*/*"):
        matching = [quality for media_range, quality in ranges if media_range == wanted]
        if matching:
            return max(matching)
    return 0.0


def negotiate(accept: str | None, offers: Sequence[str]) -> str:
    """Return the media type to answer with; the first offer wins a tie.

    Raises
    ------
    RefusedError
        406, with the offers, where the caller accepts none of them.
    """
    ranges = _ranges(accept or "*/*")
    weights = [_weight(offer, ranges) for offer in offers]
    best = max(weights)
    if best <= 0.0:
        detail = f"found Accept: {(accept or '')[:200]!r}, expected one of {', '.join(offers)}"
        raise RefusedError(HTTPStatus.NOT_ACCEPTABLE, detail)
    return offers[weights.index(best)]
