"""Cubic splines against scipy's, an independent program."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from phantom.geometry.splines import not_a_knot, periodic


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6, 17, 300])
@pytest.mark.parametrize("shape", [(), (3,), (2, 2)])
@pytest.mark.parametrize("seed", range(3))
def test_not_a_knot(count, shape, seed):
    rng = np.random.default_rng(seed)
    x = np.cumsum(10 ** rng.uniform(-2, 0, count))
    y = rng.normal(0, 10, (count, *shape))
    mine, theirs = not_a_knot(x, y), CubicSpline(x, y, bc_type="not-a-knot")
    u = np.linspace(x[0], x[-1], 500)
    assert mine(u) == pytest.approx(theirs(u), rel=1e-11, abs=1e-11 * np.abs(theirs(u)).max())


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6, 17, 300])
@pytest.mark.parametrize("seed", range(3))
def test_periodic(count, seed):
    rng = np.random.default_rng(seed)
    x = np.cumsum(10 ** rng.uniform(-2, 0, count + 1))
    y = rng.normal(0, 10, (count + 1, 2))
    y[-1] = y[0]
    mine, theirs = periodic(x, y), CubicSpline(x, y, bc_type="periodic")
    u = np.linspace(x[0], x[-1], 500)
    assert mine(u) == pytest.approx(theirs(u), rel=1e-11, abs=1e-11 * np.abs(theirs(u)).max())


def test_a_cubic_is_its_own_spline():
    x = np.array([0, 1e-3, 0.5, 3.0])
    given = np.polynomial.Polynomial([1, -2, 0.5, 3])
    u = np.linspace(0, 3, 50)
    assert not_a_knot(x, given(x))(u) == pytest.approx(given(u), rel=1e-11)
