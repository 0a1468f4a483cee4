"""People: sex, age, height and weight, and how these are spread over a population.

Published:

- Means of American adults of 2015-2016, 175.4 cm and 89.8 kg for men, 161.7 cm and 77.4 kg for
  women, body mass index 29.1 and 29.6: Fryar, Kruszon-Moran, Gu, Ogden, Mean Body Weight, Height,
  Waist Circumference, and Body Mass Index Among Adults, National Health Statistics Reports 122,
  2018.
- Height lost since the age of 30: 3 cm by 70 and 5 cm by 80 in men, 5 cm and 8 cm in women, faster
  with age: Sorkin, Muller, Andres, Longitudinal change in height of men and women, American Journal
  of Epidemiology 150, 1999, 969-977. The square of the years since 30 passes within 0.3 cm of all
  four.

Estimates: the standard deviations of height (7.2 and 6.6 cm in the Health Examination Survey of
1960-1962; what is used is rounded up for a more varied people), and that the logarithm of the body
mass index is normal, of these widths, at any age and height; so weight follows from height and
index, and is correlated with height as it is in people. The means above are then met.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Final, Literal, NamedTuple

from pydantic import Field, ValidationInfo, field_validator

from phantom.document import Model, told
from phantom.document.base import Fraction, Number, refuse

if TYPE_CHECKING:
    import numpy as np

Sex = Literal["female", "male"]
Side = Literal["right", "left"]

AGES_YEARS: Final = (18.0, 100.0)
HEIGHTS_CM: Final = (140.0, 210.0)
WEIGHTS_KG: Final = (35.0, 200.0)

Age = Annotated[Number, Field(ge=AGES_YEARS[0], le=AGES_YEARS[1])]
Height = Annotated[Number, Field(ge=HEIGHTS_CM[0], le=HEIGHTS_CM[1])]
Weight = Annotated[Number, Field(ge=WEIGHTS_KG[0], le=WEIGHTS_KG[1])]


class _Spread(NamedTuple):
    """Mean and standard deviation of height; of the logarithm of the body mass index."""

    height_cm: float
    height_sd_cm: float
    log_bmi: float
    log_bmi_sd: float


_SPREAD: Final[dict[Sex, _Spread]] = {
    "male": _Spread(175.4, 7.6, math.log(28.5), 0.20),
    "female": _Spread(161.7, 7.1, math.log(28.6), 0.25),
}


_SHRINKS_FROM_YEARS: Final = 30.0
_SHRINKS_CM: Final[dict[Sex, float]] = {"male": 0.00195, "female": 0.0031}
"""Height lost per square of the years since then."""

_SURVEYED_YEARS: Final = (20.0, 80.0)
"""Ages of the survey that the mean heights are of, all alike."""


def height_lost_cm(sex: Sex, age_years: float) -> float:
    """Return how much shorter people of that age are than they were when grown."""
    return _SHRINKS_CM[sex] * max(0.0, age_years - _SHRINKS_FROM_YEARS) ** 2


def mean_height_cm(sex: Sex, age_years: float) -> float:
    """Return the mean height at that age; over all ages it is the published mean."""
    youngest, oldest = _SURVEYED_YEARS
    years = oldest - _SHRINKS_FROM_YEARS
    usual = _SHRINKS_CM[sex] * years**3 / 3.0 / (oldest - youngest)
    return _SPREAD[sex].height_cm + usual - height_lost_cm(sex, age_years)


class Person(Model):
    """Who is X-rayed."""

    sex: Annotated[Sex, told("Sex", "none", "Female or male.")] = "male"
    age_years: Annotated[Age, told("Age", "years", "Of an adult.")] = 45.0
    height_cm: Annotated[Height, told("Height", "cm", "Standing.")]
    weight_kg: Annotated[Weight, told("Weight", "kg", "Of the body.")]

    @property
    def bmi(self) -> float:
        """Body mass index, kg/m²."""
        return self.weight_kg / (self.height_cm / 100.0) ** 2

    @property
    def tallness(self) -> float:
        """Standard deviations of height above the mean of the sex at this age.

        Bones keep their length when the spine shrinks; they go with this, not with the height.
        """
        mean_cm = mean_height_cm(self.sex, self.age_years)
        return (self.height_cm - mean_cm) / _SPREAD[self.sex].height_sd_cm


def mean_person(sex: Sex, age_years: float = 45.0) -> Person:
    """Return the person of the mean height at this age and of the median body mass index."""
    height = round(mean_height_cm(sex, age_years), 1)
    weight = math.exp(_SPREAD[sex].log_bmi) * (height / 100.0) ** 2
    return Person(sex=sex, age_years=age_years, height_cm=height, weight_kg=round(weight, 1))


class PersonParameters(Model):
    """Parameters that every phantom of a person has; what is left out is the mean person's."""

    sex: Annotated[Sex, told("Sex", "none", "Female or male.")] = "male"
    age_years: Annotated[Age, told("Age", "years", "Of an adult.")] = 45.0
    height_cm: Annotated[
        Height | None, told("Height", "cm", "Standing; null for the mean of the sex at this age.")
    ] = None
    weight_kg: Annotated[
        Weight | None,
        told("Weight", "kg", "Null for the median body mass index of the sex at the height."),
    ] = None

    @property
    def person(self) -> Person:
        """The person, with height and weight filled in."""
        mean_cm = round(mean_height_cm(self.sex, self.age_years), 1)
        height = mean_cm if self.height_cm is None else self.height_cm
        usual = math.exp(_SPREAD[self.sex].log_bmi) * (height / 100.0) ** 2
        weight = round(usual, 1) if self.weight_kg is None else self.weight_kg
        return Person(sex=self.sex, age_years=self.age_years, height_cm=height, weight_kg=weight)


class Population(Model):
    """How the people of a series are spread."""

    female: Annotated[Fraction, told("Female", "1", "Share of women.")] = 0.5
    age_years: Annotated[
        tuple[Age, Age], told("Age", "years", "Youngest and oldest; all ages between alike.")
    ] = (20.0, 80.0)

    @field_validator("age_years")
    @classmethod
    def _grows(cls, ages: tuple[float, float], _: ValidationInfo) -> tuple[float, float]:
        if ages[1] < ages[0]:
            message = f"found {ages[0]:g} to {ages[1]:g}; expected the youngest first"
            refuse("bad_range", ((), message))
        return ages

    def draw(self, generator: np.random.Generator) -> Person:
        """Return a person; the same from a generator of the same state.

        Four numbers are drawn whatever they turn out to be, so that what is drawn afterwards does
        not depend on who this is. Heights and weights beyond the limits of a person are cut.
        """
        chance, at = generator.random(2)
        tall, heavy = generator.standard_normal(2)
        sex: Sex = "female" if chance < self.female else "male"
        spread = _SPREAD[sex]
        age = self.age_years[0] + (self.age_years[1] - self.age_years[0]) * at
        mean_cm = mean_height_cm(sex, age)
        height = _within(mean_cm + spread.height_sd_cm * tall, HEIGHTS_CM)
        bmi = math.exp(spread.log_bmi + spread.log_bmi_sd * heavy)
        weight = _within(bmi * (height / 100.0) ** 2, WEIGHTS_KG)
        return Person(
            sex=sex,
            age_years=round(age, 1),
            height_cm=round(height, 1),
            weight_kg=round(weight, 1),
        )


def _within(value: float, limits: tuple[float, float]) -> float:
    return min(max(value, limits[0]), limits[1])
