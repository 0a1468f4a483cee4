"""What every leaf may have besides its shape: a name, a material, cuts and a look."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.base import (
    Fraction,
    Model,
    Name,
    Number,
    Point,
    Vector,
    direction,
    refuse,
    told,
)


class Cut(Model):
    """A plane that keeps the side its normal points away from."""

    point: Annotated[Point, told("Point", "mm", "A point of the plane.")]
    normal: Annotated[Vector, told("Normal", "none", "Normal, pointing to the side cut away.")]

    _direction = field_validator("normal")(direction)


class Appearance(Model):
    """How a leaf looks in visible light (Phong); ambient + diffuse + specular <= 1."""

    color: Annotated[
        tuple[Fraction, Fraction, Fraction], told("Colour", "1", "Red, green and blue from 0 to 1.")
    ] = (0.8, 0.8, 0.8)
    ambient: Annotated[Fraction, told("Ambient", "1", "The paper's K_a.")] = 0.2
    diffuse: Annotated[Fraction, told("Diffuse", "1", "The paper's K_d.")] = 0.6
    specular: Annotated[
        Fraction, told("Specular", "1", "The paper's K_s."), Field(validate_default=True)
    ] = 0.2
    exponent: Annotated[
        Number, told("Exponent", "none", "The paper's n, how tight the highlight is.", ge=1, le=1e4)
    ] = 20.0

    @field_validator("specular")
    @classmethod
    def _gives_back_no_more_light_than_it_gets(cls, specular: float, info: ValidationInfo) -> float:
        if "ambient" in info.data and "diffuse" in info.data:
            total = info.data["ambient"] + info.data["diffuse"] + specular
            if total > 1 + 1e-9:
                message = f"found ambient + diffuse + specular = {total:.6g}; expected at most 1"
                refuse("out_of_range", ((), message), whole=True)
        return specular


class LeafModel(Model):
    """What every leaf may have."""

    name: Annotated[
        Name | None, told("Name", "none", "Last part of the leaf's label in the ground truth.")
    ] = None
    material: Annotated[
        Name | None,
        told("Material", "none", "Name in materials; left out only where it can never surface."),
    ] = None
    appearance: Annotated[
        Appearance | None, told("Appearance", "none", "Look in visible light.")
    ] = None
    cuts: Annotated[
        tuple[Cut, ...], told("Cuts", "none", "Planes that truncate the leaf and move with it.")
    ] = ()
