"""From the analogue signal to whole codes: saturation, gain, offset and bits."""

from __future__ import annotations

import numpy as np

from phantom.imaging.detection.receptor import Digitizer
from phantom.imaging.view import FloatArray


def digitize(signal: FloatArray, digitizer: Digitizer) -> FloatArray:
    """Return the codes of a signal: whole numbers from 0 to 2^bits − 1, as floats.

    ``round(offset + gain · min(signal, saturation))``, halves to even, cut to the codes there are.
    """
    limited = signal
    if digitizer.saturation_signal is not None:
        limited = np.minimum(signal, digitizer.saturation_signal)
    codes = np.rint(digitizer.offset_codes + digitizer.codes_per_signal * limited)
    found: FloatArray = np.clip(codes, 0.0, 2.0**digitizer.bits - 1)
    return found
