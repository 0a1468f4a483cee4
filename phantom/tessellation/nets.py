"""The (u, v) net of a solid: its surface as functions of two parameters.

A net is what the paper draws in figures 8 and 9: rings, at one u each, and lines along u. Rings
are closed in v; the body between the first and the last ring is closed by flat ends, by points, or
by meeting itself.
"""

from __future__ import annotations

from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
End = Literal["flat", "point", "seam"]


class Net(Protocol):
    """A surface over ``u_breaks[0] <= u <= u_breaks[-1]``, closed in v, smooth between breaks."""

    @property
    def u_breaks(self) -> Floats:
        """Parameters u where a derivative may jump, both ends included."""

    @property
    def v_breaks(self) -> Floats:
        """Parameters v where a derivative may jump; the last is the first, once round."""

    @property
    def ends(self) -> tuple[End, End]:
        """How the body ends at the first and the last u; both are ``seam`` on a closed axis."""

    def points(self, u: Floats, u_piece: Ints, v: Floats, v_piece: Ints) -> Floats:
        """Return the surface ``(u, v, 3)`` in mm on the named intervals between breaks."""


def pieces_of(breaks: Floats, at: Floats) -> Ints:
    """Return the interval between breaks of each parameter; at a break the one that follows."""
    found = np.searchsorted(breaks, at, side="right") - 1
    return np.clip(found, 0, len(breaks) - 2)
