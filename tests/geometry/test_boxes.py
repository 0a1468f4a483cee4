"""The box of a quadric is that of points taken all over it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phantom import document as doc
from phantom.geometry.quadrics import bounds, quadric
from phantom.geometry.transforms import Similarity

TURNS = np.linspace(0.0, 2 * math.pi, 4001)


def _rim(middle, axis, radii, up):
    """Points of an ellipse about the middle, its first radius along ``up``."""
    k = axis / np.linalg.norm(axis)
    first = up - k * (k @ up)
    first /= np.linalg.norm(first)
    second = np.cross(k, first)
    return (
        middle
        + np.outer(radii[0] * np.cos(TURNS), first)
        + np.outer(radii[1] * np.sin(TURNS), second)
    )


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("kind", ["cylinder", "elliptic cylinder", "cone", "ellipsoid"])
def test_the_box_holds_all_points_and_no_more(kind, seed):
    rng = np.random.default_rng(seed)
    start, end, up = rng.normal(size=(3, 3)) * 40.0
    one, other = rng.uniform(0.5, 30.0, 2)
    axis = end - start
    if kind == "cylinder":
        leaf = doc.Cylinder(start=tuple(start), end=tuple(end), radius=one)
        rims = [_rim(at, axis, (one, one), up) for at in (start, end)]
    elif kind == "elliptic cylinder":
        leaf = doc.Cylinder(
            start=tuple(start), end=tuple(end), semi_axes=(one, other), up=tuple(up)
        )
        rims = [_rim(at, axis, (one, other), up) for at in (start, end)]
    elif kind == "cone":
        leaf = doc.Cone(start=tuple(start), end=tuple(end), start_radius=one, end_radius=other)
        rims = [_rim(start, axis, (one, one), up), _rim(end, axis, (other, other), up)]
    else:
        semi = rng.uniform(0.5, 30.0, 3)
        leaf = doc.Ellipsoid(center=tuple(start), semi_axes=tuple(semi))
        sphere = rng.normal(size=(200_000, 3))
        sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
        rims = [start + semi * np.vstack([sphere, np.eye(3), -np.eye(3)])]
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0] if kind != "ellipsoid" else np.eye(3)
    move = Similarity(float(rng.uniform(0.5, 2.0)), turn, rng.normal(size=3))
    points = np.vstack([move.points(rim) for rim in rims])
    box = bounds(quadric(leaf).moved(move))
    # A rim of 4,000 steps misses its extremes by (pi / 4000)^2 / 2 of a radius at most.
    slack = 60.0 * (math.pi / 4000) ** 2 / 2
    assert np.all(box[0] <= points.min(axis=0) + 1e-9)
    assert np.all(box[1] >= points.max(axis=0) - 1e-9)
    np.testing.assert_allclose(box, [points.min(axis=0), points.max(axis=0)], atol=slack)


@pytest.mark.parametrize("seed", range(6))
def test_a_turned_ellipsoid_reaches_as_far_as_its_points(seed):
    """Along a unit vector e it reaches |D R^T e|, D its semi-axes and R its turn."""
    rng = np.random.default_rng(seed)
    semi = rng.uniform(0.5, 30.0, 3)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    shape = quadric(doc.Ellipsoid(center=(1.0, 2.0, 3.0), semi_axes=tuple(semi)))
    box = bounds(shape.moved(Similarity(1.0, turn, np.zeros(3))))
    reach = np.linalg.norm(turn * semi, axis=1)
    center = turn @ [1.0, 2.0, 3.0]
    np.testing.assert_allclose(box, [center - reach, center + reach], rtol=1e-12, atol=1e-10)
