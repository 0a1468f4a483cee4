"""The modules of the Digital X-Ray and Digital Mammography objects (PS3.3 A.26, A.27)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from numpy.typing import NDArray

from phantom.encode.attributes import json_text
from phantom.encode.content import Content
from phantom.encode.dicom.anatomy import (
    DX_ANATOMY,
    DX_VIEW,
    MAMMOGRAPHY_VIEW,
    VIEW_POSITIONS,
    body_part,
    code_item,
    coded,
)
from phantom.encode.dicom.facts import Facts
from phantom.encode.dicom.identity import Identity
from phantom.encode.dicom.intensity import Intensity
from phantom.encode.dicom.orientation import (
    mammogram_angle_deg,
    mammogram_laterality,
    mammogram_view,
    patient_orientation,
    positioner_angles_deg,
    projection_view,
)

if TYPE_CHECKING:
    from pydicom import Dataset

NOT_FOR_DIAGNOSIS: Final = "Synthetic image of a modelled phantom. NOT FOR DIAGNOSTIC USE."
PRIVATE_GROUP: Final = 0x0099
PRIVATE_CREATOR: Final = "PHANTOM-XRAY"


def decimal(value: float) -> Any:
    """Return a number as a decimal string, of 16 characters at most."""
    from pydicom.valuerep import DSfloat

    return DSfloat(float(value), auto_format=True)


def patient(dataset: Dataset, who: Identity, name: str) -> None:
    """Say that nobody was X-rayed: Patient, General Study and Patient Study."""
    dataset.PatientName = f"{who.patient_id}^SYNTHETIC"
    dataset.PatientID = who.patient_id
    dataset.PatientBirthDate = ""
    dataset.PatientSex = ""
    dataset.QualityControlSubject = "YES"
    dataset.PatientComments = NOT_FOR_DIAGNOSIS
    dataset.StudyInstanceUID = who.study_uid
    dataset.StudyDate = ""
    dataset.StudyTime = ""
    dataset.ReferringPhysicianName = ""
    dataset.StudyID = ""
    dataset.AccessionNumber = ""
    if name:
        dataset.StudyDescription = _short(name)


def series(dataset: Dataset, who: Identity, facts: Facts, *, presented: bool, blind: bool) -> None:
    """Say what kind of images these are, and what made them: General, DX and Mammography Series."""
    dataset.Modality = "MG" if facts.is_mammogram else "DX"
    dataset.SeriesInstanceUID = who.series_uid
    dataset.SeriesNumber = 1
    dataset.PresentationIntentType = "FOR PRESENTATION" if presented else "FOR PROCESSING"
    dataset.Manufacturer = facts.software
    dataset.ManufacturerModelName = facts.software
    if not blind:
        dataset.SoftwareVersions = facts.version


def image(
    dataset: Dataset, pixels: NDArray[Any], content: Content, facts: Facts, found: Intensity
) -> None:
    """Put the pixels and what they mean: General Image, Image Pixel, DX Image."""
    rows, columns = pixels.shape
    bits = 8 * pixels.dtype.itemsize
    dataset.ImageType = ["ORIGINAL", "PRIMARY", ""]
    dataset.InstanceNumber = 1
    dataset.ContentDate = ""
    dataset.ContentTime = ""
    dataset.PatientOrientation = patient_orientation(facts)
    dataset.ImageComments = NOT_FOR_DIAGNOSIS
    dataset.BurnedInAnnotation = "NO"
    dataset.LossyImageCompression = "00"
    dataset.SamplesPerPixel = 1
    dataset.PhotometricInterpretation = "MONOCHROME2"
    dataset.PresentationLUTShape = "IDENTITY"
    dataset.Rows, dataset.Columns = rows, columns
    dataset.BitsAllocated = dataset.BitsStored = bits
    dataset.HighBit = bits - 1
    dataset.PixelRepresentation = 0
    dataset.PixelIntensityRelationship = found.relationship
    dataset.PixelIntensityRelationshipSign = found.sign
    dataset.RescaleIntercept, dataset.RescaleSlope, dataset.RescaleType = 0, 1, "US"
    dataset.AcquisitionContextSequence = []
    stored = pixels.astype(pixels.dtype.newbyteorder("<")).tobytes()
    dataset.PixelData = stored + b"\0" * (len(stored) % 2)
    dataset["PixelData"].VR = "OB" if bits == 8 else "OW"
    if content.told:
        block = dataset.private_block(PRIVATE_GROUP, PRIVATE_CREATOR, create=True)
        block.add_new(0x01, "UT", json_text(content.told))


def whole_window(dataset: Dataset, pixels: NDArray[Any]) -> None:
    """Map every stored value to itself: VOI LUT, which For Presentation needs.

    PS3.3 C.11.2.1.2.1, LINEAR: with this centre and width the least value is black and the
    greatest white.
    """
    levels = float(2 ** (8 * pixels.dtype.itemsize))
    dataset.WindowCenter, dataset.WindowWidth = decimal(levels / 2), decimal(levels)
    dataset.WindowCenterWidthExplanation = "AS PRESENTED"
    dataset.VOILUTFunction = "LINEAR"


def detector(dataset: Dataset, facts: Facts) -> None:
    """Say how large a pixel is, and what held it: DX Detector, DX Positioning."""
    across, down = facts.pitch_mm
    dataset.DetectorType = ""
    dataset.PositionerType = "MAMMOGRAPHIC" if facts.is_mammogram else "CARM"
    dataset.ImagerPixelSpacing = [decimal(down), decimal(across)]


def positioning(dataset: Dataset, facts: Facts) -> None:
    """Say where the tube stood: DX Positioning."""
    if facts.source_detector_mm is not None:
        distance = facts.source_detector_mm
        dataset.DistanceSourceToDetector = decimal(distance)
        if facts.magnification is not None:
            dataset.DistanceSourceToPatient = decimal(distance / facts.magnification)
            dataset.EstimatedRadiographicMagnificationFactor = decimal(facts.magnification)
    if facts.is_mammogram:
        dataset.PositionerPrimaryAngle = decimal(mammogram_angle_deg(facts))
    else:
        primary, secondary = positioner_angles_deg(facts)
        dataset.PositionerPrimaryAngle = decimal(primary)
        dataset.PositionerSecondaryAngle = decimal(secondary)


def generation(dataset: Dataset, facts: Facts) -> None:
    """Say what the tube did: X-Ray Generation, X-Ray Filtration."""
    if facts.kvp is not None:
        dataset.KVP = decimal(facts.kvp)
    if facts.anode is not None:
        dataset.AnodeTargetMaterial = facts.anode.upper()
    if facts.filtration_mm:
        names = [_code_string(name) for name in facts.filtration_mm]
        dataset.FilterMaterial = ["ALUMINUM" if n == "ALUMINIUM" else n for n in names]
        thicknesses = [decimal(value) for value in facts.filtration_mm.values()]
        dataset.FilterThicknessMinimum = thicknesses
        dataset.FilterThicknessMaximum = thicknesses
    if facts.mas is not None:
        dataset.ExposureInuAs = round(facts.mas * 1000)


def anatomy(dataset: Dataset, facts: Facts) -> None:
    """Say what was X-rayed, and from where: DX Anatomy Imaged, Mammography Image, views."""
    part = body_part(facts.region)
    dataset.AnatomicRegionSequence = [] if part is None else [coded(DX_ANATOMY, part.concept)]
    if facts.region_code is not None:
        dataset.AnatomicRegionSequence = [code_item(*facts.region_code)]
    if part is not None:
        dataset.BodyPartExamined = part.examined
    if facts.is_mammogram:
        dataset.ImageLaterality = mammogram_laterality(facts)
        dataset.OrganExposed = "BREAST"
        group, view = MAMMOGRAPHY_VIEW, mammogram_view(facts)
    else:
        dataset.ImageLaterality = facts.laterality or "U"
        known = projection_view(facts)
        if known is None:
            return
        group, view = DX_VIEW, known
    item = coded(group, view)
    if facts.is_mammogram:
        item.ViewModifierCodeSequence = []
    dataset.ViewCodeSequence = [item]
    position = VIEW_POSITIONS.get(view)
    if position is not None:
        dataset.ViewPosition = position


def common(dataset: Dataset, who: Identity, sop_class: str) -> None:
    """Say which object this is, and that it is made up: SOP Common, General Image."""
    dataset.SpecificCharacterSet = "ISO_IR 192"
    dataset.SOPClassUID = sop_class
    dataset.SOPInstanceUID = who.image_uid
    dataset.SyntheticData = "YES"
    dataset.QualityControlImage = "YES"


def _short(text: str) -> str:
    """Return a text as a long string (LO): 64 characters, no backslash, no control character."""
    return "".join(c if c.isprintable() and c != "\\" else "_" for c in text)[:64]


def _code_string(text: str) -> str:
    """Return a name as a code string (CS): 16 of A-Z, 0-9, space and underscore."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in text.upper())[:16]
