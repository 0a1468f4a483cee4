"""Image i of a design: whose it is, what is wrong, and the request that makes it.

Everything is a function of (design, seed, i). Each number comes from a stream of its own, whose
key starts with the person and says what is drawn (`phantom.datasets.draws`); so a design with one
more parameter, view or abnormality draws all else as before. Where prevalence is exact, which cases
have an abnormality is one order of all cases of a split (`phantom.datasets.presence`).

What is drawn may not fit: a finding too large for a thin person. It is then drawn again, from a
stream whose key counts the tries: first the finding, and the person only where the healthy phantom
is refused too. Whether a case has an abnormality is drawn once, so that prevalence stays.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from phantom import library
from phantom.datasets.design import Design, DrawnPhantom
from phantom.datasets.draws import Draw, drawn, stream, word
from phantom.datasets.places import Place
from phantom.datasets.presence import present
from phantom.errors import InvalidInputError
from phantom.library import Person, Population
from phantom.requests.words import WORDS

if TYPE_CHECKING:
    from phantom.scene import Phantom

PERSON, PARAMETERS, FINDING, EXPOSURE = 0, 1, 3, 4
"""What is drawn: the second number of a key; 2 and 5 are of `phantom.datasets.presence`."""

TRIES: Final = 8
"""Of a person, and of what is wrong with a case, before the image is given up."""


@dataclass(frozen=True, slots=True)
class Subject:
    """Who is X-rayed, and with what: what a case is before it is placed.

    Attributes
    ----------
    person
        Who; None for a phantom that is nobody.
    parameters
        Of the phantom.
    abnormalities
        What is wrong, each as a request has it, with its type.
    """

    person: Person | None
    parameters: Mapping[str, Any]
    abnormalities: tuple[Mapping[str, Any], ...] = ()


def population(design: Design) -> Population | None:
    """Return who is X-rayed; None where the phantom is nobody, or its own defaults are wanted.

    What is not said of them is as the phantom has it: a breast is a woman's.
    """
    asked = design.population
    if not isinstance(design.phantom, DrawnPhantom):
        return asked
    entry = library.entry(design.phantom.name)
    if entry.of_person is None or (asked is None and "population" in design.model_fields_set):
        return asked
    said = {} if asked is None else {n: getattr(asked, n) for n in asked.model_fields_set}
    return entry.people.model_copy(update=said)


def healthy(design: Design, person: int, attempt: int = 0) -> Subject:
    """Return a person's phantom with nothing wrong."""
    if not isinstance(design.phantom, DrawnPhantom):
        return Subject(None, {})
    seed, who, found = design.seed, None, dict[str, Any]()
    people = population(design)
    of_person = library.entry(design.phantom.name).of_person
    if people is not None and of_person is not None:
        generator = stream(seed, person, PERSON, attempt)
        who = people.draw(generator)
        found = of_person(who, generator).model_dump(mode="json")
    for name, value in design.phantom.parameters.items():
        found[name] = drawn(value, seed, person, PARAMETERS, attempt, word(name))
    return Subject(who, found)


def findings(design: Design, at: Place, attempt: int = 0) -> tuple[Mapping[str, Any], ...]:
    """Return what is wrong with a case."""
    found = []
    for k in present(design, at):
        asked = design.abnormalities[k]
        key = (design.seed, at.person, FINDING, at.case, attempt, k)
        content = {n: drawn(v, *key, word(n)) for n, v in asked.parameters.items()}
        found.append({"type": asked.type, **content})
    return tuple(found)


def exposure(design: Design, at: Place) -> dict[str, Any]:
    """Return the words that are drawn for an image."""
    key = (design.seed, at.person, EXPOSURE, at.case, at.view)
    return {name: drawn(value, *key, word(name)) for name, value in design.vary.items()}


def request(design: Design, at: Place, words: Mapping[str, Any]) -> dict[str, Any]:
    """Return the request of an image, without its phantom, as decoded from JSON."""
    said = design.tree()
    views = said.get("views", [{}])
    tree: dict[str, Any] = {
        "view": dict(views[at.view]),
        "detector": said.get("detector", {}),
        "beam": dict(said.get("beam", {})),
        "quantity": design.quantity,
        "presentation": said.get("presentation", {}),
        "truth": list(design.truth),
        "blind": design.blind,
    }
    asked = said.get("acquisition", {})
    tree["acquisition"] = None if asked is None else dict(asked)
    if asked is not None:
        noise = {"seed": design.seed, "case": at.case_number(design), "view": at.view}
        tree["noise"] = noise
    for name, value in words.items():
        _put(tree, WORDS[name], value)
    return tree


def _put(tree: dict[str, Any], path: tuple[str, ...], value: object) -> None:
    *sections, name = path
    for section in sections:
        inner = dict(tree.get(section) or {})
        tree[section] = inner
        tree = inner
    tree[name] = value


class Case(NamedTuple):
    """A case that fits.

    Attributes
    ----------
    subject
        Who and what.
    phantom
        Ready to be X-rayed.
    twin
        The phantom with nothing wrong; None where nothing is, or where nothing is held against it.
    """

    subject: Subject
    phantom: Phantom
    twin: Phantom | None


def case(design: Design, at: Place, prepared: Callable[[Subject], Phantom]) -> Case:
    """Return the case of an image, drawn until it fits.

    Parameters
    ----------
    design, at
        Whose.
    prepared
        Makes the phantom of a subject; refuses what does not fit.

    Raises
    ------
    InvalidInputError
        Nothing that was drawn fits: what was wrong with the last of it.
    """
    refusal: InvalidInputError | None = None
    for who in range(TRIES):
        try:
            plain = healthy(design, at.person, who)
        except InvalidInputError as error:
            refusal = error
            continue
        for attempt in range(TRIES):
            subject = replace(plain, abnormalities=findings(design, at, attempt))
            try:
                phantom = prepared(subject)
            except InvalidInputError as error:
                refusal = error
            else:
                wanted = (design.twins or design.outputs.visibility) and subject.abnormalities
                return Case(subject, phantom, prepared(plain) if wanted else None)
            if not subject.abnormalities or not _is_sound(plain, prepared):
                break
    assert refusal is not None
    raise refusal


def _is_sound(subject: Subject, prepared: Callable[[Subject], Phantom]) -> bool:
    try:
        prepared(subject)
    except InvalidInputError:
        return False
    return True


def combinations(design: Design) -> int | None:
    """Return how many different cases there can be; None for any number of them."""
    draws = list(design.vary.values())
    if isinstance(design.phantom, DrawnPhantom):
        draws += design.phantom.parameters.values()
    of_findings = 1
    for asked in design.abnormalities:
        own = 1
        for value in asked.parameters.values():
            kinds = value.kinds if isinstance(value, Draw) else 1
            if kinds is None and asked.prevalence > 0:
                return None
            own *= kinds or 1
        states = (1 if asked.prevalence < 1 else 0) + (own if asked.prevalence > 0 else 0)
        of_findings = of_findings + states - 1 if design.exclusive else of_findings * states
    total = of_findings
    for value in draws:
        kinds = value.kinds if isinstance(value, Draw) else 1
        if kinds is None:
            return None
        total *= kinds
    if population(design) is not None:
        return None
    noisy = design.acquisition is not None and design.acquisition.draws
    return None if noisy and design.quantity == "signal" else total
