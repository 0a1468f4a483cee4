"""Scattered radiation over a detector's whole field, and the anti-scatter grid.

What an object scatters onto a pixel is the sum over the field of the primary image times the
scatter kernel of a slab of water as thick, there, as the object seems at the beam's mean energy.
The whole field counts, whatever window of it is asked for; scatter is smooth, so it is computed on
a coarse lattice of the field and interpolated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from phantom.geometry.vectors import box_corners
from phantom.imaging.camera import projection
from phantom.imaging.detection.acquisition import Acquisition
from phantom.imaging.detection.multiple import THICKEST_MM
from phantom.imaging.detection.slab import amounts, kernel_per_mm2, water
from phantom.imaging.detection.window import Lattice, Window
from phantom.imaging.view import Detector, FloatArray, View

_CELLS: Final = 64
"""Cells of the coarse lattice along the longer side of the field."""

_NODES: Final = 13
"""Thicknesses at which kernels are computed; between them a cell's share is divided."""

_NEAR: Final = 3
"""Cells on every side of the middle over which the kernel is averaged, not taken at the centre."""

_SUB: Final = 8
"""Points along each side of such a cell."""


@dataclass(frozen=True, eq=False)
class ScatterField:
    """Scatter over the whole field, and what the grid does to it.

    Attributes
    ----------
    energies_kev
        (K,) mean energy of the photons that photons of each bin become.
    photons
        (K, rows, columns) scattered photons a pixel behind the grid, on the coarse lattice; None
        without scatter.
    scatter_to_primary
        Over the whole field, before the grid; None without scatter.
    bucky_factor
        Photons before the grid over photons behind it, whole field; None without a grid.
    """

    energies_kev: FloatArray
    photons: FloatArray | None
    scatter_to_primary: float | None
    bucky_factor: float | None
    air_gap_mm: float


def _cells(detector: Detector) -> tuple[int, int, float, float]:
    """Return rows and columns of the coarse lattice, and its steps down and across in mm."""
    pitch_x, pitch_y = detector.pitch_xy_mm
    width, height = detector.columns * pitch_x, detector.rows * pitch_y
    size = max(width, height) / _CELLS
    columns, rows = max(2, round(width / size)), max(2, round(height / size))
    return rows, columns, height / rows, width / columns


def scatter_lattice(detector: Detector) -> Lattice:
    """Return the points of the field to trace rays to for scatter: the centres of its cells."""
    rows, columns, step_y, step_x = _cells(detector)
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    first = detector.pixel(step_x / pitch_x / 2 - 0.5, step_y / pitch_y / 2 - 0.5)
    return Lattice(first, right * step_x, down * step_y, columns, rows)


def air_gap_mm(view: View, bounds: FloatArray) -> float:
    """Return how far before the detector a bounding box ends, in mm; 0 where it reaches it.

    ``bounds`` (2, 3) are the least and the greatest coordinates.
    """
    camera = projection(view)
    plane = 0.0 if camera.distance_mm is None else camera.distance_mm
    return max(plane - float(camera.depth_mm(box_corners(bounds)).max()), 0.0)


def scatter_field(
    path_lengths: FloatArray | None,
    attenuation_per_mm: FloatArray,
    energies_kev: FloatArray,
    photons: FloatArray,
    acquisition: Acquisition,
    view: View,
    default_gap_mm: float,
) -> ScatterField:
    """Return the scatter of an exposure.

    Parameters
    ----------
    path_lengths
        (rows, columns, M) mm over :func:`scatter_lattice`; not looked at without scatter.
    attenuation_per_mm
        (K, M).
    energies_kev, photons
        (K,): the bins, and the open field's photons a pixel.
    acquisition, view
        Scatter, grid, and the field.
    default_gap_mm
        From the object to the detector, where the acquisition does not say.
    """
    grid = acquisition.grid
    through = (1.0, 1.0) if grid is None else (grid.primary_transmission, grid.scatter_transmission)
    if acquisition.scatter is None:
        return ScatterField(energies_kev, None, None, None if grid is None else 1 / through[0], 0.0)
    if path_lengths is None:
        raise ValueError("scatter needs the path lengths over scatter_lattice")
    asked = acquisition.scatter.air_gap_mm
    gap_mm = default_gap_mm if asked is None else asked

    # Beer's law on the coarse lattice, and how thick the object seems.
    depth = np.einsum("km,rcm->krc", attenuation_per_mm, path_lengths)
    passed = photons[:, None, None] * np.exp(-depth)
    mean_kev = float(energies_kev @ photons / photons.sum())
    nearest = int(np.abs(energies_kev - mean_kev).argmin())
    mu_water = water(float(energies_kev[nearest])).attenuation_per_mm
    thickness = np.minimum(depth[nearest] / mu_water, THICKEST_MM)
    nodes = np.linspace(0.0, max(float(thickness.max()), 1e-6), _NODES)

    # Each cell's primary is shared between the two nearest thicknesses.
    place = thickness / nodes[1]
    lower = np.minimum(place.astype(np.int64), _NODES - 2)
    upper_share = place - lower
    rows, columns, step_y, step_x = _cells(view.detector)
    shape = (2 * rows, 2 * columns)
    amount = np.zeros((len(energies_kev), _NODES, 2))
    energy = np.zeros((len(energies_kev), _NODES, 2))
    for k, e in enumerate(energies_kev.tolist()):
        amount[k], energy[k] = amounts(e, nodes)
    spread = np.zeros((len(energies_kev), shape[0], shape[1] // 2 + 1), dtype=np.complex128)
    weight = np.zeros(len(energies_kev))
    carried = np.zeros(len(energies_kev))
    for n in range(1, _NODES):
        share = np.where(lower == n, 1 - upper_share, np.where(lower == n - 1, upper_share, 0.0))
        shared = passed * share
        if not share.any():
            continue
        total = shared.sum(axis=(1, 2))
        weight += total * amount[:, n].sum(axis=1)
        carried += total * (amount[:, n] * energy[:, n]).sum(axis=1)
        images = np.fft.rfft2(shared, shape)
        for order in (0, 1):
            kernel = _on_lattice(
                mean_kev, float(nodes[n]), gap_mm, order, rows, columns, step_y, step_x
            )
            product = images * np.fft.rfft2(kernel)
            spread += amount[:, n, order, None, None] * product
    scattered = np.maximum(np.fft.irfft2(spread, shape)[:, :rows, :columns], 0.0)
    late = np.where(weight > 0, carried / np.maximum(weight, 1e-300), energies_kev)
    primary, scatter = float(passed.sum()), float(scattered.sum())
    behind = through[0] * primary + through[1] * scatter
    return ScatterField(
        energies_kev=late,
        photons=through[1] * scattered,
        scatter_to_primary=scatter / primary,
        bucky_factor=None if grid is None else (primary + scatter) / behind,
        air_gap_mm=gap_mm,
    )


def _on_lattice(
    energy_kev: float,
    thickness_mm: float,
    gap_mm: float,
    order: int,
    rows: int,
    columns: int,
    step_y: float,
    step_x: float,
) -> FloatArray:
    """Return the kernel, its whole plane adding to one, on (2 rows, 2 columns) for a transform.

    Index 0 is the middle and the second half of each axis is what lies on the other side.
    """
    y = np.fft.fftfreq(2 * rows, 1 / (2 * rows)) * step_y
    x = np.fft.fftfreq(2 * columns, 1 / (2 * columns)) * step_x
    inside = (np.arange(_SUB) + 0.5) / _SUB - 0.5
    radii = np.geomspace(min(step_x, step_y) / 50, math.hypot(y.min(), x.min()) * 1.1, 240)
    profile = np.log(
        np.maximum(kernel_per_mm2(energy_kev, thickness_mm, gap_mm, radii, order), 1e-300)
    )

    def density(radius: FloatArray) -> FloatArray:
        return np.exp(np.interp(np.log(radius), np.log(radii), profile))

    # Near the middle the kernel changes within a cell, and is averaged over it.
    out = density(np.maximum(np.hypot(y[:, None], x[None, :]), radii[0]))
    near = np.arange(-_NEAR, _NEAR + 1)
    fine_y = (near[:, None] + inside) * step_y
    fine_x = (near[:, None] + inside) * step_x
    fine = density(np.hypot(fine_y[:, :, None, None], fine_x[None, None]))
    out[np.ix_(near, near)] = fine.mean(axis=(1, 3))
    return out * (step_x * step_y)


def interpolated(field: FloatArray, detector: Detector, window: Window) -> FloatArray:
    """Return (J, rows, columns) at a window's pixels of (J, r, c) on the coarse lattice.

    Linear between cells, and on beyond the outermost; a pixel's value does not depend on the
    window.
    """
    cells_y, cells_x, _, _ = _cells(detector)
    at_y = (window.row_indices + 0.5) * (cells_y / detector.rows) - 0.5
    at_x = (window.column_indices + 0.5) * (cells_x / detector.columns) - 0.5
    i = np.clip(at_y.astype(np.int64), 0, cells_y - 2)
    j = np.clip(at_x.astype(np.int64), 0, cells_x - 2)
    fy, fx = (at_y - i)[:, None], at_x - j
    down = field[:, i] * (1 - fy) + field[:, i + 1] * fy
    across: FloatArray = down[:, :, j] * (1 - fx) + down[:, :, j + 1] * fx
    return np.maximum(across, 0.0)
