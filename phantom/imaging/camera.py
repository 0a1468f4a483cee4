"""From world millimetres to columns and rows: the projection matrix of a view.

``w·(column, row, 1) = P (x, y, z, 1)`` with ``P = K [R | t]``. The camera's axes are ±right, down
and the normal n that points from the source to the detector; the sign of the first makes R proper
(det R = +1), and the same sign on ``fx`` keeps columns rising along ``right``: a view that is shown
mirrored, such as PA, has a negative ``fx``. For a parallel beam ``P = K A [R | t]`` (the last a 4×4
matrix), where A (3×4) drops the depth along the beam. R. Hartley and A. Zisserman, *Multiple View
Geometry in Computer Vision*, 2nd ed. (2004), equations 6.11 and 6.22.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phantom.imaging.view import FloatArray, View, unit


@dataclass(frozen=True, eq=False)
class Projection:
    """The camera of a view; make one with :func:`projection`.

    Attributes
    ----------
    matrix
        (3, 4) world mm to homogeneous (column, row); the third coordinate is the depth in mm from
        the source along the detector's normal (1 for a parallel beam).
    intrinsics
        (3, 3) K, in pixels; ``K[0, 0]`` may be negative.
    rotation
        (3, 3) R, world to camera axes, det +1.
    translation
        (3,) t in mm: a point has camera coordinates ``R p + t``. The camera's origin is the source,
        or the detector's centre for a parallel beam.
    distance_mm
        From the source to the plane of the detector; None for a parallel beam.
    """

    matrix: FloatArray
    intrinsics: FloatArray
    rotation: FloatArray
    translation: FloatArray
    distance_mm: float | None

    def depth_mm(self, points: FloatArray) -> FloatArray:
        """Return (N,) depths along the camera's axis of (N, 3) world points, in mm."""
        depth: FloatArray = points @ self.rotation[2] + self.translation[2]
        return depth

    def project(self, points: FloatArray) -> FloatArray:
        """Return (N, 2) columns and rows of (N, 3) world points; nan at or behind the source."""
        homogeneous = np.asarray(points, dtype=np.float64) @ self.matrix[:, :3].T
        homogeneous += self.matrix[:, 3]
        scale = np.where(homogeneous[:, 2:] > 0, homogeneous[:, 2:], np.nan)
        image: FloatArray = homogeneous[:, :2] / scale
        return image

    def magnification(self, point: FloatArray) -> float | None:
        """Return how much larger than life the plane through ``point`` along the detector is.

        None where the point is at or behind the source; 1 for a parallel beam.
        """
        if self.distance_mm is None:
            return 1.0
        depth = float(self.depth_mm(np.asarray(point, dtype=np.float64)[None])[0])
        return self.distance_mm / depth if depth > 0 else None


def projection(view: View) -> Projection:
    """Return the camera of a view."""
    detector = view.detector
    right, down = detector.axes
    center = np.asarray(detector.center, dtype=np.float64)
    beam = unit(view.direction) if view.direction is not None else center - np.asarray(view.source)
    mirror = 1.0 if detector.normal @ beam > 0 else -1.0
    rotation = np.stack([mirror * right, down, mirror * detector.normal])

    pitch_x, pitch_y = detector.pitch_xy_mm
    column, row = (detector.columns - 1) / 2, (detector.rows - 1) / 2
    if view.source is None:
        x, y, z = rotation @ beam
        flatten = np.array([[1.0, 0, -x / z, 0], [0, 1, -y / z, 0], [0, 0, 0, 1]])
        intrinsics = np.array([[mirror / pitch_x, 0, column], [0, 1 / pitch_y, row], [0, 0, 1.0]])
        translation = -rotation @ center
        pose = np.vstack([np.column_stack([rotation, translation]), [0.0, 0, 0, 1]])
        matrix = intrinsics @ flatten @ pose
        return Projection(matrix, intrinsics, rotation, translation, None)

    source = np.asarray(view.source, dtype=np.float64)
    foot_x, foot_y = right @ (source - center), down @ (source - center)
    distance = float(rotation[2] @ (center - source))
    intrinsics = np.array(
        [
            [mirror * distance / pitch_x, 0, column + foot_x / pitch_x],
            [0, distance / pitch_y, row + foot_y / pitch_y],
            [0, 0, 1.0],
        ]
    )
    translation = -rotation @ source
    matrix = intrinsics @ np.column_stack([rotation, translation])
    return Projection(matrix, intrinsics, rotation, translation, distance)
