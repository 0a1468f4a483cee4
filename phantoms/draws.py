"""What a seed that is a parameter draws from."""

from __future__ import annotations

import numpy as np


def generator_of(seed: int) -> np.random.Generator:
    """Return the generator of a seed, counter-based, the same on every machine."""
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(seed)))
