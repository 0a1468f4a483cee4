"""What stomach and liver may be, what they are for a person, and how people of one size differ."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Final

from phantom.document import told
from phantom.document.base import Boolean, Number
from phantom.library import Person, PersonParameters
from phantoms.people import fat_mm, trimmed

if TYPE_CHECKING:
    import numpy as np

# Spread of single people about their formula, as a share (estimates, but for the liver: Feng et
# al. found 257 of 1205 cm³ in all, of which body surface explains 30 %).
_LIVER_SPREAD: Final = 0.178
_DRAWS: Final = 5


class Parameters(PersonParameters):
    """What the phantom may be."""

    liver_volume_cm3: Annotated[
        Number | None,
        told(
            "Liver",
            "cm³",
            "Volume; null for 758.3 times the body surface in m², less 124.3.",
            ge=500.0,
            le=3000.0,
        ),
    ] = None
    stomach_axis_mm: Annotated[
        Number | None,
        told(
            "Stomach's axis",
            "mm",
            "From the fundus' top to the pylorus, along the J; null by stature.",
            ge=210.0,
            le=340.0,
        ),
    ] = None
    stomach_lumen_mm: Annotated[
        Number | None,
        told(
            "Lumen",
            "mm",
            "The widest place's diameter, at most 0.4 of the axis; null by stature.",
            ge=60.0,
            le=105.0,
        ),
    ] = None
    stomach_wall_mm: Annotated[
        Number,
        told("Wall", "mm", "Of the antrum; the body's is two fifths of it.", ge=2.5, le=8.0),
    ] = 5.1
    filling: Annotated[
        Number,
        told(
            "Filling",
            "1",
            "Height of the barium's level over that of the stomach, standing; air is above.",
            ge=0.1,
            le=1.0,
        ),
    ] = 0.62
    barium_g_ml: Annotated[
        Number,
        told("Barium", "g/mL", "Barium sulphate in the suspension.", ge=0.05, le=2.0),
    ] = 0.12
    coating_mm: Annotated[
        Number, told("Coating", "mm", "Barium on the wall above the level.", ge=0.05, le=1.0)
    ] = 0.4
    fat_mm: Annotated[
        Number | None,
        told("Fat", "mm", "Under the skin; null for the body mass index.", ge=2.0, le=90.0),
    ] = None
    ribs: Annotated[Boolean, told("Ribs", "none", "Whether the lower ribs are there.")] = True

    def resolved(self) -> Parameters:
        """Return the same phantom with nothing left out."""
        person = self.person
        usual: dict[str, object] = dict(_of(person, [0.0] * _DRAWS))
        usual |= {"height_cm": person.height_cm, "weight_kg": person.weight_kg}
        given = {
            name: value
            for name, value in self.model_dump().items()
            if name in self.model_fields_set and value is not None
        }
        return Parameters.model_validate({**self.model_dump(), **usual, **given})

    def value(self, name: str) -> float:
        """Return a number of a phantom with nothing left out.

        Raises
        ------
        ValueError
            It is left out.
        """
        value = getattr(self, name)
        if value is None:
            raise ValueError(f"{name} is left out; resolve the parameters first")
        return float(value)


def body_surface_m2(person: Person) -> float:
    """Return the surface of a body (Du Bois and Du Bois 1916)."""
    surface: float = 0.007184 * person.height_cm**0.725 * person.weight_kg**0.425
    return surface


def liver_volume_cm3(person: Person) -> float:
    """Return the mean volume of a person's liver (Feng et al. 2017)."""
    return 758.259 * body_surface_m2(person) - 124.272


def of_person(person: Person, generator: np.random.Generator) -> Parameters:
    """Return the parameters of a person; as many numbers are drawn whoever it is."""
    drawn = [float(number) for number in generator.standard_normal(_DRAWS)]
    return Parameters.model_validate({**person.model_dump(), **_of(person, drawn)})


def _of(person: Person, drawn: list[float]) -> dict[str, float]:
    """Return a person's numbers; zeros draw the mean ones of that size."""
    liver, axis, lumen, wall, fat = (trimmed(number) for number in drawn)
    made = {
        "liver_volume_cm3": liver_volume_cm3(person) * math.exp(_LIVER_SPREAD * 0.8 * liver),
        "stomach_axis_mm": 275.0 * person.height_cm / 168.5 * (1 + 0.05 * axis),
        "stomach_lumen_mm": 88.0 * person.height_cm / 168.5 * (1 + 0.05 * lumen),
        "stomach_wall_mm": 5.1 + 0.8 * wall,
        "fat_mm": fat_mm(person, 15.0, 20.0, per_bmi=0.07, scatter=fat),
    }
    limits = {
        "liver_volume_cm3": (500.0, 3000.0),
        "stomach_axis_mm": (210.0, 340.0),
        "stomach_lumen_mm": (60.0, 105.0),
        "stomach_wall_mm": (2.5, 8.0),
        "fat_mm": (2.0, 90.0),
    }
    return {
        name: round(min(max(value, limits[name][0]), limits[name][1]), 3)
        for name, value in made.items()
    }
