"""How large a breast is, and what it is made of.

All lengths are of the breast as it lies, compressed or not; what a person's size and age give is
said beside each formula, with its source or as an estimate.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Final, Literal, NamedTuple

from phantom.document import told
from phantom.document.base import Fraction, Integer
from phantom.errors import InvalidInputError, Problem
from phantom.library import Person, PersonParameters
from phantom.library.people import Side
from phantoms.fields import count, millimetres

if TYPE_CHECKING:
    import numpy as np

SOURCES: Final = (
    "Yaffe, Boone, Packard et al., Medical Physics 36:5437, 2009: the fibroglandular share of the"
    " breast's volume is 0.19 on average.",
    "Huang, Boone, Yang et al., Medical Physics 35:1199, 2008: skin 1.45 +- 0.30 mm thick.",
    "Badano, Graff, Badal et al., JAMA Network Open 1:e185474, 2018 (VICTRE): compressed to 35, 45,"
    " 55 and 60 mm from the densest class to the fattest; calcium oxalate 1.78 g/cm3.",
)

Compression = Literal["cc", "mlo", "none"]

MEAN_THICKNESS_MM: Final = 59.0
SD_THICKNESS_MM: Final = 16.0
MEAN_GLANDULAR: Final = 0.19
_SD_LOG_GLANDULAR: Final = 0.5
SKIN_MM: Final = 1.45
SD_SKIN_MM: Final = 0.30


class Parameters(PersonParameters):
    """What a breast may be."""

    sex: Annotated[Literal["female"], told("Sex", "none", "Female.")] = "female"
    age_years: Annotated[
        float, told("Age", "years", "Of an adult.", ge=18, le=100, strict=True)
    ] = 55.0
    side: Annotated[
        Side, told("Side", "none", "A left breast is the mirror image of a right one.")
    ] = "right"
    compression: Annotated[
        Compression,
        told("Compression", "none", "Between the plates of a cc or an mlo view, or none."),
    ] = "cc"
    thickness_mm: Annotated[
        float | None,
        millimetres("Thickness", "Compressed; null follows from the body mass index.", 20.0, 120.0),
    ] = None
    depth_mm: Annotated[
        float | None,
        millimetres("Depth", "From the chest wall to the skin below the nipple.", 40.0, 180.0),
    ] = None
    width_mm: Annotated[
        float | None, millimetres("Width", "Along the chest wall.", 60.0, 300.0)
    ] = None
    skin_mm: Annotated[float | None, millimetres("Skin", "Its thickness.", 0.5, 4.0)] = None
    glandular: Annotated[
        Fraction | None,
        told(
            "Glandular share",
            "1",
            "Of the volume inside the skin; null follows from age and body mass index.",
            ge=0.02,
            le=0.7,
        ),
    ] = None
    lobules: Annotated[int, count("Lobules", "Ellipsoids of the gland.", 20, 3000)] = 760
    strands: Annotated[
        int, count("Strands", "Ducts, ligaments, septa and vessels, thin and curved.", 0, 600)
    ] = 150
    seed: Annotated[Integer, told("Seed", "none", "Of the gland's pattern.", ge=0, lt=2**64)] = 0


class Sizes(NamedTuple):
    """A breast with every length filled in."""

    thickness_mm: float
    depth_mm: float
    width_mm: float
    skin_mm: float
    glandular: float


def sizes(parameters: Parameters) -> Sizes:
    """Return the lengths of a breast: those that are given, else those of the person.

    Thickness has Yaffe's mean at the mean body mass index and grows by 1.4 mm for each of its
    units; depth and width grow with its square root; the glandular share falls by 1.2 % a year and
    by 4 % a unit. These slopes are estimates.
    """
    bmi = parameters.person.bmi
    over = bmi - 28.6
    spread = math.sqrt(bmi / 28.6)
    glandular = MEAN_GLANDULAR * math.exp(-0.012 * (parameters.age_years - 55.0) - 0.04 * over)
    usual = Sizes(
        thickness_mm=min(max(MEAN_THICKNESS_MM + 1.4 * over, 25.0), 110.0),
        depth_mm=min(max(95.0 * spread, 50.0), 170.0),
        width_mm=min(max(190.0 * spread, 90.0), 290.0),
        skin_mm=SKIN_MM,
        glandular=min(max(glandular, 0.04), 0.6),
    )
    given = {name: getattr(parameters, name) for name in Sizes._fields}
    return usual._replace(**{name: value for name, value in given.items() if value is not None})


def of_person(person: Person, generator: np.random.Generator) -> Parameters:
    """Return the breast of a woman, with the scatter that women of her size and age have.

    Scatter: a standard deviation of 12 mm in thickness about the regression (so that all women
    together have 16 mm), 10 % in depth and width, Huang's in skin; half a logarithmic unit in the
    glandular share (estimates but for Huang's).

    Raises
    ------
    InvalidInputError
        The person is no woman (``/sex``).
    """
    thick, deep, wide, skin, dense = (float(z) for z in generator.standard_normal(5))
    seed = int(generator.integers(2**63))
    right = bool(generator.random() < 0.5)
    if person.sex != "female":
        message = "found male; expected female, for this phantom is a woman's breast"
        raise InvalidInputError([Problem("/sex", "out_of_range", message)])
    usual = sizes(Parameters(**person.model_dump()))
    return Parameters(
        **person.model_dump(),
        side="right" if right else "left",
        thickness_mm=_within(usual.thickness_mm + 12.0 * thick, 22.0, 115.0),
        depth_mm=_within(usual.depth_mm * math.exp(0.1 * deep), 45.0, 175.0),
        width_mm=_within(usual.width_mm * math.exp(0.1 * wide), 80.0, 295.0),
        skin_mm=_within(SKIN_MM + SD_SKIN_MM * skin, 0.7, 3.5),
        glandular=_within(usual.glandular * math.exp(_SD_LOG_GLANDULAR * dense), 0.03, 0.65),
        seed=seed,
    )


def _within(value: float, least: float, most: float) -> float:
    return round(min(max(value, least), most), 4)
