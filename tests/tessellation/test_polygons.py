"""Polygons are filled to their edges, holes left out, with no corner added."""

import math
from itertools import pairwise

import numpy as np
import pytest

from phantom.tessellation.polygons import triangulated


def ring(count, radius, center=(0, 0), wobble=0.0, clockwise=False, rng=None):
    angle = 2 * math.pi * np.arange(count) / count
    r = radius * (1 + (0 if rng is None else wobble * rng.uniform(-1, 1, count)))
    points = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1) + center
    return points[::-1] if clockwise else points


def area(points):
    x, y = points.T
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


def filled(loops):
    starts = np.cumsum([0, *map(len, loops)])
    rows = [np.arange(a, b) for a, b in pairwise(starts)]
    points = np.concatenate(loops)
    triangles, simple = triangulated(points, rows)
    corners = points[triangles]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = 0.5 * (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    return points, triangles, areas, simple


def assert_filled(loops):
    """Areas add up and none is turned over: so no triangle lies outside or on another."""
    points, triangles, areas, simple = filled(loops)
    assert simple
    assert areas.min() >= -1e-12
    assert areas.sum() == pytest.approx(sum(area(loop) for loop in loops))
    starts = np.cumsum([0, *map(len, loops)])
    edges = {(a, b) for t in triangles.tolist() for a, b in zip(t, t[1:] + t[:1], strict=True)}
    for start, loop in zip(starts, loops, strict=False):
        n = len(loop)
        assert all((start + k, start + (k + 1) % n) in edges for k in range(n))
    return points


def test_a_star_with_deep_notches_is_filled():
    rng = np.random.default_rng(1)
    for _ in range(20):
        assert_filled([ring(60, 10, wobble=0.8, rng=rng)])


def test_holes_are_left_out_wherever_they_lie():
    rng = np.random.default_rng(2)
    for _ in range(20):
        holes = [
            ring(12, 0.8, (x, y), wobble=0.3, clockwise=True, rng=rng)
            for x in (-4, -1, 2, 5)
            for y in (-4.5, -1.5, 1.5, 4.5)
            if rng.random() < 0.6
        ]
        assert_filled([ring(40, 12, wobble=0.2, rng=rng), *holes])


def test_islands_in_holes_are_filled():
    loops = [
        ring(30, 10),
        ring(24, 7, clockwise=True),
        ring(12, 4),
        ring(8, 2, clockwise=True),
        ring(9, 3, (20, 0)),
    ]
    assert_filled(loops)


def test_corners_on_a_straight_side_stay_corners():
    side = np.linspace(0, 1, 7)[:-1]
    square = np.concatenate(
        [
            np.stack([side, 0 * side], axis=-1),
            np.stack([1 + 0 * side, side], axis=-1),
            np.stack([1 - side, 1 + 0 * side], axis=-1),
            np.stack([0 * side, 1 - side], axis=-1),
        ]
    )
    assert_filled([square])
    hole = 0.5 + 0.3 * (square[::-1] - 0.5)
    assert_filled([square, hole])


def test_a_spiral_is_filled():
    t = np.linspace(0, 6 * math.pi, 300)
    spiral = np.stack([(1 + t) * np.cos(t), (1 + t) * np.sin(t)], axis=-1)
    inner = spiral * ((1.6 + t) / (1 + t))[:, None]
    assert_filled([np.concatenate([inner, spiral[::-1]])])


def test_an_outline_that_crosses_itself_is_told():
    bow = np.array([[0.0, 0], [2, 2], [2, 0], [0, 3]])
    assert not filled([bow])[3]
