"""Phantoms for other programs: meshes, and volumes of labels, with a table of their materials."""

from phantom.export.files import (
    DEFAULT_SPACING_MM,
    DEFAULT_TOLERANCE_MM,
    MESH_FORMATS,
    VOLUME_FORMATS,
    Exported,
    export_mesh,
    export_volume,
)
from phantom.export.models import Part, What, model
from phantom.export.tables import MaterialRow
from phantom.export.volumes import LabelVolume, label_volume

__all__ = [
    "DEFAULT_SPACING_MM",
    "DEFAULT_TOLERANCE_MM",
    "MESH_FORMATS",
    "VOLUME_FORMATS",
    "Exported",
    "LabelVolume",
    "MaterialRow",
    "Part",
    "What",
    "export_mesh",
    "export_volume",
    "label_volume",
    "model",
]
