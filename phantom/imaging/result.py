"""One radiograph: path lengths, Beer's law, and what was done to get there.

``path_lengths`` L (mm of each material) → ``line_integral`` Σ μ_m(E) L_m → ``transmission``
exp(−Σ μ_m L_m) → ``signal``, the transmission of one monochromatic unit of photons.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, get_args

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.beam import Beam
from phantom.imaging.camera import Projection, projection
from phantom.imaging.presentation import GreyArray, Presentation, present
from phantom.imaging.view import FloatArray, View

if TYPE_CHECKING:
    from phantom.scene import Phantom

Quantity = Literal["signal", "transmission", "line_integral", "path_lengths"]

QUANTITIES: Final[tuple[Quantity, ...]] = get_args(Quantity)
"""Every quantity a radiograph has; ``path_lengths`` has one value a pixel and material."""

IMAGES: Final = QUANTITIES[:3]
"""The quantities with one value a pixel."""


@dataclass(frozen=True, eq=False)
class Radiograph:
    """What an X-ray of a phantom gives. Arrays cannot be written to.

    Attributes
    ----------
    phantom, view, beam
        What was X-rayed, from where, with what.
    path_lengths
        (rows, columns, M) mm of each material between source and pixel, in the order of
        ``phantom.material_names``; 0 where a material is missed.
    attenuation_per_mm
        (M,) linear attenuation coefficients at the beam's energy.
    truncated
        Names of the leaves that are not wholly in the field.
    warnings
        What was asked for and had no effect, or is likely to surprise.
    """

    phantom: Phantom
    view: View
    beam: Beam
    path_lengths: FloatArray
    attenuation_per_mm: FloatArray
    truncated: tuple[str, ...]
    warnings: tuple[str, ...]

    @cached_property
    def line_integral(self) -> FloatArray:
        """(rows, columns) Σ μ_m(E) L_m, without unit; 0 where everything is missed."""
        total = np.zeros(self.path_lengths.shape[:2])
        for index, attenuation in enumerate(self.attenuation_per_mm):
            total += attenuation * self.path_lengths[..., index]
        return sealed(total)

    @cached_property
    def transmission(self) -> FloatArray:
        """(rows, columns) fraction of the photons that reach the pixel, by Beer's law."""
        return sealed(np.exp(-self.line_integral))

    @property
    def signal(self) -> FloatArray:
        """(rows, columns) what the detector reads; for one unit of photons, the transmission."""
        return self.transmission

    def quantity(self, name: str) -> FloatArray:
        """Return a quantity by its name; see :data:`QUANTITIES`."""
        if name not in QUANTITIES:
            message = f"found {name!r}, expected one of {', '.join(QUANTITIES)}"
            raise InvalidInputError([Problem("/quantity", "unknown_quantity", message)])
        found: FloatArray = getattr(self, name)
        return found

    def presented(
        self, name: str = "signal", presentation: Presentation | None = None
    ) -> GreyArray:
        """Return the grey levels of a quantity that has one value a pixel."""
        image = self.quantity(name)
        if name not in IMAGES:
            message = f"{name!r} is no image; a picture shows one of {', '.join(IMAGES)}"
            raise InvalidInputError([Problem("/quantity", "not_an_image", message)])
        return present(image, presentation, rises_with_attenuation=name == "line_integral")

    @cached_property
    def projection(self) -> Projection:
        """The camera of the view."""
        return projection(self.view)

    @property
    def projection_matrix(self) -> FloatArray:
        """(3, 4) world mm to homogeneous (column, row)."""
        return self.projection.matrix

    @property
    def intrinsics(self) -> FloatArray:
        """(3, 3) K in pixels."""
        return self.projection.intrinsics

    @property
    def rotation(self) -> FloatArray:
        """(3, 3) R, a proper rotation from world to camera axes."""
        return self.projection.rotation

    @property
    def translation(self) -> FloatArray:
        """(3,) t in mm."""
        return self.projection.translation

    @cached_property
    def magnification(self) -> float | None:
        """How much larger than life the isocentre is; None if it is behind the source."""
        return self.projection.magnification(self.phantom.isocentre)

    @property
    def pitch_at_isocentre_mm(self) -> tuple[float, float] | None:
        """Pitch along a row and down a column, brought back to the isocentre."""
        if self.magnification is None:
            return None
        x, y = self.view.detector.pitch_xy_mm
        return x / self.magnification, y / self.magnification

    @property
    def stages(self) -> tuple[dict[str, Any], ...]:
        """Every stage that was applied, in order, with its values."""
        coefficients = zip(
            self.phantom.material_names, self.attenuation_per_mm.tolist(), strict=True
        )
        return (
            {"stage": "path_lengths", "unit": "mm", "beam": _beam_kind(self.view)},
            {
                "stage": "beer_lambert",
                "energy_kev": self.beam.energy_kev,
                "attenuation_per_mm": dict(coefficients),
                "coherent_scattering": "included",
            },
            {"stage": "signal", "photons": 1.0},
        )

    def metadata(self) -> dict[str, Any]:
        """Return what a file should say of this radiograph, as plain JSON values."""
        from phantom.imaging.metadata import metadata

        return metadata(self)


def _beam_kind(view: View) -> str:
    return "parallel" if view.source is None else "point source"


def sealed(array: FloatArray) -> FloatArray:
    """Return the array, made read-only."""
    array.setflags(write=False)
    return array
