"""The options of every command that makes radiographs: the words of a query string.

They are told once, as a table, and put into the signature of a command, which gets those that were
given as one mapping.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Final, NamedTuple

import typer

_KEYWORD: Final = inspect.Parameter.KEYWORD_ONLY

WORDS: Final = "words"
"""The parameter of a command that the words take the place of."""


class Word(NamedTuple):
    """An option: what it means, and how its value is written; without that it is a flag."""

    meaning: str
    metavar: str | None


EXPOSURE: Final[Mapping[str, Word]] = {
    "view": Word("Preset, or a source and detector in JSON.", "VIEW"),
    "source_detector_mm": Word("Source to detector.", "MM"),
    "source_object_mm": Word("Source to isocentre.", "MM"),
    "object_detector_mm": Word("Isocentre to detector.", "MM"),
    "angle_deg": Word("Of an oblique.", "DEG"),
    "primary_angle_deg": Word("Of c_arm, to the left.", "DEG"),
    "secondary_angle_deg": Word("Of c_arm, to the head.", "DEG"),
    "laterality": Word("Side of a limb or breast.", "left|right"),
    "columns": Word("Pixels in a row.", "N"),
    "rows": Word("Pixels in a column.", "N"),
    "pitch_mm": Word("Distance of pixel centres.", "MM"),
    "energy_kev": Word("Photon energy.", "KEV"),
    "kvp": Word("Tube voltage, in place of the photon energy.", "KV"),
    "anode": Word("Of the tube.", "tungsten|molybdenum|rhodium"),
    "filtration": Word("Filters of the tube.", "MATERIAL=MM,…|none"),
    "acquisition": Word("Dose, focal spot, scatter, detector; none is ideal.", "FILE|JSON|none"),
    "dose_ugy": Word("Air kerma at the detector in the open field.", "UGY"),
    "mas": Word("Tube load, in place of the dose.", "MAS"),
    "falloff": Word("Of the open field.", "none|inverse_square_cosine"),
    "focal_spot_mm": Word("Size of the focal spot.", "MM|[MM,MM]"),
    "scatter": Word("Scattered radiation.", None),
    "grid": Word("Transmissions of an anti-scatter grid.", "PRIMARY,SCATTER|none"),
    "samples": Word("Rays a pixel, across and down.", "N|[N,N]"),
    "quantum_noise": Word("How photons are drawn.", "off|compound|per_bin"),
    "seed": Word("Of the noise.", "N"),
    "case": Word("Of a series, for its noise.", "N"),
    "quantity": Word("signal, transmission, line_integral or path_lengths.", "NAME"),
    "mode": Word("How grey is chosen.", "stretch|window|percentile|equalise"),
    "scope": Word("What the greys depend on.", "image|fixed"),
    "window_center": Word("Line integral in the middle of the greys.", "X"),
    "window_width": Word("Line integrals that the greys span.", "X"),
    "percentiles": Word("What becomes black and white.", "[LOW,HIGH]"),
    "polarity": Word("Which end bones have.", "bones_white|bones_dark"),
    "bits": Word("Of a grey level.", "8|16"),
    "gsdf": Word("The display's luminances and response.", "JSON"),
    "truth": Word("Ground truth of every named leaf.", "KIND,…|all"),
    "blind": Word("Leave out of the file what it says of itself.", None),
}
"""What a radiograph is asked for with, in the order of :data:`phantom.requests.words.WORDS`."""


def worded(words: Mapping[str, Word]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command these words as options, in the place of its parameter ``words``.

    The command is handed a mapping of those that were given, each as a query string has it.
    """

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        def run(**given: Any) -> None:
            said = {word: _text(given.pop(word)) for word in words}
            command(**given, words={word: text for word, text in said.items() if text is not None})

        own = inspect.signature(command, eval_str=True).parameters
        parameters: list[inspect.Parameter] = []
        for name, parameter in own.items():
            options = [_option(word, words[word]) for word in words]
            parameters += options if name == WORDS else [parameter.replace(kind=_KEYWORD)]
        run.__name__, run.__doc__ = command.__name__, command.__doc__
        run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        run.__annotations__ = {p.name: p.annotation for p in parameters}
        return run

    return decorate


def _option(name: str, word: Word) -> inspect.Parameter:
    flag = name.replace("_", "-")
    if word.metavar is None:
        told: Any = Annotated[bool | None, typer.Option(f"--{flag}/--no-{flag}", help=word.meaning)]
    else:
        told = Annotated[
            str | None, typer.Option(f"--{flag}", help=word.meaning, metavar=word.metavar)
        ]
    return inspect.Parameter(name, _KEYWORD, default=None, annotation=told)


def _text(value: str | bool | None) -> str | None:
    """Return a value as a query string has it."""
    return str(value).lower() if isinstance(value, bool) else value
