"""What can be wrong with a chest.

A nodule measures up to 30 mm and a mass more; both as radiologists use the words. A fluid level
that blunts the costophrenic angle and the rim of air of a pneumothorax are drawn as a PA view of a
standing person shows them. Ranges without a source are estimates.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Final, Literal

from phantom.document import told
from phantom.document.base import Coordinate, Fraction
from phantom.library import Abnormality
from phantoms.fields import count, millimetres

Side = Literal["right", "left"]
LungSite = Literal[
    "right apex",
    "right upper lobe",
    "right middle lobe",
    "right lower lobe",
    "left apex",
    "left upper lobe",
    "lingula",
    "left lower lobe",
]
Level = Literal["T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "T10", "T11", "T12", "L1"]

_SIDE = told("Side", "none", "Of the body.")
_NUMBER = told("Rib", "none", "Counted from the top.", ge=1, le=12, strict=True)


class _InLung(Abnormality):
    site: Annotated[LungSite, told("Site", "none", "The middle of a lobe, or an apex.")] = (
        "right upper lobe"
    )
    offset_mm: Annotated[
        tuple[Coordinate, Coordinate, Coordinate],
        told("Offset", "mm", "From the site, along x (left), y (back) and z (head)."),
    ] = (0.0, 0.0, 0.0)
    density_g_cm3: Annotated[
        float,
        told(
            "Density",
            "g/cm³",
            "Of soft tissue: 0.5 for ground glass, 1.06 for a solid one, 1.6 if calcified.",
            ge=0.3,
            le=2.5,
            strict=True,
        ),
    ] = 1.06


class Nodule(_InLung):
    """A round nodule in a lung."""

    type: Literal["nodule"] = "nodule"
    diameter_mm: Annotated[float, millimetres("Diameter", "Of the ball.", 2.0, 30.0)] = 12.0


class Mass(_InLung):
    """A lobed mass in a lung, with spicules or without."""

    type: Literal["mass"] = "mass"
    diameter_mm: Annotated[
        float, millimetres("Diameter", "Of the ball that holds its lobes.", 20.0, 90.0)
    ] = 40.0
    spicules: Annotated[int, count("Spicules", "None for a mass without.", 0, 60)] = 28
    spicule_mm: Annotated[float, millimetres("Spicule", "Length beyond the core.", 2.0, 30.0)] = (
        12.0
    )
    seed: Annotated[int, count("Seed", "Of its lobes and spicules.", 0, 2**31 - 1)] = 0


class Effusion(Abnormality):
    """Fluid in the pleural space, higher at the wall than toward the middle."""

    type: Literal["effusion"] = "effusion"
    side: Annotated[Side, _SIDE] = "right"
    depth_mm: Annotated[
        float, millimetres("Depth", "Of the fluid over the costophrenic angle.", 15.0, 120.0)
    ] = 40.0


class Pneumothorax(Abnormality):
    """Air between lung and wall: the lung is drawn in toward its hilum."""

    type: Literal["pneumothorax"] = "pneumothorax"
    side: Annotated[Side, _SIDE] = "left"
    rim_mm: Annotated[float, millimetres("Rim", "From the apex to the lung.", 5.0, 60.0)] = 25.0


class _InRib(Abnormality):
    side: Annotated[Side, _SIDE] = "right"
    rib: Annotated[int, _NUMBER] = 6
    along: Annotated[
        Fraction, told("Along", "1", "From its head (0) to its front end (1).", ge=0.08, le=0.95)
    ] = 0.5


class RibFracture(_InRib):
    """A rib broken across, its fragments apart and out of line."""

    type: Literal["rib_fracture"] = "rib_fracture"
    gap_mm: Annotated[float, millimetres("Gap", "Between the fragments.", 0.2, 5.0)] = 1.0
    step_mm: Annotated[
        float, millimetres("Step", "Of the front fragment, down along the wall.", 0.0, 8.0)
    ] = 3.0


class RibLesion(_InRib):
    """A lesion of a rib: bone lost to soft tissue, or denser than it was."""

    type: Literal["rib_lesion"] = "rib_lesion"
    kind: Annotated[Literal["lytic", "blastic"], told("Kind", "none", "Lost or gained bone.")] = (
        "lytic"
    )
    length_mm: Annotated[float, millimetres("Length", "Along the rib.", 4.0, 50.0)] = 22.0


class VertebralLesion(Abnormality):
    """A lesion in the body of a vertebra."""

    type: Literal["vertebral_lesion"] = "vertebral_lesion"
    level: Annotated[Level, told("Level", "none", "Which vertebra.")] = "T9"
    kind: Annotated[Literal["lytic", "blastic"], told("Kind", "none", "Lost or gained bone.")] = (
        "blastic"
    )
    diameter_mm: Annotated[float, millimetres("Diameter", "Of the ball.", 4.0, 18.0)] = 16.0
    offset_mm: Annotated[
        tuple[Coordinate, Coordinate, Coordinate],
        told("Offset", "mm", "From the middle of the body, along x, y and z."),
    ] = (0.0, 0.0, 0.0)


class Coin(Abnormality):
    """A swallowed coin, its face to the front."""

    type: Literal["coin"] = "coin"
    site: Annotated[
        Literal["upper oesophagus", "lower oesophagus", "stomach"],
        told("Site", "none", "Where it has stopped."),
    ] = "upper oesophagus"
    diameter_mm: Annotated[float, millimetres("Diameter", "Of the coin.", 14.0, 33.0)] = 23.0
    thickness_mm: Annotated[float, millimetres("Thickness", "Of the coin.", 0.8, 3.5)] = 2.0


class TrachealTube(Abnormality):
    """A tube in the trachea."""

    type: Literal["tracheal_tube"] = "tracheal_tube"
    tip_above_carina_mm: Annotated[
        float, millimetres("Tip", "Height over the carina; 50 is where it should be.", 5.0, 90.0)
    ] = 50.0


KINDS: Final[Mapping[str, type[Abnormality]]] = {
    "nodule": Nodule,
    "mass": Mass,
    "effusion": Effusion,
    "pneumothorax": Pneumothorax,
    "rib_fracture": RibFracture,
    "rib_lesion": RibLesion,
    "vertebral_lesion": VertebralLesion,
    "coin": Coin,
    "tracheal_tube": TrachealTube,
}
