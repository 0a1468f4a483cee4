"""Contours by their definitions: whether a point of the plane is inside, area, centroid."""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import gamma


def inside(contour):
    """Function of x, y that tells whether they are inside."""
    kind = contour["type"]
    if kind == "circle":
        return lambda x, y: np.hypot(x, y) <= contour["radius"]
    if kind in ("ellipse", "superellipse"):
        a, b = contour["semi_axes"]
        k = contour.get("exponent", 2)
        return lambda x, y: np.abs(x / a) ** k + np.abs(y / b) ** k <= 1
    if kind == "polar":
        radius = polar(contour["radii"])
        return lambda x, y: np.hypot(x, y) <= radius(np.mod(np.arctan2(y, x), 2 * np.pi))
    if kind == "spline":
        return _inside_spline(spline(contour["points"]))
    return _inside_rounded(np.array(contour["points"], float), contour["corner_radius"])


def extent(contour):
    """A radius about the origin that holds the contour."""
    kind = contour["type"]
    if kind == "circle":
        return contour["radius"]
    if kind in ("ellipse", "superellipse"):
        return float(np.hypot(*contour["semi_axes"]))
    if kind == "polar":
        return 1.01 * polar(contour["radii"])(np.linspace(0, 2 * np.pi, 4000)).max()
    if kind == "spline":
        curve = spline(contour["points"])
        return 1.01 * np.linalg.norm(curve(np.linspace(0, curve.x[-1], 4000)), axis=1).max()
    points = np.array(contour["points"])
    return np.linalg.norm(points, axis=1).max() + 2 * np.ptp(points)


def moments(contour):
    """Area and centroid."""
    kind = contour["type"]
    if kind == "circle":
        return np.pi * contour["radius"] ** 2, np.zeros(2)
    if kind in ("ellipse", "superellipse"):
        a, b = contour["semi_axes"]
        k = contour.get("exponent", 2)
        return 4 * a * b * gamma(1 + 1 / k) ** 2 / gamma(1 + 2 / k), np.zeros(2)
    if kind == "spline":
        return _spline_moments(spline(contour["points"]))
    if kind == "polar":
        return _polar_moments(polar(contour["radii"]))
    return _rounded_moments(np.array(contour["points"], float), contour["corner_radius"])


def _spline_moments(curve):
    node, weight = np.polynomial.legendre.leggauss(12)
    area, first = 0.0, np.zeros(2)
    for a, b in zip(curve.x[:-1], curve.x[1:], strict=True):
        v = 0.5 * (a + b) + 0.5 * (b - a) * node
        p, d = curve(v), curve(v, 1)
        cross = (p[:, 0] * d[:, 1] - p[:, 1] * d[:, 0]) * weight * 0.5 * (b - a)
        area += cross.sum() / 2
        first += (p * cross[:, None]).sum(axis=0) / 3
    return abs(area), first / area


def _polar_moments(radius):
    node, weight = np.polynomial.legendre.leggauss(16)
    area, first = 0.0, np.zeros(2)
    for a, b in zip(radius.x[:-1], radius.x[1:], strict=True):
        theta = 0.5 * (a + b) + 0.5 * (b - a) * node
        r = radius(theta)
        w = weight * 0.5 * (b - a)
        area += (r**2 * w).sum() / 2
        first += [(r**3 * np.cos(theta) * w).sum() / 3, (r**3 * np.sin(theta) * w).sum() / 3]
    return area, first / area


def polar(radii):
    theta = np.linspace(0, 2 * np.pi, len(radii) + 1)
    return CubicSpline(theta, [*radii, radii[0]], bc_type="periodic")


def spline(points):
    closed = np.array([*points, points[0]], float)
    chord = np.linalg.norm(np.diff(closed, axis=0), axis=1)
    return CubicSpline(np.concatenate([[0], np.cumsum(chord)]), closed, bc_type="periodic")


def _inside_spline(curve):
    """Even-odd rule along +x, with the curve cut where x or y turns round."""
    turning = curve.derivative()
    cuts = [curve.x]
    for i in range(len(curve.x) - 1):
        for k in range(2):
            roots = np.roots(turning.c[:, i, k])
            roots = roots[np.abs(roots.imag) < 1e-12].real
            cuts.append(curve.x[i] + roots[(roots > 0) & (roots < curve.x[i + 1] - curve.x[i])])
    v = np.unique(np.concatenate(cuts))
    corners = curve(v)
    corners[-1] = corners[0]
    return even_odd(v, corners, lambda v: curve(v).T)


def even_odd(v, corners, curve):
    """Inside test of a closed curve that is monotone in x and in y between the parameters v.

    Each piece lies in the box of its ends: a point left of the box looks at it, one right of it
    does not, and for one within it the place at its height is found by halves.
    """
    y0, y1 = corners[:-1, 1], corners[1:, 1]
    left, right = np.sort(np.stack([corners[:-1, 0], corners[1:, 0]]), axis=0)

    def test(px, py):
        odd = np.zeros(len(px), dtype=bool)
        for k in range(0, len(px), 4000):
            odd[k : k + 4000] = crossings(px[k : k + 4000], py[k : k + 4000]) % 2
        return odd

    def crossings(px, py):
        beside = (py[:, None] >= y0) != (py[:, None] >= y1)
        found = np.count_nonzero(beside & (px[:, None] < left), axis=1)
        who, i = np.nonzero(beside & (px[:, None] >= left) & (px[:, None] <= right))
        rising = y1[i] > y0[i]
        low, high = v[i], v[i + 1]
        for _ in range(52):
            middle = 0.5 * (low + high)
            below = (curve(middle)[1] <= py[who]) == rising
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        np.add.at(found, who, curve(0.5 * (low + high))[0] > px[who])
        return found

    return test


def _inside_polygon(points, px, py):
    odd = np.zeros(len(px), dtype=bool)
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        hit = (py >= ay) != (py >= by)
        with np.errstate(divide="ignore", invalid="ignore"):
            odd ^= hit & (ax + (py - ay) * (bx - ax) / (by - ay) > px)
    return odd


def _inside_rounded(points, radius):
    """The polygon, less what the arcs cut off, plus what they fill in at reflex corners.

    At a corner P with tangent points T, T' and arc centre C the difference is the part of the
    kite P T C T' that is farther than the radius from C.
    """
    kites = _kites(points, radius)

    def test(px, py):
        result = _inside_polygon(points, px, py)
        for kite, center, convex in kites:
            far = np.hypot(px - center[0], py - center[1]) > radius
            result[_inside_polygon(kite, px, py) & far] = not convex
        return result

    return test


def _twice_area(points):
    following = np.roll(points, -1, axis=0)
    return float((points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]).sum())


def _kites(points, radius):
    area = _twice_area(points)
    kites = []
    for i, p in enumerate(points):
        into = p - points[i - 1]
        out = points[(i + 1) % len(points)] - p
        into, out = into / np.linalg.norm(into), out / np.linalg.norm(out)
        cross = into[0] * out[1] - into[1] * out[0]
        half = 0.5 * np.arctan2(abs(cross), into @ out)
        if half == 0:
            continue
        reach = radius * np.tan(half)
        bisector = (out - into) / np.linalg.norm(out - into)
        center = p + bisector * np.hypot(reach, radius)
        kite = np.array([p, p + out * reach, center, p - into * reach])
        kites.append((kite, center, cross * area > 0))
    return kites


def _rounded_moments(points, radius):
    """The polygon's, less or plus kite minus circular sector at every corner."""
    following = np.roll(points, -1, axis=0)
    cross = points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]
    sign = np.sign(cross.sum())
    area = abs(cross.sum()) / 2
    first = sign * ((points + following) * cross[:, None]).sum(axis=0) / 6
    for kite, center, convex in _kites(points, radius):
        corner, reach = kite[0], np.linalg.norm(kite[1] - kite[0])
        half = np.arctan2(reach, radius)
        outward = (corner - center) / np.linalg.norm(corner - center)
        triangles = reach * radius
        sector = half * radius**2
        # Kite: two right triangles; sector: centroid at 2 r sin(half) / (3 half).
        kite_first = sum(
            triangles / 2 * (corner + center + side) / 3 for side in (kite[1], kite[3])
        )
        sector_first = sector * (center + outward * 2 * radius * np.sin(half) / (3 * half))
        share = -1 if convex else 1
        area += share * (triangles - sector)
        first = first + share * (kite_first - sector_first)
    return area, first / area
