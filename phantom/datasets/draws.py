"""Numbers that are drawn: what a design says of them, and the streams they come from.

A stream is NumPy's Philox generator, seeded by ``SeedSequence(entropy=seed, spawn_key=key)``: keys
that differ give independent streams, and nothing depends on the order in which they are asked.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, Self

from pydantic import Field, model_validator

from phantom.document import Model, told
from phantom.document.base import Choice, Number, refuse

if TYPE_CHECKING:
    import numpy as np

TYPES: Final = ("uniform", "log_uniform", "normal", "choice")


class _Drawn(Model):
    """A distribution; its type is said even where it was left out."""

    @model_validator(mode="after")
    def _says_its_type(self) -> Self:
        self.__pydantic_fields_set__.add("type")
        return self


class _Between(_Drawn):
    """Numbers between two ends."""

    low: Annotated[Number, told("Low", "its own", "The least.")]
    high: Annotated[Number, told("High", "its own", "The greatest.")]

    @model_validator(mode="after")
    def _rises(self) -> Self:
        if self.high < self.low:
            message = f"found {self.high:g}; expected {self.low:g}, the low end, or more"
            refuse("bad_range", (("high",), message))
        return self

    @property
    def ends(self) -> tuple[Any, ...]:
        """What it may be at the most and at the least."""
        return (self.low, self.high)

    @property
    def kinds(self) -> int | None:
        """How many values there are; None for any number of them."""
        return 1 if self.low == self.high else None


class Uniform(_Between):
    """Any number of a range alike."""

    type: Literal["uniform"] = "uniform"

    def at(self, chance: float) -> Any:
        """Return the value with this share, in (0, 1), below it."""
        return self.low + (self.high - self.low) * chance


class LogUniform(_Between):
    """Numbers above 0 whose logarithm is uniform."""

    type: Literal["log_uniform"] = "log_uniform"
    low: Annotated[Annotated[Number, Field(gt=0)], told("Low", "its own", "The least, above 0.")]

    def at(self, chance: float) -> Any:
        """Return the value with this share, in (0, 1), below it."""
        found = math.exp(math.log(self.low) + math.log(self.high / self.low) * chance)
        return min(max(found, self.low), self.high)


class Normal(_Between):
    """A normal distribution, cut off at both ends."""

    type: Literal["normal"] = "normal"
    mean: Annotated[Number, told("Mean", "its own", "Before the ends are cut off.")]
    sd: Annotated[
        Annotated[Number, Field(gt=0)], told("Standard deviation", "its own", "Before that.")
    ]

    @model_validator(mode="after")
    def _has_some(self) -> Self:
        from scipy.special import ndtr

        share = float(
            ndtr((self.high - self.mean) / self.sd) - ndtr((self.low - self.mean) / self.sd)
        )
        if self.low < self.high and share < 1e-6:
            message = f"found {share:.1g} of it between the ends; expected a millionth or more"
            refuse("bad_range", (("mean",), message))
        return self

    def at(self, chance: float) -> Any:
        """Return the value with this share, in (0, 1), below it."""
        from scipy.special import ndtr, ndtri

        below, above = (float(ndtr((end - self.mean) / self.sd)) for end in (self.low, self.high))
        found = self.mean + self.sd * float(ndtri(below + (above - below) * chance))
        return min(max(found, self.low), self.high)


class Choose(_Drawn):
    """One of some values."""

    type: Literal["choice"] = "choice"
    values: Annotated[
        tuple[Any, ...], told("Values", "its own", "What it may be.", min_length=1, max_length=1000)
    ]
    weights: Annotated[
        tuple[Annotated[Number, Field(ge=0)], ...] | None,
        told("Weights", "none", "How often each, against the others; all alike by default."),
    ] = None

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.weights is not None:
            if len(self.weights) != len(self.values):
                message = f"found {len(self.weights)}; expected one a value, {len(self.values)}"
                refuse("wrong_length", (("weights",), message))
            if sum(self.weights) <= 0:
                refuse("bad_range", (("weights",), "found nothing but 0; expected some weight"))
        return self

    @property
    def ends(self) -> tuple[Any, ...]:
        """All that it may be."""
        return self.values

    @property
    def kinds(self) -> int | None:
        """How many values there are."""
        return len(self.values)

    def at(self, chance: float) -> Any:
        """Return the value with this share, in (0, 1), below it."""
        weights = self.weights or (1.0,) * len(self.values)
        left = chance * sum(weights)
        for value, weight in zip(self.values, weights, strict=True):
            left -= weight
            if left < 0:
                return value
        return self.values[-1]


Draw = Uniform | LogUniform | Normal | Choose


def _kind(value: Any) -> str:
    found = value.get("type") if isinstance(value, Mapping) else getattr(value, "type", None)
    return found if found in TYPES else "constant"


Value = Annotated[
    Uniform | LogUniform | Normal | Choose | Any,
    Choice(_kind, (*TYPES, "constant"), "unknown_type", "a value, or an object with a type"),
]
"""A distribution, by its ``type``, or else the value itself."""


def ends(value: object) -> tuple[Any, ...]:
    """Return what a value may be at its ends; itself where it is not drawn."""
    return value.ends if isinstance(value, Draw) else (value,)


def kinds(value: object) -> int | None:
    """Return how many values there are; None for any number of them."""
    return value.kinds if isinstance(value, Draw) else 1


def drawn(value: object, seed: int, *key: int) -> Any:
    """Return the value, drawn from the stream of this key where it is a distribution."""
    return value.at(chance(seed, *key)) if isinstance(value, Draw) else value


def stream(seed: int, *key: int) -> np.random.Generator:
    """Return the generator of this key."""
    import numpy as np

    sequence = np.random.SeedSequence(entropy=seed, spawn_key=key)
    return np.random.Generator(np.random.Philox(sequence))


def chance(seed: int, *key: int) -> float:
    """Return a uniform number in (0, 1)."""
    found = float(stream(seed, *key).random())
    return found if found > 0.0 else 2.0**-54


def word(name: str) -> int:
    """Return the number that stands for a name in a key, so that other names do not shift it."""
    return zlib.crc32(name.encode())
