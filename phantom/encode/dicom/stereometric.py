"""The Stereometric Relationship object: which two images are the left and the right eye's.

PS3.3 A.43 and C.8.18. It has no pixels of its own.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from phantom.encode.dicom.identity import uid

if TYPE_CHECKING:
    from pydicom import Dataset

STEREOMETRIC_RELATIONSHIP: Final = "1.2.840.10008.5.1.4.1.1.77.1.5.3"

SHARED: Final = (
    "SpecificCharacterSet",
    "PatientName",
    "PatientID",
    "PatientBirthDate",
    "PatientSex",
    "QualityControlSubject",
    "PatientComments",
    "StudyInstanceUID",
    "StudyDate",
    "StudyTime",
    "ReferringPhysicianName",
    "StudyID",
    "AccessionNumber",
    "StudyDescription",
    "Manufacturer",
    "ManufacturerModelName",
    "SoftwareVersions",
    "SyntheticData",
)
"""What is said of patient, study and equipment as the images say it."""


def stereometric(left: bytes, right: bytes, geometry: Mapping[str, Any]) -> bytes:
    """Return the object that pairs two DICOM images.

    Parameters
    ----------
    left, right
        The files of the two images, of one patient and study.
    geometry
        ``baseline_mm`` or ``angle_deg`` of the pair, where it is to be told; empty for a blind one.
    """
    from pydicom import Dataset, dcmread
    from pydicom.dataset import FileMetaDataset
    from pydicom.uid import UID, ExplicitVRLittleEndian

    images = [dcmread(io.BytesIO(data), stop_before_pixels=True) for data in (left, right)]
    names = [str(image.SOPInstanceUID) for image in images]
    dataset = Dataset()
    for name in SHARED:
        if name in images[0]:
            setattr(dataset, name, getattr(images[0], name))
    dataset.SOPClassUID = STEREOMETRIC_RELATIONSHIP
    dataset.SOPInstanceUID = uid(["stereometric", *names])
    dataset.Modality = "SMR"
    dataset.SeriesInstanceUID = uid(["stereometric series", *names])
    dataset.SeriesNumber = 2
    dataset.InstanceNumber = 1
    dataset.Laterality = {"L": "L", "R": "R"}.get(images[0].get("ImageLaterality", ""), "")
    pair = Dataset()
    pair.LeftImageSequence, pair.RightImageSequence = ([_reference(image)] for image in images)
    if geometry.get("baseline_mm") is not None:
        pair.StereoBaselineDisplacement = float(geometry["baseline_mm"])
    if geometry.get("angle_deg") is not None:
        pair.StereoBaselineAngle = float(geometry["angle_deg"])
    # No row or column is to be moved, nor an image turned, to see the pair as it was made.
    pair.StereoHorizontalPixelOffset = pair.StereoVerticalPixelOffset = pair.StereoRotation = 0.0
    dataset.StereoPairsSequence = [pair]
    dataset.ReferencedSeriesSequence = _series(images)
    # A program that does not look into the pair finds here that there are references at all;
    # dciodvfy is one.
    dataset.ReferencedImageSequence = [_reference(image) for image in images]

    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = UID(STEREOMETRIC_RELATIONSHIP)
    meta.MediaStorageSOPInstanceUID = UID(dataset.SOPInstanceUID)
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    dataset.file_meta = meta
    buffer = io.BytesIO()
    dataset.save_as(buffer, enforce_file_format=True)
    return buffer.getvalue()


def _reference(image: Dataset) -> Dataset:
    from pydicom import Dataset

    item = Dataset()
    item.ReferencedSOPClassUID = image.SOPClassUID
    item.ReferencedSOPInstanceUID = image.SOPInstanceUID
    return item


def _series(images: Sequence[Dataset]) -> list[Dataset]:
    """Return the items of Common Instance Reference: each series once, with its images."""
    from pydicom import Dataset

    found: dict[str, dict[str, Dataset]] = {}
    for image in images:
        of_series = found.setdefault(str(image.SeriesInstanceUID), {})
        of_series[str(image.SOPInstanceUID)] = _reference(image)
    items = []
    for name, references in found.items():
        item = Dataset()
        item.SeriesInstanceUID = name
        item.ReferencedInstanceSequence = list(references.values())
        items.append(item)
    return items
