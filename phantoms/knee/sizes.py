"""How large the parts of a knee are: every length that the bones are drawn from, in mm."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sizes:
    """Lengths of one knee in mm, its angles in degrees, its densities in g/cm³.

    ``limb`` is how far the limb reaches above and below the joint; the thickness of a cortex is
    that at midshaft, half a bone's length from the joint.
    """

    limb: float
    bicondylar_width: float
    condylar_depth: float
    notch_width: float
    femur_length: float
    femur_shaft: float
    femur_cortex: float
    valgus_deg: float
    plateau_width: float
    plateau_depth: float
    slope_deg: float
    tibia_length: float
    tibia_shaft: float
    tibia_cortex: float
    fibula_shaft: float
    fibula_cortex: float
    patella_height: float
    patella_width: float
    patella_thickness: float
    joint_space: float
    fat: float
    muscle: float
    cortical_density: float
    spongiosa_density: float
    trabecular_seed: int
