"""The beam, and what it sees of each material.

Monochromatic: one photon energy, one linear attenuation coefficient a material. Of a tube: a
spectrum from the shipped tables, behind the window of the tube and the filters asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Final, Literal, Self

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from phantom.document.asked import Asked
from phantom.document.base import Name, Number, refuse, told
from phantom.document.substances import (
    CompositionMaterial,
    FixedMaterial,
    Material,
    ReferenceMaterial,
)
from phantom.imaging.spectrum import Spectrum, monochromatic
from phantom.imaging.spectrum_tables import Anode, anode_spectrum, check_kvp
from phantom.imaging.view import FloatArray
from phantom.materials import (
    FILTER_NAMES,
    attenuation_curve_per_mm,
    check_energy,
    filter_substance,
    k_edges_kev,
    reference,
)

Response = Literal["energy_integrating", "photon_counting"]
"""What a photon adds to a detector's signal: its energy, or one."""

ENERGY_KEV: Final = 60.0
"""Energy of the beam where nothing is said."""

INHERENT_FILTRATION_MM: Final[dict[str, float]] = {"beryllium": 0.5}
"""What every tube has in its beam: its window. Oil, glass and mirror are counted as filters."""

DEFAULT_ANODE: Final[Anode] = "tungsten"

DEFAULT_FILTRATION_MM: Final[dict[Anode, dict[str, float]]] = {
    "tungsten": {"aluminium": 2.5},
    "molybdenum": {"molybdenum": 0.03},
    "rhodium": {"rhodium": 0.025},
}
"""Filters where none are said: the least total filtration that IEC 60601-1-3 allows a radiographic
tube, and the usual filters of mammography."""

LARGEST_FILTER_MM: Final = 10_000.0
"""Thickest filter; metres of it are of air."""

LEAST_LEFT: Final = 1e-12
"""Least share of the anode's photons that filters may leave."""

FINE_KVP: Final = 50.0
"""Up to this voltage images are summed over the bins of the tables, above it over 1 keV."""

BIN_KEV: Final = 1.0

TRACE_SHARE: Final = 1e-6
"""The softest bins that together hold less than this share of the photons are not imaged."""

Thickness = Annotated[Number, Field(ge=0, le=LARGEST_FILTER_MM)]


class Beam(Asked):
    """A beam of one photon energy, or of a tube.

    What is left out is filled in: ``energy_kev`` if there is no ``kvp``, ``anode`` and
    ``filtration_mm`` if there is.
    """

    place: ClassVar[str] = "/beam"

    energy_kev: Annotated[
        Number | None,
        told("Energy", "keV", "Of every photon; 60 where neither it nor kvp is given."),
    ] = None
    anode: Annotated[
        Anode | None, told("Anode", "none", "Of the tube; tungsten where none is given.")
    ] = None
    kvp: Annotated[
        Number | None,
        told("Tube voltage", "kV", "Peak voltage, in place of energy_kev: a spectrum."),
    ] = None
    filtration_mm: Annotated[
        dict[Name, Thickness] | None,
        told("Filtration", "mm", "Reference material or element to thickness, after the window."),
    ] = None

    @field_validator("energy_kev")
    @classmethod
    def _is_served(cls, energy_kev: float | None) -> float | None:
        for problem in () if energy_kev is None else check_energy(energy_kev):
            refuse(problem.kind, ((), problem.message))
        return energy_kev

    @field_validator("kvp")
    @classmethod
    def _is_tabulated(cls, kvp: float | None, info: ValidationInfo) -> float | None:
        if kvp is None:
            return None
        if info.data.get("energy_kev") is not None:
            message = "found energy_kev and kvp; expected one of them"
            refuse("contradiction", ((), message))
        if "anode" in info.data:
            for problem in check_kvp(kvp, info.data["anode"] or DEFAULT_ANODE):
                refuse(problem.kind, ((), problem.message))
        return kvp

    @field_validator("filtration_mm")
    @classmethod
    def _is_known(cls, filtration_mm: dict[str, float] | None) -> dict[str, float] | None:
        unknown = [name for name in filtration_mm or () if name not in FILTER_NAMES]
        if unknown:
            expected = f"expected one of {', '.join(FILTER_NAMES)}"
            refuse(
                "unknown_material",
                *(((name,), f"found {name[:60]!r}; {expected}") for name in unknown),
            )
        return filtration_mm

    @model_validator(mode="after")
    def _is_whole(self) -> Self:
        # Straight into the model, which is frozen for others: null is not said.
        silent = {name for name in self.model_fields_set if getattr(self, name) is None}
        self.__pydantic_fields_set__.difference_update(silent)
        tube = {"anode": self.anode, "filtration_mm": self.filtration_mm}
        idle = [name for name, value in tube.items() if value is not None and self.kvp is None]
        if idle:
            expected = "expected it only with kvp, which a tube has"
            refuse(
                "no_effect", *(((name,), f"found {name} without kvp; {expected}") for name in idle)
            )
        if self.kvp is None:
            self._fill(energy_kev=ENERGY_KEV)
        else:
            self._fill(anode=DEFAULT_ANODE)
            assert self.anode is not None
            self._fill(filtration_mm=dict(DEFAULT_FILTRATION_MM[self.anode]))
            self._check_that_something_is_left()
        return self

    def _check_that_something_is_left(self) -> None:
        """Refuse filters behind which there is no beam."""
        assert self.kvp is not None
        assert self.anode is not None
        whole = anode_spectrum(self.anode, self.kvp).photons_per_mm2_mas_at_1m.sum()
        left = self.spectrum().photons_per_mm2_mas_at_1m.sum() / whole
        if left < LEAST_LEFT:
            message = f"found filters that let {left:.1g} of the photons through"
            refuse("no_beam", (("filtration_mm",), f"{message}; expected {LEAST_LEFT:g} or more"))

    def _fill(self, **values: object) -> None:
        """Put in what was left out; it does not count among what was said."""
        for name, value in values.items():
            if getattr(self, name) is None:
                self.__dict__[name] = value

    def spectrum(self, cut_at_kev: FloatArray | None = None) -> Spectrum:
        """Return the photons that leave the tube's last filter, or the one energy.

        Bins are cut at the K-edges of the filters, and at the energies ``cut_at_kev``, so that no
        bin has part of its photons below an edge and part above. Air in the way is not counted; it
        can be put among the filters.
        """
        if self.kvp is None:
            assert self.energy_kev is not None
            return monochromatic(self.energy_kev)
        assert self.anode is not None
        edges = self.filter_k_edges_kev
        if cut_at_kev is not None:
            edges = np.concatenate([edges, cut_at_kev])
        photons = anode_spectrum(self.anode, self.kvp).cut_at(edges)
        for filters in (INHERENT_FILTRATION_MM, self.filtration_mm or {}):
            for name, thickness_mm in filters.items():
                photons = photons.behind(name, thickness_mm)
        return photons

    @property
    def filter_k_edges_kev(self) -> FloatArray:
        """K-edges of the elements of the filters, rising."""
        names = [*INHERENT_FILTRATION_MM, *(self.filtration_mm or {})]
        elements = {symbol for n in names for symbol in filter_substance(n).composition}
        return np.array(k_edges_kev(elements), dtype=np.float64)

    def imaging_spectrum(self, materials: Mapping[str, Material]) -> Spectrum:
        """Return the spectrum that an image of these materials is summed over.

        Its bins lie on one side of every K-edge of the materials and the filters. Above 50 kV they
        are 1 keV wide, which moves a transmission of a thousandth by 0.15 % at most.
        """
        if self.kvp is None:
            return self.spectrum()
        edges = material_k_edges_kev(materials)
        fine = self.spectrum(edges)
        if self.kvp > FINE_KVP:
            fine = fine.grouped(BIN_KEV, np.concatenate([edges, self.filter_k_edges_kev]))
        return fine.without_traces(TRACE_SHARE)


def material_attenuation_per_mm(material: Material, energies_kev: FloatArray) -> FloatArray:
    """Return the (K,) linear attenuation of a document's material, in 1/mm."""
    match material:
        case FixedMaterial():
            return np.full(len(energies_kev), material.attenuation_per_mm)
        case ReferenceMaterial():
            named = reference(material.reference)
            density = material.density_g_cm3
            if density is None:
                density = named.density_g_cm3
            return attenuation_curve_per_mm(named.composition, density, energies_kev)
        case CompositionMaterial():
            return attenuation_curve_per_mm(
                material.composition, material.density_g_cm3, energies_kev
            )


def attenuations_per_mm(
    materials: Mapping[str, Material], energy_kev: float | FloatArray
) -> FloatArray:
    """Return the coefficients of a document's materials, in their order, in 1/mm.

    Returns
    -------
    numpy.ndarray
        (M,) for one energy; (K, M) for an array of K energies.
    """
    energies = np.atleast_1d(np.asarray(energy_kev, dtype=np.float64))
    curves = [material_attenuation_per_mm(m, energies) for m in materials.values()]
    found = np.array(curves, dtype=np.float64).reshape(len(curves), len(energies)).T
    return found[0] if np.ndim(energy_kev) == 0 else np.ascontiguousarray(found)


def material_k_edges_kev(materials: Mapping[str, Material]) -> FloatArray:
    """Return the K-edges of all elements of a document's materials, rising, in keV."""
    symbols: set[str] = set()
    for material in materials.values():
        if isinstance(material, ReferenceMaterial):
            symbols.update(reference(material.reference).composition)
        elif isinstance(material, CompositionMaterial):
            symbols.update(material.composition)
    return np.array(k_edges_kev(symbols), dtype=np.float64)


def depends_on_energy(materials: Mapping[str, Material]) -> bool:
    """Tell whether any material has another coefficient at another energy."""
    return any(not isinstance(material, FixedMaterial) for material in materials.values())
