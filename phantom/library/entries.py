"""What the library knows of one phantom."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Generic, TypeVar

from pydantic import BaseModel

from phantom.document import Document, Model, told
from phantom.document.base import Name
from phantom.library.people import Population

if TYPE_CHECKING:
    import numpy as np

    from phantom.library.people import Person

ParametersT = TypeVar("ParametersT", bound=BaseModel)


class Abnormality(Model):
    """Something wrong with a phantom, of known size and place.

    Those of a phantom derive from it; each has a ``type`` of its own, a ``Literal`` with a default.
    """

    name: Annotated[
        Name | None,
        told("Name", "none", "Of the finding; its type, with a number if repeated, by default."),
    ] = None


@dataclass(frozen=True, slots=True)
class Technique:
    """How a phantom is X-rayed when a request does not say: what a radiographer would set.

    Attributes
    ----------
    energy_kev
        Energy of the monochromatic beam, where there is no ``kvp``.
    kvp, anode, filtration_mm
        Tube voltage in kV, anode and filters (material to mm); None for the latter two means what a
        beam has by default.
    source_detector_mm, object_detector_mm
        Distances from the detector to the source and to the isocentre; None for the latter means
        as near as the phantom lets it.
    polarity
        ``bones_white``, or ``bones_dark`` as in the paper.
    window
        Centre and width of the one range of line integrals that is shown, so that no lesion and no
        case shifts another's greys; None for a stretch of each image by itself, as in the paper.
    window_follows
        A length among the document's parameters, the millimetres of it that ``window`` is for, and
        by how much the centre rises for each one more: as an exposure control does with thickness.
    field_mm
        Width and height of the detector, so that pictures of all people have one scale and show
        what a radiographer would; None for one that the whole phantom falls on.
    air_kerma_ugy
        Air kerma at the detector of a real exposure, with its noise; None for the ideal image, as
        test objects have it.
    """

    energy_kev: float = 60.0
    source_detector_mm: float = 1150.0
    object_detector_mm: float | None = None
    polarity: str = "bones_white"
    window: tuple[float, float] | None = None
    window_follows: tuple[str, float, float] | None = None
    kvp: float | None = None
    anode: str | None = None
    filtration_mm: Mapping[str, float] | None = None
    air_kerma_ugy: float | None = None
    field_mm: float | None = None

    def window_of(self, parameters: Mapping[str, object]) -> tuple[float, float] | None:
        """Return centre and width of the window for a phantom with these parameters."""
        if self.window is None or self.window_follows is None:
            return self.window
        name, usual_mm, slope_per_mm = self.window_follows
        found = parameters.get(name)
        over_mm = found - usual_mm if isinstance(found, int | float) else 0.0
        center, width = self.window
        return round(center + slope_per_mm * over_mm, 6), width


@dataclass(frozen=True, slots=True)
class Entry(Generic[ParametersT]):
    """One phantom of the library.

    Attributes
    ----------
    name
        Its name in the library, as in ``phantom radiograph NAME``.
    title, summary
        One line, and a paragraph that says what it is made of and where that comes from.
    parameters
        A frozen pydantic model; every field has a default, a unit and a range.
    build
        Turns checked parameters into the document. Where the phantom has abnormalities it takes
        a second argument, the tuple of the checked ones that are asked for; it tells each as one of
        the document's ``findings``, and refuses one that does not fit with paths under
        ``/abnormalities/i``. Without any it gives the healthy twin: same materials, in the same
        order (those of abnormalities last), same leaves otherwise.
    views
        Preset views worth looking at, the best first.
    technique
        The defaults of its radiographs.
    techniques
        Those of single preset views, in place of ``technique``.
    abnormalities
        What can be wrong with it: type to model.
    of_person
        Draws the parameters of a person, with the scatter that people of that size and age have;
        None for a phantom that is nobody.
    people
        Who a series X-rays where nothing else is said.
    """

    name: str
    title: str
    summary: str
    parameters: type[ParametersT]
    build: Callable[..., Document]
    views: tuple[str, ...] = ("ap", "left_lateral")
    technique: Technique = field(default_factory=Technique)
    techniques: Mapping[str, Technique] = field(default_factory=dict)
    abnormalities: Mapping[str, type[Abnormality]] = field(default_factory=dict)
    of_person: Callable[[Person, np.random.Generator], ParametersT] | None = None
    people: Population = field(default_factory=Population)

    def technique_of(self, view: str | None) -> Technique:
        """Return the defaults of a preset view; None is a view with a source and a detector."""
        return self.techniques.get(view, self.technique) if view is not None else self.technique
