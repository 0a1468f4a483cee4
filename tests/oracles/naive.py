"""The slow, obvious twin: which leaves of a document are left at a point, and along a ray.

Everything is told pointwise from the plain tree of a document. Nothing is bounded, tabulated or
solved for along the ray: a ray is looked at in thousands of points, and every change between two
of them is closed in on by bisection.
"""

import numpy as np

from tests.oracles import cylinders

FINE_MM = 1e-11


class Twin:
    """A document, read pointwise. Leaves are numbered from left to right, instances expanded."""

    def __init__(self, document, samples_of_u=400):
        self.materials = list(document["materials"])
        self.definitions = document.get("definitions", {})
        self.samples_of_u = samples_of_u
        self.leaves = []
        self.root = self._read(document["solid"])
        self.channel = np.zeros((len(self.leaves), len(self.materials)), dtype=int)
        for i, leaf in enumerate(self.leaves):
            if "material" in leaf:
                self.channel[i, self.materials.index(leaf["material"])] = 1

    def survivors(self, points):
        """(P, L) bool: the leaves of the final solid at each point."""
        state = self.root(np.asarray(points, dtype=float))
        out = np.zeros((len(points), len(self.leaves)), dtype=bool)
        for leaf, mask in state.items():
            out[:, leaf] = mask
        return out

    def materials_at(self, points):
        """(P, M) counts of each material at each point."""
        return self.survivors(points) @ self.channel

    def _read(self, solid):
        kind = solid["type"]
        if kind == "instance":
            return self._read(self.definitions[solid["of"]])
        if kind == "transformed":
            inner, back = self._read(solid["solid"]), undo(solid)
            return lambda x: inner(back(x))
        if kind in OPERATORS:
            parts = [self._read(s) for s in solid["solids"]]

            def combined(x):
                left = parts[0](x)
                for part in parts[1:]:
                    left = OPERATORS[kind](left, part(x))
                return left

            return combined
        return self._leaf(solid)

    def _leaf(self, leaf):
        index = len(self.leaves)
        self.leaves.append(leaf)
        if leaf["type"] == "generalized_cylinder":
            shape = cylinders.membership(leaf, self.samples_of_u)
        else:
            shape = quadric_membership(leaf)
        cuts = [(np.array(c["point"], float), np.array(c["normal"], float)) for c in _cuts(leaf)]

        def state(x):
            inside = shape(x)
            for point, normal in cuts:
                inside &= (x - point) @ normal <= 0
            return {index: inside}

        return state

    def chords(self, origins, directions, span, samples=2000, also=None):
        """For each ray, a list of (entry, exit, survivors) with something left, in order of entry.

        ``span`` is (first, last) distance along every ray. ``also`` are more distances at which to
        look, one sequence for each ray.
        """
        directions = directions / np.linalg.norm(directions, axis=1)[:, None]
        steps = np.linspace(max(span[0], 0.0), span[1], samples)
        marks = []
        for i in range(len(origins)):
            more = [] if also is None else [w for w in also[i] if w > 0]
            marks.append(np.unique(np.concatenate([steps, more])))
        ray = np.repeat(np.arange(len(origins)), [len(m) for m in marks])
        w = np.concatenate(marks)
        state = self._states(origins, directions, ray, w)
        changed = np.flatnonzero((ray[1:] == ray[:-1]) & np.any(state[1:] != state[:-1], axis=1))
        events = self._close_in(origins, directions, ray, w, state, changed)
        result = []
        starts = np.searchsorted(ray, np.arange(len(origins)))
        for i, first in enumerate(starts):
            mine = sorted((at, k) for k, (who, at, _) in enumerate(events) if who == i)
            edges = [w[first], *(at for at, _ in mine), marks[i][-1]]
            inside = [state[first], *(events[k][2] for _, k in mine)]
            result.append(
                [
                    (a, b, s)
                    for a, b, s in zip(edges[:-1], edges[1:], inside, strict=True)
                    if s.any() and b > a
                ]
            )
        return result

    def path_lengths(self, origins, directions, span, samples=2000, also=None):
        """(N, M) mm of each material on each ray."""
        out = np.zeros((len(origins), len(self.materials)))
        for i, rows in enumerate(self.chords(origins, directions, span, samples, also)):
            for entry, exit_, state in rows:
                out[i] += (exit_ - entry) * (state @ self.channel)
        return out

    def surface_within(self, points, distance):
        """Whether the leaves that are left change somewhere within a distance of each point.

        Looks at the corners and the faces of a small cube, so a surface nearer than about
        0.85 of the distance is always seen and one farther than it never.
        """
        near = np.array([(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)])
        near = near[np.any(near != 0, axis=1)].astype(float)
        near *= distance / np.linalg.norm(near, axis=1)[:, None]
        states = self.survivors((points[:, None] + near).reshape(-1, 3))
        states = states.reshape(len(points), len(near), len(self.leaves))
        return np.any(states != states[:, :1], axis=(1, 2))

    def _states(self, origins, directions, ray, w):
        parts = [np.zeros((0, len(self.leaves)), dtype=bool)]
        parts += [
            self.survivors(origins[ray[k : k + 20_000]] + w[k : k + 20_000, None] * d)
            for k in range(0, len(w), 20_000)
            for d in (directions[ray[k : k + 20_000]],)
        ]
        return np.concatenate(parts)

    def _close_in(self, origins, directions, ray, w, state, changed):
        """Halve every step with a change until it is short; a step may hold several changes."""
        low, high = w[changed], w[changed + 1]
        left, right, who = state[changed], state[changed + 1], ray[changed]
        events = []
        while len(low):
            middle = 0.5 * (low + high)
            short = (high - low < FINE_MM) | (middle <= low) | (middle >= high)
            events += [
                (r, m, s) for r, m, s in zip(who[short], middle[short], right[short], strict=True)
            ]
            low, high, middle = low[~short], high[~short], middle[~short]
            left, right, who = left[~short], right[~short], who[~short]
            if not len(low):
                break
            between = self._states(origins, directions, who, middle)
            first = np.any(between != left, axis=1)
            second = np.any(between != right, axis=1)
            low, high = (
                np.concatenate([low[first], middle[second]]),
                np.concatenate([middle[first], high[second]]),
            )
            left, right = (
                np.concatenate([left[first], between[second]]),
                np.concatenate([between[first], right[second]]),
            )
            who = np.concatenate([who[first], who[second]])
        return events


def _cuts(leaf):
    return leaf.get("cuts", ())


def _present(state):
    """Where any leaf is left. A state maps leaf numbers to the points where the leaf is left."""
    return np.logical_or.reduce(list(state.values()))


def _kept(state, where):
    return {leaf: mask & where for leaf, mask in state.items()}


def _union(left, right):
    return left | _kept(right, ~_present(left))


def _intersection(left, right):
    return _kept(left, _present(right))


def _difference(left, right):
    return _kept(left, ~_present(right))


def _overlap(left, right):
    return left | right


def _replace(left, right):
    return _kept(left, ~_present(right)) | right


OPERATORS = {
    "union": _union,
    "intersection": _intersection,
    "difference": _difference,
    "overlap": _overlap,
    "replace": _replace,
}


def turn(axis, angle_deg):
    """Rotation matrix, right-handed about an axis."""
    k = np.array(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    a = np.radians(angle_deg)
    return np.eye(3) + np.sin(a) * cross + (1 - np.cos(a)) * cross @ cross


def undo(transformed):
    """The map from the world back into what is transformed."""
    if "matrix" in transformed:
        matrix = np.array(transformed["matrix"], float)
        inverse = np.linalg.inv(matrix[:, :3])
        return lambda x: (x - matrix[:, 3]) @ inverse.T
    scale = transformed.get("scale", 1.0)
    shift = np.array(transformed.get("translate", (0, 0, 0)), float)
    rotate = transformed.get("rotate")
    matrix = turn(rotate["axis"], rotate["angle_deg"]) if rotate else np.eye(3)
    about = np.array(rotate.get("about", (0, 0, 0)) if rotate else (0, 0, 0), float)
    return lambda x: ((x - shift - about) @ matrix + about) / scale


def quadric_membership(leaf):
    """Inside test of a leaf that is no generalized cylinder, without its cuts."""
    kind = leaf["type"]
    get = {
        k: np.array(v, float)
        for k, v in leaf.items()
        if k not in ("type", "name", "material", "cuts", "appearance")
    }
    if kind == "sphere":
        return lambda x: np.linalg.norm(x - get["center"], axis=1) <= get["radius"]
    if kind == "ellipsoid":
        return lambda x: np.linalg.norm((x - get["center"]) / get["semi_axes"], axis=1) <= 1
    if kind == "box":
        return lambda x: np.all(np.abs(x - get["center"]) <= get["size"] / 2, axis=1)
    if kind == "quadric":
        a, b, c, d, e, f, g, h, i, j = get["coefficients"]

        def general(p):
            x, y, z = p.T
            square = a * x * x + b * y * y + c * z * z + d * x * y + e * y * z + f * z * x
            return square + g * x + h * y + i * z + j <= 0

        return general
    if kind == "double_cone":
        k = get["axis"] / np.linalg.norm(get["axis"])

        def both_cones(x):
            along = (x - get["apex"]) @ k
            across = np.linalg.norm(x - get["apex"] - along[:, None] * k, axis=1)
            return across <= get["slope"] * np.abs(along)

        return both_cones
    span = get["end"] - get["start"]
    length = np.linalg.norm(span)
    k = span / length

    def straight(x):
        y = x - get["start"]
        along = y @ k
        across = y - along[:, None] * k
        if kind == "cone":
            radius = (
                get["start_radius"] + (get["end_radius"] - get["start_radius"]) * along / length
            )
            near = np.linalg.norm(across, axis=1) <= radius
        elif "radius" in get:
            near = np.linalg.norm(across, axis=1) <= get["radius"]
        else:
            first = get["up"] - (get["up"] @ k) * k
            first /= np.linalg.norm(first)
            second = np.cross(k, get["up"])
            second /= np.linalg.norm(second)
            a, b = get["semi_axes"]
            near = np.hypot(y @ first / a, y @ second / b) <= 1
        return near & (along >= 0) & (along <= length)

    return straight
