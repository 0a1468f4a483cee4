"""``phantom radiograph``: X-ray a phantom and write the picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from phantom.cli.console import Bar, answer, reporting, say
from phantom.cli.options import Abnormalities, AsJson, Settings, json_text, subject

if TYPE_CHECKING:
    from phantom.imaging import Radiograph
    from phantom.requests.radiograph import RadiographPlan


def _word(help_text: str, metavar: str, flag: str) -> Any:
    """Return an option whose text means what it means in a query string."""
    return typer.Option(flag, help=help_text, metavar=metavar)


def make(
    target: Annotated[
        str, typer.Argument(metavar="NAME|FILE", help="A phantom of the library, or a document.")
    ],
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: .png .jpg .tif .f32.tif .exr .npy .u16.npy .dcm .raw.dcm .json",
            metavar="FILE",
        ),
    ] = None,
    view: Annotated[
        str | None, _word("Preset, or a source and detector in JSON.", "VIEW", "--view")
    ] = None,
    source_detector_mm: Annotated[
        str | None, _word("Source to detector.", "MM", "--source-detector-mm")
    ] = None,
    source_object_mm: Annotated[
        str | None, _word("Source to isocentre.", "MM", "--source-object-mm")
    ] = None,
    object_detector_mm: Annotated[
        str | None, _word("Isocentre to detector.", "MM", "--object-detector-mm")
    ] = None,
    angle_deg: Annotated[str | None, _word("Of an oblique.", "DEG", "--angle-deg")] = None,
    primary_angle_deg: Annotated[
        str | None, _word("Of c_arm, to the left.", "DEG", "--primary-angle-deg")
    ] = None,
    secondary_angle_deg: Annotated[
        str | None, _word("Of c_arm, to the head.", "DEG", "--secondary-angle-deg")
    ] = None,
    laterality: Annotated[
        str | None, _word("Side of a limb or breast.", "left|right", "--laterality")
    ] = None,
    columns: Annotated[str | None, _word("Pixels in a row.", "N", "--columns")] = None,
    rows: Annotated[str | None, _word("Pixels in a column.", "N", "--rows")] = None,
    pitch_mm: Annotated[str | None, _word("Distance of pixel centres.", "MM", "--pitch-mm")] = None,
    energy_kev: Annotated[str | None, _word("Photon energy.", "KEV", "--energy-kev")] = None,
    kvp: Annotated[
        str | None, _word("Tube voltage, in place of the photon energy.", "KV", "--kvp")
    ] = None,
    anode: Annotated[
        str | None, _word("Of the tube.", "tungsten|molybdenum|rhodium", "--anode")
    ] = None,
    filtration: Annotated[
        str | None, _word("Filters of the tube.", "MATERIAL=MM,…|none", "--filtration")
    ] = None,
    acquisition: Annotated[
        str | None,
        _word(
            "Dose, focal spot, scatter, detector; none is ideal.", "FILE|JSON|none", "--acquisition"
        ),
    ] = None,
    dose_ugy: Annotated[
        str | None, _word("Air kerma at the detector in the open field.", "UGY", "--dose-ugy")
    ] = None,
    mas: Annotated[str | None, _word("Tube load, in place of the dose.", "MAS", "--mas")] = None,
    falloff: Annotated[
        str | None,
        _word("Of the open field.", "none|inverse_square_cosine", "--falloff"),
    ] = None,
    focal_spot_mm: Annotated[
        str | None, _word("Size of the focal spot.", "MM|[MM,MM]", "--focal-spot-mm")
    ] = None,
    scatter: Annotated[
        bool | None, typer.Option("--scatter/--no-scatter", help="Scattered radiation.")
    ] = None,
    grid: Annotated[
        str | None,
        _word("Transmissions of an anti-scatter grid.", "PRIMARY,SCATTER|none", "--grid"),
    ] = None,
    samples: Annotated[
        str | None, _word("Rays a pixel, across and down.", "N|[N,N]", "--samples")
    ] = None,
    quantum_noise: Annotated[
        str | None, _word("How photons are drawn.", "off|compound|per_bin", "--quantum-noise")
    ] = None,
    seed: Annotated[str | None, _word("Of the noise.", "N", "--seed")] = None,
    case: Annotated[str | None, _word("Of a series, for its noise.", "N", "--case")] = None,
    quantity: Annotated[
        str | None,
        _word("signal, transmission, line_integral or path_lengths.", "NAME", "--quantity"),
    ] = None,
    mode: Annotated[
        str | None, _word("How grey is chosen.", "stretch|window|percentile|equalise", "--mode")
    ] = None,
    scope: Annotated[
        str | None, _word("What the greys depend on.", "image|fixed", "--scope")
    ] = None,
    window_center: Annotated[
        str | None, _word("Line integral in the middle of the greys.", "X", "--window-center")
    ] = None,
    window_width: Annotated[
        str | None, _word("Line integrals that the greys span.", "X", "--window-width")
    ] = None,
    percentiles: Annotated[
        str | None, _word("What becomes black and white.", "[LOW,HIGH]", "--percentiles")
    ] = None,
    polarity: Annotated[
        str | None, _word("Which end bones have.", "bones_white|bones_dark", "--polarity")
    ] = None,
    bits: Annotated[str | None, _word("Of a grey level.", "8|16", "--bits")] = None,
    gsdf: Annotated[
        str | None, _word("The display's luminances and response.", "JSON", "--gsdf")
    ] = None,
    truth: Annotated[
        str | None, _word("Ground truth of every named leaf.", "KIND,…|all", "--truth")
    ] = None,
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
    blind: Annotated[
        bool | None,
        typer.Option("--blind/--no-blind", help="Leave out of the file what it says of itself."),
    ] = None,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """X-ray a phantom of the library, or a document, and write the picture."""
    options = {**locals(), "blind": _truth(blind), "scatter": _truth(scatter)}
    with reporting(as_json=as_json):
        from phantom.encode import format_of_path
        from phantom.requests.radiograph import plan
        from phantom.requests.words import WORDS, request_tree

        if acquisition is not None:
            options["acquisition"] = json_text(acquisition, "/acquisition")
        if truth_output is not None and truth is None:
            options["truth"] = "all"
        given = {word: options[word] for word in WORDS if options[word] is not None}
        planned = plan(*request_tree(subject(target, settings, abnormality), given.items()))
        pose = planned.chosen.get("view", "view")
        path = Path(output or f"{planned.phantom.document.name}-{pose}.png")
        planned.check_format(format_of_path(path))
        beside_it = _truth_path(planned, truth_output, path)
        _tell_defaults(planned, given, None if output else path)
        made, beside = _render(planned, path, sidecar=sidecar, quiet=as_json)
        for warning in made.warnings:
            say(f"warning: {warning}")
        if beside_it is not None:
            _write_truth(planned, beside_it, path)
        if as_json:
            answer({"output": str(path), **beside})


def _truth(flag: bool | None) -> str | None:
    """Return a flag as a query string has it."""
    return None if flag is None else str(flag).lower()


def _tell_defaults(
    planned: RadiographPlan, given: Mapping[str, object], output: Path | None
) -> None:
    """Say in one line every value that was chosen for the person."""
    chosen = {**planned.chosen, **({} if output is None else {"output": output})}
    told = {word: value for word, value in chosen.items() if word not in given}
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
