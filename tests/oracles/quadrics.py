"""Quadrics between planes along a ray, by the quadratic formula in extended precision."""

import numpy as np

wide = np.longdouble


class Quadric:
    """(x - c).A.(x - c) + 2 b.(x - c) + e <= 0 between planes (point, normal pointing out)."""

    def __init__(self, center, matrix, linear=(0, 0, 0), constant=-1.0, planes=()):
        self.center = np.asarray(center, dtype=wide)
        self.matrix = np.asarray(matrix, dtype=wide)
        self.linear = np.asarray(linear, dtype=wide)
        self.constant = wide(constant)
        self.planes = []
        for point, normal in planes:
            n = np.asarray(normal, dtype=wide)
            self.planes.append((np.asarray(point, dtype=wide), n / np.sqrt(n @ n)))

    def cut(self, point, normal):
        """Add a plane."""
        more = Quadric(self.center, self.matrix, self.linear, self.constant)
        n = np.asarray(normal, dtype=wide)
        more.planes = [*self.planes, (np.asarray(point, dtype=wide), n / np.sqrt(n @ n))]
        return more

    def chords(self, origin, direction):
        """(k, 2) sorted entries and exits in front of the origin."""
        o, d = np.asarray(origin, dtype=wide), np.asarray(direction, dtype=wide)
        d = d / np.sqrt(d @ d)
        # From the point of the ray nearest the centre, so that far sources lose no digits.
        shift = (self.center - o) @ d
        y = o + shift * d - self.center
        a = d @ self.matrix @ d
        b = d @ self.matrix @ y + self.linear @ d
        c = y @ self.matrix @ y + 2 * self.linear @ y + self.constant
        first, last = -shift, wide(np.inf)
        for point, normal in self.planes:
            speed, gap = normal @ d, normal @ (point - self.center - y)
            if speed == 0:
                if gap < 0:
                    return np.zeros((0, 2), dtype=wide)
            elif speed > 0:
                last = min(last, gap / speed)
            else:
                first = max(first, gap / speed)
        inside = [(max(p, first), min(q, last)) for p, q in _below(a, b, c)]
        return np.array([(p + shift, q + shift) for p, q in inside if q > p]).reshape(-1, 2)

    def surface_gap(self, points):
        """Distance of points from the nearest of the quadric and the planes, to first order."""
        y = np.asarray(points, dtype=wide) - self.center
        ay = y @ self.matrix
        value = (ay * y).sum(axis=1) + 2 * y @ self.linear + self.constant
        slope = 2 * (ay + self.linear)
        slope = np.sqrt((slope * slope).sum(axis=1))
        gaps = [np.abs(value) / np.where(slope == 0, 1, slope)]
        gaps += [np.abs((np.asarray(points, dtype=wide) - p) @ n) for p, n in self.planes]
        return np.min(gaps, axis=0)


def _below(a, b, c):
    """Where a w^2 + 2 b w + c <= 0."""
    far = wide(np.inf)
    if a == 0:
        if b == 0:
            return [(-far, far)] if c <= 0 else []
        return [(-far, -c / (2 * b))] if b > 0 else [(-c / (2 * b), far)]
    under = b * b - a * c
    if under < 0:
        return [] if a > 0 else [(-far, far)]
    q = -(b + np.copysign(np.sqrt(under), b))
    low, high = sorted((q / a, c / q if q != 0 else q / a))
    return [(low, high)] if a > 0 else [(-far, low), (high, far)]


def of(leaf):
    """The quadric of a document's leaf, with its cuts."""
    shape = _SHAPES[leaf["type"]](leaf)
    for cut in leaf.get("cuts", ()):
        shape = shape.cut(cut["point"], cut["normal"])
    return shape


def _ellipsoid(leaf):
    semi = leaf.get("semi_axes") or [leaf["radius"]] * 3
    return Quadric(leaf["center"], np.diag(np.asarray(semi, dtype=wide) ** -2))


def _straight(leaf):
    start, end = np.asarray(leaf["start"], dtype=wide), np.asarray(leaf["end"], dtype=wide)
    span = end - start
    length = np.sqrt(span @ span)
    k = span / length
    planes = [(start, -k), (end, k)]
    eye = np.eye(3, dtype=wide)
    if leaf["type"] == "cone":
        first, last = wide(leaf["start_radius"]), wide(leaf["end_radius"])
        slope = (last - first) / length
        matrix = eye - (1 + slope**2) * np.outer(k, k)
        return Quadric(start, matrix, -first * slope * k, -(first**2), planes)
    if "radius" in leaf:
        return Quadric(start, (eye - np.outer(k, k)) / wide(leaf["radius"]) ** 2, planes=planes)
    up = np.asarray(leaf["up"], dtype=wide)
    a = up - (up @ k) * k
    a = a / np.sqrt(a @ a)
    b = np.array([k[1] * a[2] - k[2] * a[1], k[2] * a[0] - k[0] * a[2], k[0] * a[1] - k[1] * a[0]])
    p, q = (wide(s) for s in leaf["semi_axes"])
    return Quadric(start, np.outer(a, a) / p**2 + np.outer(b, b) / q**2, planes=planes)


def _double_cone(leaf):
    k = np.asarray(leaf["axis"], dtype=wide)
    k = k / np.sqrt(k @ k)
    matrix = np.eye(3, dtype=wide) - (1 + wide(leaf["slope"]) ** 2) * np.outer(k, k)
    return Quadric(leaf["apex"], matrix, constant=0)


def _box(leaf):
    center, half = np.asarray(leaf["center"], dtype=wide), np.asarray(leaf["size"], dtype=wide) / 2
    planes = [(center + s * half * e, s * e) for e in np.eye(3, dtype=wide) for s in (1, -1)]
    return Quadric(center, np.zeros((3, 3)), constant=-1, planes=planes)


def _general(leaf):
    a, b, c, d, e, f, g, h, i, j = (wide(x) for x in leaf["coefficients"])
    matrix = [[a, d / 2, f / 2], [d / 2, b, e / 2], [f / 2, e / 2, c]]
    return Quadric((0, 0, 0), matrix, (g / 2, h / 2, i / 2), j)


_SHAPES = {
    "sphere": _ellipsoid,
    "ellipsoid": _ellipsoid,
    "cylinder": _straight,
    "cone": _straight,
    "double_cone": _double_cone,
    "box": _box,
    "quadric": _general,
}
