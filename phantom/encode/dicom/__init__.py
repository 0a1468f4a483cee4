"""DICOM: Digital X-Ray and Digital Mammography, for presentation and for processing."""

from phantom.encode.dicom.intensity import judged
from phantom.encode.dicom.stereometric import stereometric
from phantom.encode.dicom.writing import for_presentation, for_processing

__all__ = ["for_presentation", "for_processing", "judged", "stereometric"]
