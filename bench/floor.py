"""The floor: what the machine takes for seven ellipsoids and nothing else.

No engine that gives path lengths in double precision can be much faster: one square root and one
division a pixel and ellipsoid, everything else constant along a row, no clipping, no algebra, no
materials. Each ellipsoid is one pass over the whole row (no spans), in vector registers; bands of
rows go to the library's own threads. Cost does not depend on where the ellipsoids lie.

Run with ``python -m bench.floor`` from the root of the project.
"""

import math
import statistics
import time

import numba
import numpy as np

from phantom.tracing.pool import cut_bands, default_workers, run_bands

# Centre and semi-axes in mm, axis-parallel: the knee-like scene's three ellipsoids, and one in
# place of each tube (length and largest radius) and of the soft tissue's cylinder.
ELLIPSOIDS = np.array(
    [
        [0.0, 0.0, 0.0, 90.0, 120.0, 65.0],
        [-40.0, 0.0, 4.0, 30.0, 100.0, 30.0],
        [36.0, 0.0, 0.0, 26.0, 100.0, 26.0],
        [2.7, 0.0, -40.0, 9.0, 100.0, 9.0],
        [0.0, 20.0, 45.0, 22.0, 26.0, 10.0],
        [-40.0, 92.0, 4.0, 30.0, 22.0, 34.0],
        [36.16, 60.0, 1.73, 8.0, 14.0, 9.0],
    ]
)
SOURCE = np.array([0.0, 0.0, 1000.0])
CENTER = np.array([0.0, 0.0, -500.0])
RIGHT, DOWN = np.array([1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])
WIDTH_MM = 1024 * 0.3
BAND_ROWS = 64


@numba.njit(nogil=True, error_model="numpy", fastmath={"contract"}, cache=True)
def one_ellipsoid(row, a0, a1, a2, d0, d1, d2):
    """Add ``sqrt(disc)/a`` of each pixel, both quadratic in its column."""
    for j in range(len(row)):
        x = float(j)
        disc = (d2 * x + d1) * x + d0
        disc = disc if disc > 0.0 else 0.0
        row[j] += math.sqrt(disc) / ((a2 * x + a1) * x + a0)


@numba.njit(nogil=True, error_model="numpy", fastmath={"contract"}, cache=True)
def to_lengths(row, l0, l1, l2):
    """Turn sums in units of the ray's parameter into mm."""
    for j in range(len(row)):
        x = float(j)
        row[j] *= 2.0 * math.sqrt((l2 * x + l1) * x + l0)


@numba.njit(nogil=True, error_model="numpy", fastmath={"contract"}, cache=True)
def band_of_rows(ellipsoids, source, first, across, down, start, out):
    for i in range(out.shape[0]):
        row = out[i]
        row[:] = 0.0
        ray = first + (start + i) * down - source
        for k in range(len(ellipsoids)):
            center, size = ellipsoids[k, :3], ellipsoids[k, 3:]
            o, d, s = (source - center) / size, ray / size, across / size
            c = np.sum(o * o) - 1.0
            b0, b1 = np.sum(o * d), np.sum(o * s)
            a0, a1, a2 = np.sum(d * d), 2.0 * np.sum(d * s), np.sum(s * s)
            d0, d1, d2 = b0 * b0 - a0 * c, 2.0 * b0 * b1 - a1 * c, b1 * b1 - a2 * c
            one_ellipsoid(row, a0, a1, a2, d0, d1, d2)
        to_lengths(row, np.sum(ray * ray), 2.0 * np.sum(ray * across), np.sum(across * across))


def floor_image(side=1024, workers=None, ellipsoids=ELLIPSOIDS):
    """Return (side, side) mm: the sum of the chords of all ellipsoids, float64."""
    pitch = WIDTH_MM / side
    across, down = pitch * RIGHT, pitch * DOWN
    first = CENTER - 0.5 * (side - 1) * (across + down)
    out = np.empty((side, side))

    def band(start, end):
        band_of_rows(ellipsoids, SOURCE, first, across, down, start, out[start:end])

    rows = max(1, min(BAND_ROWS, side // (2 * default_workers())))
    run_bands(band, cut_bands(side, rows), workers=workers)
    return out


def time_floor(side=1024, workers=None, repeats=21):
    """Return the seconds of each of ``repeats`` images, the compiling one left out."""
    floor_image(side, workers)
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        floor_image(side, workers)
        times.append(time.perf_counter() - start)
    return times


def registers():
    """Return how many packed square roots and divisions the machine code of the pass has."""
    # Compiled anew: numba keeps no listing of what it loads from its cache.
    fresh = numba.njit(nogil=True, error_model="numpy", fastmath={"contract"})(
        one_ellipsoid.py_func
    )
    fresh(np.zeros(8), 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    code = "\n".join(fresh.inspect_asm().values())
    return {
        f"{name} {register}": sum(
            name in line and f"%{register}" in line for line in code.splitlines()
        )
        for name in ("vsqrtpd", "vdivpd")
        for register in ("ymm", "zmm")
    }


def main():
    for workers in (1, None):
        times = [1e3 * t for t in time_floor(workers=workers)]
        print(
            f"floor, 1024 x 1024, {workers or default_workers()} threads:"
            f" {statistics.median(times):.1f} ms ({min(times):.1f} .. {max(times):.1f})"
        )
    print(registers())


if __name__ == "__main__":
    main()
