"""Scatter against photons followed one by one, and the grid against its definitions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phantom.imaging.detection import (
    Acquisition,
    Grid,
    Scatter,
    Window,
    air_gap_mm,
    scatter_lattice,
)
from phantom.imaging.detection.multiple import multiple
from phantom.imaging.detection.scatter import ScatterField, interpolated, scatter_field
from phantom.imaging.detection.slab import amounts, kernel_per_mm2, single, water
from phantom.imaging.view import Detector, View

# Printed by bench/scatter_in_water.py (400 000 histories): keV, mm of water, photons scattered once
# over unscattered, scattered more often over scattered once, energy kept of those scattered once.
FOLLOWED = [
    (20, 50, 0.4192, 0.412, 0.997),
    (40, 100, 0.6416, 1.315, 0.987),
    (60, 50, 0.3661, 0.917, 0.972),
    (60, 200, 0.9498, 3.638, 0.981),
    (100, 100, 0.5734, 1.914, 0.956),
    (120, 20, 0.1569, 0.375, 0.932),
    (140, 300, 1.1528, 7.177, 0.953),
]
VIEW = View(
    source=(0, -1000, 0),
    detector=Detector(
        center=(0, 0, 0), right=(1, 0, 0), down=(0, 0, -1), columns=400, rows=400, pitch_mm=5.0
    ),
)


@pytest.mark.parametrize(("energy", "thickness", "once", "more", "kept"), FOLLOWED)
def test_amounts_are_those_of_photons_followed_one_by_one(
    energy: float, thickness: float, once: float, more: float, kept: float
) -> None:
    number, left = single(float(energy), np.array([float(thickness)]))
    assert number[0] == pytest.approx(once, rel=0.03)
    assert left[0] / energy == pytest.approx(kept, abs=0.005)
    assert multiple(energy, np.array([thickness])).ratio[0] == pytest.approx(more, rel=0.03)


@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize(
    ("energy", "thickness", "gap"), [(60, 200, 50), (30, 40, 0), (90, 100, 300)]
)
def test_kernels_add_to_one_over_the_plane(
    energy: float, thickness: float, gap: float, order: int
) -> None:
    radii = np.geomspace(1e-4, 1e6, 6001)
    density = kernel_per_mm2(float(energy), float(thickness), float(gap), radii, order)
    whole = np.trapezoid(density * 2 * math.pi * radii**2, np.log(radii))
    assert whole == pytest.approx(1, rel=2e-3)


def test_rings_of_photons_scattered_once_are_those_followed() -> None:
    # Printed by bench/scatter_in_water.py: 50 mm behind 100 mm of water at 100 keV.
    followed = [0.0403, 0.1048, 0.3599, 0.6982, 0.9310]
    radii = np.geomspace(1e-3, 200, 4001)
    density = kernel_per_mm2(100.0, 100.0, 50.0, radii, 0) * 2 * math.pi * radii
    inside = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(radii))])
    found = np.interp([10, 20, 50, 100, 200], radii, inside)
    assert found == pytest.approx(followed, abs=0.01)


def water_slab(thickness: float, acquisition: Acquisition, gap: float = 50.0) -> ScatterField:
    lattice = scatter_lattice(VIEW.detector)
    lengths = np.full((lattice.rows, lattice.columns, 1), thickness)
    mu = np.array([[water(60.0).attenuation_per_mm]])
    return scatter_field(lengths, mu, np.array([60.0]), np.array([1000.0]), acquisition, VIEW, gap)


def test_behind_a_wide_slab_the_middle_has_the_scatter_of_an_infinite_one() -> None:
    field = water_slab(150.0, Acquisition(scatter=Scatter()))
    assert field.photons is not None
    primary = 1000 * math.exp(-water(60.0).attenuation_per_mm * 150)
    number, left = amounts(60.0, np.array([150.0]))
    # Two metres of field: a thirtieth of what is scattered more than once comes from beyond.
    middle = field.photons[0, 32, 32] / primary
    assert middle == pytest.approx(float(number.sum()), rel=0.03)
    assert middle < float(number.sum())
    assert field.photons[0, 0, 0] < 0.4 * field.photons[0, 32, 32]
    assert field.energies_kev[0] == pytest.approx(float((number * left).sum() / number.sum()))


def test_a_smaller_field_and_a_longer_gap_scatter_less() -> None:
    scatter = Acquisition(scatter=Scatter())
    wide = water_slab(200.0, scatter)
    far = water_slab(200.0, scatter, gap=600.0)
    assert wide.scatter_to_primary is not None
    assert far.scatter_to_primary is not None
    assert far.scatter_to_primary < 0.8 * wide.scatter_to_primary
    asked = water_slab(200.0, Acquisition(scatter=Scatter(air_gap_mm=600.0)))
    assert asked.scatter_to_primary == far.scatter_to_primary
    lengths = np.zeros((64, 64, 1))
    lengths[30:34, 30:34] = 200.0
    lengths[:30] = lengths[34:] = 1e4
    lengths[:, :30] = lengths[:, 34:] = 1e4
    mu = np.array([[water(60.0).attenuation_per_mm]])
    slit = scatter_field(lengths, mu, np.array([60.0]), np.array([1000.0]), scatter, VIEW, 50.0)
    assert wide.photons is not None
    assert slit.photons is not None
    assert slit.photons[0, 32, 32] < 0.5 * wide.photons[0, 32, 32]


def test_nothing_in_the_beam_scatters_nothing() -> None:
    field = water_slab(0.0, Acquisition(scatter=Scatter()))
    assert field.photons is not None
    assert (field.photons == 0).all()
    assert field.scatter_to_primary == 0


def test_a_grid_by_its_definitions() -> None:
    grid = Grid(primary_transmission=0.7, scatter_transmission=0.12)
    bare = water_slab(200.0, Acquisition(scatter=Scatter()))
    behind = water_slab(200.0, Acquisition(scatter=Scatter(), grid=grid))
    assert bare.photons is not None
    assert behind.photons is not None
    assert behind.photons == pytest.approx(0.12 * bare.photons)
    ratio = bare.scatter_to_primary
    assert ratio is not None
    assert behind.scatter_to_primary == ratio
    # IEC 60627: total transmission (P Tp + S Ts)/(P + S), Bucky factor its inverse.
    assert behind.bucky_factor == pytest.approx((1 + ratio) / (0.7 + 0.12 * ratio))
    assert bare.bucky_factor is None
    alone = water_slab(200.0, Acquisition(grid=grid))
    assert alone.bucky_factor == pytest.approx(1 / 0.7)


def test_a_straight_line_is_interpolated_exactly_wherever_the_window_is() -> None:
    lattice = scatter_lattice(VIEW.detector)
    rows = (np.arange(lattice.rows) + 0.5) / lattice.rows
    columns = (np.arange(lattice.columns) + 0.5) / lattice.columns
    field = (3 + 2 * rows[:, None] + columns[None, :])[None]
    whole = interpolated(field, VIEW.detector, Window.whole(VIEW.detector))
    expected = 3 + 2 * (np.arange(400)[:, None] + 0.5) / 400 + (np.arange(400)[None, :] + 0.5) / 400
    assert whole[0] == pytest.approx(expected, rel=1e-12)
    part = interpolated(field, VIEW.detector, Window(17, 203, 61, 9))
    assert (part[0] == whole[0, 17:78, 203:212]).all()


def test_the_gap_reaches_from_the_box_to_the_detector() -> None:
    bounds = np.array([[-50.0, -400, -30], [50, -120, 30]])
    assert air_gap_mm(VIEW, bounds) == pytest.approx(120)
    parallel = View(source=None, direction=(0, 2, 0), detector=VIEW.detector)
    assert air_gap_mm(parallel, bounds) == pytest.approx(120)
    assert air_gap_mm(VIEW, bounds + np.array([0, 200.0, 0])) == 0
