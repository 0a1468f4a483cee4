"""A radiograph as it is asked for, from the request to the arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.metadata import version
from typing import Annotated, Any, Literal, TypeVar, cast

import numpy as np
from pydantic import Field

from phantom import library
from phantom.document import Model, told
from phantom.document.base import Boolean
from phantom.document.identity import content_sha256
from phantom.encode import Format, check_held
from phantom.errors import InvalidInputError, Problem
from phantom.imaging import (
    Acquisition,
    Beam,
    DetectorGrid,
    NoiseKey,
    Presentation,
    Radiograph,
    Truth,
    View,
    document_sha256,
    ground_truth,
    radiograph,
)
from phantom.imaging.beam import DEFAULT_ANODE
from phantom.imaging.presentation import OF_MODE
from phantom.imaging.refusals import check_exposure
from phantom.imaging.truth import Kind
from phantom.imaging.truth_trace import check_kinds
from phantom.requests.exposures import check_cost, words_of
from phantom.requests.limits import Limits
from phantom.requests.subject import LibraryPhantom, Subject, read_request
from phantom.requests.viewpoint import PlacedView, PresetView, Viewpoint, view_of
from phantom.scene import Phantom

ModelT = TypeVar("ModelT", bound=Model)
Quantity = Literal["signal", "transmission", "line_integral", "path_lengths"]


class RadiographRequest(Model):
    """What is X-rayed, from where and how; everything but the phantom has a default."""

    phantom: Annotated[Subject, told("Phantom", "none", "What is X-rayed.")]
    view: Annotated[Viewpoint, told("View", "none", "From where.")] = Field(
        default_factory=PresetView
    )
    detector: Annotated[DetectorGrid, told("Detector", "none", "The pixels.")] = Field(
        default_factory=DetectorGrid
    )
    beam: Annotated[Beam, told("Beam", "none", "The photons.")] = Field(default_factory=Beam)
    acquisition: Annotated[
        Acquisition | None,
        told("Acquisition", "none", "Dose, focal spot, scatter, detector; null for an ideal one."),
    ] = None
    noise: Annotated[NoiseKey, told("Noise", "none", "Whose noise an acquisition has.")] = Field(
        default_factory=NoiseKey
    )
    quantity: Annotated[Quantity, told("Quantity", "none", "What a pixel holds.")] = "signal"
    presentation: Annotated[Presentation, told("Presentation", "none", "How it is shown.")] = Field(
        default_factory=Presentation
    )
    truth: Annotated[
        tuple[Kind, ...],
        told("Ground truth", "none", "What to tell of every named leaf; the answer is an archive."),
    ] = ()
    blind: Annotated[
        Boolean, told("Blind", "none", "True leaves out of the file what it says of itself.")
    ] = False


@dataclass(frozen=True, slots=True)
class RadiographPlan:
    """A radiograph with every default filled in and every limit checked, not yet traced."""

    phantom: Phantom
    view: View
    beam: Beam
    acquisition: Acquisition | None
    noise: NoiseKey | None
    """None where the request says nothing of it."""
    quantity: Quantity
    presentation: Presentation
    chosen: dict[str, object]
    """The value of every flat word (`phantom.requests.words`) that has one."""
    blind: bool = False
    truth: tuple[Kind, ...] = ()
    """Kinds of ground truth; none for the picture alone."""

    def fingerprint(self) -> str:
        """Return a hash of all that the result depends on, the same for equal requests."""
        content = {
            "engine": version("phantom-xray"),
            "encoder": [version("OpenImageIO"), version("pydicom")],
            "document": document_sha256(self.phantom.document),
            "view": self.view.model_dump(mode="json"),
            "beam": self.beam.model_dump(mode="json"),
            **self._exposure(),
            "quantity": self.quantity,
            "presentation": self.presentation.model_dump(mode="json"),
            "blind": self.blind,
            "truth": self.truth,
        }
        return content_sha256(content)

    def _exposure(self) -> dict[str, object]:
        """Return what the detector's image depends on; nothing for an ideal one."""
        if self.acquisition is None:
            return {}
        noise = (self.noise or NoiseKey()).model_dump(mode="json")
        return {"acquisition": self.acquisition.model_dump(mode="json"), "noise": noise}

    def check_format(self, format: Format) -> None:
        """Refuse a file format that cannot hold the quantity, before anything is traced."""
        check_held(format, self.quantity)
        display = self.presentation.gsdf
        if format.name == "dicom" and display is not None and display.response is not None:
            message = "found a response, but a DICOM file holds P-values; expected none"
            raise InvalidInputError(
                [Problem("/presentation/gsdf/response", "not_in_format", message)]
            )

    def render(
        self,
        *,
        workers: int | None = None,
        cancelled: Callable[[], bool] | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> Radiograph:
        """Trace it, on so many threads; the result does not depend on their number.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        """
        return radiograph(
            self.phantom,
            self.view,
            self.beam,
            acquisition=self.acquisition,
            noise=self.noise,
            workers=workers,
            cancelled=cancelled,
            progress=progress,
            keep_path_lengths=self.quantity not in ("signal", "transmission"),
        )

    def tell(
        self,
        *,
        workers: int | None = None,
        cancelled: Callable[[], bool] | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> Truth:
        """Trace its ground truth, on so many threads.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        """
        return ground_truth(
            self.phantom,
            self.view,
            self.truth,
            workers=workers,
            cancelled=cancelled,
            progress=progress,
        )


def plan(
    tree: object, known: Iterable[Problem] = (), limits: Limits | None = None
) -> RadiographPlan:
    """Return what a request, as decoded from JSON, asks for.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request.
    """
    request, phantom = read_request(RadiographRequest, tree, known)
    planned = plan_of(request, phantom, limits)
    planned.presentation.check_alone()
    return planned


def plan_of(
    request: RadiographRequest,
    phantom: Phantom,
    limits: Limits | None = None,
    images: int = 1,
) -> RadiographPlan:
    """Return what a request asks for, of a phantom that is ready.

    Limits count so many ``images``, such as the two of a pair.

    The phantom need not be the one that the request describes, which then only says whose views
    and techniques hold: a series prepares each phantom once.

    Raises
    ------
    InvalidInputError
        As for :func:`plan`.
    """
    technique, recommended = library.Technique(), "ap"
    if isinstance(request.phantom, LibraryPhantom):
        entry = library.entry(request.phantom.name)
        recommended = entry.views[0]
        technique = entry.technique_of(_preset(request.view, recommended))
    grid = request.detector
    # A detector is square where only its columns are given.
    if "rows" not in grid.model_fields_set:
        grid = grid.model_copy(update={"rows": grid.columns})
    limits = limits or Limits()
    limits.check_radiograph(grid.columns, grid.rows, len(phantom.material_names), images)
    kinds = check_kinds(request.truth)
    if kinds:
        limits.check_truth(grid.columns, grid.rows, len(phantom.named_leaves), images)
    view = view_of(phantom, request.view, grid, technique, recommended)
    detector = view.detector
    beam = _beam(request.beam, technique)
    acquisition, noise = _acquisition(request, technique), request.noise
    check_cost(acquisition, detector, beam, phantom.document.materials, limits, images)
    check_exposure(phantom, view, beam, acquisition)
    window = technique.window_of(phantom.document.parameters)
    presentation = _presentation(request.presentation, technique.polarity, window)
    chosen = {
        **_placing(phantom, request.view, view, recommended),
        "columns": detector.columns,
        "rows": detector.rows,
        "pitch_mm": detector.pitch_mm,
        **_beam_words(beam),
        **words_of(acquisition, noise),
        "quantity": request.quantity,
        **presentation.model_dump(exclude_none=True),
        **({"truth": ",".join(kinds)} if kinds else {}),
    }
    return RadiographPlan(
        phantom,
        view,
        beam,
        acquisition,
        noise if "noise" in request.model_fields_set else None,
        request.quantity,
        presentation,
        chosen,
        request.blind,
        kinds,
    )


def _filled(model: ModelT, **defaults: object) -> ModelT:
    """Return the model with these values where the request left them out, still marked as such."""
    said = {name: getattr(model, name) for name in model.model_fields_set}
    content = {**dict(model), **defaults, **said}
    return cast("ModelT", model.model_construct(_fields_set=model.model_fields_set, **content))


def _presentation(
    asked: Presentation, polarity: str, window: tuple[float, float] | None
) -> Presentation:
    """Return the presentation with what the request left out as the technique has it.

    The technique's window is used where the request wants a window but gives none, or says nothing
    of the mapping at all.

    Raises
    ------
    InvalidInputError
        A window is wanted and there is none.
    """
    usual: dict[str, object] = {"polarity": polarity}
    silent = not {"mode", "scope", *OF_MODE} & asked.model_fields_set
    wanting = asked.mode == "window" and asked.window_center is None
    if window is not None and (silent or wanting):
        center, width = window
        usual |= {"mode": "window", "scope": "fixed"}
        usual |= {"window_center": center, "window_width": width}
    filled = _filled(asked, **usual)
    if filled.mode == "window":
        _ = filled.window  # refused here, before anything is traced
    return filled


def _acquisition(request: RadiographRequest, technique: library.Technique) -> Acquisition | None:
    """Return the exposure; the technique's dose where the request says nothing of it."""
    asked, usual = request.acquisition, technique.air_kerma_ugy
    if usual is None or (asked is None and "acquisition" in request.model_fields_set):
        return asked
    if asked is None:
        return Acquisition(detector_air_kerma_ugy=usual)
    if {"mas", "detector_air_kerma_ugy"} & asked.model_fields_set:
        return asked
    return _filled(asked, detector_air_kerma_ugy=usual)


def _beam(asked: Beam, technique: library.Technique) -> Beam:
    """Return the beam with what the request left out as the technique has it.

    What is said of the tube is kept; a voltage alone keeps the technique's anode and filters, and
    another anode has filters of its own.
    """
    said: dict[str, Any] = {name: getattr(asked, name) for name in asked.model_fields_set}
    if "energy_kev" in said:
        return asked
    usual: dict[str, Any]
    if technique.kvp is None and "kvp" not in said:
        usual = {"energy_kev": technique.energy_kev}
    else:
        usual = {"kvp": technique.kvp, "anode": technique.anode}
        own_anode = technique.anode or DEFAULT_ANODE
        if technique.filtration_mm is not None and said.get("anode", own_anode) == own_anode:
            usual["filtration_mm"] = dict(technique.filtration_mm)
    return _filled(asked, **Beam(**{**usual, **said}).model_dump())


def _beam_words(beam: Beam) -> dict[str, object]:
    """Return the words of a beam; filters as a query string would have them."""
    if beam.kvp is None:
        return {"energy_kev": beam.energy_kev}
    filters = ",".join(f"{name}={mm:g}" for name, mm in (beam.filtration_mm or {}).items())
    return {"kvp": beam.kvp, "anode": beam.anode, "filtration": filters or "none"}


def _preset(wanted: PresetView | PlacedView, recommended: str) -> str | None:
    """Return the clinical word of a view; None for one with a source and a detector."""
    if isinstance(wanted, PlacedView):
        return None
    return wanted.preset if "preset" in wanted.model_fields_set else recommended


def _placing(
    phantom: Phantom, wanted: PresetView | PlacedView, view: View, recommended: str
) -> dict[str, object]:
    """Return the words of a preset as it came out; a view in full has none."""
    if isinstance(wanted, PlacedView):
        return {}
    aim = phantom.isocentre if wanted.isocentre is None else wanted.isocentre
    center = view.detector.center
    return {
        "view": _preset(wanted, recommended),
        "source_detector_mm": _distance_mm(center, view.source or center),
        "object_detector_mm": _distance_mm(center, aim),
    }


def _distance_mm(one: Iterable[float], other: Iterable[float]) -> float:
    return round(float(np.linalg.norm(np.subtract(tuple(one), tuple(other)))), 6)
