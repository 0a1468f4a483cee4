"""A DICOM file from what it holds."""

from __future__ import annotations

import io
from typing import Final

from phantom.encode.content import Content
from phantom.encode.dicom import modules
from phantom.encode.dicom.facts import facts
from phantom.encode.dicom.identity import identity
from phantom.encode.dicom.intensity import Intensity

_ROOT: Final = "1.2.840.10008.5.1.4.1.1.1"
DIGITAL_X_RAY: Final = {True: f"{_ROOT}.1", False: f"{_ROOT}.1.1"}
DIGITAL_MAMMOGRAPHY: Final = {True: f"{_ROOT}.2", False: f"{_ROOT}.2.1"}
"""SOP classes, for presentation (True) and for processing (PS3.4 B.5)."""


def for_presentation(content: Content) -> bytes:
    """Return grey levels as a Digital X-Ray, or a mammogram, that a workstation shows as it is."""
    return _written(content, presented=True)


def for_processing(content: Content) -> bytes:
    """Return coded numbers as a Digital X-Ray, or a mammogram, before any presentation."""
    return _written(content, presented=False)


def _written(content: Content, *, presented: bool) -> bytes:
    from pydicom import Dataset
    from pydicom.dataset import FileMetaDataset
    from pydicom.uid import UID, ExplicitVRLittleEndian

    known, pixels = facts(content.metadata), content.only
    classes = DIGITAL_MAMMOGRAPHY if known.is_mammogram else DIGITAL_X_RAY
    sop_class = classes[presented]
    who = identity(content, known, sop_class)

    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = UID(sop_class)
    meta.MediaStorageSOPInstanceUID = UID(who.image_uid)
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    dataset = Dataset()
    dataset.file_meta = meta
    modules.common(dataset, who, sop_class)
    modules.patient(dataset, who, "" if content.blind else known.name)
    modules.series(dataset, who, known, presented=presented, blind=content.blind)
    modules.image(dataset, pixels, content, known, Intensity(*content.file["intensity"]))
    modules.detector(dataset, known)
    modules.anatomy(dataset, known)
    if not content.blind:
        modules.positioning(dataset, known)
        modules.generation(dataset, known)
    if presented:
        modules.whole_window(dataset, pixels)
    buffer = io.BytesIO()
    dataset.save_as(buffer, enforce_file_format=True)
    return buffer.getvalue()
