"""What a chest may be, and what follows from the person where a length is left open.

Lengths on a PA radiograph are larger than in the body by the magnification of their plane; the
published means are divided by it: 1.09 for the chest wall and the lungs, 1.065 for the heart (a
tube 1800 mm from the detector, which stands 150 mm before the middle of the chest).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final, NamedTuple

from phantom.document import told
from phantom.library import PersonParameters
from phantom.library.people import mean_person
from phantoms.chest.arms import Arms
from phantoms.people import fat_mm, trimmed

if TYPE_CHECKING:
    import numpy as np

    from phantom.library import Person

WALL_MAGNIFICATION: Final = 1.09
HEART_MAGNIFICATION: Final = 1.065
MODEL_HEIGHT_CM: Final = 175.4
"""Stature of the man that the tables of this package draw."""


class Means(NamedTuple):
    """Means and standard deviations of one sex at its mean stature and body mass index."""

    chest_width_mm: float
    chest_width_sd_mm: float
    chest_depth_mm: float
    heart_width_mm: float
    heart_ratio_sd: float
    lung_height_mm: float
    rib_height_mm: float
    rib_thickness_mm: float
    thinning_mm_per_decade: float
    aorta_mm: float


MEANS: Final = {
    "male": Means(
        297.0 / WALL_MAGNIFICATION,
        27.0 / WALL_MAGNIFICATION,
        176.0,
        130.8 / HEART_MAGNIFICATION,
        0.039,
        229.0 / WALL_MAGNIFICATION,
        13.4,
        7.2,
        0.022,
        28.5,
    ),
    "female": Means(
        271.0 / WALL_MAGNIFICATION,
        26.0 / WALL_MAGNIFICATION,
        158.0,
        129.0 / HEART_MAGNIFICATION,
        0.048,
        215.0 / WALL_MAGNIFICATION,
        12.4,
        6.6,
        0.039,
        26.5,
    ),
}


def _length(title: str, meaning: str, low: float, high: float) -> object:
    return told(title, "mm", f"{meaning} Null: derived from the person.", ge=low, le=high)


class Parameters(PersonParameters):
    """A person's chest; each length that is left out follows from the person."""

    chest_width_mm: Annotated[
        float | None,
        _length("Chest width", "Between the inner margins of the ribs where widest.", 200, 350),
    ] = None
    chest_depth_mm: Annotated[
        float | None,
        _length("Chest depth", "Inside the ribs, breastbone to the hollow by the spine.", 125, 240),
    ] = None
    lung_height_mm: Annotated[
        float | None,
        _length("Lung height", "Apex to right dome: how deep the breath is.", 140, 270),
    ] = None
    heart_width_mm: Annotated[
        float | None, _length("Heart width", "From the right border to the left.", 85, 190)
    ] = None
    rib_height_mm: Annotated[
        float | None, _length("Rib height", "Long axis of the sixth rib's section.", 9, 18)
    ] = None
    rib_thickness_mm: Annotated[
        float | None, _length("Rib thickness", "Short axis of the sixth rib's section.", 5, 10)
    ] = None
    rib_cortex_mm: Annotated[
        float | None, _length("Rib cortex", "Wall of the ribs where it is thickest.", 0.5, 2.6)
    ] = None
    aorta_mm: Annotated[float | None, _length("Aorta", "Diameter of the arch.", 18, 45)] = None
    kyphosis_deg: Annotated[
        float | None,
        told(
            "Kyphosis",
            "degrees",
            "Between T3 and T10. Null: derived from the age.",
            ge=5,
            le=60,
        ),
    ] = None
    arms: Annotated[
        Arms,
        told(
            "Arms", "none", "Hanging, as for a PA view, or raised beside the head, for a lateral."
        ),
    ] = "at_sides"
    lung_density_g_cm3: Annotated[
        float, told("Lung density", "g/cm³", "Of lung without its drawn vessels.", ge=0.08, le=0.6)
    ] = 0.2
    vessel_seed: Annotated[
        int,
        told(
            "Vessel seed",
            "none",
            "Which of many trees the lungs' vessels are.",
            ge=0,
            le=2**31 - 1,
            strict=True,
        ),
    ] = 0
    asymmetry: Annotated[
        float,
        told(
            "Asymmetry",
            "1",
            "Of the skeleton's sides: 0 for mirror images, 1 for the usual differences.",
            ge=0,
            le=1,
        ),
    ] = 1.0
    asymmetry_seed: Annotated[
        int,
        told(
            "Asymmetry seed",
            "none",
            "Which of many small differences between the sides.",
            ge=0,
            le=2**31 - 1,
            strict=True,
        ),
    ] = 0


class Sizes(NamedTuple):
    """The lengths of one person's chest, all known."""

    chest_width_mm: float
    chest_depth_mm: float
    lung_height_mm: float
    heart_width_mm: float
    rib_height_mm: float
    rib_thickness_mm: float
    rib_cortex_mm: float
    aorta_mm: float
    kyphosis_deg: float
    fat_mm: float


def _within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def usual(person: Person) -> Sizes:
    """Return the mean sizes of people like this one."""
    means, mean = MEANS[person.sex], mean_person(person.sex)
    tall = person.height_cm / mean.height_cm
    heavy = person.bmi / mean.bmi
    decades = (person.age_years - 45.0) / 10.0
    return Sizes(
        chest_width_mm=_within(means.chest_width_mm * tall**0.7 * heavy**0.1, 200, 350),
        chest_depth_mm=_within(
            means.chest_depth_mm * tall**0.5 * heavy**0.25 * (1 + 0.01 * decades), 125, 240
        ),
        lung_height_mm=_within(means.lung_height_mm * tall * heavy**-0.05, 140, 270),
        heart_width_mm=_within(
            means.heart_width_mm * tall**0.5 * heavy**0.15 * (1 + 0.012 * decades), 85, 190
        ),
        rib_height_mm=_within(means.rib_height_mm * tall, 9, 18),
        rib_thickness_mm=_within(means.rib_thickness_mm * tall, 5, 10),
        rib_cortex_mm=_within(1.4 - means.thinning_mm_per_decade * decades, 0.5, 2.6),
        aorta_mm=_within(means.aorta_mm * tall**0.5 + 1.3 * decades, 18, 45),
        kyphosis_deg=_within(25.0 + 2.0 * decades, 5, 60),
        fat_mm=_within(fat_mm(person, 10.5, 12.5), 3.0, 50.0),
    )


def sizes(parameters: Parameters) -> Sizes:
    """Return a person's sizes: those that are given, and the usual ones for the rest."""
    known = usual(parameters.person)._asdict()
    for name in known:
        given = getattr(parameters, name, None)
        if given is not None:
            known[name] = float(given)
    return Sizes(**known)


def of_person(person: Person, generator: np.random.Generator) -> Parameters:
    """Draw a person's chest about the means of people like this one; nine numbers are drawn."""
    mean, means = usual(person), MEANS[person.sex]
    z = [trimmed(number) for number in generator.standard_normal(7).tolist()]
    # Height and weight explain about half of the spread of the chest's width.
    width = mean.chest_width_mm + 0.7 * means.chest_width_sd_mm * z[0]
    ratio = mean.heart_width_mm / mean.chest_width_mm + 0.6 * means.heart_ratio_sd * z[1]
    return Parameters(
        **person.model_dump(),
        chest_width_mm=round(_within(width, 205, 345), 1),
        chest_depth_mm=round(_within(mean.chest_depth_mm * (1 + 0.06 * z[2]), 130, 235), 1),
        heart_width_mm=round(_within(ratio * width, 90, 180), 1),
        lung_height_mm=round(_within(mean.lung_height_mm * (1 + 0.06 * z[3]), 150, 260), 1),
        rib_cortex_mm=round(_within(mean.rib_cortex_mm * (1 + 0.18 * z[4]), 0.6, 2.5), 2),
        aorta_mm=round(_within(mean.aorta_mm * (1 + 0.1 * z[5]), 19, 44), 1),
        kyphosis_deg=round(_within(mean.kyphosis_deg + 5.0 * z[6], 6, 58), 1),
        vessel_seed=int(generator.integers(0, 2**31 - 1)),
        asymmetry_seed=int(generator.integers(0, 2**31 - 1)),
    )
