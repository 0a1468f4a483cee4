"""One radiograph: path lengths, Beer's law, and what was done to get there.

One energy: ``path_lengths`` L (mm of each material) → ``line_integral`` Σ μ_m(E) L_m →
``transmission`` exp(−Σ μ_m L_m) → ``signal``, the transmission of one unit of photons.

A spectrum: ``transmission`` is the signal over that of the open field, Σ_k w_k exp(−Σ_m μ_km L_m)
over the bins k, each weighted by its photons and by what one of them adds to the signal; the
weights w add up to 1. ``line_integral`` is −ln(transmission): what a person takes for Σ μ L who has
only the image. It grows less than in proportion to the path length, which is beam hardening.

With an acquisition, ``signal`` is what its detector reads. The other three stay ideal: they belong
to the one ray from the view's source to the pixel's centre, without dose, focal spot, scatter,
noise and blur. Only the signal averages the samples of a pixel and the points of a focal spot, and
it averages what comes through (after the exponential), not path lengths.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, TypedDict, get_args

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.beam import Beam
from phantom.imaging.beer import line_integral, transmission
from phantom.imaging.camera import Projection, projection
from phantom.imaging.detection import Acquisition, DetectorModel, Exposed, NoiseKey
from phantom.imaging.detection.scintillator import response as photon_response
from phantom.imaging.presentation import GreyArray, Presentation, present
from phantom.imaging.presentation_stage import presentation_stage
from phantom.imaging.spectrum import Spectrum
from phantom.imaging.traces import Traces
from phantom.imaging.truncation import truncated
from phantom.imaging.truth import KINDS, Truth
from phantom.imaging.tube import spectrum_stages
from phantom.imaging.view import FloatArray, View

if TYPE_CHECKING:
    from phantom.scene import Phantom

Quantity = Literal["signal", "transmission", "line_integral", "path_lengths"]

QUANTITIES: Final[tuple[Quantity, ...]] = get_args(Quantity)
"""Every quantity a radiograph has; ``path_lengths`` has one value a pixel and material."""

IMAGES: Final = QUANTITIES[:3]
"""The quantities with one value a pixel."""


class Scale(TypedDict):
    """What a presentation must know of a quantity, as arguments of :func:`present`."""

    rises_with_attenuation: bool
    open_field: float


@dataclass(frozen=True, eq=False)
class Radiograph:
    """What an X-ray of a phantom gives. Arrays cannot be written to.

    Attributes
    ----------
    phantom, view, beam
        What was X-rayed, from where, with what.
    kept
        The path lengths, where they were kept.
    left
        The transmission, where it was reckoned with the trace.
    spectrum
        The K photon energies that the image is summed over; one for a beam of one energy.
    attenuation_per_mm
        (M,) linear attenuation coefficients for one energy, (K, M) for a spectrum.
    acquisition
        Dose, focal spot, scatter, grid and detector; None for the ideal image.
    noise
        Whose noise the signal has.
    exposed
        What the acquisition's detector read; None without one.
    warnings
        What was asked for and had no effect, or is likely to surprise.
    """

    phantom: Phantom
    view: View
    beam: Beam
    kept: FloatArray | None
    left: FloatArray | None
    spectrum: Spectrum
    attenuation_per_mm: FloatArray
    acquisition: Acquisition | None
    noise: NoiseKey
    exposed: Exposed | None
    warnings: tuple[str, ...]

    @property
    def weights(self) -> FloatArray:
        """(K,) share of each photon energy in the signal of the open field; they add up to 1.

        Each photon counts with what the detector makes of it; with its energy where there is no
        acquisition.
        """
        return signal_weights(self.spectrum, self._model)

    @property
    def _model(self) -> DetectorModel:
        return DetectorModel() if self.acquisition is None else self.acquisition.detector

    @cached_property
    def path_lengths(self) -> FloatArray:
        """(rows, columns, M) mm of each material between source and pixel.

        They are in the order of ``phantom.material_names``, and 0 where a material is missed. Where
        they were not kept they are traced once more.
        """
        if self.kept is not None:
            return self.kept
        return sealed(Traces(self.phantom, self.view, None).centres())

    @cached_property
    def line_integral(self) -> FloatArray:
        """(rows, columns) Σ μ_m(E) L_m for one energy, −ln(transmission) for a spectrum.

        Without unit; 0 where everything is missed.
        """
        if self.attenuation_per_mm.ndim == 2:
            with np.errstate(divide="ignore"):  # nothing is left behind too much: infinite
                return sealed(np.maximum(-np.log(self.transmission), 0.0))
        return sealed(line_integral(self._lengths, self.attenuation_per_mm))

    @cached_property
    def transmission(self) -> FloatArray:
        """(rows, columns) share of the open field's signal that is left, by Beer's law."""
        if self.left is not None:
            return self.left
        return sealed(transmission(self._lengths, self.attenuation_per_mm, self.weights))

    @cached_property
    def truncated(self) -> tuple[str, ...]:
        """Names of the leaves that are not wholly in the field."""
        return truncated(self.phantom, self.view, projection(self.view))

    @property
    def _lengths(self) -> FloatArray:
        """(M, rows, columns), as they lie in memory."""
        return np.moveaxis(self.path_lengths, -1, 0)

    @property
    def signal(self) -> FloatArray:
        """(rows, columns) what the detector reads, in :attr:`signal_unit`.

        Without an acquisition 1 in the open field: the transmission.
        """
        return self.transmission if self.exposed is None else self.exposed.signal

    @property
    def signal_unit(self) -> str:
        """``1``, a share of the open field, or ``photons``, ``keV``, ``signal`` or ``codes``."""
        return "1" if self.exposed is None else self.exposed.unit

    @property
    def open_field(self) -> float:
        """What the signal is on average at the detector's centre with nothing in the way."""
        return 1.0 if self.exposed is None else self.exposed.open_field

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
        return present(self.image(name), _alone(presentation), **self.scale(name))

    def shown(
        self, name: str = "signal", presentation: Presentation | None = None
    ) -> dict[str, Any]:
        """Return the stage that makes the grey levels, with its values, as plain JSON values."""
        return presentation_stage(self.image(name), _alone(presentation), **self.scale(name))

    def image(self, name: str) -> FloatArray:
        """Return a quantity that has one value a pixel."""
        image = self.quantity(name)
        if name not in IMAGES:
            message = f"{name!r} is no image; a picture shows one of {', '.join(IMAGES)}"
            raise InvalidInputError([Problem("/quantity", "not_an_image", message)])
        return image

    def scale(self, name: str) -> Scale:
        """Return what a presentation must know of a quantity."""
        return {
            "rises_with_attenuation": name == "line_integral",
            "open_field": self.open_field if name == "signal" else 1.0,
        }

    def truth(self, kinds: Iterable[str] = KINDS, **run: Any) -> Truth:
        """Return what the picture shows, leaf by leaf; see :func:`phantom.imaging.ground_truth`.

        Parameters
        ----------
        kinds
            Some of ``masks``, ``thickness``, ``boxes``, ``entry_depth``, ``centroids`` and
            ``landmarks``.
        run
            ``workers``, ``cancelled`` and ``progress``, as in :func:`phantom.imaging.radiograph`.
        """
        from phantom.imaging.truth_trace import ground_truth

        return ground_truth(self.phantom, self.view, kinds, **run)

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
        return (
            {"stage": "path_lengths", "unit": "mm", "beam": _beam_kind(self.view)},
            *spectrum_stages(self.beam),
            {
                "stage": "beer_lambert",
                **self._coefficients(),
                "coherent_scattering": "included",
            },
            *(
                ({"stage": "signal", "open_field": 1.0, "response": self._model.response},)
                if self.exposed is None
                else self.exposed.stages
            ),
        )

    def _coefficients(self) -> dict[str, Any]:
        """Return the energies and what each material has at them, for `stages`."""
        energies = self.spectrum.energies_kev.tolist()
        by_material = dict(
            zip(self.phantom.material_names, self.attenuation_per_mm.T.tolist(), strict=True)
        )
        if self.attenuation_per_mm.ndim == 1:
            return {"energy_kev": energies[0], "attenuation_per_mm": by_material}
        return {
            "energies_kev": energies,
            "weights": self.weights.tolist(),
            "attenuation_per_mm": by_material,
        }

    def metadata(self) -> dict[str, Any]:
        """Return what a file should say of this radiograph, as plain JSON values."""
        from phantom.imaging.metadata import metadata

        return metadata(self)


def _alone(presentation: Presentation | None) -> Presentation | None:
    """Return the presentation of one image; refused where it asks for a pair."""
    if presentation is not None:
        presentation.check_alone()
    return presentation


def signal_weights(spectrum: Spectrum, model: DetectorModel) -> FloatArray:
    """Return (K,) share of each photon energy in the signal of the open field."""
    counted = spectrum.shares * photon_response(model, spectrum.energies_kev).weights[:, 1]
    weights: FloatArray = counted / float(counted.sum())
    return weights


def _beam_kind(view: View) -> str:
    return "parallel" if view.source is None else "point source"


def sealed(array: FloatArray) -> FloatArray:
    """Return the array, made read-only."""
    array.setflags(write=False)
    return array
