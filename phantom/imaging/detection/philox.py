"""Random bits that depend on a key and a counter alone: Philox4x32-10.

J. K. Salmon, M. A. Moraes, R. O. Dror and D. E. Shaw, *Parallel random numbers: as easy as 1, 2,
3*, SC '11 (2011), doi:10.1145/2063384.2063405, section 3.3. Nothing is carried from one value to
the next, so that a pixel has the same bits in whatever tile, thread or crop it is computed.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint64]
"""32-bit words, each held in 64 bits so that a product of two has room."""

_ROUNDS: Final = 10
_MULTIPLIERS: Final = (np.uint64(0xD2511F53), np.uint64(0xCD9E8D57))
_WEYL: Final = (0x9E3779B9, 0xBB67AE85)
_LOW: Final = np.uint64(0xFFFFFFFF)
_32: Final = np.uint64(32)


def philox4x32(
    counter: tuple[Words, Words, Words, Words], key: tuple[int, int]
) -> tuple[Words, Words, Words, Words]:
    """Return four words of 32 random bits for every counter.

    Parameters
    ----------
    counter
        Four arrays of words below 2³² that broadcast together.
    key
        Two words below 2³².
    """
    c0, c1, c2, c3 = counter
    k0, k1 = key
    for _ in range(_ROUNDS):
        first, second = c0 * _MULTIPLIERS[0], c2 * _MULTIPLIERS[1]
        c0, c1, c2, c3 = (
            (second >> _32) ^ c1 ^ np.uint64(k0),
            second & _LOW,
            (first >> _32) ^ c3 ^ np.uint64(k1),
            first & _LOW,
        )
        k0, k1 = (k0 + _WEYL[0]) & 0xFFFFFFFF, (k1 + _WEYL[1]) & 0xFFFFFFFF
    return c0, c1, c2, c3


def fractions(high: Words, low: Words) -> NDArray[np.float64]:
    """Return numbers inside (0, 1), 2⁵² of them equally far apart, from two words of bits."""
    bits = (high << _32 | low) >> np.uint64(12)
    # Half a step up, so that neither 0 nor 1 can come out and an inverse is always finite.
    return (bits.astype(np.float64) + 0.5) * 2.0**-52
