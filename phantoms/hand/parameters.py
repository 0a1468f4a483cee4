"""What the hand may be, what it is for a person, and how people of one size differ."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final

from phantom.document import told
from phantom.document.base import Number
from phantom.library import Person
from phantom.library.people import Sex, Side
from phantoms.hand.frames import KINDS
from phantoms.hand.lengths import BoneLengths, field, hand_scale, length_mm
from phantoms.hand.sizes import DIGITS, METACARPAL
from phantoms.people import fat_mm, trimmed

if TYPE_CHECKING:
    import numpy as np

# Age, then the metacarpal index of men and of women: 40 years, and the means over all ages, are
# published (Ekpo et al. 2007); the course between and beyond is an estimate.
_INDEX: Final = (
    (18.0, 0.545, 0.505),
    (40.0, 0.574, 0.528),
    (50.0, 0.555, 0.495),
    (65.0, 0.515, 0.425),
    (80.0, 0.475, 0.365),
    (100.0, 0.43, 0.31),
)
_INDEX_SD: Final[dict[Sex, float]] = {"male": 0.032, "female": 0.039}
_JOINT_MM: Final[dict[Sex, float]] = {"male": 1.72, "female": 1.49}
_STOUT: Final[dict[Sex, float]] = {"male": 1.02, "female": 0.97}
_COMMON: Final = 0.75
"""Correlation of what stature leaves unexplained with the whole hand's share of it (estimate)."""


class Parameters(BoneLengths):
    """What the hand may be; lengths that are left out follow from the stature."""

    side: Annotated[
        Side, told("Side", "none", "Of the body; a left hand is the mirror image of a right one.")
    ] = "right"
    metacarpal_index: Annotated[
        Number | None,
        told(
            "Metacarpal index",
            "1",
            "Share of cortex in the width of the index metacarpal at mid-shaft, all other shafts"
            " in proportion; null for the mean of sex and age.",
            ge=0.2,
            le=0.75,
        ),
    ] = None
    joint_space_mm: Annotated[
        Number | None,
        told(
            "Joint space",
            "mm",
            "Of the fingers' base joints, the others in proportion; null for the mean of the sex.",
            ge=0.8,
            le=2.6,
        ),
    ] = None
    bone_width: Annotated[
        Number | None,
        told(
            "Bone width",
            "1",
            "Of all bones, wrist and palm over that of the mean adult, at equal stature; null for"
            " the mean of the sex.",
            ge=0.85,
            le=1.15,
        ),
    ] = None
    fat_mm: Annotated[
        Number | None,
        told("Fat", "mm", "Under the skin; null for the body mass index.", ge=0.4, le=4.0),
    ] = None

    @property
    def scale(self) -> float:
        """How much larger the hand is than the mean adult's."""
        return hand_scale(self.person)

    def value(self, name: str) -> float:
        """Return a number of a hand with nothing left out.

        Raises
        ------
        ValueError
            It is left out.
        """
        value = getattr(self, name)
        if value is None:
            raise ValueError(f"{name} is left out; resolve the parameters first")
        return float(value)

    def resolved(self) -> Parameters:
        """Return the same hand with nothing left out."""
        person = self.person
        usual: dict[str, object] = dict(_of(person, [0.0] * _DRAWS))
        usual |= {"height_cm": person.height_cm, "weight_kg": person.weight_kg}
        given = {name: value for name, value in self.model_dump().items() if value is not None}
        return Parameters.model_validate({**usual, **given})


def of_person(person: Person, generator: np.random.Generator) -> Parameters:
    """Return the hand of a person; as many numbers are drawn whoever it is."""
    drawn = [float(number) for number in generator.standard_normal(_DRAWS)]
    return Parameters.model_validate({**person.model_dump(), **_of(person, drawn)})


def mean_index(sex: Sex, age_years: float) -> float:
    """Return the mean metacarpal index of a sex at an age."""
    import numpy as np

    ages, men, women = zip(*_INDEX, strict=True)
    return float(np.interp(age_years, ages, men if sex == "male" else women))


def shaft_index(kind: str, index: float) -> float:
    """Return the share of cortex in a shaft's width; phalanges have a little less (estimate)."""
    return index if kind == METACARPAL else 0.92 * index


_BONES: Final = tuple((digit, kind) for digit in DIGITS for kind in KINDS[digit])
_DRAWS: Final = len(_BONES) + 5


def _of(person: Person, drawn: list[float]) -> dict[str, float]:
    """Return the numbers of a person's hand; zeros draw the mean one of that size and age."""
    whole, index, joint, stout, fat = (trimmed(number) for number in drawn[len(_BONES) :])
    rest = (1.0 - _COMMON**2) ** 0.5
    made = {
        field(digit, kind): length_mm(person, digit, kind, _COMMON * whole + rest * own)
        for (digit, kind), own in zip(_BONES, drawn, strict=False)
    }
    mean = mean_index(person.sex, person.age_years)
    made["metacarpal_index"] = _held(mean + _INDEX_SD[person.sex] * index, 0.22, 0.72)
    made["joint_space_mm"] = _JOINT_MM[person.sex] * (1.0 + 0.1 * joint)
    made["bone_width"] = _STOUT[person.sex] * (1.0 + 0.04 * stout)
    made["fat_mm"] = _held(fat_mm(person, 1.0, 1.3, per_bmi=0.05, scatter=fat), 0.4, 4.0)
    return {name: round(value, 3) for name, value in made.items()}


def _held(value: float, least: float, most: float) -> float:
    return min(max(value, least), most)
