"""What a result says of the tube that a beam came from."""

from __future__ import annotations

from typing import Any

from phantom.imaging.beam import INHERENT_FILTRATION_MM, Beam
from phantom.imaging.spectrum_tables import ANODE_ANGLE_DEG


def spectrum_stages(beam: Beam) -> tuple[dict[str, Any], ...]:
    """Return the stage of the spectrum with its values; none for a beam of one energy.

    Half-value layers are of air kerma in aluminium, in a narrow beam. The output is that at 1 m
    from the focal spot, in vacuum.
    """
    if beam.kvp is None or beam.anode is None:
        return ()
    spectrum = beam.spectrum()
    return (
        {
            "stage": "spectrum",
            "anode": beam.anode,
            "anode_angle_deg": ANODE_ANGLE_DEG[beam.anode],
            "kvp": beam.kvp,
            "inherent_filtration_mm": dict(INHERENT_FILTRATION_MM),
            "filtration_mm": dict(beam.filtration_mm or {}),
            "mean_energy_kev": spectrum.mean_energy_kev,
            "half_value_layer_mm_aluminium": spectrum.half_value_layer_mm(),
            "second_half_value_layer_mm_aluminium": spectrum.second_half_value_layer_mm(),
            "homogeneity": spectrum.homogeneity(),
            "air_kerma_ugy_per_mas_at_1m": spectrum.air_kerma_ugy_per_mas_at_1m,
        },
    )
