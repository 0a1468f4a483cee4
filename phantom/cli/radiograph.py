"""``phantom radiograph``: X-ray a phantom and write the picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import typer

from phantom.cli.console import Bar, answer, reporting, say
from phantom.cli.exposure import EXPOSURE, worded
from phantom.cli.options import Abnormalities, AsJson, Settings, Target, json_text, subject

if TYPE_CHECKING:
    from phantom.imaging import Radiograph
    from phantom.requests.radiograph import RadiographPlan


@worded(EXPOSURE)
def make(
    target: Target,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: .png .jpg .tif .f32.tif .exr .npy .u16.npy .dcm .raw.dcm .json",
            metavar="FILE",
        ),
    ] = None,
    words: Mapping[str, str] = MappingProxyType({}),
    truth_output: Annotated[
        str | None,
        typer.Option(
            "--truth-output",
            help="Where the ground truth goes to.",
            metavar="DIR|FILE.zip|FILE.exr",
        ),
    ] = None,
    sidecar: Annotated[
        bool, typer.Option("--sidecar", help="Write the metadata beside it, as .json.")
    ] = False,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """X-ray a phantom of the library, or a document, and write the picture."""
    with reporting(as_json=as_json):
        from phantom.encode import format_of_path
        from phantom.requests.radiograph import plan
        from phantom.requests.words import request_tree

        given = asked(words, truth_output)
        planned = plan(*request_tree(subject(target, settings, abnormality), given.items()))
        pose = planned.chosen.get("view", "view")
        path = Path(output or f"{planned.phantom.document.name}-{pose}.png")
        planned.check_format(format_of_path(path))
        beside_it = _truth_path(planned, truth_output, path)
        tell_defaults(planned.chosen, given, None if output else path)
        made, beside = _render(planned, path, sidecar=sidecar, quiet=as_json)
        for warning in made.warnings:
            say(f"warning: {warning}")
        if beside_it is not None:
            _write_truth(planned, beside_it, path)
        if as_json:
            answer({"output": str(path), **beside})


def asked(words: Mapping[str, str], truth_output: str | None) -> dict[str, str]:
    """Return the words of a query string for those of a command line.

    A file of an acquisition is read; a place for ground truth asks for all of it.
    """
    given = dict(words)
    if "acquisition" in given:
        given["acquisition"] = json_text(given["acquisition"], "/acquisition")
    if truth_output is not None:
        given.setdefault("truth", "all")
    return given


def tell_defaults(
    chosen: Mapping[str, object], given: Mapping[str, object], output: Path | None
) -> None:
    """Say in one line every value that was chosen for the person."""
    all_chosen = {**chosen, **({} if output is None else {"output": output})}
    told = {word: value for word, value in all_chosen.items() if word not in given}
    if told:
        say("chosen: " + " ".join(f"{word}={_short(value)}" for word, value in told.items()))


def _render(
    planned: RadiographPlan, path: Path, *, sidecar: bool, quiet: bool
) -> tuple[Radiograph, Mapping[str, Any]]:
    """Trace the radiograph, write it and return it with what a sidecar says."""
    from phantom.cli.engine import ready
    from phantom.encode import save

    ready(quiet=quiet)
    with Bar("tracing") as bar:
        made = planned.render(progress=bar)
    saved = save(
        made,
        path,
        planned.quantity,
        planned.presentation,
        sidecar=sidecar,
        blind=planned.blind,
    )
    say(f"wrote {path}")
    return made, saved.beside


def _truth_path(planned: RadiographPlan, output: str | None, picture: Path) -> Path | None:
    """Return where the ground truth goes to, by default beside the picture; None without any."""
    from phantom.encode.truth import check_truth_path
    from phantom.errors import InvalidInputError, Problem

    if not planned.truth:
        if output is None:
            return None
        message = "found a place for ground truth without kinds of it; expected some"
        raise InvalidInputError([Problem("/truth", "missing", message)])
    path = Path(output) if output is not None else picture.with_name(f"{picture.stem}-truth.zip")
    check_truth_path(path)
    return path


def _write_truth(planned: RadiographPlan, output: Path, picture: Path) -> None:
    """Trace the ground truth and write it."""
    from phantom.encode import save_truth

    with Bar("tracing the leaves") as bar:
        truth = planned.tell(progress=bar)
    save_truth(truth, output, picture.name)
    say(f"wrote {output}")


def _short(value: object) -> str:
    """Return a whole number without its decimal point, all else as it is."""
    return f"{value:.0f}" if isinstance(value, float) and value.is_integer() else str(value)
