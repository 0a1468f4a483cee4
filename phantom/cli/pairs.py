"""What the commands that make pairs share: the options of two eyes, and where the files go."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

from phantom.cli.console import Bar, answer, say
from phantom.cli.exposure import Word
from phantom.cli.radiograph import tell_defaults

if TYPE_CHECKING:
    from phantom.encode import Format
    from phantom.imaging import StereoPair, Truth
    from phantom.requests.render_pair import RenderPairPlan
    from phantom.requests.stereo import StereoPlan
    from phantom.visible import PicturePair

EYES: Final[Mapping[str, Word]] = {
    "method": Word("The tube or camera moves, or the object turns.", "shift|rotate"),
    "baseline_mm": Word("Between the two eyes.", "MM|auto"),
    "stereo_angle_deg": Word("Between the two poses, for rotate.", "DEG|auto"),
    "zero_parallax": Word(
        "What is seen in the screen; MM from tube or camera.", "isocentre|detector|MM"
    ),
    "screen": Word("Its pixels, its distance, the eyes'.", "MM,MM,MM|JSON"),
    "mono": Word("The arm without depth.", "same_image|single"),
    "layout": Word("Of the pictures.", "files|side_by_side|cross_eyed|anaglyph|two_view|all"),
    "format": Word("Of the two files in an archive.", "NAME"),
}
"""What two eyes are asked for with."""

ZIP: Final = ".zip"


def make_pair(
    planned: StereoPlan | RenderPairPlan,
    given: Mapping[str, str],
    path: Path,
    *,
    told_path: bool,
    truth_output: str | None = None,
    sidecar: bool,
    as_json: bool,
) -> None:
    """Trace a pair, write its files and say what became of it.

    Parameters
    ----------
    planned
        What is made.
    given
        The words that the person said.
    path
        Where to; its ending says the format.
    told_path
        Whether the person said that too.
    truth_output
        Where ground truth goes to, if not beside the pictures.
    sidecar, as_json
        Whether there is a file of what is known of the pair, and whether it is the answer.
    """
    from phantom.cli.engine import ready
    from phantom.encode import format_of_path, pair_sidecar, write_atomically
    from phantom.encode.files import check_place
    from phantom.requests.stereo_files import archived, encoded, settle

    format = None if path.suffix.lower() == ZIP else format_of_path(path)
    layout = settle(planned, format)
    beside_it = _truth_path(planned, truth_output, path, format)
    check_place(path)
    tell_defaults({**planned.chosen, "layout": layout}, given, None if told_path else path)
    ready(quiet=as_json, light=True)
    pair, truths = _traced(planned)
    files = encoded(planned, pair, format)
    if format is None:
        written = {path: archived(planned, pair, files, truths if beside_it is None else {})}
    else:
        places = _places(path, format, list(files))
        written = {at: made.data for at, made in zip(places, files.values(), strict=True)}
    if sidecar:
        written[_beside(path, format)] = pair_sidecar(pair, files, blind=planned.blind)
    for place, data in written.items():
        write_atomically(place, data)
        say(f"wrote {place}")
    if beside_it is not None:
        _write_truths(truths, beside_it, list(files))
    _tell(pair)
    if as_json:
        answer({"output": [str(place) for place in written], **pair.metadata()})


def _traced(
    planned: StereoPlan | RenderPairPlan,
) -> tuple[StereoPair | PicturePair, Mapping[str, Truth]]:
    """Trace both images, and the ground truth of each where that is asked for."""
    from phantom.requests.stereo import StereoPlan

    with Bar("tracing") as bar:
        if not isinstance(planned, StereoPlan):
            return planned.render(progress=bar), {}
        pair = planned.render(progress=bar)
    with Bar("tracing the leaves") as bar:
        return pair, planned.tell(pair, progress=bar)


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


def _tell(pair: StereoPair | PicturePair) -> None:
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
    planned: StereoPlan | RenderPairPlan,
    output: str | None,
    picture: Path,
    format: Format | None,
) -> Path | None:
    """Return where the ground truth goes to; None into the archive of the pair, or without any."""
    from phantom.encode.truth import EXR_SUFFIX, check_truth_path
    from phantom.errors import InvalidInputError, Problem

    if not planned.truth:
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


def _write_truths(truths: Mapping[str, Truth], output: Path, images: list[str]) -> None:
    """Write each eye's ground truth into a folder of its name."""
    from phantom.encode.files import write_files
    from phantom.requests.stereo_files import truths_files

    write_files(truths_files(truths, images), output)
    say(f"wrote {output}")
