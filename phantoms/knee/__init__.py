"""The knee of a person."""

from __future__ import annotations

from phantom.library import Entry, Technique
from phantoms.knee.abnormalities import ABNORMALITIES
from phantoms.knee.body import SUMMARY, build
from phantoms.knee.parameters import Parameters, of_person

__all__ = ["Parameters", "build", "entry", "of_person"]


def _technique(window: tuple[float, float]) -> Technique:
    """Return the usual technique: 65 kV, no grid, a field within the limb's cut ends."""
    return Technique(
        kvp=65.0,
        source_detector_mm=1150.0,
        window=window,
        air_kerma_ugy=2.5,
        field_mm=250.0,
    )


entry = Entry(
    name="knee",
    title="Knee",
    summary=SUMMARY,
    parameters=Parameters,
    build=build,
    views=("ap", "mediolateral", "lpo"),
    technique=_technique((3.1, 4.2)),
    techniques={"mediolateral": _technique((3.2, 4.6)), "lateromedial": _technique((3.2, 4.6))},
    abnormalities=ABNORMALITIES,
    of_person=of_person,
)
