"""The rotary fan of the 1993 paper (section IV.B, figure 9): three blades and a hub.

One blade is defined, a generalized cylinder whose elongated section twists along a straight axis,
and stands in the fan three times, turned about the hub's axis (y). The hub is an ellipsoid
truncated in front and behind. All measures are estimates: the paper gives none.
"""

from __future__ import annotations

from typing import Annotated, Final

from phantom.document import (
    Cut,
    Document,
    EllipseContour,
    Ellipsoid,
    FixedMaterial,
    GeneralizedCylinder,
    Instance,
    KnotProfile,
    LinearSweep,
    LineAxis,
    Model,
    Rotation,
    Transformed,
    Union,
    told,
)
from phantom.library import Entry

_SUMMARY: Final = (
    "The fan of the 1993 paper's figure 9: three instances of one twisted blade, a generalized"
    " cylinder, round a truncated ellipsoid."
)
BLADES: Final = 3
_HUB_DEPTH: Final = 0.85  # semi-axis along y over the hub's radius
_HUB_FRONT: Final = -0.5  # where the hub is cut, over its radius
_HUB_BACK: Final = 0.45
_ROOT: Final = 0.55  # where a blade begins, over the hub's radius
# u along the blade, half the section's length and its shift sideways over the blade's span.
_OUTLINE: Final = (
    (0.0, 0.120, 0.000),
    (0.2, 0.175, 0.005),
    (0.45, 0.240, 0.025),
    (0.7, 0.275, 0.065),
    (0.85, 0.250, 0.105),
    (0.94, 0.180, 0.130),
    (0.985, 0.100, 0.142),
    (1.0, 0.050, 0.145),
)
_HALF_THICKNESS: Final = ((0.0, 0.032), (0.5, 0.022), (1.0, 0.012))


class Parameters(Model):
    """What the fan may be."""

    radius_mm: Annotated[
        float,
        told("Radius", "mm", "From the axis to the blades' tips.", ge=10.0, le=300.0, strict=True),
    ] = 125.0
    hub_share: Annotated[
        float,
        told("Hub share", "none", "Hub radius over the fan's.", ge=0.15, le=0.35, strict=True),
    ] = 0.22
    root_pitch_deg: Annotated[
        float,
        told("Root pitch", "degrees", "Of a blade at the hub.", ge=-80.0, le=80.0, strict=True),
    ] = 55.0
    tip_pitch_deg: Annotated[
        float,
        told("Tip pitch", "degrees", "Of a blade at its tip.", ge=-80.0, le=80.0, strict=True),
    ] = 15.0
    attenuation_per_mm: Annotated[
        float,
        told("Attenuation", "1/mm", "Of the whole fan.", ge=0.001, le=1.0, strict=True),
    ] = 0.05


def _blade(parameters: Parameters) -> GeneralizedCylinder:
    """Return the blade that points to +z; its pitch is the turn of its section from x toward y."""
    root = _ROOT * parameters.hub_share * parameters.radius_mm
    span = parameters.radius_mm - root
    half_length = tuple((u, half * span) for u, half, _ in _OUTLINE)
    half_thickness = tuple((u, half * span) for u, half in _HALF_THICKNESS)
    shift = tuple((u, value * span) for u, _, value in _OUTLINE)
    twist = ((0.0, parameters.root_pitch_deg), (1.0, parameters.tip_pitch_deg))
    return GeneralizedCylinder(
        type="generalized_cylinder",
        material="fan",
        axis=LineAxis(type="line", start=(0.0, 0.0, root), end=(0.0, 0.0, parameters.radius_mm)),
        contour=EllipseContour(type="ellipse", semi_axes=(1.0, 1.0)),
        sweep=LinearSweep(
            type="linear",
            scale=(KnotProfile(knots=half_length), KnotProfile(knots=half_thickness)),
            rotate_deg=KnotProfile(knots=twist),
            offset=(KnotProfile(knots=shift), 0.0),
        ),
    )


def _turned(index: int) -> Transformed:
    """Return the blade turned to its place."""
    about = Rotation(axis=(0.0, 1.0, 0.0), angle_deg=index * 360.0 / BLADES)
    blade = Instance(type="instance", of="blade", name=f"blade-{index + 1}")
    return Transformed(type="transformed", solid=blade, rotate=about)


def _hub(radius: float) -> Ellipsoid:
    """Return the ellipsoid, flat in front and behind."""
    return Ellipsoid(
        type="ellipsoid",
        name="hub",
        material="fan",
        center=(0.0, 0.0, 0.0),
        semi_axes=(radius, _HUB_DEPTH * radius, radius),
        cuts=(
            Cut(point=(0.0, _HUB_FRONT * radius, 0.0), normal=(0.0, -1.0, 0.0)),
            Cut(point=(0.0, _HUB_BACK * radius, 0.0), normal=(0.0, 1.0, 0.0)),
        ),
    )


def build(parameters: Parameters) -> Document:
    """Return the fan, its hub about the origin and its axis along y: face on from the front."""
    blades = tuple(_turned(index) for index in range(BLADES))
    return Document(
        format="phantom/1",
        name="fan",
        title="Rotary fan of 1993",
        description=_SUMMARY,
        materials={"fan": FixedMaterial(attenuation_per_mm=parameters.attenuation_per_mm)},
        definitions={"blade": _blade(parameters)},
        solid=Union(
            type="union", solids=(_hub(parameters.hub_share * parameters.radius_mm), *blades)
        ),
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        sources=("Hsu, Chelberg 1993, section IV.B and figure 9.",),
        parameters=parameters.model_dump(mode="json"),
    )


entry = Entry(
    name="fan",
    title="Rotary fan of 1993",
    summary=_SUMMARY,
    parameters=Parameters,
    build=build,
    views=("ap", "left_lateral"),
)
