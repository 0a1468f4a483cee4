"""What a sound document amounts to: its parts, where they are, how much of what."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from phantom.document import Document, Material, Model, told
from phantom.document.substances import density_g_cm3
from phantom.scene import Phantom
from phantom.tracing import measure

Bounds = tuple[tuple[float, float, float], tuple[float, float, float]]


class LeafSummary(Model):
    """One leaf of the phantom."""

    label: Annotated[str, told("Label", "none", "The names from the root, joined by /.")]
    material: Annotated[str | None, told("Material", "none", "What it is made of.")]
    bounds_mm: Annotated[Bounds, told("Bounds", "mm", "Least and greatest corner.")]


class MaterialSummary(Model):
    """How much there is of one material."""

    name: Annotated[str, told("Name", "none", "As in the document.")]
    volume_mm3: Annotated[float, told("Volume", "mm³", "Where it is present.")]
    density_g_cm3: Annotated[float | None, told("Density", "g/cm³", "Null where none is known.")]
    mass_g: Annotated[float | None, told("Mass", "g", "Null where the density is not known.")]


class DocumentSummary(Model):
    """A document that was accepted, measured."""

    name: Annotated[str, told("Name", "none", "As in the document.")]
    title: Annotated[str, told("Title", "none", "As in the document.")]
    leaves: Annotated[tuple[LeafSummary, ...], told("Leaves", "none", "Every leaf.")]
    bounds_mm: Annotated[Bounds, told("Bounds", "mm", "Least and greatest corner.")]
    volume_mm3: Annotated[float, told("Volume", "mm³", "Of the final solid.")]
    volume_relative_error: Annotated[
        float, told("Relative error", "none", "Of the volume, estimated.")
    ]
    materials: Annotated[tuple[MaterialSummary, ...], told("Materials", "none", "All of them.")]
    mass_g: Annotated[
        float | None, told("Mass", "g", "Null where something present has no known density.")
    ]
    warnings: Annotated[
        tuple[str, ...], told("Warnings", "none", "What to know about solids that are sound.")
    ]


def summarise(phantom: Phantom, cancelled: Callable[[], bool] | None = None) -> DocumentSummary:
    """Measure a phantom; volumes are right to 0.1 %."""
    document: Document = phantom.document
    measured = measure(phantom, cancelled=cancelled)
    materials = tuple(
        _material(name, document.materials[name], float(volume))
        for name, volume in zip(
            phantom.material_names, measured.volume_by_material_mm3, strict=True
        )
    )
    present = [material.mass_g for material in materials if material.volume_mm3 > 0]
    masses = [mass for mass in present if mass is not None]
    return DocumentSummary(
        name=document.name,
        title=document.title,
        leaves=_leaves(phantom),
        bounds_mm=_bounds(phantom.bounds.tolist()),
        volume_mm3=float(measured.volume_mm3),
        volume_relative_error=float(measured.relative_error),
        materials=materials,
        mass_g=sum(masses) if len(masses) == len(present) else None,
        warnings=phantom.warnings,
    )


def _material(name: str, material: Material, volume_mm3: float) -> MaterialSummary:
    density = density_g_cm3(material)
    mass = None if density is None else density * volume_mm3 / 1000.0
    return MaterialSummary(name=name, volume_mm3=volume_mm3, density_g_cm3=density, mass_g=mass)


def _leaves(phantom: Phantom) -> tuple[LeafSummary, ...]:
    names = phantom.material_names
    return tuple(
        LeafSummary(
            label=label,
            material=names[material] if material >= 0 else None,
            bounds_mm=_bounds(bounds),
        )
        for label, material, bounds in zip(
            phantom.leaf_names,
            phantom.leaf_materials.tolist(),
            phantom.leaf_bounds.tolist(),
            strict=True,
        )
    )


def _bounds(corners: list[list[float]]) -> Bounds:
    (x0, y0, z0), (x1, y1, z1) = corners
    return ((x0, y0, z0), (x1, y1, z1))
