"""What light falls on a scene: everywhere alike, from far away, or from a point.

The words are those of the paper's Phong model (II.G): a light is told by where it is, seen from the
surface. A light may stand still in the world or move with the camera, like a lamp at the head.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Final, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, field_validator

from phantom.document.asked import Asked, plain
from phantom.document.base import (
    Boolean,
    Fraction,
    Model,
    Number,
    Point,
    Vector,
    by_type,
    direction,
    told,
)
from phantom.geometry.vectors import unit
from phantom.visible.camera import Camera

Floats = NDArray[np.float64]

Color = tuple[Fraction, Fraction, Fraction]
Intensity = Annotated[Number, Field(ge=0, le=100)]
FixedTo = Literal["world", "camera"]

MAX_LIGHTS: Final = 16

_FIXED = (
    "Whose axes: the world's, or the camera's with x to the right, y up and z from the target to"
    " the eye, and the eye as origin."
)


class DirectionalLight(Model):
    """A light so far away that it falls from the same side everywhere."""

    type: Literal["directional"] = "directional"
    to_light: Annotated[
        Annotated[Vector, BeforeValidator(plain)],
        told("To the light", "none", "From the surface toward the light, the paper's L."),
    ]
    color: Annotated[Color, told("Colour", "1", "Red, green and blue.")] = (1.0, 1.0, 1.0)
    intensity: Annotated[Intensity, told("Intensity", "1", "The colour is multiplied by it.")] = 1.0
    fixed_to: Annotated[FixedTo, told("Fixed to", "none", _FIXED)] = "world"

    _direction = field_validator("to_light")(direction)


class PointLight(Model):
    """A light at a point, as bright near as far (the paper's model has no falloff)."""

    type: Literal["point"] = "point"
    position: Annotated[
        Annotated[Point, BeforeValidator(plain)], told("Position", "mm", "Where the light is.")
    ]
    color: Annotated[Color, told("Colour", "1", "Red, green and blue.")] = (1.0, 1.0, 1.0)
    intensity: Annotated[Intensity, told("Intensity", "1", "The colour is multiplied by it.")] = 1.0
    fixed_to: Annotated[FixedTo, told("Fixed to", "none", _FIXED)] = "world"


Light = Annotated[DirectionalLight | PointLight, by_type("directional", "point")]

HEAD_LIGHTS: Final = (
    DirectionalLight(to_light=(-0.6, 0.75, 0.85), intensity=1.15, fixed_to="camera"),
    DirectionalLight(to_light=(0.9, 0.0, 0.5), intensity=0.3, fixed_to="camera"),
)
"""A lamp over the viewer's left shoulder and a weak one from the right that opens the shadows."""


class Lighting(Asked):
    """All the light of a picture; without lights only the ambient light is left."""

    place: ClassVar[str] = "/lighting"

    ambient: Annotated[
        Color, told("Ambient", "1", "Red, green and blue of the light from everywhere.")
    ] = (1.0, 1.0, 1.0)
    lights: Annotated[
        tuple[Light, ...],
        told("Lights", "none", "Lights; by default two that move with the camera."),
        Field(max_length=MAX_LIGHTS),
    ] = HEAD_LIGHTS
    shadows: Annotated[
        Boolean, told("Shadows", "none", "Whether solids keep the lights from one another.")
    ] = False


def light_arrays(lighting: Lighting, camera: Camera) -> tuple[Floats, Floats]:
    """Return what kernels read: places (n, 4), see :func:`placed`, and colours (n, 3)."""
    places, colors = np.zeros((len(lighting.lights), 4)), np.zeros((len(lighting.lights), 3))
    for i, light in enumerate(lighting.lights):
        places[i, :3], places[i, 3] = placed(light, camera)
        colors[i] = np.array(light.color) * light.intensity
    return places, colors


def placed(light: DirectionalLight | PointLight, camera: Camera) -> tuple[Floats, float]:
    """Return where a light is in the world: (3,) and how much of it is a place.

    The second is 1 for a point in mm and 0 for a unit direction, as in homogeneous coordinates:
    the way from a surface point p to the light is ``place - weight * p``.
    """
    right, down, forward = camera.axes
    turn = np.stack([right, -down, -forward], axis=1)
    own = light.fixed_to == "camera"
    if isinstance(light, DirectionalLight):
        toward = unit(np.asarray(light.to_light, dtype=np.float64))
        return (turn @ toward if own else toward), 0.0
    place = np.asarray(light.position, dtype=np.float64)
    return (np.asarray(camera.eye) + turn @ place if own else place), 1.0
