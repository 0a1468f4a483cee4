"""Every tolerance of the engine, in one place, with its reason."""

from __future__ import annotations

SURFACE_MM = 1e-8
"""The traced surface lies within this distance of the surface the document defines."""

FIT_SHARE = 0.6
"""Share of :data:`SURFACE_MM` given to the fit of segments; the rest is the contour table's."""

OVERLAP_MM = 1e-6
"""A generalized cylinder may run into itself no deeper than this."""

CHORD_MM = 1e-3
"""No chord of the traced surface longer than this is lost."""

SINGULAR_SWEEP = 1e-3
"""A sweep is refused where its smallest stretch falls below this share of the largest."""

SMALLEST_SECTION_MM = 1e-6
"""A section thinner than this is refused: nothing of it could be told from the tolerance."""

CLOSING_MM = 1e-9
"""Sections at the two ends of a closed axis agree to this."""

TANGENT_JUMP_RAD = 1e-6
"""Tangents on both sides of a break differ by less than this, or the axis has a corner."""

IRREGULAR_SPEED = 1e-6
"""An axis whose speed falls below this share of its mean speed is not regular."""

UP_PARALLEL = 1e-6
"""``up`` frames are refused where the sine between the tangent and ``up`` is below this."""

STRAIGHT = 1e-7
"""Curvature times axis length below which a Frenet frame is undefined."""

MAX_SEGMENTS = 4096
"""A generalized cylinder that needs more segments than this is refused with the figure."""

CONTOUR_GAP_MM = 1e-6
"""A contour whose stretches come nearer to one another than this crosses or touches itself."""

PICKING = 1e-9
"""What is first seen along a ray lasts longer than this share of the phantom's size."""
