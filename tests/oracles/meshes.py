"""What a closed mesh is held against: its edges, its volume, and the surface it stands for."""

import numpy as np

import phantom


def open_edges(triangles):
    """Edges that do not run as often one way as the other (a plain count, edge by edge)."""
    balance = {}
    for triangle in np.asarray(triangles).tolist():
        for a, b in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            key, sense = ((a, b), 1) if a < b else ((b, a), -1)
            balance[key] = balance.get(key, 0) + sense
    return [key for key, value in balance.items() if value]


def samples(mesh, rng, count):
    """Points spread over a mesh by area, with the normals of their triangles."""
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    rows = rng.choice(len(areas), count, p=areas / areas.sum())
    a, b = rng.random((2, count))
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    c = corners[rows]
    points = c[:, 0] + a[:, None] * (c[:, 1] - c[:, 0]) + b[:, None] * (c[:, 2] - c[:, 0])
    return points, normals[rows] / areas[rows, None]


def off_surface_mm(solid, points, normals, reach, rng, tries=12):
    """How far points are, at most, from the surface of a solid: the nearest along a few lines."""
    found = np.full(len(points), np.inf)
    left = np.arange(len(points))
    way = normals
    for _ in range(tries):
        far = 20 * reach
        cut = phantom.intervals(solid, points[left] - far * way, way)
        nearest = np.full(len(left), np.inf)
        for ends in (cut.entry_mm, cut.exit_mm):
            np.minimum.at(nearest, cut.ray, np.abs(ends - far))
        found[left] = np.minimum(found[left], nearest)
        left = np.flatnonzero(found > reach)
        if not len(left):
            break
        way = normals[left] + 0.8 * rng.standard_normal((len(left), 3))
        way /= np.linalg.norm(way, axis=1)[:, None]
    return found


def volume_mm3(solid, count=300):
    """The volume of a solid as a sum of exact chords over a lattice of parallel rays."""
    low, high = solid.bounds
    step = (high - low)[:2] / count
    x, y = (low[k] + step[k] * (np.arange(count) + 0.5) for k in (0, 1))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    origins = np.column_stack([grid, np.full(len(grid), low[2] - 1.0)])
    along = np.broadcast_to([0.0, 0.0, 1.0], origins.shape)
    return phantom.path_lengths(solid, origins, along).sum(axis=0) * step[0] * step[1]
