"""A file for another program as it is asked for: a mesh, or a volume of labels."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Field

from phantom.document import Model, told
from phantom.document.base import Length, Number, refuse
from phantom.errors import InvalidInputError, Problem
from phantom.export import Exported, What, export_mesh, export_volume
from phantom.export.files import (
    DEFAULT_ENERGY_KEV,
    DEFAULT_SPACING_MM,
    DEFAULT_TOLERANCE_MM,
    is_volume,
)
from phantom.export.models import check_what
from phantom.export.tables import check_table_energy
from phantom.export.volumes import check_spacing
from phantom.requests.subject import Subject, read_request
from phantom.scene import Phantom
from phantom.tessellation import check_tolerance

EXPORT_WORDS: Final = {
    name: (name,) for name in ("what", "tolerance_mm", "spacing_mm", "energy_kev")
}
"""Where each flat word stands in a request."""

_OF_MESHES: Final = ("what", "tolerance_mm")
_OF_VOLUMES: Final = ("spacing_mm",)


def _spacing(given: Any) -> tuple[float, float, float]:
    try:
        return check_spacing(given)
    except InvalidInputError as error:
        refuse("out_of_range", ((), error.problems[0].message))


class ExportRequest(Model):
    """What is written, and how finely; all but the phantom has a default."""

    phantom: Annotated[Subject, told("Phantom", "none", "What is written.")]
    what: Annotated[
        What,
        told(
            "What",
            "none",
            "leaves: each by itself; parts: what the operators leave of each; result: where each"
            " material is in the final solid.",
        ),
    ] = "leaves"
    tolerance_mm: Annotated[
        Length, told("Tolerance", "mm", "How far a triangle may lie from the surface.")
    ] = DEFAULT_TOLERANCE_MM
    spacing_mm: Annotated[
        tuple[float, float, float],
        BeforeValidator(_spacing),
        told("Spacing", "mm", "Of voxels: one length, or three along x, y and z."),
    ] = (DEFAULT_SPACING_MM,) * 3
    energy_kev: Annotated[
        Annotated[Number, Field(gt=0)],
        told("Energy", "keV", "Photon energy of the attenuations in the table."),
    ] = DEFAULT_ENERGY_KEV


@dataclass(frozen=True, slots=True)
class ExportPlan:
    """A file with every default filled in, not yet made."""

    phantom: Phantom
    request: ExportRequest
    output: Path
    table: Path | None
    chosen: dict[str, object]
    """The value of every flat word that has an effect on this file."""

    def write(
        self,
        *,
        cancelled: Callable[[], bool] | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> Exported:
        """Make the file, and write it and its table.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        InvalidInputError
            What only shows when it is made: too many voxels or triangles.
        """
        asked = self.request
        if is_volume(self.output):
            return export_volume(
                self.phantom,
                self.output,
                spacing_mm=asked.spacing_mm,
                energy_kev=asked.energy_kev,
                table=self.table,
                cancelled=cancelled,
                progress=progress,
            )
        return export_mesh(
            self.phantom,
            self.output,
            what=asked.what,
            tolerance_mm=asked.tolerance_mm,
            energy_kev=asked.energy_kev,
            table=self.table,
            cancelled=cancelled,
            progress=progress,
        )


def plan_export(
    tree: object,
    known: Iterable[Problem] = (),
    *,
    output: Path | str,
    table: Path | str | None = None,
) -> ExportPlan:
    """Return what a request, as decoded from JSON, asks for.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request; fields that have no effect
        on a file of this kind are refused.
    """
    request, phantom = read_request(ExportRequest, tree, known)
    volume = is_volume(output)
    kind = "volume" if volume else "mesh"
    idle = _OF_MESHES if volume else _OF_VOLUMES
    problems = [
        Problem(f"/{name}", "no_effect", f"found it for a {kind}; expected none")
        for name in idle
        if name in request.model_fields_set
    ]
    if problems:
        raise InvalidInputError(problems)
    check_table_energy(request.energy_kev)
    if not volume:
        check_what(request.what)
        check_tolerance(request.tolerance_mm)
    chosen = {name: getattr(request, name) for name in EXPORT_WORDS if name not in idle}
    beside = None if table is None else Path(table)
    return ExportPlan(phantom, request, Path(output), beside, chosen)
