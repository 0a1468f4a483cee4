"""The engine against a twin, in figures: what is off, what is lost, by how much."""

from dataclasses import dataclass

import numpy as np

import phantom

SURFACE_MM = 1e-8
STEPS_MM = (1e-9, 2e-9, 3e-9, 4.5e-9, 6e-9, 9e-9, 1.2 * SURFACE_MM)


@dataclass(frozen=True)
class Comparison:
    rays: int
    hits: int
    ends: int
    ends_off: int
    """Ends with no surface of the twin within 1.2 times the tolerance."""
    within_mm: float
    """The smallest of a few steps within which every other end has a surface of the twin."""
    false_pieces: int
    """Pieces longer than 1e-6 mm whose middle is not inside."""
    lost: int
    """Ends of the twin that the engine lacks, or the other way, and that no sliver explains."""
    slivers: int
    """Chords or gaps shorter than sqrt(8 R e) that only one of the two has."""
    implied_mm: float
    """Largest error of a path length times c / 4R: for round bodies, the surface's displacement."""
    worst_ray: int

    def right(self):
        """Every end lies on the surface and has its partner."""
        return not (self.ends_off or self.false_pieces or self.lost)


def compare(shape, twin, origins, directions, span, reach, samples=200):
    """Trace a single leaf with the engine, look with the twin.

    The twin looks in the middles of the engine's pieces and gaps too.
    """
    pieces = phantom.intervals(shape, origins, directions)
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    mine = [pieces.ray == i for i in range(len(origins))]
    ends = [np.sort(np.concatenate([pieces.entry_mm[m], pieces.exit_mm[m]])) for m in mine]
    also = [0.5 * (e[1:] + e[:-1]) for e in ends]
    ray = np.concatenate([pieces.ray, pieces.ray])
    distance = np.concatenate([pieces.entry_mm, pieces.exit_mm])
    ray, distance = ray[distance > 0], distance[distance > 0]
    on, within = _on_surface(twin, origins[ray] + distance[:, None] * unit[ray])
    middle = 0.5 * (pieces.entry_mm + pieces.exit_mm)
    left = twin.survivors(origins[pieces.ray] + middle[:, None] * unit[pieces.ray])
    left = left[np.arange(len(middle)), pieces.leaf]
    least = np.sqrt(8 * reach * SURFACE_MM)
    lost, slivers, implied = 0, 0, np.zeros(len(origins))
    for i, chords in enumerate(twin.chords(origins, directions, span, samples, also)):
        true = np.sort(np.array([w for entry, exit_, _ in chords for w in (entry, exit_)]))
        found, true, dropped = matched(ends[i], true, least)
        slivers += dropped
        if len(found) != len(true):
            lost += abs(len(found) - len(true))
            continue
        lost += int(np.count_nonzero(np.abs(found - true) > least))
        error = abs(np.diff(found)[::2].sum() - np.diff(true)[::2].sum())
        chord = max(np.diff(true)[::2].sum(), least)
        implied[i] = error * min(chord / (4 * reach), 1.0)
    return Comparison(
        rays=len(origins),
        hits=sum(len(e) > 0 for e in ends),
        ends=len(on),
        ends_off=int(np.count_nonzero(~on)),
        within_mm=within,
        false_pieces=int(np.count_nonzero(~left & (pieces.exit_mm - pieces.entry_mm > 1e-6))),
        lost=lost,
        slivers=slivers,
        implied_mm=float(implied.max()),
        worst_ray=int(np.argmax(implied)),
    )


def _on_surface(twin, points):
    """Which points have a surface within the last step, and the step that is enough for those."""
    left, enough = np.arange(len(points)), STEPS_MM[0]
    for step in STEPS_MM:
        if not len(left):
            break
        near = twin.surface_within(points[left], step)
        if near.any():
            enough = step
        left = left[~near]
    on = np.ones(len(points), dtype=bool)
    on[left] = False
    return on, enough


def matched(one, two, least):
    """Both without the closest pairs of neighbours that only the longer has; how many pairs."""
    dropped = 0
    while len(one) != len(two):
        longer = one if len(one) > len(two) else two
        k = int(np.argmin(np.diff(longer)))
        if np.diff(longer)[k] > least:
            break
        shorter = np.delete(longer, [k, k + 1])
        one, two = (shorter, two) if longer is one else (one, shorter)
        dropped += 1
    return one, two, dropped
