"""Contours that cross or touch themselves are refused, wherever that is; near misses are not."""

import numpy as np
import pytest

from phantom.geometry.outlines import EdgesOutline, RoundedOutline, SplineOutline
from phantom.geometry.refusal import RefusalError
from phantom.geometry.simple import check_simple
from phantom.geometry.splines import Cubics


class Formula:
    """A closed curve by functions of v over [0, 2 pi], in pieces of equal length."""

    def __init__(self, x, y, pieces=1):
        self.parts = (x, y)
        self.breaks = np.linspace(0, 2 * np.pi, pieces + 1)

    def derivatives(self, v, piece):
        """Three terms of the Taylor series by complex steps and their differences."""
        h = 1e-4

        def slope(f, v):
            return f(v + 1e-30j).imag / 1e-30

        columns = [
            (f(v), slope(f, v), (slope(f, v + h) - slope(f, v - h)) / (2 * h)) for f in self.parts
        ]
        return np.stack([np.stack(rows, axis=-1) for rows in zip(*columns, strict=True)])


def refused(outline):
    with pytest.raises(RefusalError) as caught:
        check_simple(outline)
    assert caught.value.problem.kind == "crossing_contour"


def lemniscate(turn, waist=0.0):
    """Gerono's: two lobes that cross at v = pi / 2 and 3 pi / 2, each moved on by ``turn``."""
    return lambda v: 10 * np.cos(v + turn) + waist, lambda v: 5 * np.sin(2 * (v + turn))


@pytest.mark.parametrize("pieces", [1, 2, 3, 7])
@pytest.mark.parametrize("turn", [0.0, np.pi / 2, np.pi / 4, 0.1, np.pi / 192])
def test_a_figure_of_eight_wherever_it_crosses(turn, pieces):
    # With turn 0 the crossing is a sample at every even cutting, and a break of two pieces.
    refused(Formula(*lemniscate(turn), pieces))


def neck(width):
    """Cassini-like: x = cos, y = sin (w + (1 - w) cos^2) comes together at x = 0."""
    half = width / 20

    def x(v):
        return 20 * np.cos(v)

    def y(v):
        return 10 * np.sin(v) * (half + (1 - half) * np.cos(v) ** 2)

    return Formula(x, y)


@pytest.mark.parametrize("width", [1.0, 1e-3, 1e-5])
def test_a_neck_is_accepted(width):
    check_simple(neck(width))


def test_a_neck_that_closes_is_refused():
    # The lobes touch with one tangent and do not cross: y >= 0 above and y <= 0 below.
    refused(neck(0.0))
    refused(neck(4e-7))


def polygon(*points):
    return EdgesOutline(np.array(points, dtype=float))


def test_a_corner_on_an_edge():
    def house(height):
        return polygon([0, 0], [10, 0], [10, 10], [5, height], [0, 10])

    refused(house(0.0))
    refused(house(-1e-5))
    check_simple(house(1e-3))
    check_simple(house(2e-6))


def test_a_corner_on_a_corner():
    bowtie = [[0, 0], [5, 5], [10, 0], [10, 10], [5, 5], [0, 10]]
    refused(polygon(*bowtie))
    bowtie[1] = [5, 5 - 1e-3]
    check_simple(polygon(*bowtie))


def test_edges_that_lie_on_one_another():
    refused(polygon([0, 0], [10, 0], [10, 10], [20, 10], [10, 10], [0, 10]))
    refused(polygon([0, 0], [20, 0], [20, 5], [10, 0], [5, 0], [0, 5]))


def test_a_star_drawn_in_one_stroke():
    angle = 4 * np.pi * np.arange(5) / 5
    refused(polygon(*np.stack([10 * np.cos(angle), 10 * np.sin(angle)], axis=1)))


def test_a_curve_that_goes_round_twice():
    refused(Formula(lambda v: 10 * np.cos(2 * v), lambda v: 10 * np.sin(2 * v)))


@pytest.mark.parametrize("size", [1e-4, 1e-2, 1.0])
def test_a_small_loop_in_one_cubic(size):
    """x = t^3 - t, y = t^2 crosses itself at t = -1 and 1, within a single piece of a spline."""
    corner = size * np.array([6.0, 4.0])
    loop = Cubics(
        np.array([0.0, 4.0, 5.0, 6.0]),
        np.array(
            [
                [[size, 0], [0, 0], [0, 0]],
                [[-6 * size, size], [0, 0], [0, 0]],
                [[11 * size, -4 * size], [0, 30.0], [-2 * corner[0], 0]],
                [[-corner[0], corner[1]], corner, corner + np.array([0, 30.0])],
            ]
        ),
    )
    refused(SplineOutline(loop))


def test_two_turns_of_a_spiral_that_touch_along_their_way():
    """An Archimedean band whose inner edge is its neighbour's outer one."""

    def band(width):
        angle = 2 * np.pi * np.arange(300) / 120
        ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        radius = 5 + 4 * angle[:, None] / (2 * np.pi)
        return polygon(*(radius * ring), *((radius + width) * ring)[::-1])

    check_simple(band(3.0))
    check_simple(band(4.0 - 1e-3))
    refused(band(4.0))


def test_round_corners_are_no_touching():
    points = np.array([[0.0, 0], [10, 0], [10, 10], [0, 10]])
    along = np.roll(points, -1, axis=0) - points
    along /= np.linalg.norm(along, axis=1)[:, None]
    for radius in (1e-8, 1e-5, 1e-2, 4.9):
        starts = points + radius * along
        ends = np.roll(points, -1, axis=0) - radius * along
        centers = ends + radius * np.stack([-along[:, 1], along[:, 0]], axis=1)
        check_simple(RoundedOutline(starts, ends, centers, np.full(4, np.pi / 2)))


def test_needles_are_accepted():
    check_simple(polygon([0, 0], [100, 0.01], [0, 0.02]))
    check_simple(polygon([0, 0], [100, 1e-4], [0, 2e-4]))
