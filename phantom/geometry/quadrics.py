"""Quadrics as ``y.A.y + 2 b.y + c <= 0`` about a centre, with the planes that end them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.halfspaces import Halfspaces
from phantom.geometry.refusal import RefusalError
from phantom.geometry.transforms import Similarity

Floats = NDArray[np.float64]

MAX_CUTS = 32
"""More planes than this on one leaf are refused: its bounds are found by looking at triples."""

QuadricLeaf = (
    doc.Sphere | doc.Ellipsoid | doc.Cylinder | doc.Cone | doc.DoubleCone | doc.Box | doc.Quadric
)


@dataclass(frozen=True)
class QuadricShape:
    """A quadric between planes; a box has no quadric and ``form`` is None."""

    center: Floats  # (3,) mm
    form: tuple[Floats, Floats, float] | None  # A (3, 3), b (3,), c about the centre
    planes: Halfspaces
    discs: Floats | None = None  # (2, 3, 3) mm: middle and two radii of each end, if it has two

    def moved(self, to: Similarity) -> QuadricShape:
        """Return the shape moved by a similarity."""
        form = None
        if self.form is not None:
            a, b, c = self.form
            r = to.rotation
            form = (r @ a @ r.T / to.scale**2, r @ b / to.scale, c)
        discs = None
        if self.discs is not None:
            discs = to.scale * self.discs @ to.rotation.T
            discs[:, 0] = to.points(self.discs[:, 0])
        return QuadricShape(to.points(self.center), form, self.planes.moved(to), discs)

    def values(self, points: Floats) -> Floats:
        """Return the form at points ``(n, 3)``, -1 everywhere for a box."""
        if self.form is None:
            return np.full(len(points), -1.0)
        a, b, c = self.form
        y = points - self.center
        return np.asarray(np.einsum("ni,ij,nj->n", y, a, y) + 2 * y @ b + c)

    def inside(self, points: Floats, slack: Floats) -> NDArray[np.bool_]:
        """Tell which points the form holds, or some point within ``slack`` (n,) of them."""
        if self.form is None:
            return np.ones(len(points), dtype=np.bool_)
        a, b, c = self.form
        y = points - self.center
        slope = 2 * np.linalg.norm(y @ a + b, axis=1)
        # No farther than the slack away the form is less by this; at a tip it is rounding.
        size, far = np.abs(a).max(), np.linalg.norm(y, axis=1)
        rounding = 1e-14 * ((3 * size * far + 2 * np.linalg.norm(b)) * far + abs(c))
        least = (slope + size * slack) * slack + rounding
        return np.asarray(self.values(points) <= least)


def quadric(leaf: QuadricLeaf) -> QuadricShape:
    """Read a quadric leaf with its cuts.

    Raises
    ------
    RefusalError
        Where the solid is not bounded, is empty, or has too many cuts.
    """
    shape = _shape(leaf)
    cuts = Halfspaces.cuts(leaf.cuts)
    if len(cuts.offsets) > MAX_CUTS:
        raise RefusalError(
            "/cuts", "too_many", f"{len(cuts.offsets)} cuts; expected at most {MAX_CUTS}"
        )
    if len(cuts.offsets):
        shape = QuadricShape(shape.center, shape.form, shape.planes.joined(cuts))
    if isinstance(leaf, doc.Quadric | doc.DoubleCone):
        _check_bounded(shape)
    bounds(shape)
    return shape


def _shape(leaf: QuadricLeaf) -> QuadricShape:
    free = Halfspaces.everything()
    match leaf:
        case doc.Sphere():
            form = (np.eye(3) / leaf.radius**2, np.zeros(3), -1.0)
            return QuadricShape(np.array(leaf.center, dtype=np.float64), form, free)
        case doc.Ellipsoid():
            semi = np.array(leaf.semi_axes, dtype=np.float64)
            form = (np.diag(semi**-2), np.zeros(3), -1.0)
            return QuadricShape(np.array(leaf.center, dtype=np.float64), form, free)
        case doc.Box():
            center = np.array(leaf.center, dtype=np.float64)
            normals = np.vstack([np.eye(3), -np.eye(3)])
            points = center + normals * np.tile(np.array(leaf.size) / 2, 2)[:, None]
            return QuadricShape(center, None, Halfspaces.of(points, normals))
        case doc.Cylinder():
            return _cylinder(leaf)
        case doc.Cone():
            return _cone(leaf)
        case doc.DoubleCone():
            k = np.array(leaf.axis, dtype=np.float64)
            k /= np.linalg.norm(k)
            form = (np.eye(3) - (1 + leaf.slope**2) * np.outer(k, k), np.zeros(3), 0.0)
            return QuadricShape(np.array(leaf.apex, dtype=np.float64), form, free)
        case doc.Quadric():
            return _general(leaf)


def _ends(start: Floats, end: Floats) -> tuple[Floats, float, Floats, Halfspaces]:
    """Return unit axis, length, midpoint and the two end planes."""
    span = end - start
    length = float(np.linalg.norm(span))
    axis = span / length
    planes = Halfspaces.of(np.stack([start, end]), np.stack([-axis, axis]))
    return axis, length, 0.5 * (start + end), planes


def _cylinder(leaf: doc.Cylinder) -> QuadricShape:
    start, end = np.array(leaf.start, dtype=np.float64), np.array(leaf.end, dtype=np.float64)
    k, _, middle, planes = _ends(start, end)
    if leaf.semi_axes is None:
        a = b = float(leaf.radius or 0.0)
        matrix = (np.eye(3) - np.outer(k, k)) / a**2
        first, second = np.linalg.svd(k[None])[2][1:]
    else:
        up = np.array(leaf.up, dtype=np.float64)
        first = up - k * (k @ up)
        first /= np.linalg.norm(first)
        second = np.cross(k, first)
        a, b = leaf.semi_axes
        matrix = np.outer(first, first) / a**2 + np.outer(second, second) / b**2
    discs = np.array([[at, a * first, b * second] for at in (start, end)])
    return QuadricShape(middle, (matrix, np.zeros(3), -1.0), planes, discs)


def _cone(leaf: doc.Cone) -> QuadricShape:
    start, end = np.array(leaf.start, dtype=np.float64), np.array(leaf.end, dtype=np.float64)
    k, length, middle, planes = _ends(start, end)
    slope = (leaf.end_radius - leaf.start_radius) / length
    mean = 0.5 * (leaf.end_radius + leaf.start_radius)
    # |y|^2 - s^2 - (mean + slope s)^2 with s = k.y, scaled by the larger radius.
    size = max(leaf.end_radius, leaf.start_radius) ** 2
    matrix = (np.eye(3) - (1 + slope**2) * np.outer(k, k)) / size
    first, second = np.linalg.svd(k[None])[2][1:]
    radii = ((start, leaf.start_radius), (end, leaf.end_radius))
    discs = np.array([[at, r * first, r * second] for at, r in radii])
    form = (matrix, -mean * slope * k / size, -(mean**2) / size)
    return QuadricShape(middle, form, planes, discs)


def _general(leaf: doc.Quadric) -> QuadricShape:
    a, b, c, d, e, f, g, h, i, j = (float(x) for x in leaf.coefficients)
    matrix = np.array([[a, d / 2, f / 2], [d / 2, b, e / 2], [f / 2, e / 2, c]])
    linear = np.array([g, h, i]) / 2
    # About its own centre, where it has one, the numbers are small and rounding is too.
    center = -np.linalg.pinv(matrix, rcond=1e-12) @ linear
    constant = float(center @ matrix @ center + 2 * linear @ center + j)
    rounding = 1e-13 * (np.abs(linear).max() + np.abs(matrix).max() * np.abs(center).max())
    linear = matrix @ center + linear
    linear[np.abs(linear) <= rounding] = 0.0  # a cylinder is not a very long paraboloid
    scale = max(abs(constant), float(np.abs(matrix).max()), float(np.abs(linear).max()))
    return QuadricShape(
        center, (matrix / scale, linear / scale, constant / scale), Halfspaces.everything()
    )


def _check_bounded(shape: QuadricShape) -> None:
    """Refuse a solid with a direction in which one can walk on for ever.

    The smallest value of d.A.d over the unit directions that no plane forbids is taken at an
    eigenvector of A, of A restricted to a plane, or on a line where two planes meet.
    """
    assert shape.form is not None
    a, b, _ = shape.form
    normals = shape.planes.normals
    candidates = [*np.linalg.eigh(a)[1].T]
    for normal in normals:
        basis = _nullspace(normal[None])
        candidates += list((basis @ np.linalg.eigh(basis.T @ a @ basis)[1]).T)
    for one, two in combinations(normals, 2):
        line = np.cross(one, two)
        if np.linalg.norm(line) > 1e-12:
            candidates.append(line / np.linalg.norm(line))
    size = float(np.abs(a).max()) or 1.0
    for direction in candidates:
        for d in (direction, -direction):
            if np.any(normals @ d > 1e-12):
                continue
            bend = float(d @ a @ d) / size
            flat = abs(bend) <= 1e-12 and np.linalg.norm(a @ d) <= 1e-9 * size
            if bend > 1e-12 or (flat and b @ d > 1e-9 * np.linalg.norm(b)):
                continue
            raise RefusalError(
                "",
                "unbounded",
                f"the solid goes on for ever along [{d[0]:.4g}, {d[1]:.4g}, {d[2]:.4g}]; "
                "expected a quadric that is bounded, by itself or by its cuts",
            )


def _nullspace(rows: Floats) -> Floats:
    return np.linalg.svd(rows)[2][len(rows) :].T


def bounds(shape: QuadricShape) -> Floats:
    """Return the tight axis-parallel box ``(2, 3)`` of a bounded shape.

    Extreme points lie on the quadric alone, on it and one or two planes, or where three planes
    meet; each case is a small quadratic (Lagrange).

    Raises
    ------
    RefusalError
        Where nothing is left inside the planes.
    """
    planes = shape.planes
    if shape.discs is not None:
        # The hull of two ellipses; one about m of radii u and v reaches sqrt(u_i^2 + v_i^2).
        middles, reach = shape.discs[:, 0], np.linalg.norm(shape.discs[:, 1:], axis=1)
        return np.stack([(middles - reach).min(axis=0), (middles + reach).max(axis=0)])
    if not len(planes.offsets) and (whole := _ellipsoid_box(shape)) is not None:
        return whole
    found = []
    for count in range(4):
        for chosen in combinations(range(len(planes.offsets)), count):
            rows = planes.normals[list(chosen)]
            if count and np.linalg.matrix_rank(rows, tol=1e-9) < count:
                continue
            found += _extremes(shape, rows, planes.offsets[list(chosen)])
    points = np.array(found).reshape(-1, 3)
    # Planes that are nearly parallel meet far away; what is kept is judged by its own size.
    sizes = np.maximum(1.0, np.abs(points - shape.center).max(axis=1, initial=0.0))
    slack = 1e-9 * sizes
    inside = np.all(points @ planes.normals.T <= planes.offsets + slack[:, None], axis=1)
    inside &= shape.inside(points, slack)
    points, size = points[inside], float(sizes[inside].max(initial=1.0))
    box = np.stack([points.min(axis=0), points.max(axis=0)]) if len(points) else np.zeros((2, 3))
    if np.any(box[1] - box[0] <= 1e-9 * size):
        raise RefusalError("", "empty", "nothing is left of this solid; expected a volume above 0")
    return box


def _ellipsoid_box(shape: QuadricShape) -> Floats | None:
    """Return the box of an ellipsoid; None for any other quadric, and for a nearly flat one.

    Along a unit vector e an ellipsoid about m reaches sqrt(v e.A^-1.e), -v being its value at m.
    """
    if shape.form is None:
        return None
    a, b, c = shape.form
    values = np.linalg.eigvalsh(a)
    if values[0] <= 1e-9 * values[2]:
        return None
    inverse = np.linalg.inv(a)
    middle = -inverse @ b
    depth = -float(c + b @ middle)
    if depth <= 0.0:
        return None
    reach = np.sqrt(depth * np.diag(inverse))
    center = shape.center + middle
    box = np.stack([center - reach, center + reach])
    return box if np.all(2 * reach > 1e-9 * max(1.0, float(np.abs(reach).max()))) else None


def _extremes(shape: QuadricShape, rows: Floats, offsets: Floats) -> list[Floats]:
    """Extreme points along x, y and z of the quadric within the planes ``rows . x = offsets``."""
    base = shape.center.copy()
    if len(rows):
        base = base + np.linalg.pinv(rows) @ (offsets - rows @ base)
    basis = _nullspace(rows) if len(rows) else np.eye(3)
    if basis.shape[1] == 0:
        return [base]
    if shape.form is None:
        return []
    a, b, _ = shape.form
    inner = basis.T @ a @ basis
    slope = basis.T @ (a @ (base - shape.center) + b)
    level = float(shape.values(base[None])[0])
    inverse = _pseudo_inverse(inner, float(np.abs(a).max()))
    middle = -inverse @ slope
    at_middle = level + slope @ middle
    points = [base + basis @ middle]
    drift = slope + inner @ middle
    size = float(np.abs(a).max()) * (1.0 + float(np.linalg.norm(base - shape.center)))
    if np.linalg.norm(drift) > 1e-12 * size:
        return points + [base + basis @ y for y in _vertices(basis, inverse, slope, drift, level)]
    for axis in np.eye(3):
        direction = inverse @ (basis.T @ axis)
        bend = float(direction @ inner @ direction)
        if bend == 0 or -at_middle / bend < 0:
            continue
        reach = np.sqrt(-at_middle / bend)
        points += [base + basis @ (middle + s * reach * direction) for s in (-1.0, 1.0)]
    return points


def _pseudo_inverse(matrix: Floats, size: float) -> Floats:
    """Invert a symmetric matrix where it is not 0 to rounding, beside entries of ``size``."""
    values, vectors = np.linalg.eigh(matrix)
    kept = np.abs(values) > 1e-12 * size
    return np.asarray((vectors[:, kept] / values[kept]) @ vectors[:, kept].T)


def _vertices(
    basis: Floats, inverse: Floats, slope: Floats, drift: Floats, level: float
) -> list[Floats]:
    """Extreme points of a paraboloid ``y.A.y + 2 slope.y + level = 0``, in its own coordinates.

    It opens along ``-drift``, the part of ``slope`` that A maps to 0. An extreme point along g has
    ``A y + slope = m g``; along the drift that fixes m, and the surface fixes y there.
    """
    points = []
    square = float(drift @ drift)
    for axis in np.eye(3):
        g = basis.T @ axis
        share = float(g @ drift)
        if abs(share) <= 1e-9 * np.sqrt(square):  # g is not bounded by the surface alone
            continue
        y = inverse @ (square / share * g - slope)
        value = float(y @ (square / share * g - slope)) + 2 * float(slope @ y) + level
        points.append(y - value / (2 * square) * drift)
    return points
