"""What a caller asks of an image: models that refuse in this package's words.

A model of pydantic raises its own error when it is called. These raise the problems that a request
over HTTP, or a command line, would give for the same fault, with the same paths.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic import ValidationError

from phantom.document.base import Model
from phantom.document.validation import translated
from phantom.errors import InvalidInputError, prefixed

if TYPE_CHECKING:

    class Asked(Model):
        """A frozen model; ``place`` is its JSON pointer in a request."""

        place: ClassVar[str]

else:
    # Only a call from Python passes through here: pydantic builds the parts of a larger model
    # without calling their class, so their problems are told once, by the whole.
    class _Meta(type(Model)):
        def __call__(cls, *args: Any, **fields: Any) -> Any:
            try:
                return super().__call__(*args, **fields)
            except ValidationError as error:
                problems = prefixed(cls.place, translated(error, fields))
            raise InvalidInputError(problems)

    class Asked(Model, metaclass=_Meta):
        """A frozen model; ``place`` is its JSON pointer in a request."""

        place: ClassVar[str] = ""


def plain(value: object) -> object:
    """Turn a numpy array, or number, into plain lists and numbers; leave all else."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
