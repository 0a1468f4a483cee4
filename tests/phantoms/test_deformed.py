"""The deformed object of 1993: star, circle and square stand where the document says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.scene import Phantom
from phantom.tracing import materials_at, measure

SIZE = 240.0


@pytest.fixture(scope="module")
def deformed() -> Phantom:
    return library.build("deformed", size_mm=SIZE)


def plane(u: float) -> tuple[Any, Any, Any, Any]:
    """Point of the axis and the paper's Frenet frame t, n, b, from the curve's own derivatives."""
    turn, climb, faster = 0.24 * SIZE, 0.18 * SIZE, 0.045 * SIZE
    at = np.array([turn * np.cos(u), turn * np.sin(u), climb * u + faster * u**2])
    first = np.array([-turn * np.sin(u), turn * np.cos(u), climb + 2 * faster * u])
    second = np.array([-turn * np.cos(u), -turn * np.sin(u), 2 * faster])
    t = first / np.linalg.norm(first)
    b = np.cross(first, second)
    b /= np.linalg.norm(b)
    return at, t, np.cross(b, t), b


def inside(phantom: Phantom, u: float, radii: Any, angles: Any, shift: float = 0.0) -> Any:
    """Whether points of the section at u, given in polar coordinates from n, are in the object."""
    at, t, n, b = plane(u)
    radii, angles = np.broadcast_arrays(radii, angles)
    points = (
        at
        + shift * t
        + radii[:, None] * (np.outer(np.cos(angles), n) + np.outer(np.sin(angles), b))
    )
    return materials_at(phantom, points)[:, 0]


def test_starts_as_a_star_of_five_points(deformed: Phantom) -> None:
    tip, between = 2 * np.pi * np.arange(5) / 5, 2 * np.pi * (np.arange(5) + 0.5) / 5
    outer = 0.19 * SIZE
    assert inside(deformed, 0.5, 0.85 * outer, tip, shift=1e-3).all()
    assert not inside(deformed, 0.5, outer, tip, shift=1e-3).any(), "tips are rounded"
    assert inside(deformed, 0.5, 0.54 * outer, between, shift=1e-3).all()
    assert not inside(deformed, 0.5, 0.58 * outer, between, shift=1e-3).any()


def test_is_a_circle_halfway(deformed: Phantom) -> None:
    angles = np.linspace(0.0, 2 * np.pi, 100)
    assert inside(deformed, 1.75, 0.092 * SIZE - 1e-6, angles).all()
    assert not inside(deformed, 1.75, 0.092 * SIZE + 1e-6, angles).any()


def test_ends_as_a_square_with_rounded_corners(deformed: Phantom) -> None:
    half, angles = 0.052 * SIZE, np.radians([0.0, 10.0, 20.0, 80.0, 170.0, 265.0])
    edge = half / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    assert inside(deformed, 3.0, edge - 1e-3, angles, shift=-1e-6).all()
    assert not inside(deformed, 3.0, edge + 1e-3, angles, shift=-1e-6).any()
    corners = np.radians([45.0, 135.0, 225.0, 315.0])
    reach = half * (np.sqrt(2) - 0.4 * (np.sqrt(2) - 1))
    assert inside(deformed, 3.0, reach - 1e-3, corners, shift=-1e-6).all()
    assert not inside(deformed, 3.0, reach + 1e-3, corners, shift=-1e-6).any()


def test_ends_are_flat(deformed: Phantom) -> None:
    origin, around = np.zeros(3), np.radians([0.0, 120.0, 240.0])
    assert not inside(deformed, 0.5, origin, around, shift=-1e-6).any()
    assert not inside(deformed, 3.0, origin, around, shift=1e-6).any()


def test_grows_in_all_directions_alike(deformed: Phantom) -> None:
    double = library.build("deformed", size_mm=2 * SIZE)
    assert np.allclose(double.bounds, 2 * deformed.bounds, rtol=1e-3)
    assert measure(double).volume_mm3 == pytest.approx(8 * measure(deformed).volume_mm3, rel=3e-3)


@pytest.mark.parametrize(
    ("size", "points", "depth", "share"),
    [(20.0, 3, 0.1, 0.05), (500.0, 9, 0.6, 0.95), (20.0, 9, 0.1, 0.95), (500.0, 3, 0.6, 0.05)],
)
def test_every_extreme_of_the_range_is_an_object(
    size: float, points: int, depth: float, share: float
) -> None:
    made = library.build(
        "deformed", size_mm=size, points=points, star_depth=depth, corner_share=share
    )
    assert 0.9 * size < np.ptp(made.bounds[:, 2]) < 1.2 * size


@pytest.mark.parametrize(
    "changed",
    [
        {"size_mm": 100.0},
        {"points": 6},
        {"star_depth": 0.3},
        {"corner_share": 0.8},
        {"attenuation_per_mm": 0.1},
    ],
)
def test_every_parameter_changes_the_document(changed: dict[str, object]) -> None:
    usual, other = library.document("deformed"), library.document("deformed", changed)
    assert (usual.solid, usual.materials) != (other.solid, other.materials)
