"""Label volumes as MetaImage, ITK's own format: the world is LPS, as the document's."""

from __future__ import annotations

import zlib

from phantom.export.volumes import LabelVolume

_ELEMENTS = {1: "MET_UCHAR", 2: "MET_USHORT"}


def mha(volume: LabelVolume) -> bytes:
    """Return a ``.mha`` file: header and compressed voxels, x fastest."""
    voxels = volume.labels.astype(volume.labels.dtype.newbyteorder("<")).tobytes(order="F")
    packed = zlib.compress(voxels, 6)
    # ITK calls axes that run to the left, the back and the head RAI, for where they come from.
    header = {
        "ObjectType": "Image",
        "NDims": "3",
        "BinaryData": "True",
        "BinaryDataByteOrderMSB": "False",
        "CompressedData": "True",
        "CompressedDataSize": str(len(packed)),
        "TransformMatrix": "1 0 0 0 1 0 0 0 1",
        "Offset": _numbers(volume.origin_mm),
        "CenterOfRotation": "0 0 0",
        "AnatomicalOrientation": "RAI",
        "ElementSpacing": _numbers(volume.spacing_mm),
        "DimSize": " ".join(str(n) for n in volume.labels.shape),
        "ElementType": _ELEMENTS[volume.labels.dtype.itemsize],
        "ElementDataFile": "LOCAL",
    }
    text = "".join(f"{name} = {value}\n" for name, value in header.items())
    return text.encode("ascii") + packed


def _numbers(values: tuple[float, float, float]) -> str:
    return " ".join(f"{value:.12g}" for value in values)
