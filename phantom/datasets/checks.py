"""What no design can ask for, found before the first image is made."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from itertools import product
from typing import Any, Final

from phantom import library
from phantom.datasets.design import MOST_IMAGES, Design, DrawnPhantom
from phantom.datasets.draws import TYPES, ends, stream
from phantom.datasets.making import Maker
from phantom.datasets.places import ROUNDING, people_of_splits, place
from phantom.datasets.sampling import combinations, exposure, population, request
from phantom.datasets.storage import Storage, sized
from phantom.document import Model, validate_model
from phantom.document.words import arranged
from phantom.errors import InvalidInputError, Problem, pointer, prefixed
from phantom.imaging.stereo import placed
from phantom.imaging.visibility import check_display
from phantom.library.people import Sex
from phantom.requests.limits import Limits
from phantom.requests.radiograph import RadiographPlan, RadiographRequest

BYTES_A_PIXEL: Final = {"noisy": 1.6, "ideal": 0.35, "codes": 2.0, "mask": 0.02}
"""Measured: 16-bit PNG with and without noise, coded NPY, masks."""

BYTES_AN_IMAGE: Final = 12_000
"""Measured: rows, names and metadata."""

BYTES_A_MASK: Final = (120.0, 0.45)
"""Measured, of one leaf's in COCO: as it is, and for each pixel of the detector's side."""

TIMES_COCO: Final = 2.5
"""It is in the ledger too, packed, and in the list of what a part has made."""


def check(design: Design, limits: Limits | None = None) -> RadiographPlan:
    """Return the radiograph of the first image; a design that cannot be made is refused.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the design.
    """
    problems = [*_counts(design), *_extras(design)]
    countable = not problems
    if isinstance(design.phantom, DrawnPhantom):
        try:
            problems += _of_library(design, design.phantom)
        except InvalidInputError as error:
            problems += prefixed("/phantom", error.problems)
    elif design.abnormalities or design.population is not None:
        fields = [name for name in ("abnormalities", "population") if getattr(design, name)]
        told = "found it with a document; expected it with a phantom of the library"
        problems += [Problem(f"/{name}", "no_effect", told) for name in fields]
    if countable:
        problems += _words(design)
    if problems:
        raise InvalidInputError(arranged(problems))
    return _first(design, limits)


def _first(design: Design, limits: Limits | None) -> RadiographPlan:
    """Plan the first image of every view; return the first."""
    maker = Maker(design)
    plans = []
    for view in range(len(design.views)):
        at = place(design, view)
        try:
            of = maker.case(at)
        except InvalidInputError as error:
            raise InvalidInputError(prefixed("/phantom", error.problems)) from None
        planned = maker.plan(at, of, limits)
        if design.stereo is not None:
            placed(of.phantom, planned.view, design.stereo)
        if design.outputs.form == "presentation" and planned.presentation.mode == "window":
            _ = planned.presentation.window
        if design.outputs.visibility and planned.presentation.gsdf is not None:
            check_display(planned.presentation)
        plans.append(planned)
    return plans[0]


def _counts(design: Design) -> Iterator[Problem]:
    """Yield what is wrong with how many of what there are."""
    if design.images > MOST_IMAGES:
        message = f"found {design.images} images; expected {MOST_IMAGES} at most"
        yield Problem("/people", "too_large", message)
    total = sum(design.splits.values())
    whole = all(float(count).is_integer() for count in design.splits.values())
    if abs(total - 1.0) > ROUNDING and not (whole and total == design.people):
        message = (
            f"found splits that add up to {total:g};"
            f" expected 1, or numbers that add up to {design.people} people"
        )
        yield Problem("/splits", "bad_sum", message)
    elif (empty := [n for n, count in people_of_splits(design).items() if not count]) and (
        any(design.splits[name] > 0 for name in empty)
    ):
        names = ", ".join(name for name in empty if design.splits[name] > 0)
        message = f"found {design.people} people, so that {names} would be empty; expected more"
        yield Problem("/people", "too_few", message)
    shares = sum(asked.prevalence for asked in design.abnormalities)
    if design.exclusive and shares > 1.0 + ROUNDING:
        message = f"found prevalences that add up to {shares:g}; expected 1 at most, one a case"
        yield Problem("/abnormalities", "bad_sum", message)
    elif design.exact_prevalence:
        yield from _whole(design)
    if not any(asked.prevalence > 0 for asked in design.abnormalities):
        needing = {"/twins": design.twins, "/outputs/visibility": design.outputs.visibility}
        for path in (path for path, wanted in needing.items() if wanted):
            message = "found true without any abnormality; expected some prevalence above 0"
            yield Problem(path, "no_effect", message)


def _whole(design: Design) -> Iterator[Problem]:
    """Yield what cannot be exact: prevalences that are no whole number of cases."""
    cases = design.people * design.cases_per_person
    if not design.abnormalities:
        message = "found true without any abnormality; expected some, or false"
        yield Problem("/exact_prevalence", "no_effect", message)
    for k, asked in enumerate(design.abnormalities):
        number = asked.prevalence * cases
        if abs(number - round(number)) > ROUNDING:
            below, above = math.floor(number) / cases, math.ceil(number) / cases
            message = (
                f"found {asked.prevalence!r}, which is {number:.10g} of {cases} cases;"
                f" expected a whole number of them, as {below!r} or {above!r} give,"
                " or exact_prevalence false"
            )
            yield Problem(f"/abnormalities/{k}/prevalence", "not_whole", message)


def _extras(design: Design) -> Iterator[Problem]:
    if design.outputs.parquet and find_spec("pyarrow") is None:
        message = "found true, which needs pyarrow; expected the extra tables to be installed"
        yield Problem("/outputs/parquet", "missing_extra", message)


def _of_library(design: Design, asked: DrawnPhantom) -> Iterator[Problem]:
    """Yield what the phantom's models refuse of either end of each distribution."""
    entry = library.entry(asked.name)
    if entry.of_person is None and design.population is not None:
        message = f"found a population, but {entry.name} is nobody; expected null"
        yield Problem("/population", "no_effect", message)
    yield from _people(design, entry)
    yield from _judged(entry.parameters, asked.parameters, ("phantom", "parameters"))
    known = entry.abnormalities
    for k, wrong in enumerate(design.abnormalities):
        if wrong.type not in known:
            expected = f"one of {', '.join(known)}" if known else f"none, for {entry.name} has none"
            message = f"found {wrong.type[:60]!r}; expected {expected}"
            yield Problem(pointer(("abnormalities", k, "type")), "unknown_type", message)
            continue
        where = ("abnormalities", k, "parameters")
        yield from _judged(known[wrong.type], wrong.parameters, where, {"type": wrong.type})


def _people(design: Design, entry: library.Entry[Any]) -> Iterator[Problem]:
    """Yield what a phantom refuses of the people that may be drawn: a man with a woman's breast."""
    asked = population(design)
    if asked is None or entry.of_person is None:
        return
    shares: dict[Sex, float] = {"female": asked.female, "male": 1.0 - asked.female}
    seen = set()
    for sex, age in product((sex for sex, share in shares.items() if share > 0), asked.age_years):
        try:
            entry.of_person(library.mean_person(sex, age), stream(design.seed))
        except InvalidInputError as error:
            for problem in error.problems:
                name = "female" if problem.path == "/sex" else "age_years"
                if problem.message not in seen:
                    seen.add(problem.message)
                    yield Problem(f"/population/{name}", problem.kind, problem.message)


def _judged(
    model: type[Model],
    values: Mapping[str, Any],
    where: tuple[str | int, ...],
    given: Mapping[str, Any] | None = None,
) -> Iterator[Problem]:
    """Yield what a model refuses of the ends of each value, all others left out."""
    for name, value in values.items():
        seen = set()
        for end in ends(value):
            try:
                validate_model(model, {**(given or {}), name: end})
            except InvalidInputError as error:
                for problem in error.problems:
                    if problem.path.startswith(pointer((name,))) and problem.message not in seen:
                        seen.add(problem.message)
                        at, message = pointer((*where, name)), problem.message
                        if isinstance(value, Mapping):  # an object that is no distribution
                            message += f", or a distribution: {', '.join(TYPES)}"
                        yield Problem(at, problem.kind, message)


def _words(design: Design) -> Iterator[Problem]:
    """Yield what a request refuses of the ends of what differs from image to image."""
    at = place(design, 0)
    usual = exposure(design, at)
    for name, value in design.vary.items():
        seen = set()
        for end in ends(value):
            tree = {**request(design, at, {**usual, name: end}), "phantom": {"name": "any"}}
            try:
                validate_model(RadiographRequest, tree)
            except InvalidInputError as error:
                for problem in error.problems:
                    if problem.message not in seen:
                        seen.add(problem.message)
                        yield Problem(pointer(("vary", name)), problem.kind, problem.message)
    most = combinations(design)
    cases = design.people * design.cases_per_person
    if most is not None and cases > most:
        message = (
            f"found {cases} cases, but no more than {most} that differ: nothing else is drawn,"
            " and no noise; expected fewer, or a distribution"
        )
        yield Problem("/people", "too_many", message)


def expected_bytes(design: Design, planned: RadiographPlan) -> int:
    """Return about how large the set will be."""
    detector, kept = planned.view.detector, design.outputs
    pixels = detector.columns * detector.rows
    noisy = planned.acquisition is not None and planned.acquisition.draws
    noisy = noisy and design.quantity == "signal"
    picture = BYTES_A_PIXEL["noisy" if noisy else "ideal"] * pixels
    if kept.codes:
        picture += BYTES_A_PIXEL["codes"] * pixels
    if design.stereo is not None and design.stereo.mono != "single":
        picture *= 2.0
    if design.twins:
        shares = [asked.prevalence for asked in design.abnormalities]
        healthy = 1.0 - sum(shares) if design.exclusive else math.prod(1.0 - s for s in shares)
        picture *= 2.0 - healthy
    if kept.masks:
        picture += BYTES_A_PIXEL["mask"] * pixels
    of_case = 0
    if kept.coco:
        fixed, by_side = BYTES_A_MASK
        each = TIMES_COCO * (fixed + by_side * math.sqrt(pixels))
        picture += each * len(planned.phantom.named_leaves)
    if kept.documents:
        of_case = len(planned.phantom.document.model_dump_json(exclude_none=True))
    cases = design.people * design.cases_per_person
    return int(design.images * (picture + BYTES_AN_IMAGE) + cases * of_case)


def check_room(design: Design, planned: RadiographPlan, where: Storage) -> None:
    """Refuse a set for which there is no room.

    Raises
    ------
    InvalidInputError
        Less is free than the set takes (``/output``).
    """
    free, needed = where.free_bytes(), expected_bytes(design, planned)
    if free is not None and needed > free:
        message = (
            f"found {sized(free)} free at {where.address!r};"
            f" expected {sized(needed)}, for {design.images} images"
        )
        raise InvalidInputError([Problem("/output", "disk_too_small", message)])


def warnings(design: Design, planned: RadiographPlan) -> list[str]:
    """Return what a person should know of a design that can be made."""
    found = []
    if combinations(design) is not None:
        found.append("only so many cases differ, so some may be drawn twice")
    if planned.presentation.scope == "image" and design.outputs.form == "presentation":
        found.append("each image has greys of its own: a lesion shifts those of the rest")
    return found
