"""A design: everything that a set of images depends on, as one document."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from importlib.metadata import version
from typing import Annotated, Any, Final, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.datasets.draws import Value
from phantom.document import Model, told
from phantom.document.base import Boolean, Choice, Fraction, Integer, Name, Text, refuse
from phantom.imaging import Acquisition, Beam, DetectorGrid, Presentation
from phantom.imaging.truth import Kind
from phantom.library import Population
from phantom.requests.subject import OwnPhantom
from phantom.requests.viewpoint import PlacedView, PresetView, Viewpoint
from phantom.requests.words import WHOLE, WORDS
from phantom.stereo import Stereo

MOST_IMAGES: Final = 100_000_000
"""An index has eight digits."""

SHARDED_ABOVE: Final = 10_000
"""Sets of more images come as WebDataset shards unless they say otherwise."""

SAMPLES_A_SHARD: Final = 1000

VARIED: Final = tuple(
    word
    for word, path in WORDS.items()
    if path[0] in ("view", "beam", "acquisition") and word not in WHOLE
)
"""The words of a request (`phantom.requests.words`) that may differ from image to image."""

_Count = Annotated[Integer, Field(ge=1, le=MOST_IMAGES)]
_SplitName = Annotated[str, Field(strict=True, pattern=r"^[a-z][a-z0-9_]{0,39}$")]

TAKEN: Final = ("truth", "coco", "index", "image", "images")
"""Names in a set that are no split's."""


class DrawnPhantom(Model):
    """A phantom of the library whose parameters may be drawn."""

    name: Annotated[Name, told("Name", "none", "A phantom of the library.")]
    parameters: Annotated[
        dict[Name, Value],
        told("Parameters", "none", "Each a value, or a distribution drawn anew for each person."),
    ] = Field(default_factory=dict)


def _subject(value: Any) -> str | None:
    if isinstance(value, Mapping):
        return "own" if "document" in value else "drawn"
    return {"OwnPhantom": "own", "DrawnPhantom": "drawn"}.get(type(value).__name__)


class DrawnAbnormality(Model):
    """Something that is wrong with some of the cases."""

    type: Annotated[Name, told("Type", "none", "One of the phantom's abnormalities.")]
    prevalence: Annotated[
        Fraction,
        told("Prevalence", "1", "Chance that a case has it, or the share of the cases that do."),
    ]
    parameters: Annotated[
        dict[Name, Value],
        told("Parameters", "none", "Each a value, or a distribution drawn anew for each case."),
    ] = Field(default_factory=dict)


class Outputs(Model):
    """What is kept of each image."""

    form: Annotated[
        Literal["linear", "presentation"],
        told(
            "Form",
            "none",
            "linear: 16 bits in proportion to the quantity; presentation: grey levels as shown.",
        ),
    ] = "linear"
    codes: Annotated[
        Boolean, told("Codes", "none", "The same 16 bits as an NPY beside the picture.")
    ] = False
    masks: Annotated[
        Boolean,
        told(
            "Masks",
            "none",
            "A picture of 0 and 255: what of the findings is seen, or of the named leaves where"
            " the design has no abnormality.",
        ),
    ] = True
    coco: Annotated[
        Boolean, told("COCO", "none", "A run-length mask of every leaf, one file a split.")
    ] = True
    documents: Annotated[
        Boolean, told("Documents", "none", "The phantom document of every case.")
    ] = True
    visibility: Annotated[
        Boolean,
        told(
            "Visibility",
            "none",
            "How well what is wrong is seen, beside the same picture without it; an abnormal image"
            " takes more than twice as long.",
        ),
    ] = False
    parquet: Annotated[
        Boolean, told("Parquet", "none", "An index of the whole set; needs the extra tables.")
    ] = False
    shards: Annotated[
        Boolean | None,
        told(
            "Shards",
            "none",
            "WebDataset shards of 1,000 samples in place of files; by default above 10,000 images.",
        ),
    ] = None


class Design(Model):
    """A study or training set, before any of it is made."""

    name: Annotated[
        Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,79}$")],
        told("Name", "none", "Of the set."),
    ] = "phantom-set"
    description: Annotated[Text, told("Description", "none", "What it is for.")] = ""
    licence: Annotated[
        Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9][A-Za-z0-9.+-]{0,79}$")],
        told("Licence", "none", "Under which the set is given away, by its SPDX name."),
    ] = "CC0-1.0"
    phantom: Annotated[
        Annotated[
            DrawnPhantom | OwnPhantom,
            Choice(
                _subject,
                ("drawn", "own"),
                "wrong_shape",
                "an object with the name of a library phantom, or with a document",
            ),
        ],
        told("Phantom", "none", "What is X-rayed."),
    ]
    population: Annotated[
        Population | None,
        told(
            "Population",
            "none",
            "Who is X-rayed; by default people of 20 to 80 years where the phantom is somebody,"
            " null for its own defaults.",
        ),
    ] = None
    abnormalities: Annotated[
        tuple[DrawnAbnormality, ...], told("Abnormalities", "none", "What may be wrong.")
    ] = ()
    exclusive: Annotated[
        Boolean, told("Exclusive", "none", "True where no case has two of them.")
    ] = False
    exact_prevalence: Annotated[
        Boolean,
        told(
            "Exact prevalence",
            "none",
            "True where each prevalence is a share of the cases to the case, and of each split's"
            " as near as whole cases allow; false where it is the chance that a case has it.",
        ),
    ] = False
    people: Annotated[_Count, told("People", "1", "How many.")]
    cases_per_person: Annotated[
        _Count, told("Cases", "1", "Of each person; each with abnormalities of its own.")
    ] = 1
    views: Annotated[
        tuple[Viewpoint, ...],
        told("Views", "none", "Of each case; by default the phantom's first.", min_length=1),
    ] = (PresetView(),)
    detector: Annotated[DetectorGrid, told("Detector", "none", "The pixels.")] = Field(
        default_factory=DetectorGrid
    )
    beam: Annotated[Beam, told("Beam", "none", "The photons.")] = Field(default_factory=Beam)
    acquisition: Annotated[
        Acquisition | None,
        told(
            "Acquisition",
            "none",
            "Dose, noise and detector; by default the phantom's dose, else 2.5 uGy; null for none.",
        ),
    ] = Field(default_factory=Acquisition)
    stereo: Annotated[
        Stereo | None, told("Stereo", "none", "Two eyes, or an arm without depth; null for one.")
    ] = None
    vary: Annotated[
        dict[Literal[VARIED], Value],  # type: ignore[valid-type]
        told("Vary", "none", "Words of a request, such as kvp, drawn anew for each image."),
    ] = Field(default_factory=dict)
    quantity: Annotated[
        Literal["signal", "transmission", "line_integral"],
        told("Quantity", "none", "What a pixel holds."),
    ] = "signal"
    presentation: Annotated[
        Presentation, told("Presentation", "none", "Grey levels, for the form presentation.")
    ] = Field(default_factory=Presentation)
    truth: Annotated[
        tuple[Kind, ...],
        told("Ground truth", "none", "Kept of every image as an archive; masks need not be said."),
    ] = ()
    outputs: Annotated[Outputs, told("Outputs", "none", "What is kept.")] = Field(
        default_factory=Outputs
    )
    twins: Annotated[
        Boolean,
        told("Twins", "none", "True keeps every abnormal picture without what is wrong, too."),
    ] = False
    splits: Annotated[
        dict[_SplitName, Annotated[float, Field(strict=True, ge=0, le=MOST_IMAGES)]],
        told(
            "Splits",
            "1",
            "Of the people: shares that add up to 1, or numbers that add up to all of them.",
            min_length=1,
            max_length=20,
        ),
    ] = Field(default_factory=lambda: {"train": 0.8, "validation": 0.1, "test": 0.1})
    seed: Annotated[
        Annotated[Integer, Field(ge=0, lt=2**63)], told("Seed", "none", "The user's choice.")
    ] = 0
    blind: Annotated[
        Boolean,
        told("Blind", "none", "True gives opaque names and keeps all that is known apart."),
    ] = False

    @field_validator("splits")
    @classmethod
    def _are_free(cls, splits: dict[str, float], _: ValidationInfo) -> dict[str, float]:
        taken = [name for name in splits if name in TAKEN]
        if taken:
            refuse(
                "taken", *(((name,), f"found {name!r}; expected another name") for name in taken)
            )
        return splits

    @property
    def images(self) -> int:
        """How many samples the set has: a picture each, or a pair."""
        return self.people * self.cases_per_person * len(self.views)

    @property
    def sharded(self) -> bool:
        """Whether the set comes as WebDataset shards."""
        wanted = self.outputs.shards
        return self.images > SHARDED_ABOVE if wanted is None else wanted

    def tree(self) -> dict[str, Any]:
        """Return what was said of it, as plain JSON values: what a design file holds."""
        return self.model_dump(mode="json", exclude_unset=True)

    def digest(self) -> str:
        """Return a hash of all that the bytes of the set depend on."""
        content = {
            "engine": version("phantom-xray"),
            "encoder": version("OpenImageIO"),
            "design": self.tree(),
        }
        text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()


def view_name(view: PresetView | PlacedView, recommended: str) -> str:
    """Return the clinical word of a view; ``placed`` for a source and a detector."""
    if isinstance(view, PlacedView):
        return "placed"
    return view.preset if "preset" in view.model_fields_set else recommended
