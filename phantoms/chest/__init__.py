"""The chest: ribs, spine, shoulder girdle, lungs with vessels, heart, diaphragm, soft parts."""

from __future__ import annotations

from dataclasses import replace

from phantom.library import Entry, Technique
from phantoms.chest.abnormalities import KINDS
from phantoms.chest.document import SUMMARY, build
from phantoms.chest.parameters import Parameters, of_person
from phantoms.chest.sources import SOURCES

__all__ = ["SOURCES", "Parameters", "build", "entry"]

_PA = Technique(
    kvp=120.0,
    source_detector_mm=1800.0,
    object_detector_mm=150.0,
    window=(3.75, 4.7),
    air_kerma_ugy=2.5,
    field_mm=410.0,
)
_LATERAL = replace(_PA, object_detector_mm=240.0, window=(5.0, 5.0))

entry = Entry(
    name="chest",
    title="Chest",
    summary=SUMMARY,
    parameters=Parameters,
    build=build,
    views=("pa", "left_lateral"),
    technique=_PA,
    techniques={"left_lateral": _LATERAL},
    abnormalities=KINDS,
    of_person=of_person,
)
