"""The reference materials a document may name, each with its composition, density and source.

Compositions are mass fractions. Those of the tissues are printed to 0.1 % in ICRU Report 44 and add
to one there; those of pure compounds follow from the formula and the 2021 IUPAC atomic weights.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from phantom.errors import InvalidInputError, Problem
from phantom.materials import mixtures, tissues


@dataclass(frozen=True, slots=True)
class ReferenceTissue:
    """A named material of the reference table.

    Attributes
    ----------
    name
        The word a document writes after ``reference``.
    title
        The name a person reads.
    composition
        Mass fraction of every element; they add to one.
    density_g_cm3
        Mass density used unless the document overrides it.
    source
        Where composition and density were published, or how they follow.
    """

    name: str
    title: str
    composition: Mapping[str, float]
    density_g_cm3: float
    source: str


_TABLE: Final[dict[str, ReferenceTissue]] = {
    name: ReferenceTissue(name, title, MappingProxyType(composition), density_g_cm3, source)
    for name, (title, density_g_cm3, composition, source) in {
        **mixtures.TABLE,
        **tissues.TABLE,
    }.items()
}

REFERENCE_NAMES: Final[tuple[str, ...]] = tuple(_TABLE)
"""Every name that ``reference`` may hold in a document."""


def reference(name: str) -> ReferenceTissue:
    """Return the reference material of that name.

    Raises
    ------
    InvalidInputError
        The table holds no such name; the known ones are listed.
    """
    tissue = _TABLE.get(name)
    if tissue is None:
        raise InvalidInputError(
            [
                Problem(
                    "/reference",
                    "unknown_reference",
                    f"{name!r} is not a reference material; known are {', '.join(REFERENCE_NAMES)}",
                )
            ]
        )
    return tissue
