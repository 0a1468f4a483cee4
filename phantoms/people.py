"""What a person's parts measure: with stature, age, sex and weight, and the scatter that is left.

Every phantom of a person draws its lengths, walls, densities and fat from here, so that one
person's hand and knee are of one person.

Published:

- Femoral midshaft, Feik, Thomas, Clement 1997 (Journal of Anatomy 191, 407-416): void is 25 % of
  the section in young adults of both sexes, 37 % in men and 50 % in women in their 80s, of which
  pores are 4-6 % of the cortex in the young and over 9 % in the old. What is left is the canal:
  21 % of the section, then 31 % and 45 %.
- Riggs et al. 2004 (Journal of Bone and Mineral Research 19, 1945-1954): over life, trabecular
  density falls by 46 % (men) and 55 % (women) in spine and hip, by 26 % and 24 % in forearm and
  shin, from youth on; cortical density by 18 % and 25 %, from midlife on.
- Stature and the length of the femur: r = 0.84 in men, 0.83 in women (International Journal of
  Legal Medicine 2023, doi:10.1007/s00414-022-02921-y).
- Thickness of the superficial fat and body mass index: r = 0.75 (Cotofana et al. 2020, Journal of
  Drugs in Dermatology 19, 36).

Estimates: the correlation of widths of bones with stature; the ages between those published; that
fat grows by a fixed share for each kg/m², and by which; that mineral lost from spongiosa is
replaced by marrow, told here as a lower density of the reference tissue that attenuates as much
at 60 keV.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from phantom.library import Person
    from phantom.library.people import Sex

LENGTH_CORRELATION: Final = 0.84
"""Of the length of a long bone with stature."""

WIDTH_CORRELATION: Final = 0.6
"""Of the width of a bone with stature."""

MOST_SCATTER: Final = 2.5
"""Standard deviations at which a draw is cut, so that no one is a giant in one bone."""

_MIDLIFE_YEARS: Final = 45.0
_YOUNG_YEARS, _OLD_YEARS = 20.0, 90.0

_CANAL: Final[dict[Sex, tuple[tuple[float, float], ...]]] = {
    "male": ((25.0, 0.21), (55.0, 0.24), (85.0, 0.31)),
    "female": ((25.0, 0.21), (45.0, 0.24), (55.0, 0.29), (85.0, 0.45)),
}
_CORTICAL_LOSS: Final[dict[Sex, float]] = {"male": 0.18, "female": 0.25}
_TRABECULAR_LOSS: Final[dict[str, dict[Sex, float]]] = {
    "central": {"male": 0.46, "female": 0.55},
    "peripheral": {"male": 0.26, "female": 0.24},
}
MINERAL_IN_SPONGIOSA: Final = 0.37
"""Share of the attenuation of spongiosa at 60 keV, 0.281 / cm, that marrow alone has not."""


class Measure(NamedTuple):
    """A length of grown people: mean and standard deviation in mm of each sex.

    ``correlation`` is that with stature.
    """

    male: tuple[float, float]
    female: tuple[float, float]
    correlation: float = WIDTH_CORRELATION

    def of(self, person: Person, scatter: float = 0.0) -> float:
        """Return the length that goes with a person's stature.

        Parameters
        ----------
        scatter
            A standard normal number; its share of the spread is what stature leaves unexplained,
            so that mean and standard deviation over people are those of the measure.
        """
        mean_mm, sd_mm = self.male if person.sex == "male" else self.female
        rest = math.sqrt(1.0 - self.correlation**2)
        deviation = self.correlation * person.tallness + rest * trimmed(scatter)
        return mean_mm + sd_mm * deviation


def trimmed(scatter: float) -> float:
    """Return a standard normal number, at most :data:`MOST_SCATTER` from 0."""
    return min(max(scatter, -MOST_SCATTER), MOST_SCATTER)


def canal_share(person: Person) -> float:
    """Return the share of a long bone's midshaft section that is marrow canal."""
    return _between(_CANAL[person.sex], person.age_years)


def cortex_share(person: Person, scatter: float = 0.0) -> float:
    """Return the cortex's thickness at midshaft over half the shaft's width, from 0.15 to 0.85.

    ``scatter`` is a standard normal number; people of one age and sex differ by 12 % (an estimate:
    Feik et al. report great variability in the elderly).
    """
    share = 1.0 - math.sqrt(canal_share(person))
    return min(max(share * (1.0 + 0.12 * trimmed(scatter)), 0.15), 0.85)


def cortical_density_g_cm3(person: Person, grown_g_cm3: float = 1.92) -> float:
    """Return the density of cortical bone: the reference's up to midlife, then less each year."""
    years = min(max(person.age_years, _MIDLIFE_YEARS), _OLD_YEARS) - _MIDLIFE_YEARS
    lost = _CORTICAL_LOSS[person.sex] * years / (_OLD_YEARS - _MIDLIFE_YEARS)
    return grown_g_cm3 * (1.0 - lost)


def spongiosa_density_g_cm3(
    person: Person, grown_g_cm3: float = 1.18, *, central: bool = False, scatter: float = 0.0
) -> float:
    """Return the density of spongiosa: the reference's at midlife, more in youth, less in age.

    ``central`` is the spine and the hip. ``scatter`` is a standard normal number; people of one age
    and sex differ by 15 % of the mineral (an estimate).
    """
    over_life = _TRABECULAR_LOSS["central" if central else "peripheral"][person.sex]

    def left(age_years: float) -> float:
        years = min(max(age_years, _YOUNG_YEARS), _OLD_YEARS) - _YOUNG_YEARS
        return 1.0 - over_life * years / (_OLD_YEARS - _YOUNG_YEARS)

    mineral = left(person.age_years) / left(_MIDLIFE_YEARS) * (1.0 + 0.15 * trimmed(scatter))
    return grown_g_cm3 * (1.0 + MINERAL_IN_SPONGIOSA * (mineral - 1.0))


def fat_mm(
    person: Person,
    male_mm: float,
    female_mm: float,
    *,
    per_bmi: float = 0.08,
    scatter: float = 0.0,
) -> float:
    """Return how thick the fat under the skin is at a place.

    Parameters
    ----------
    male_mm, female_mm
        Thickness at a body mass index of 25 kg/m².
    per_bmi
        Share by which it grows for each kg/m².
    scatter
        A standard normal number; the logarithm scatters by 0.40, which makes r = 0.75.
    """
    usual = male_mm if person.sex == "male" else female_mm
    return usual * math.exp(per_bmi * (person.bmi - 25.0) + 5.0 * per_bmi * trimmed(scatter))


def muscle_scale(person: Person) -> float:
    """Return by how much limbs' muscle is wider than the mean person's: mass without fat.

    Half of what weight is above or below that of a body mass index of 28.5 counts as muscle, at
    equal length, so that widths grow with the square root of it; a tenth is lost from 50 to 80
    years. An estimate.
    """
    weight = 1.0 + 0.5 * (min(person.bmi, 45.0) / 28.5 - 1.0)
    aged = 1.0 - 0.1 * min(max((person.age_years - 50.0) / 30.0, 0.0), 1.0)
    return math.sqrt(weight * aged) * (1.0 + 0.043 * person.tallness)


def _between(points: Sequence[tuple[float, float]], at: float) -> float:
    """Return the straight line through points at a place, level beyond their ends."""
    before = points[0]
    for after in points:
        if at <= after[0]:
            if after[0] == before[0]:
                return after[1]
            return before[1] + (after[1] - before[1]) * (at - before[0]) / (after[0] - before[0])
        before = after
    return points[-1][1]
