"""The engine against the naive twin, on rays."""

import numpy as np

import phantom
from tests.oracles.naive import Twin

SURFACE_MM = 1e-8


def assert_agree(document, origins, directions, span, reach, samples=700, shape=None):
    """Every end is on a surface, and nothing is lost or invented.

    The twin looks along every ray in ``samples`` points, and in the middle of each piece and of
    each gap that the engine tells of, so that it misses only what is short and what both miss.
    Returns the engine's path lengths.
    """
    shape = phantom.load(document) if shape is None else shape
    twin = Twin(document)
    pieces = phantom.intervals(shape, origins, directions)
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    also = []
    for i in range(len(origins)):
        mine = pieces.ray == i
        ends = np.unique(np.concatenate([pieces.entry_mm[mine], pieces.exit_mm[mine]]))
        also.append(0.5 * (ends[1:] + ends[:-1]))
    for distance in (pieces.entry_mm, pieces.exit_mm):
        seen = distance > 0
        ray = pieces.ray[seen]
        points = origins[ray] + distance[seen, None] * unit[ray]
        on = twin.surface_within(points, 1.2 * SURFACE_MM)
        off = [(int(r), float(w)) for r, w in zip(ray[~on], distance[seen][~on], strict=True)]
        assert not off, f"ends off the surface, as (ray, distance): {off[:5]}"
    middle = 0.5 * (pieces.entry_mm + pieces.exit_mm)
    long = pieces.exit_mm - pieces.entry_mm > 1e-6
    points = origins[pieces.ray] + middle[:, None] * unit[pieces.ray]
    left = twin.survivors(points)[np.arange(len(points)), pieces.leaf]
    assert left[long].all(), "a piece is told where its leaf is not left"
    lengths = phantom.path_lengths(shape, origins, directions)
    truth = twin.path_lengths(origins, directions, span, samples, also)
    # Implied displacement: a surface off by e moves a chord c by about 4 R e / c.
    chord = np.maximum(np.minimum(lengths, truth), np.sqrt(8 * reach * SURFACE_MM))
    implied = np.abs(lengths - truth) * np.minimum(chord / (4 * reach), 1.0)
    worst = np.unravel_index(np.argmax(implied), implied.shape)
    assert implied.max() <= SURFACE_MM, (
        f"ray {worst[0]}, material {worst[1]}: engine {lengths[worst]:.12g} mm, "
        f"twin {truth[worst]:.12g} mm"
    )
    return lengths
