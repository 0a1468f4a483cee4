"""A design for the impatient: so many images of a phantom, everything else chosen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, get_args

from phantom import library
from phantom.datasets.design import Design
from phantom.document import Model, validate_model
from phantom.errors import InvalidInputError

SCATTER: Final = 0.1
"""Standard deviation of a parameter, as a share of its default, where nobody's size is known."""

ABNORMAL: Final = 0.5
"""Share of the cases that have an abnormality, where the phantom can have one."""

SIDE: Final = 512


def quick(
    name: str,
    count: int,
    *,
    parameters: Mapping[str, Any] | None = None,
    seed: int = 0,
    side: int = SIDE,
) -> Design:
    """Return a design of ``count`` images of a library phantom, one of each person.

    People differ as people do where the phantom is somebody; else each of its measures scatters by
    a tenth about its default, and each choice is drawn. Half of the cases have one of its
    abnormalities, if it has any. What ``parameters`` says is as it says.

    Raises
    ------
    UnknownPhantomError, InvalidInputError
        No such phantom, or a value that does not do.
    """
    entry = library.entry(name)
    given = dict(parameters or {})
    drawn = {} if entry.of_person is not None else scattered(entry.parameters)
    wrong = [
        {
            "type": kind,
            "prevalence": round(ABNORMAL / len(entry.abnormalities), 6),
            "parameters": scattered(model),
        }
        for kind, model in entry.abnormalities.items()
    ]
    tree: dict[str, Any] = {
        "name": f"{name}-{count}",
        "phantom": {"name": name, "parameters": {**drawn, **given}},
        "people": count,
        "detector": {"columns": side, "rows": side},
        "seed": seed,
    }
    if wrong:
        tree |= {"abnormalities": wrong, "exclusive": True}
    if count < FEW:
        tree["splits"] = {"train": 1.0}
    return validate_model(Design, tree)


FEW: Final = 10
"""Sets of fewer images have one split."""


def scattered(model: type[Model]) -> dict[str, Any]:
    """Return a distribution for each measure and each choice of a model that has a default.

    One whose ends do not go with the defaults of the others stays as it is.
    """
    found: dict[str, Any] = {}
    schema = model.model_json_schema()["properties"]
    for name, field in model.model_fields.items():
        default, told = field.default, schema[name]
        choices = get_args(field.annotation)
        if name == "type" or default is None:
            continue
        if isinstance(default, str) and choices and all(isinstance(c, str) for c in choices):
            found[name] = {"type": "choice", "values": list(choices)}
        elif isinstance(default, float) and default > 0:
            sd = SCATTER * default
            low = max(told.get("minimum", 0.0), default - 3 * sd)
            high = min(told.get("maximum", default + 3 * sd), default + 3 * sd)
            if low < high:
                shape = {"mean": default, "sd": sd, "low": low, "high": high}
                shape = {k: _short(v) for k, v in shape.items()}
                if all(_goes(model, name, shape[end]) for end in ("low", "high")):
                    found[name] = {"type": "normal", **shape}
    return found


def _goes(model: type[Model], name: str, value: float) -> bool:
    try:
        validate_model(model, {name: value})
    except InvalidInputError as error:
        return not any(problem.path.startswith(f"/{name}") for problem in error.problems)
    return True


def _short(number: float) -> float:
    return float(f"{number:.6g}")
