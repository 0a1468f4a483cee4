"""Phong's model at the first hits of a raster (paper II.G), averaged over the samples of a pixel.

``color (K_a ambient + sum over lights of light (K_d N.L + K_s (H.N)^n))`` with N.L and H.N held at
0 or above, and ``H = |E + L|``; N is turned to the eye, so that a wall seen from within is lit
from within.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import kernel
from phantom.kernels.cylinder import ROW, STACK
from phantom.kernels.first_hit import first_of_ray
from phantom.kernels.leaves import leaf_intervals
from phantom.kernels.normals import leaf_normal

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]

OFF_SURFACE = 100.0
"""A ray to a light starts this many tolerances off the surface, so as not to meet it again."""


@kernel
def shine(
    nx: float, ny: float, nz: float, hx: float, hy: float, hz: float, exponent: float
) -> float:
    """Return ``(H.N)^n``, H of any length; 0 where it is below 0."""
    half = math.sqrt(hx * hx + hy * hy + hz * hz)
    if half == 0.0:
        return 0.0
    cosine = (hx * nx + hy * ny + hz * nz) / half
    return cosine**exponent if cosine > 0.0 else 0.0


@kernel
def shade_facets(
    view: Floats,
    first_row: int,
    found: Floats,
    hits: Ints,
    normals: Floats,
    looks: Floats,
    ambient: Floats,
    places: Floats,
    colors: Floats,
    samples: int,
    rgb: Floats,
    coverage: Floats,
) -> None:
    """Add the light of samples whose normals are known to their pixels, without shadows.

    ``found`` (rows, columns) holds the t of the first hits and ``normals`` (rows, columns, 3) the
    unit normals; all else is as of :func:`shade`.
    """
    share = 1.0 / (samples * samples)
    for i in range(found.shape[0]):
        row = first_row + i
        for j in range(found.shape[1]):
            t = found[i, j]
            if t == math.inf:
                continue
            dx = view[3, 0] + row * view[4, 0] + j * view[5, 0]
            dy = view[3, 1] + row * view[4, 1] + j * view[5, 1]
            dz = view[3, 2] + row * view[4, 2] + j * view[5, 2]
            length = math.sqrt(dx * dx + dy * dy + dz * dz)
            ex, ey, ez = -dx / length, -dy / length, -dz / length
            x = view[0, 0] + row * view[1, 0] + j * view[2, 0] + t * dx
            y = view[0, 1] + row * view[1, 1] + j * view[2, 1] + t * dy
            z = view[0, 2] + row * view[1, 2] + j * view[2, 2] + t * dz
            nx, ny, nz = normals[i, j, 0], normals[i, j, 1], normals[i, j, 2]
            if nx * ex + ny * ey + nz * ez < 0.0:
                nx, ny, nz = -nx, -ny, -nz
            look = looks[hits[i, j, 1]]
            r, g, b = look[3] * ambient[0], look[3] * ambient[1], look[3] * ambient[2]
            for k in range(len(places)):
                lx = places[k, 0] - places[k, 3] * x
                ly = places[k, 1] - places[k, 3] * y
                lz = places[k, 2] - places[k, 3] * z
                far = math.sqrt(lx * lx + ly * ly + lz * lz)
                if far == 0.0:
                    continue
                lx, ly, lz = lx / far, ly / far, lz / far
                light = look[4] * max(nx * lx + ny * ly + nz * lz, 0.0)
                light += look[5] * shine(nx, ny, nz, ex + lx, ey + ly, ez + lz, look[6])
                r += light * colors[k, 0]
                g += light * colors[k, 1]
                b += light * colors[k, 2]
            u, v = i // samples, j // samples
            rgb[u, v, 0] += share * look[0] * r
            rgb[u, v, 1] += share * look[1] * g
            rgb[u, v, 2] += share * look[2] * b
            coverage[u, v] += share


@kernel
def shade(
    scene: Scene,
    view: Floats,
    first_row: int,
    distances: Floats,
    hits: Ints,
    looks: Floats,
    ambient: Floats,
    places: Floats,
    colors: Floats,
    shadows: bool,
    shown: Flags,
    shortest: float,
    tolerance: float,
    slack: float,
    room: int,
    samples: int,
    rgb: Floats,
    coverage: Floats,
) -> bool:
    """Add the light of every sample to its pixel; return False where there was no room.

    Parameters
    ----------
    view, first_row
        As of :func:`phantom.kernels.first_hit.tile_hits`.
    distances, hits
        (rows, columns) and (rows, columns, 4) of the samples.
    looks
        (L, 7) red, green, blue, K_a, K_d, K_s and n of every leaf.
    ambient
        (3,) red, green and blue.
    places
        (lights, 4): the way from a point p to light i is ``places[i, :3] - places[i, 3] p``.
    colors
        (lights, 3).
    samples
        Along a side of a pixel; the first sample is a pixel's first.
    rgb, coverage
        (pixel rows, pixel columns, 3) and without the 3; added to.
    """
    work, gradient, normal = np.empty((6, 7)), np.empty(3), np.empty(3)
    size = room if shadows else 1
    entries, exits = np.empty(size), np.empty(size)
    owners = np.empty(size, dtype=np.int64)
    where, order = np.empty(2 * size), np.empty(2 * size, dtype=np.int64)
    beam, stack, found = np.empty(10), np.empty((STACK, ROW)), np.empty((size, 2))
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(len(scene.leaf_radius) + 1, dtype=np.int64)
    counter, met = np.zeros(1, dtype=np.int64), np.empty(4, dtype=np.int64)
    share = 1.0 / (samples * samples)
    for i in range(distances.shape[0]):
        row = first_row + i
        for j in range(distances.shape[1]):
            way = distances[i, j]
            if way == math.inf:
                continue
            dx = view[3, 0] + row * view[4, 0] + j * view[5, 0]
            dy = view[3, 1] + row * view[4, 1] + j * view[5, 1]
            dz = view[3, 2] + row * view[4, 2] + j * view[5, 2]
            length = math.sqrt(dx * dx + dy * dy + dz * dz)
            ex, ey, ez = -dx / length, -dy / length, -dz / length
            x = view[0, 0] + row * view[1, 0] + j * view[2, 0] - way * ex
            y = view[0, 1] + row * view[1, 1] + j * view[2, 1] - way * ey
            z = view[0, 2] + row * view[1, 2] + j * view[2, 2] - way * ez
            leaf_normal(scene, hits[i, j, 0], x, y, z, slack, work, gradient, normal)
            nx, ny, nz = normal[0], normal[1], normal[2]
            if nx * ex + ny * ey + nz * ez < 0.0:
                nx, ny, nz = -nx, -ny, -nz
            seen = hits[i, j, 1]
            red, green, blue = looks[seen, 0], looks[seen, 1], looks[seen, 2]
            diffuse, specular, exponent = looks[seen, 4], looks[seen, 5], looks[seen, 6]
            r, g, b = (
                looks[seen, 3] * ambient[0],
                looks[seen, 3] * ambient[1],
                looks[seen, 3] * ambient[2],
            )
            for k in range(len(places)):
                lx = places[k, 0] - places[k, 3] * x
                ly = places[k, 1] - places[k, 3] * y
                lz = places[k, 2] - places[k, 3] * z
                far = math.sqrt(lx * lx + ly * ly + lz * lz)
                if far == 0.0:
                    continue
                lx, ly, lz = lx / far, ly / far, lz / far
                cosine = nx * lx + ny * ly + nz * lz
                if shadows:
                    # A surface that faces away from a light lies in its own shadow.
                    if cosine <= 0.0:
                        continue
                    off = OFF_SURFACE * tolerance
                    end = far - off if places[k, 3] != 0.0 else math.inf
                    count = leaf_intervals(
                        scene,
                        x + off * nx,
                        y + off * ny,
                        z + off * nz,
                        lx,
                        ly,
                        lz,
                        end,
                        shortest,
                        entries,
                        exits,
                        owners,
                        work,
                        beam,
                        stack,
                        found,
                        counter,
                    )
                    if count < 0:
                        return False
                    blocked = first_of_ray(
                        scene,
                        count,
                        entries,
                        exits,
                        owners,
                        shown,
                        tolerance,
                        where,
                        order,
                        present,
                        nodes,
                        kept,
                        met,
                    )
                    if blocked < math.inf:
                        continue
                light = diffuse * max(cosine, 0.0)
                light += specular * shine(nx, ny, nz, ex + lx, ey + ly, ez + lz, exponent)
                r += light * colors[k, 0]
                g += light * colors[k, 1]
                b += light * colors[k, 2]
            u, v = i // samples, j // samples
            rgb[u, v, 0] += share * red * r
            rgb[u, v, 1] += share * green * g
            rgb[u, v, 2] += share * blue * b
            coverage[u, v] += share
    return True
