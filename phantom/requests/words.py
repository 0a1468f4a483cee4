"""The flat words of a command line or a query string, and the request that they mean."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from phantom.errors import InvalidInputError, Problem, pointer
from phantom.requests.forms import FORMS, plain, scalar

PARAMETERS = "parameters."

WORDS: Mapping[str, tuple[str, ...]] = {
    "view": ("view", "preset"),
    "source_detector_mm": ("view", "source_detector_mm"),
    "source_object_mm": ("view", "source_object_mm"),
    "object_detector_mm": ("view", "object_detector_mm"),
    "angle_deg": ("view", "angle_deg"),
    "primary_angle_deg": ("view", "primary_angle_deg"),
    "secondary_angle_deg": ("view", "secondary_angle_deg"),
    "laterality": ("view", "laterality"),
    "columns": ("detector", "columns"),
    "rows": ("detector", "rows"),
    "pitch_mm": ("detector", "pitch_mm"),
    "energy_kev": ("beam", "energy_kev"),
    "kvp": ("beam", "kvp"),
    "anode": ("beam", "anode"),
    "filtration": ("beam", "filtration_mm"),
    "acquisition": ("acquisition",),
    "dose_ugy": ("acquisition", "detector_air_kerma_ugy"),
    "mas": ("acquisition", "mas"),
    "falloff": ("acquisition", "falloff"),
    "focal_spot_mm": ("acquisition", "focal_spot", "size_mm"),
    "scatter": ("acquisition", "scatter"),
    "grid": ("acquisition", "grid"),
    "samples": ("acquisition", "samples_per_pixel"),
    "quantum_noise": ("acquisition", "quantum_noise"),
    "seed": ("noise", "seed"),
    "case": ("noise", "case"),
    "quantity": ("quantity",),
    "mode": ("presentation", "mode"),
    "scope": ("presentation", "scope"),
    "window_center": ("presentation", "window_center"),
    "window_width": ("presentation", "window_width"),
    "percentiles": ("presentation", "percentiles"),
    "polarity": ("presentation", "polarity"),
    "bits": ("presentation", "bits"),
    "gsdf": ("presentation", "gsdf"),
    "truth": ("truth",),
    "blind": ("blind",),
}
"""Where each word's value stands in a request."""

OF_EYES: Mapping[str, tuple[str, ...]] = {
    "method": ("stereo", "method"),
    "baseline_mm": ("stereo", "baseline_mm"),
    "stereo_angle_deg": ("stereo", "angle_deg"),
    "zero_parallax": ("stereo", "zero_parallax"),
    "screen": ("stereo", "screen"),
    "mono": ("stereo", "mono"),
    "layout": ("stereo", "layout"),
    "format": ("stereo", "format"),
}
"""What a pair of any kind is asked for with."""

STEREO_WORDS: Mapping[str, tuple[str, ...]] = {**WORDS, **OF_EYES, "dose": ("stereo", "dose")}
"""Those of a pair of radiographs."""

RENDER_WORDS: Mapping[str, tuple[str, ...]] = {
    "view": ("camera", "preset"),
    "azimuth_deg": ("camera", "azimuth_deg"),
    "elevation_deg": ("camera", "elevation_deg"),
    "parallel": ("camera", "parallel"),
    "field_of_view_deg": ("camera", "field_of_view_deg"),
    "zoom": ("camera", "zoom"),
    "columns": ("camera", "columns"),
    "rows": ("camera", "rows"),
    "hide": ("hide",),
    "samples_per_pixel": ("samples_per_pixel",),
    "lighting": ("lighting",),
    "shadows": ("lighting", "shadows"),
    "background": ("background",),
    "mode": ("tone", "mode"),
    "bits": ("tone", "bits"),
}
"""The same for a picture in visible light."""

RENDER_PAIR_WORDS: Mapping[str, tuple[str, ...]] = {**RENDER_WORDS, **OF_EYES}
"""The same for a pair of them."""

WHOLE = frozenset({"view", "acquisition", "lighting"})
"""Words that may be a JSON object, which is then the part of the request that they stand in."""


def parameters(pairs: Iterable[tuple[str, str]]) -> dict[str, object]:
    """Return the phantom's parameters from (name, text) pairs; a name given twice is refused."""
    found: dict[str, object] = {}
    for name, text in pairs:
        if name in found:
            path = pointer(("phantom", "parameters", name))
            raise InvalidInputError([Problem(path, "given_twice", "found it twice; expected once")])
        found[name] = scalar(text)
    return found


def abnormality(text: str) -> object:
    """Return an abnormality written TYPE,NAME=VALUE,..., or as a JSON object.

    A part without an equals sign is refused with the path of the whole.
    """
    if text.lstrip()[:1] == "{":
        return scalar(text)
    kind, *parts = text.split(",")
    found: dict[str, object] = {"type": kind.strip()}
    for part in parts:
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not (name and equals) or name in found:
            message = f"found {part[:60]!r}; expected NAME=VALUE, each name once"
            path = pointer(("phantom", "abnormalities"))
            raise InvalidInputError([Problem(path, "not_a_pair", message)])
        found[name] = scalar(value)
    return found


def request_tree(
    phantom: Mapping[str, object],
    words: Iterable[tuple[str, str]],
    known: Mapping[str, tuple[str, ...]] = WORDS,
) -> tuple[dict[str, object], tuple[Problem, ...]]:
    """Return the request that the words ask for, as it would stand in JSON, and what is wrong.

    A word of :data:`WHOLE` that is a JSON object is taken as it is, so that all of it can be given;
    other words add to it. Some words have a form of their own, see
    :mod:`phantom.requests.forms`. Words that are not known, or that give a field twice, are
    problems.
    """
    tree: dict[str, object] = {"phantom": dict(phantom)}
    problems: list[Problem] = []
    for word, text in sorted(words, key=lambda pair: pair[0] not in WHOLE):
        path = known.get(word)
        if path is None:
            message = f"found an unknown word; expected one of {', '.join(known)}"
            problems.append(Problem(pointer([word]), "unknown_field", message))
            continue
        value, wrong = FORMS.get(word, plain)(text, path)
        problems += wrong
        if word in WHOLE and isinstance(value, dict):
            for name, part in value.items():
                problems += _place(tree, (path[0], name), part)
        else:
            problems += _place(tree, path, value)
    return tree, tuple(problems)


def _place(tree: dict[str, object], path: tuple[str, ...], value: object) -> list[Problem]:
    """Put a value where the request has it, unless there is one already."""
    *sections, name = path
    for section in sections:
        inner = tree.setdefault(section, {})
        if not isinstance(inner, dict):
            return [_twice(path)]
        tree = inner
    if name in tree:
        return [_twice(path)]
    tree[name] = value
    return []


def _twice(path: tuple[str, ...]) -> Problem:
    return Problem(pointer(path), "given_twice", "found it twice; expected once")
