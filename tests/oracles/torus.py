"""A torus about the z axis: rays by its quartic, in extended precision."""

import numpy as np


def chords(R, r, origins, directions):
    """Sorted roots of the quartic of each ray, as a list of (k, 2) arrays of entry and exit.

    (|x|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2) with x = p + w d and |d| = 1. Roots come from the
    companion matrix and are polished by Newton's method in 80-bit arithmetic.
    """
    wide = np.longdouble
    p = origins.astype(wide)
    d = directions.astype(wide)
    d /= np.sqrt((d * d).sum(axis=1))[:, None]
    shift = -(p * d).sum(axis=1)
    p = p + shift[:, None] * d
    # About the point nearest the centre p.d = 0, so |x|^2 = p.p + w^2.
    k = (p * p).sum(axis=1) + R * R - r * r
    a = (d[:, :2] ** 2).sum(axis=1)
    b = (d[:, :2] * p[:, :2]).sum(axis=1)
    c = (p[:, :2] ** 2).sum(axis=1)
    four = wide(4) * R * R
    coefficients = np.stack(
        [np.ones_like(k), np.zeros_like(k), 2 * k - four * a, -2 * four * b, k * k - four * c],
        axis=1,
    )
    companion = np.zeros((len(p), 4, 4))
    companion[:, 1:, :3] = np.eye(3)
    companion[:, :, 3] = -coefficients[:, :0:-1].astype(float)
    values = np.linalg.eigvals(companion)
    w = values.real.astype(wide)
    poly = coefficients[:, :, None]
    for _ in range(40):
        f = (((w + poly[:, 1]) * w + poly[:, 2]) * w + poly[:, 3]) * w + poly[:, 4]
        f1 = ((4 * w + 3 * poly[:, 1]) * w + 2 * poly[:, 2]) * w + poly[:, 3]
        w = w - np.where(f1 != 0, f / np.where(f1 != 0, f1, 1), 0)
    f = (((w + poly[:, 1]) * w + poly[:, 2]) * w + poly[:, 3]) * w + poly[:, 4]
    real = (np.abs(values.imag) < 1e-3) & (np.abs(f) < 1e-9 * (1 + np.abs(poly[:, 4])))
    w = np.sort(np.where(real, (w + shift[:, None]).astype(float), np.inf), axis=1)
    # An odd number is a tangent ray: nothing of length lies between equal roots.
    counts = np.where(real.sum(axis=1) % 2, 0, real.sum(axis=1))
    return [row[:n].reshape(-1, 2) for row, n in zip(w, counts, strict=True)]


def distance(R, r, points):
    """Signed distance of points from the torus, negative inside."""
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - R, points[:, 2]) - r
