"""Where the metacarpals' bases meet the carpals: the thumb's saddle, the hollows of the others."""

from __future__ import annotations

from typing import Final

from phantom.document import Solid
from phantoms.hand.carpus import GAP_MM, SHELL_MM
from phantoms.hand.frames import Frame
from phantoms.hand.rows import times
from phantoms.hand.tubular import CORTEX, SPONGIOSA, Knob

# In the frame of the thumb's metacarpal.
_SADDLE: Final = Knob("saddle", (-0.6, 0.0, -5.4), (8.6, 6.2, 5.0))
# Center and semi-axes of what a base is hollowed by, in the frame of its metacarpal.
_HOLLOWS: Final = {
    "index": ((0.8, 0.0, -9.4), (8.4, 14.0, 10.0)),
    "middle": ((0.0, 0.0, -30.0), (22.0, 22.0, 30.0)),
    "ring": ((0.0, 0.0, -24.0), (16.0, 16.0, 24.2)),
    "little": ((0.0, 0.0, -20.0), (13.0, 13.0, 20.4)),
}


def saddle(scale: float, frame: Frame) -> tuple[Solid, Solid]:
    """Return cortex and spongiosa of the trapezium's joint surface for the thumb."""
    knob = _scaled(_SADDLE, scale)
    shell = knob.solid("saddle cortex", CORTEX)
    core = knob.grown(-SHELL_MM).solid("saddle spongiosa", SPONGIOSA)
    return frame.placed(None, shell), frame.placed(None, core)


def carpal_hollows(digit: str, scale: float) -> tuple[Knob, ...]:
    """Return what is taken out of the base of a metacarpal, in its own frame."""
    if digit == "thumb":
        return (_scaled(_SADDLE, scale).grown(GAP_MM * scale),)
    center, semi_axes = _HOLLOWS[digit]
    return (_scaled(Knob("carpal", center, semi_axes), scale),)


def _scaled(knob: Knob, scale: float) -> Knob:
    return knob._replace(center=times(knob.center, scale), semi_axes=times(knob.semi_axes, scale))
