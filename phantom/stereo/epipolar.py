"""Where the other eye sees the same point: the fundamental matrix of two projections."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def fundamental_matrix(left: Floats, right: Floats) -> Floats | None:
    """Return (3, 3) F with ``(x, y, 1)_right · F · (x, y, 1)_left = 0`` for one point's two images.

    ``F (x, y, 1)_left`` is the line (a, b, c), a x + b y + c = 0, on which the right eye sees the
    point. Its elements are bifocal determinants (R. Hartley and A. Zisserman, *Multiple View
    Geometry in Computer Vision*, 2nd ed. (2004), equation 17.3), so that parallel beams have one
    too; scaled to a Frobenius norm of 1, the element of greatest size positive.

    Parameters
    ----------
    left, right
        (3, 4) projection matrices, world mm to homogeneous column and row. None comes back where
        they are one: what both eyes see from one place has no depth.
    """
    if np.array_equal(left, right):
        return None
    lengths = [np.linalg.norm(m[:, :3], axis=1) for m in (left, right)]
    one, other = _near_the_left_eye(left, right)
    found = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            rows = np.vstack([np.delete(one, i, axis=0), np.delete(other, j, axis=0)])
            found[j, i] = (-1.0) ** (i + j) * np.linalg.det(rows)
    # Row k of a matrix was divided by its length, which is taken back.
    of_right, of_left = (np.where(length > 0, length, 1.0) for length in reversed(lengths))
    found /= np.outer(of_right, of_left)
    found /= np.linalg.norm(found)
    greatest = found.flat[int(np.argmax(np.abs(found)))]
    return np.asarray(found * np.sign(greatest) + 0.0)


def _near_the_left_eye(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Return both matrices in a world about the left eye, in a unit near the eyes' distance.

    The determinants would otherwise be small differences of large products.
    """
    eye = np.linalg.lstsq(left[:, :3], -left[:, 3], rcond=None)[0]
    moved = []
    for matrix in (left, right):
        length = np.linalg.norm(matrix[:, :3], axis=1)
        length[length == 0.0] = 1.0
        moved.append(np.column_stack([matrix[:, :3], matrix[:, :3] @ eye + matrix[:, 3]]))
        moved[-1] /= length[:, np.newaxis]
    unit_mm = float(np.abs(moved[1][:, 3]).max())
    for matrix in moved:
        matrix[:, 3] /= unit_mm
    return moved[0], moved[1]
