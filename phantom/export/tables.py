"""What the labels and parts of an exported phantom are made of."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

from phantom.document.identity import identity
from phantom.document.substances import composition, density_g_cm3
from phantom.encode import sidecar
from phantom.errors import InvalidInputError, Problem
from phantom.imaging.beam import attenuations_per_mm
from phantom.materials import check_energy
from phantom.scene import Phantom

AXES: Final = "LPS: +x patient left, +y back, +z head"
ABSENT: Final = "absent"
"""Name of label 0: nothing is there."""


@dataclass(frozen=True)
class MaterialRow:
    """One label, or one material.

    Attributes
    ----------
    label
        Value of a voxel; the place of a material in the document, counted from 1.
    name
        Of the material; of several that ``overlap`` keeps in one place, their names joined by
        ``+``, one that adds to itself with its count.
    count_of
        How often each material is present.
    density_g_cm3
        The sum over them; None where one has no density.
    composition
        Mass fraction of each element; None where one material has none.
    attenuation_per_mm
        At the energy of the table, the sum over them.
    """

    label: int
    name: str
    count_of: dict[str, int]
    density_g_cm3: float | None
    composition: dict[str, float] | None
    attenuation_per_mm: float


def check_table_energy(energy_kev: float) -> None:
    """Refuse a photon energy outside the tables (``/energy_kev``)."""
    problems = [Problem("/energy_kev", p.kind, p.message) for p in check_energy(energy_kev)]
    if problems:
        raise InvalidInputError(problems)


def material_rows(
    phantom: Phantom, energy_kev: float, mixtures: Sequence[tuple[int, ...]] = ()
) -> tuple[MaterialRow, ...]:
    """Return the row of label 0, of every material, and of every mixture.

    Parameters
    ----------
    phantom
        Whose materials.
    energy_kev
        Photon energy of the attenuation.
    mixtures
        How often each material is present, for the labels after those of the materials.

    Raises
    ------
    InvalidInputError
        At ``/energy_kev``, where the energy is outside the tables.
    """
    check_table_energy(energy_kev)
    count = len(phantom.material_names)
    single = [tuple(int(k == m) for k in range(count)) for m in range(count)]
    attenuations = attenuations_per_mm(phantom.document.materials, energy_kev).tolist()
    counts = [tuple([0] * count), *single, *mixtures]
    return tuple(_row(phantom, label, of, attenuations) for label, of in enumerate(counts))


def _row(
    phantom: Phantom, label: int, counts: tuple[int, ...], attenuations: Sequence[float]
) -> MaterialRow:
    names = phantom.material_names
    present = [(names[m], n) for m, n in enumerate(counts) if n]
    materials = phantom.document.materials
    densities = [density_g_cm3(materials[name]) for name, _ in present]
    elements = [composition(materials[name]) for name, _ in present]
    total: float | None = 0.0
    fractions: dict[str, float] | None = {}
    for (_, n), density, inside in zip(present, densities, elements, strict=True):
        if density is None or inside is None or total is None or fractions is None:
            total = fractions = None
            continue
        total += n * density
        for symbol, share in inside.items():
            fractions[symbol] = fractions.get(symbol, 0.0) + n * density * share
    if total and fractions:
        fractions = {symbol: mass / total for symbol, mass in fractions.items()}
    name = "+".join(f"{n} {name}" if n > 1 else name for name, n in present)
    return MaterialRow(
        label,
        name or ABSENT,
        dict(present),
        total,
        fractions,
        float(sum(n * a for n, a in zip(counts, attenuations, strict=True))),
    )


def table_json(
    phantom: Phantom, energy_kev: float, rows: Sequence[MaterialRow], **more: Any
) -> bytes:
    """Return a table as JSON, with what it is of and what its numbers mean."""
    content: Mapping[str, Any] = {
        **identity(phantom.document),
        **more,
        "energy_kev": energy_kev,
        "units": {"density": "g/cm3", "composition": "g/g", "attenuation": "1/mm"},
        "materials": [asdict(row) for row in rows],
    }
    return sidecar(content)


def table_csv(rows: Sequence[MaterialRow]) -> bytes:
    """Return a table as CSV: label, name, density, attenuation, and a column an element."""
    symbols = sorted({symbol for row in rows for symbol in row.composition or ()})
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["label", "name", "density_g_cm3", "attenuation_per_mm", *symbols])
    for row in rows:
        density = "" if row.density_g_cm3 is None else f"{row.density_g_cm3:.9g}"
        shares = row.composition
        writer.writerow(
            [
                row.label,
                row.name,
                density,
                f"{row.attenuation_per_mm:.9g}",
                *("" if shares is None else f"{shares.get(s, 0.0):.9g}" for s in symbols),
            ]
        )
    return text.getvalue().encode()
