"""How pixel values follow the X-rays: Pixel Intensity Relationship and its sign."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from phantom.encode.content import Take, Taken, Wanted
    from phantom.encode.picture import Picture

SAMPLES_A_SIDE: Final = 256


class Intensity(NamedTuple):
    """PS3.3 C.8.11.3.1.2.

    Attributes
    ----------
    relationship
        ``LIN`` where values follow the intensity, ``LOG`` where they follow its logarithm.
    sign
        1 where more intensity gives greater values, -1 where it gives smaller ones.
    """

    relationship: str
    sign: int


def intensity(pixels: NDArray[Any], transmission: NDArray[Any]) -> Intensity:
    """Return which of the four the pixels follow most closely, whatever presentation made them.

    Judged by Pearson's correlation over at most 256 × 256 of the (rows, columns) pixels. Where
    nothing varies it is ``LIN`` and -1, bones white.
    """
    step = tuple(slice(None, None, max(1, side // SAMPLES_A_SIDE)) for side in pixels.shape)
    values = pixels[step].astype(np.float64).ravel()
    through = np.maximum(transmission[step].astype(np.float64).ravel(), np.finfo(np.float32).tiny)
    linear, logarithmic = _correlation(values, through), _correlation(values, np.log(through))
    closest = linear if abs(linear) >= abs(logarithmic) else logarithmic
    return Intensity("LIN" if closest is linear else "LOG", 1 if closest > 0 else -1)


def judged(take: Take) -> Take:
    """Return the taking with the intensity of what it took said as ``intensity``."""

    def taken(picture: Picture[Any], wanted: Wanted) -> Taken:
        layers, file = take(picture, wanted)
        found = intensity(layers[wanted.quantity], picture.quantity("transmission"))
        return layers, {**file, "intensity": list(found)}

    return taken


def _correlation(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    one, other = one - one.mean(), other - other.mean()
    size = float(np.sqrt((one @ one) * (other @ other)))
    return float(one @ other) / size if size > 0 else 0.0
