"""``phantom stereo``: X-ray a phantom for two eyes and write the pictures."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Final

import typer

from phantom.cli.console import Bar, answer, reporting, say
from phantom.cli.exposure import EXPOSURE, Word, worded
from phantom.cli.options import Abnormalities, AsJson, Settings, subject
from phantom.cli.radiograph import asked, tell_defaults

if TYPE_CHECKING:
    from phantom.encode import Format
    from phantom.imaging import StereoPair, Truth
    from phantom.requests.stereo import StereoPlan

STEREO: Final[Mapping[str, Word]] = {
    **EXPOSURE,
    "scope": Word("What the greys depend on.", "image|pair|fixed"),
    "method": Word("The tube moves, or the object turns.", "shift|rotate"),
    "baseline_mm": Word("Between the two places of the tube.", "MM|auto"),
    "stereo_angle_deg": Word("Between the two poses, for rotate.", "DEG|auto"),
    "zero_parallax": Word("What is seen in the screen; MM from the tube.", "isocentre|detector|MM"),
    "screen": Word("Its pixels, its distance, the eyes'.", "MM,MM,MM|JSON"),
    "dose": Word("For both images together, or for each.", "split|per_image"),
    "mono": Word("The arm without depth.", "same_image|single"),
    "layout": Word(
        "Of the pictures.", "files|side_by_side|cross_eyed|anaglyph|two_view|all"
    ),
    "format": Word("Of the two files in an archive.", "NAME"),
}  # fmt: skip

ZIP: Final = ".zip"


@worded(STEREO)
def make(
    target: Annotated[
        str, typer.Argument(metavar="NAME|FILE", help="A phantom of the library, or a document.")
    ],
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: as for radiograph, or .zip; two files get -left and -right.",
            metavar="FILE",
        ),
    ] = None,
    words: Mapping[str, str] = MappingProxyType({}),
    truth_output: Annotated[
        str | None,
        typer.Option(
            "--truth-output", help="Where the ground truth goes to.", metavar="DIR|FILE.zip"
        ),
    ] = None,
    sidecar: Annotated[
        bool, typer.Option("--sidecar", help="Write what is known of the pair beside it, as .json.")
    ] = False,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """X-ray a phantom for the left and the right eye, and write the pictures."""
    with reporting(as_json=as_json):
        from phantom.cli.engine import ready
        from phantom.encode import format_of_path, write_atomically
        from phantom.encode.files import check_place
        from phantom.requests.stereo import plan_pair
        from phantom.requests.stereo_files import archived, encoded, settle
        from phantom.requests.words import STEREO_WORDS, request_tree

        given = asked(words, truth_output)
        tree = subject(target, settings, abnormality)
        planned = plan_pair(*request_tree(tree, given.items(), STEREO_WORDS))
        pose = planned.chosen.get("view", "view")
        path = Path(output or f"{planned.mono.phantom.document.name}-{pose}-stereo.png")
        format = None if path.suffix.lower() == ZIP else format_of_path(path)
        layout = settle(planned, format)
        beside_it = _truth_path(planned, truth_output, path, format)
        check_place(path)
        tell_defaults({**planned.chosen, "layout": layout}, given, None if output else path)
        ready(quiet=as_json)
        with Bar("tracing") as bar:
            pair = planned.render(progress=bar)
        truths = _truths(planned, pair)
        files = encoded(planned, pair, format)
        if format is None:
            inside = truths if beside_it is None else {}
            written = {path: archived(planned, pair, files, inside)}
        else:
            written = {
                place: made.data
                for place, made in zip(
                    _places(path, format, list(files)), files.values(), strict=True
                )
            }
        if sidecar:
            from phantom.encode import pair_sidecar

            written[_beside(path, format)] = pair_sidecar(pair, files, blind=planned.mono.blind)
        for place, data in written.items():
            write_atomically(place, data)
            say(f"wrote {place}")
        if beside_it is not None:
            _write_truths(truths, beside_it, list(files))
        _tell(pair)
        if as_json:
            answer({"output": [str(place) for place in written], **pair.metadata()})


def _places(path: Path, format: Format, names: list[str]) -> list[Path]:
    """Return where each file goes to: the path itself for one, with the eyes' names for more."""
    if len(names) == 1:
        return [path]
    stem = _stem(path, format)
    return [path.with_name(f"{stem}-{name}") for name in names]


def _stem(path: Path, format: Format | None) -> str:
    endings = (ZIP,) if format is None else format.extensions
    longest = max((e for e in endings if path.name.lower().endswith(e)), key=len)
    return path.name[: -len(longest)]


def _beside(path: Path, format: Format | None) -> Path:
    return path.with_name(f"{_stem(path, format)}.json")


def _tell(pair: StereoPair) -> None:
    """Say where the eyes were, and whether they can bear it."""
    for warning in pair.warnings:
        say(f"warning: {warning}")
    if pair.eyes.angle_deg is None:
        return
    apart = [f"{pair.eyes.angle_deg:.2f}° at the isocentre"]
    if pair.eyes.baseline_mm is not None:
        apart.insert(0, f"{pair.eyes.baseline_mm:.1f} mm")
    say(f"eyes {', '.join(apart)} apart: {pair.comfort.verdict}")


def _truth_path(
    planned: StereoPlan, output: str | None, picture: Path, format: Format | None
) -> Path | None:
    """Return where the ground truth goes to; None into the archive of the pair, or without any."""
    from phantom.encode.truth import EXR_SUFFIX, check_truth_path
    from phantom.errors import InvalidInputError, Problem

    if not planned.mono.truth:
        if output is None:
            return None
        message = "found a place for ground truth without kinds of it; expected some"
        raise InvalidInputError([Problem("/truth", "missing", message)])
    if output is None and format is None:
        return None
    usual = picture.with_name(f"{_stem(picture, format)}-truth.zip")
    path = Path(output) if output is not None else usual
    if path.suffix.lower() == EXR_SUFFIX:
        message = "found an OpenEXR for the ground truth of two eyes; expected a folder or a .zip"
        raise InvalidInputError([Problem("/truth", "not_in_format", message)])
    check_truth_path(path)
    return path


def _truths(planned: StereoPlan, pair: StereoPair) -> Mapping[str, Truth]:
    """Trace the ground truth of each eye."""
    with Bar("tracing the leaves") as bar:
        return planned.tell(pair, progress=bar)


def _write_truths(truths: Mapping[str, Truth], output: Path, images: list[str]) -> None:
    """Write each eye's ground truth into a folder of its name."""
    from phantom.encode.files import write_files
    from phantom.requests.stereo_files import truths_files

    write_files(truths_files(truths, images), output)
    say(f"wrote {output}")
