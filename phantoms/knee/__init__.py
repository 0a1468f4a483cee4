"""The knee of a person."""

from __future__ import annotations

from phantom.library import Entry, Technique
from phantoms.knee.abnormalities import ABNORMALITIES
from phantoms.knee.body import SUMMARY, build
from phantoms.knee.parameters import Parameters, of_person

__all__ = ["Parameters", "build", "entry", "of_person"]

entry = Entry(
    name="knee",
    title="Knee",
    summary=SUMMARY,
    parameters=Parameters,
    build=build,
    views=("ap", "mediolateral", "lpo"),
    technique=Technique(
        kvp=65.0,
        source_detector_mm=1150.0,
        object_detector_mm=100.0,
        window=(2.6, 3.2),
        air_kerma_ugy=2.5,
    ),
    abnormalities=ABNORMALITIES,
    of_person=of_person,
)
