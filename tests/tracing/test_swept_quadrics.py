"""Generalized cylinders that are quadrics, slabs or superellipses, against closed forms."""

import numpy as np
import pytest

import phantom
from tests.oracles import quadrics, rays
from tests.oracles.quadrics import Quadric

SURFACE_MM = 1e-8
START, END = np.array([-12.0, 20.0, -45.0]), np.array([9.0, -14.0, 50.0])
AXIS = {"type": "line", "start": START.tolist(), "end": END.tolist()}


def frame():
    """t, and n from world +x made orthogonal to it, and b = t x n, as the document says."""
    t = (END - START).astype(np.longdouble)
    t /= np.sqrt(t @ t)
    n = np.array([1, 0, 0], dtype=np.longdouble) - t[0] * t
    n /= np.sqrt(n @ n)
    b = np.array([t[1] * n[2] - t[2] * n[1], t[2] * n[0] - t[0] * n[2], t[0] * n[1] - t[1] * n[0]])
    return t, n, b


def tube(**parts):
    return {"type": "generalized_cylinder", "axis": AXIS, **parts}


def assert_agree(shape, truth, origins, directions, reach=80.0):
    pieces = phantom.intervals(shape, origins, directions)
    unit = rays.unit(directions)
    for distance in (pieces.entry_mm, pieces.exit_mm):
        seen = distance > 0
        ray = pieces.ray[seen]
        points = origins[ray] + distance[seen, None] * unit[ray]
        assert truth.surface_gap(points).max(initial=0) <= SURFACE_MM
    lengths = phantom.path_lengths(shape, origins, directions)[:, 0]
    exact = [truth.chords(o, d) for o, d in zip(origins, directions, strict=True)]
    wanted = np.array([np.diff(rows, axis=1).sum() for rows in exact])
    chord = np.maximum(np.minimum(lengths, wanted), np.sqrt(8 * reach * SURFACE_MM))
    assert (np.abs(lengths - wanted) * np.minimum(chord / (4 * reach), 1)).max() <= SURFACE_MM
    assert np.count_nonzero(wanted) > len(origins) / 20


def circular(radius):
    return quadrics.of(
        {"type": "cylinder", "start": START, "end": END, "radius": np.longdouble(radius)}
    )


def elliptic_cone(first, last):
    """Half widths along n and b run linearly from ``first`` to ``last``.

    Where the two keep one ratio it is a quadric; their radii meet 0 in one point.
    """
    t, n, b = frame()
    span = END - START
    length = np.sqrt((span.astype(np.longdouble) ** 2).sum())
    ratio = np.longdouble(first[1]) / first[0]
    slope = (np.longdouble(last[0]) - first[0]) / length
    matrix = np.outer(n, n) + np.outer(b, b) / ratio**2 - slope**2 * np.outer(t, t)
    linear = -first[0] * slope * t
    return Quadric(START, matrix, linear, -(np.longdouble(first[0]) ** 2), [(START, -t), (END, t)])


def elliptic(semi, angle_deg=0.0):
    t, n, b = frame()
    a = np.radians(np.longdouble(angle_deg))
    p, q = np.cos(a) * n + np.sin(a) * b, -np.sin(a) * n + np.cos(a) * b
    matrix = np.outer(p, p) / np.longdouble(semi[0]) ** 2
    matrix = matrix + np.outer(q, q) / np.longdouble(semi[1]) ** 2
    return Quadric(START, matrix, planes=[(START, -t), (END, t)])


CIRCLE = {"type": "circle", "radius": 14}
TWIST = {"rotate_deg": {"knots": [[0, -70], [0.4, 120], [1, 480]]}}
CASES = {
    "cylinder": (tube(contour=CIRCLE), circular(14)),
    "twisted cylinder": (tube(contour=CIRCLE, sweep={"type": "linear", **TWIST}), circular(14)),
    "cylinder from a polar contour": (
        tube(contour={"type": "polar", "radii": [14] * 7}),
        circular(14),
    ),
    "cylinder from a superellipse": (
        tube(
            contour={"type": "superellipse", "semi_axes": [7, 28], "exponent": 2},
            sweep={"type": "linear", "scale": [2, 0.5], **TWIST},
        ),
        circular(14),
    ),
    "cylinder in an up frame": (tube(contour=CIRCLE, frame={"up": [0, 1, 0]}), circular(14)),
    "mirrored scale": (
        tube(contour=CIRCLE, sweep={"type": "linear", "scale": -0.5}),
        circular(7),
    ),
    "cone": (
        tube(contour=CIRCLE, sweep={"type": "linear", "scale": {"knots": [[0, 2], [1, 0.25]]}}),
        elliptic_cone((28, 28), (3.5, 3.5)),
    ),
    "cone in more knots": (
        tube(
            contour={"type": "circle", "radius": 1},
            sweep={
                "type": "linear",
                "scale": {"knots": [[0, 28], [0.3, 20.65], [1, 3.5]]},
                **TWIST,
            },
        ),
        elliptic_cone((28, 28), (3.5, 3.5)),
    ),
    "blunt cone": (
        tube(
            contour={"type": "circle", "radius": 1},
            sweep={"type": "linear", "scale": {"knots": [[0, 20], [1, 0.021]]}},
        ),
        elliptic_cone((20, 20), (0.021, 0.021)),
    ),
    "elliptic cone": (
        tube(
            contour={"type": "circle", "radius": 1},
            sweep={
                "type": "linear",
                "scale": [{"knots": [[0, 24], [1, 6]]}, {"knots": [[0, 12], [1, 3]]}],
            },
        ),
        elliptic_cone((24, 12), (6, 3)),
    ),
    "elliptic cylinder": (
        tube(contour={"type": "ellipse", "semi_axes": [20, 6]}),
        elliptic((20, 6)),
    ),
    "turned elliptic cylinder": (
        tube(
            contour={"type": "ellipse", "semi_axes": [20, 6]},
            sweep={"type": "linear", "rotate_deg": 35},
        ),
        elliptic((20, 6), 35),
    ),
    "very flat elliptic cylinder": (
        tube(contour={"type": "ellipse", "semi_axes": [20, 0.4]}),
        elliptic((20, 0.4)),
    ),
}


@pytest.fixture(params=CASES, ids=lambda name: name.replace(" ", "-"))
def case(request, solid):
    leaf, truth = CASES[request.param]
    return solid(**leaf), truth


def test_random_lines(case):
    shape, truth = case
    origins, directions = rays.through_ball(np.random.default_rng(31), 2000, 60.0)
    assert_agree(shape, truth, origins, directions)


def test_rays_parallel_to_the_axis_and_to_its_sections(case):
    """The two directions in which a parameter along the axis has poles or does not move."""
    shape, truth = case
    t, n, b = (v.astype(float) for v in frame())
    rng = np.random.default_rng(32)
    count = 400
    across = np.outer(rng.uniform(-8, 8, count), n) + np.outer(rng.uniform(-8, 8, count), b)
    middle = 0.5 * (START + END)
    assert_agree(shape, truth, middle + across - 150 * t, np.tile(t, (count, 1)))
    assert_agree(shape, truth, middle + across + 150 * t, np.tile(-t, (count, 1)))
    angle = rng.uniform(0, 2 * np.pi, count)
    along = np.outer(np.cos(angle), n) + np.outer(np.sin(angle), b)
    heights = rng.uniform(-45, 45, count)
    starts = middle + np.outer(heights, t) + 0.3 * across - 150 * along
    assert_agree(shape, truth, starts, along)
    nearly = rays.unit(along + 1e-7 * t)
    assert_agree(shape, truth, starts - 1e-5 * np.outer(np.ones(count), t), nearly)


def test_sources_inside(case):
    shape, truth = case
    _, n, b = (v.astype(float) for v in frame())
    rng = np.random.default_rng(33)
    local = rng.uniform(-1, 1, (1000, 3)) * [6, 6, 0.5]
    origins = 0.5 * (START + END) + local @ np.array([n, b, (END - START)])
    assert_agree(shape, truth, origins, rng.standard_normal((1000, 3)))


@pytest.mark.parametrize("exponent", [2.0, 2.5, 4.0, 7.0, 20.0])
def test_chords_of_a_superellipse(solid, exponent):
    """Along n at height y a chord is 2 a (1 - |y / b|^n)^(1 / n)."""
    a, b = 18.0, 11.0
    shape = solid(
        type="generalized_cylinder",
        axis={"type": "line", "start": [0, 0, -30], "end": [0, 0, 30]},
        contour={"type": "superellipse", "semi_axes": [a, b], "exponent": exponent},
    )
    y = np.concatenate([np.linspace(-b, b, 801)[1:-1], b * (1 - np.geomspace(1e-6, 1e-2, 50))])
    z = np.linspace(-29, 29, len(y))
    origins = np.stack([np.full(len(y), -100.0), y, z], axis=1)
    lengths = phantom.path_lengths(shape, origins, np.tile([1.0, 0, 0], (len(y), 1)))[:, 0]
    share = (1 - np.abs(np.longdouble(y) / b) ** exponent) ** (1 / np.longdouble(exponent))
    wanted = 2 * a * share
    # The contour's gradient says how far a wrong end is from the surface.
    gx = share ** (exponent - 1) / a
    gy = np.abs(y / b) ** (exponent - 1) / b
    assert np.max(np.abs(lengths - wanted) / 2 * gx / np.hypot(gx, gy)) <= SURFACE_MM
    # And along b, and along the axis, where the ends are the end planes.
    x = np.linspace(-a, a, 401)[1:-1]
    origins = np.stack([x, np.full(len(x), 100.0), 0 * x], axis=1)
    lengths = phantom.path_lengths(shape, origins, np.tile([0.0, -1, 0], (len(x), 1)))[:, 0]
    wanted = 2 * b * (1 - np.abs(x / a) ** exponent) ** (1 / exponent)
    np.testing.assert_allclose(lengths, wanted, atol=4e-7)
    inside = np.abs(x / a) ** exponent + np.abs(0.5 * x / b) ** exponent < 1
    origins = np.stack([x, 0.5 * x, np.full(len(x), 90.0)], axis=1)
    lengths = phantom.path_lengths(shape, origins, np.tile([0.0, 0, -1], (len(x), 1)))[:, 0]
    np.testing.assert_allclose(lengths, 60.0 * inside, atol=1e-7)


def rounded_box_chords(origins, directions, half, radius, height):
    """A rectangle with rounded corners, extruded: a plus of two boxes and four cylinders.

    A convex solid: its chord is from the first entry to the last exit of its parts.
    """
    w, h = half
    parts = [
        quadrics.of(
            {"type": "box", "center": [0, 0, 0], "size": [2 * w, 2 * h - 2 * radius, height]}
        ),
        quadrics.of(
            {"type": "box", "center": [0, 0, 0], "size": [2 * w - 2 * radius, 2 * h, height]}
        ),
    ]
    for x in (-1, 1):
        for y in (-1, 1):
            at = [x * (w - radius), y * (h - radius)]
            parts.append(
                quadrics.of(
                    {
                        "type": "cylinder",
                        "start": [*at, -height / 2],
                        "end": [*at, height / 2],
                        "radius": radius,
                    }
                )
            )
    lengths = []
    for o, d in zip(origins, directions, strict=True):
        rows = [p.chords(o, d) for p in parts]
        rows = np.concatenate([r for r in rows if len(r)]) if any(map(len, rows)) else None
        lengths.append(0.0 if rows is None else rows[:, 1].max() - rows[:, 0].min())
    return np.array(lengths)


@pytest.mark.parametrize("radius", [0.05, 1.0, 6.0])
def test_a_rounded_box(solid, radius):
    w, h, height = 20.0, 12.0, 70.0
    shape = solid(
        type="generalized_cylinder",
        axis={"type": "line", "start": [0, 0, -height / 2], "end": [0, 0, height / 2]},
        contour={
            "type": "polygon",
            "points": [[w, -h], [w, h], [-w, h], [-w, -h]],
            "corner_radius": radius,
        },
    )
    origins, directions = rays.through_ball(np.random.default_rng(34), 1500, 42.0)
    lengths = phantom.path_lengths(shape, origins, directions)[:, 0]
    wanted = rounded_box_chords(origins, directions, (w, h), radius, height)
    chord = np.maximum(wanted, np.sqrt(8 * 42 * SURFACE_MM))
    assert np.max(np.abs(lengths - wanted) * np.minimum(chord / (4 * 42), 1)) <= SURFACE_MM


@pytest.mark.parametrize("total_deg", [0.0, 35.0, 90.0, 400.0])
def test_a_twisted_prism_keeps_its_volume(solid, total_deg):
    """V = A L for any twist."""
    w, h, r, length = 12.0, 8.0, 2.0, 60.0
    shape = solid(
        type="generalized_cylinder",
        axis={"type": "line", "start": [3, -2, -length / 2], "end": [3, -2, length / 2]},
        contour={
            "type": "polygon",
            "points": [[w, -h], [w, h], [-w, h], [-w, -h]],
            "corner_radius": r,
        },
        sweep={"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, total_deg]]}},
    )
    area = 4 * w * h - (4 - np.pi) * r * r
    count, half = 300, 50.0
    rng = np.random.default_rng(35)
    totals = []
    for _ in range(3):
        d = rays.unit(rng.standard_normal(3))
        a = rays.unit(np.cross(d, rng.standard_normal(3)))
        i, j = np.meshgrid(np.arange(count), np.arange(count))
        p, q = (2 * half * (k.ravel() + rng.random()) / count - half for k in (i, j))
        origins = np.outer(p, a) + np.outer(q, np.cross(d, a)) - 120 * d + np.array([3, -2, 0])
        lengths = phantom.path_lengths(shape, origins, np.tile(d, (len(p), 1)))
        totals.append(lengths.sum() * (2 * half / count) ** 2)
    np.testing.assert_allclose(totals, area * length, rtol=3e-4)
