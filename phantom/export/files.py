"""Files for other programs, by extension: meshes and volumes of labels, with their tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from phantom.encode import write_atomically
from phantom.encode.files import check_place
from phantom.encode.formats import by_extension
from phantom.export.meshes import glb, obj, stl, stl_archive
from phantom.export.mha import mha
from phantom.export.models import Part, What, check_what, model
from phantom.export.nifti import nifti, nifti_gz
from phantom.export.tables import AXES, MaterialRow, material_rows, table_csv, table_json
from phantom.export.volumes import Spacing, check_spacing, label_volume
from phantom.scene import Phantom
from phantom.tessellation import check_tolerance
from phantom.tessellation.regions import check_extra

DEFAULT_TOLERANCE_MM: Final = 0.1
DEFAULT_SPACING_MM: Final = 1.0
DEFAULT_ENERGY_KEV: Final = 60.0

Told = Mapping[str, Mapping[str, Any]]

MESH_FORMATS: Final[Mapping[str, tuple[str, ...]]] = {
    ".stl": (),
    ".stl.zip": (),
    ".obj": (),
    ".glb": ("trimesh",),
}
"""Extension to the packages it needs."""

VOLUME_FORMATS: Final[Mapping[str, tuple[str, ...]]] = {
    ".nii": ("nibabel",),
    ".nii.gz": ("nibabel",),
    ".mha": (),
}
"""Extension to the packages it needs."""

_TABLES: Final = {".json": ".json", ".csv": ".csv"}


@dataclass(frozen=True)
class Exported:
    """What was written.

    Attributes
    ----------
    output, table
        Paths of the file and of the table beside it.
    told
        What the table says of the file: parts, or voxels.
    """

    output: Path
    table: Path
    told: Mapping[str, Any]


def is_volume(output: Path | str) -> bool:
    """Tell whether a file's extension is that of a volume rather than of a mesh.

    Raises
    ------
    InvalidInputError
        At ``/output``, where it is neither.
    """
    return _extension(output, {**MESH_FORMATS, **VOLUME_FORMATS}) in VOLUME_FORMATS


def export_mesh(
    phantom: Phantom,
    output: Path | str,
    *,
    what: What = "leaves",
    tolerance_mm: float = DEFAULT_TOLERANCE_MM,
    energy_kev: float = DEFAULT_ENERGY_KEV,
    table: Path | str | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Exported:
    """Write a phantom as closed meshes, and a table of its parts and materials beside them.

    Parameters
    ----------
    phantom
        What is written.
    output
        Ends in ``.stl`` (one file, mm, no names), ``.stl.zip`` (a file a part), ``.obj`` (mm,
        named objects) or ``.glb`` (metres, y up, named and coloured).
    what
        ``leaves``, ``parts`` or ``result``, see :func:`phantom.export.model`.
    tolerance_mm
        How far a triangle may lie from the surface.
    energy_kev
        Photon energy of the attenuation in the table.
    table
        Where the table goes to, JSON or CSV; by default beside the file, ``.materials.json``.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts leaves.

    Raises
    ------
    InvalidInputError
        At ``/output``, ``/table``, ``/what``, ``/tolerance_mm`` or ``/energy_kev``; nothing is
        written then.
    CancelledError
        Where ``cancelled`` said yes.
    """
    extension = _extension(output, MESH_FORMATS)
    check_extra("/output", *MESH_FORMATS[extension])
    beside = _places(output, extension, table)
    check_what(what)
    check_tolerance(tolerance_mm)
    rows = material_rows(phantom, energy_kev)
    parts = model(phantom, tolerance_mm, what, cancelled=cancelled, progress=progress)
    unit = {"unit": "m", "axes": "glTF: +x patient left, +y head, +z front"}
    if extension != ".glb":
        unit = {"unit": "mm", "axes": AXES}
    told = {
        **unit,
        "what": what,
        "tolerance_mm": tolerance_mm,
        "parts": [_part(part) for part in parts],
    }
    listed = _table(beside, phantom, energy_kev, rows, told)
    match extension:
        case ".stl":
            data = stl(parts)
        case ".stl.zip":
            data = stl_archive(parts, table_json(phantom, energy_kev, rows, **told))
        case ".obj":
            data = obj(parts)
        case _:
            data = glb(parts, _extras(parts, rows, energy_kev))
    write_atomically(output, data)
    write_atomically(beside, listed)
    return Exported(Path(output), beside, told)


def export_volume(
    phantom: Phantom,
    output: Path | str,
    *,
    spacing_mm: Spacing = DEFAULT_SPACING_MM,
    energy_kev: float = DEFAULT_ENERGY_KEV,
    table: Path | str | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Exported:
    """Write a phantom as a volume of labels, and the table of its labels beside it.

    Parameters
    ----------
    phantom
        What is written.
    output
        Ends in ``.nii``, ``.nii.gz`` (NIfTI, RAS) or ``.mha`` (MetaImage, LPS).
    spacing_mm
        One length, or three along x, y and z; see :func:`phantom.export.label_volume`.
    energy_kev
        Photon energy of the attenuation in the table.
    table
        Where the table goes to, JSON or CSV; by default beside the file, ``.materials.json``.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts rows of voxels.

    Raises
    ------
    InvalidInputError
        At ``/output``, ``/table``, ``/spacing_mm`` or ``/energy_kev``; nothing is written then.
    CancelledError
        Where ``cancelled`` said yes.
    """
    extension = _extension(output, VOLUME_FORMATS)
    check_extra("/output", *VOLUME_FORMATS[extension])
    beside = _places(output, extension, table)
    check_spacing(spacing_mm)
    volume = label_volume(
        phantom, spacing_mm, energy_kev=energy_kev, cancelled=cancelled, progress=progress
    )
    told = {
        "unit": "mm",
        "axes": AXES,
        "voxels": list(volume.labels.shape),
        "spacing_mm": list(volume.spacing_mm),
        "first_voxel_center_mm": list(volume.origin_mm),
    }
    whole = table_json(phantom, energy_kev, volume.rows, **told)
    listed = _table(beside, phantom, energy_kev, volume.rows, told)
    match extension:
        case ".nii":
            data = nifti(volume, whole)
        case ".nii.gz":
            data = nifti_gz(volume, whole)
        case _:
            data = mha(volume)
    write_atomically(output, data)
    write_atomically(beside, listed)
    return Exported(Path(output), beside, told)


def _extension(output: Path | str, known: Mapping[str, tuple[str, ...]]) -> str:
    return by_extension(output, {extension: extension for extension in known})


def _places(output: Path | str, extension: str, table: Path | str | None) -> Path:
    """Return where the table goes to, once both files are seen to have a place."""
    path = Path(output)
    beside = Path(table) if table is not None else None
    if beside is None:
        beside = path.with_name(f"{path.name[: -len(extension)]}.materials.json")
    else:
        by_extension(beside, _TABLES, "/table")
    check_place(path)
    check_place(beside)
    return beside


def _table(
    place: Path,
    phantom: Phantom,
    energy_kev: float,
    rows: tuple[MaterialRow, ...],
    told: Mapping[str, Any],
) -> bytes:
    if by_extension(place, _TABLES) == ".csv":
        return table_csv(rows)
    return table_json(phantom, energy_kev, rows, **told)


def _part(part: Part) -> dict[str, Any]:
    return {
        "name": part.name,
        "material": part.material,
        "triangles": len(part.mesh.triangles),
        "volume_mm3": part.mesh.volume_mm3,
    }


def _extras(parts: tuple[Part, ...], rows: tuple[MaterialRow, ...], energy_kev: float) -> Told:
    """Return what a viewer is told of each part."""
    known = {row.name: row for row in rows}
    return {
        part.name: {
            **_part(part),
            **({"energy_kev": energy_kev, **asdict(known[part.material])} if part.material else {}),
        }
        for part in parts
    }
