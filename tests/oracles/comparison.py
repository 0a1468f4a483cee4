"""The engine against a twin, in figures: what is off, what is lost, by how much."""

from dataclasses import dataclass

import numpy as np

import phantom

SURFACE_MM = 1e-8


@dataclass(frozen=True)
class Comparison:
    rays: int
    hits: int
    ends: int
    ends_off: int
    """Ends with no surface of the twin within 1.2 times the tolerance."""
    false_pieces: int
    """Pieces longer than 1e-6 mm whose middle is not inside."""
    implied_mm: float
    """The largest error of a path length as a displacement of the surface."""
    worst_ray: int
    lost: int
    """Rays on which the twin finds more than sqrt(8 R e) and the engine nothing."""

    def right(self):
        return not (self.ends_off or self.false_pieces or self.lost) and (
            self.implied_mm <= SURFACE_MM
        )


def compare(shape, twin, origins, directions, span, reach, samples=200):
    """Trace with the engine, look with the twin. The twin looks in the middles of pieces too."""
    pieces = phantom.intervals(shape, origins, directions)
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    also = []
    for i in range(len(origins)):
        mine = pieces.ray == i
        ends = np.unique(np.concatenate([pieces.entry_mm[mine], pieces.exit_mm[mine]]))
        also.append(0.5 * (ends[1:] + ends[:-1]))
    ray = np.concatenate([pieces.ray, pieces.ray])
    distance = np.concatenate([pieces.entry_mm, pieces.exit_mm])
    ray, distance = ray[distance > 0], distance[distance > 0]
    on = twin.surface_within(origins[ray] + distance[:, None] * unit[ray], 1.2 * SURFACE_MM)
    middle = 0.5 * (pieces.entry_mm + pieces.exit_mm)
    left = twin.survivors(origins[pieces.ray] + middle[:, None] * unit[pieces.ray])
    left = left[np.arange(len(middle)), pieces.leaf]
    lengths = phantom.path_lengths(shape, origins, directions)
    truth = twin.path_lengths(origins, directions, span, samples, also)
    least = np.sqrt(8 * reach * SURFACE_MM)
    chord = np.maximum(np.minimum(lengths, truth), least)
    implied = (np.abs(lengths - truth) * np.minimum(chord / (4 * reach), 1.0)).max(axis=1)
    nothing = (lengths.sum(axis=1) == 0) & (truth.sum(axis=1) > least)
    return Comparison(
        rays=len(origins),
        hits=int(np.count_nonzero(lengths.sum(axis=1))),
        ends=len(on),
        ends_off=int(np.count_nonzero(~on)),
        false_pieces=int(np.count_nonzero(~left & (pieces.exit_mm - pieces.entry_mm > 1e-6))),
        implied_mm=float(implied.max()),
        worst_ray=int(np.argmax(implied)),
        lost=int(np.count_nonzero(nothing)),
    )
