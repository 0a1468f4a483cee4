"""What a DICOM header has to know, drawn from the metadata of a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Facts:
    """A result, as far as DICOM has words for it.

    Attributes
    ----------
    beam
        Unit vector of the central ray, from the source to the detector's centre; world axes LPS.
    named_beam
        The one that the view has its name by: of a stereo pair that between the eyes.
    right, down
        Unit vectors along the picture's rows and columns.
    pitch_mm
        Distance of pixel centres along a row and down a column, at the detector.
    source_detector_mm
        From the source to the detector's centre; None for a parallel beam.
    magnification
        Of the isocentre; None where it is not known.
    region, region_code, laterality
        The body part, its code (value, scheme, meaning) where the document gives one, and ``R``,
        ``L`` or None.
    name, document_sha256
        Of the phantom.
    software, version
        What made it.
    kvp, anode, filtration_mm, mas
        Tube voltage in kV, the anode's element, filters by substance, and tube load in mAs; None
        or empty where there is no tube.
    """

    beam: Vector
    named_beam: Vector
    right: Vector
    down: Vector
    pitch_mm: tuple[float, float]
    source_detector_mm: float | None
    magnification: float | None
    region: str | None
    region_code: tuple[str, str, str] | None
    laterality: str | None
    name: str
    document_sha256: str
    software: str
    version: str
    kvp: float | None
    anode: str | None
    filtration_mm: Mapping[str, float]
    mas: float | None

    @property
    def is_mammogram(self) -> bool:
        """True for a breast seen from overhead or from the side, as a mammography unit does."""
        return (
            self.region == "breast" and abs(self.named_beam[1]) < 1e-3 and self.named_beam[2] < 1e-3
        )


def facts(metadata: Mapping[str, Any]) -> Facts:
    """Return what the metadata of a radiograph says of it."""
    view, phantom, beam = metadata["view"], metadata["phantom"], metadata["beam"]
    detector = view["detector"]
    ray = _central_ray(view)
    distance = None if view["source"] is None else float(np.linalg.norm(ray))
    middle = metadata.get("stereo", {}).get("view", view)
    anatomy = phantom.get("anatomy") or {}
    side = str(anatomy.get("laterality") or "").lower()
    pitch_x, pitch_y = metadata["pitch_mm"]
    return Facts(
        beam=_unit(ray),
        named_beam=_unit(_central_ray(middle)),
        right=_unit(detector["right"]),
        down=_unit(detector["down"]),
        pitch_mm=(float(pitch_x), float(pitch_y)),
        source_detector_mm=distance,
        magnification=metadata.get("magnification"),
        region=_lower(anatomy.get("region")),
        region_code=_code((anatomy.get("codes") or {}).get("AnatomicRegionSequence")),
        laterality={"right": "R", "r": "R", "left": "L", "l": "L"}.get(side),
        name=str(phantom["name"]),
        document_sha256=phantom["document_sha256"],
        software=metadata["software"]["name"],
        version=metadata["software"]["version"],
        kvp=beam.get("kvp"),
        anode=beam.get("anode"),
        filtration_mm=beam.get("filtration_mm") or {},
        mas=(metadata.get("acquisition") or {}).get("mas"),
    )


def _code(told: Mapping[str, str] | None) -> tuple[str, str, str] | None:
    return None if told is None else (told["value"], told["scheme"], told["meaning"])


def _central_ray(view: Mapping[str, Any]) -> NDArray[np.float64]:
    """Return the way from the source to the detector's centre, or along a parallel beam."""
    if view["source"] is None:
        return np.asarray(view["direction"], dtype=np.float64)
    return np.asarray(np.subtract(view["detector"]["center"], view["source"]))


def _lower(word: str | None) -> str | None:
    return None if word is None else word.strip().lower().replace("_", " ")


def _unit(vector: Any) -> Vector:
    array: NDArray[np.float64] = np.asarray(vector, dtype=np.float64)
    x, y, z = (array / np.linalg.norm(array)).tolist()
    return (x, y, z)
