"""``phantom dataset``: a set from a design, a quick one, and the parts of one put together."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from phantom.cli.console import OUR_FAULT, Bar, answer, reporting, say
from phantom.cli.options import AsJson, Settings

if TYPE_CHECKING:
    from phantom.datasets import Design, Forecast, Part
    from phantom.datasets.finishing import Finished
    from phantom.datasets.ledger import Counts

MAKE = "make"
"""The command that is meant where none is named."""


class DesignFirst(typer.core.TyperGroup):
    """Commands of which one may go unnamed: ``phantom dataset DESIGN OUT``."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Put the unnamed command before its arguments."""
        if args and args[0] not in self.commands and args[0] not in ("--help", "-h"):
            args = [MAKE, *args]
        return list(super().parse_args(ctx, args))


app = typer.Typer(
    cls=DesignFirst,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Make a set of images: phantom dataset DESIGN OUT.",
)

Workers = Annotated[
    int | None, typer.Option("--workers", min=1, max=1024, help="Processes; one a processor.")
]
Shard = Annotated[
    str | None,
    typer.Option(
        "--shard",
        metavar="I/N|slurm",
        help="Make part I of N, from 0; slurm takes both from SLURM_ARRAY_TASK_….",
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler", metavar="ADDRESS", help="Of dask.distributed, in place of processes here."
    ),
]
LedgerFile = Annotated[
    Path | None, typer.Option("--ledger", metavar="FILE", help="On a disk of this machine.")
]
DryRun = Annotated[
    bool, typer.Option("--dry-run", help="Tell what would be made, how large, and how long.")
]


@app.command(MAKE)
def make(
    design: Annotated[str, typer.Argument(metavar="DESIGN", help="A design, JSON or YAML.")],
    output: Annotated[str, typer.Argument(metavar="OUT", help="A folder, or an fsspec address.")],
    workers: Workers = None,
    shard: Shard = None,
    scheduler: Scheduler = None,
    ledger: LedgerFile = None,
    dry_run: DryRun = False,
    as_json: AsJson = False,
) -> None:
    """Make a design's set, or go on with one that was cut short; this word may be left out."""
    with reporting(as_json=as_json):
        from phantom.datasets import read_design

        _make(read_design(design), output, workers, shard, scheduler, ledger, dry_run, as_json)


@app.command("quick")
def quick(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A phantom of the library.")],
    count: Annotated[int, typer.Option("--count", min=1, help="Images, one of each person.")],
    output: Annotated[str, typer.Option("--output", "-o", metavar="OUT", help="A folder.")],
    side: Annotated[int, typer.Option("--side", min=16, max=8192, help="Pixels.")] = 512,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of all that is drawn.")] = 0,
    settings: Settings = None,
    workers: Workers = None,
    shard: Shard = None,
    scheduler: Scheduler = None,
    ledger: LedgerFile = None,
    dry_run: DryRun = False,
    as_json: AsJson = False,
) -> None:
    """Make so many images of a phantom, with everything else chosen."""
    with reporting(as_json=as_json):
        from phantom import datasets
        from phantom.cli.options import subject

        parameters: Any = subject(name, settings).get("parameters", {})
        chosen = datasets.quick(name, count, parameters=parameters, seed=seed, side=side)
        said = chosen.phantom.model_dump(mode="json", exclude_unset=True)["parameters"]
        drawn = [n for n, value in said.items() if isinstance(value, dict)]
        wrong = [asked.type for asked in chosen.abnormalities]
        say(
            f"chosen: side={side} seed={seed} splits={','.join(chosen.splits)}"
            f" drawn={','.join(drawn) or 'people'} abnormalities={','.join(wrong) or 'none'}"
        )
        _make(chosen, output, workers, shard, scheduler, ledger, dry_run, as_json)


@app.command("merge")
def merge(
    output: Annotated[str, typer.Argument(metavar="OUT", help="Where all parts were made.")],
    as_json: AsJson = False,
) -> None:
    """Finish a set whose parts were made with --shard."""
    with reporting(as_json=as_json):
        from phantom import datasets

        _tell(datasets.merge(output), output, as_json=as_json)


def _make(
    design: Design,
    output: str,
    workers: int | None,
    shard: str | None,
    scheduler: str | None,
    ledger: Path | None,
    dry_run: bool,
    as_json: bool,
) -> None:
    from phantom import datasets
    from phantom.cli.engine import ready
    from phantom.datasets.finishing import Finished
    from phantom.datasets.ledger import HaltedError
    from phantom.datasets.running import WorkersLostError
    from phantom.datasets.storage import storage

    run = datasets.Run(_part(shard), workers, scheduler, ledger)
    if dry_run:
        ready(quiet=as_json)
        _foretell(datasets.forecast(design, storage(output), workers), as_json=as_json)
        return
    from phantom.datasets.checks import check

    check(design)
    ready(quiet=as_json)
    with Bar("making images") as bar:

        def progress(counts: Counts) -> None:
            bar(counts.done + counts.aside, counts.total)

        try:
            made = datasets.make(design, output, run, progress=progress)
        except (HaltedError, WorkersLostError) as error:
            say(f"{error}; what is finished is kept, and the same command goes on with it")
            raise typer.Exit(OUR_FAULT) from None
        except KeyboardInterrupt:
            say("stopped; what is finished is kept, and the same command goes on with it")
            raise
    if isinstance(made, Finished):
        _tell(made, output, as_json=as_json)
    elif as_json:
        answer({"output": output, "part": run.part.number, "parts": run.part.of, **made._asdict()})
    else:
        part = f"part {run.part.number} of {run.part.of}"
        say(f"made {part}: {made.done} images; phantom dataset merge {output} when all are there")


def _part(shard: str | None) -> Part:
    """Return the part of a set that ``--shard`` means."""
    from phantom.datasets import Part
    from phantom.errors import InvalidInputError, Problem

    if shard is None:
        return Part()
    if shard == "slurm":
        names = ("SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_COUNT")
        found = [os.environ.get(name, "") for name in names]
        if all(text.isdigit() for text in found):
            number, least, count = map(int, found)
            return Part(number - least, count)
        expected = f"expected {', '.join(names)} to be set"
    else:
        number_text, _, count_text = shard.partition("/")
        if number_text.isdigit() and count_text.isdigit():
            number, count = int(number_text), int(count_text)
            if number < count <= 99_999:
                return Part(number, count)
        expected = "expected I/N with I from 0 to N - 1, as in 0/4, or slurm"
    message = f"found {shard[:40]!r}; {expected}"
    raise InvalidInputError([Problem("/shard", "bad_shard", message)])


def _tell(made: Finished, output: str, *, as_json: bool) -> None:
    """Say what a set came to; leave with 1 where images had to be set aside."""
    from phantom.datasets.storage import sized

    if as_json:
        aside = [{"index": number, "error": error} for number, error in made.aside]
        answer({"output": output, "images": made.images, "bytes": made.bytes, "set_aside": aside})
    else:
        say(f"made {made.images} images, {sized(made.bytes)}, in {output}")
        for number, error in made.aside[:20]:
            say(f"set aside image {number}: {error}")
    if made.aside:
        raise typer.Exit(OUR_FAULT)


def _foretell(found: Forecast, *, as_json: bool) -> None:
    from phantom.datasets.storage import sized

    if as_json:
        answer(found.told())
        return
    answer(f"{found.images} images of {found.people} people, {found.columns} × {found.rows} pixels")
    for split, (people, images) in found.splits.items():
        answer(f"  {split}: {images} images of {people} people")
    for kind, count in found.abnormal.items():
        answer(f"  cases with {kind}: {count}")
    if found.shards:
        answer(f"  as {found.shards} WebDataset shards")
    answer(f"about {sized(found.bytes)}, {sized(found.image_bytes)} an image")
    each = f"{found.image_seconds:.2g} s an image on one thread"
    answer(f"about {_time(found.seconds)} with {found.workers} workers, {each}")
    for warning in found.warnings:
        answer(f"warning {warning}")


def _time(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
