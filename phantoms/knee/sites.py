"""Places in and around a right knee, and how much room there is, in mm.

Rooms are the radius of the largest ball that stays where it should (in spongy bone, in the joint),
for the table's man; they shrink with the bones. The tests hold them against the traced result.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from phantom.document import Point
from phantoms.knee import condyles, plateau
from phantoms.knee.femur import lean_x

if TYPE_CHECKING:
    from phantoms.knee.plan import Plan


class Site(NamedTuple):
    """A place: the bone that it moves with, its middle, and the radius of the room there."""

    bone: str
    middle: Point
    room: float


_IN_BONE: Final = {
    "medial_femoral_condyle": Site("femur", (27.0, 20.0, 21.0), 12.5),
    "lateral_femoral_condyle": Site("femur", (-27.0, 20.0, 21.0), 12.5),
    "distal_femur": Site("femur", (0.0, 0.0, 60.0), 11.8),
    "medial_tibial_plateau": Site("tibia", (15.5, 10.5, -15.5), 11.0),
    "lateral_tibial_plateau": Site("tibia", (-15.0, 10.5, -15.5), 11.0),
    "proximal_tibia": Site("tibia", (0.6, 3.0, -40.0), 12.0),
}


def in_bone(plan: Plan, name: str) -> Site:
    """Return a site of spongy bone, where it stands."""
    if name == "patella":
        sizes = plan.sizes
        middle = (0.0, -0.55 * sizes.patella_thickness, 0.0)
        room = 0.3 * min(sizes.patella_thickness, 0.8 * sizes.patella_height)
        return Site("patella", plan.cap.point(middle), room)
    site = _IN_BONE[name]
    scales = condyles.scales(plan.sizes) if site.bone == "femur" else plateau.scales(plan.sizes)
    x, y, z = site.middle
    drawn = (x * scales[0], y * scales[1], z * scales[1])
    if name == "distal_femur":
        drawn = (lean_x(plan.sizes, drawn[2]), drawn[1], drawn[2])
    walls = max(0.0, plan.sizes.femur_cortex * 0.27 - 1.9)
    return Site(site.bone, plan.pose(site.bone).point(drawn), site.room * min(scales) - walls)


def in_joint(plan: Plan, name: str) -> Site:
    """Return a site of the joint's cavity."""
    across, along = condyles.scales(plan.sizes)
    lift = plan.at.femur_z
    middles = {
        "suprapatellar_pouch": Site("femur", (-3.0, -26.4, 64.0), 6.5),
        "posterior_recess": Site("femur", (0.0, 49.0, 30.0), 7.0),
        "medial_gutter": Site("femur", (48.6, 6.0, 32.0), 4.0),
        "lateral_gutter": Site("femur", (-48.6, 6.0, 32.0), 4.0),
    }
    _, (x, y, z), room = middles[name]
    return Site("femur", (x * across, y * along, z * along + lift), room * min(across, along))


def under_skin(plan: Plan, name: str) -> Site:
    """Return a site between bone and skin."""
    across, along = condyles.scales(plan.sizes)
    fat = plan.sizes.fat
    if name == "front_of_the_patella":
        x, y, z = plan.at.ridge
        room = (2.6 + max(0.4 * fat, 1.0)) / 2.0
        return Site("patella", (x, y - plan.sizes.patella_thickness - room - 0.2, z), room)
    if name == "back_of_the_knee":
        return Site("femur", (0.0, 52.0 * along, 6.0), 5.0)
    room = (4.0 + 0.9 * fat) / 2.0
    side = 1.0 if name == "medial_side" else -1.0
    return Site("femur", (side * (46.6 * across + room), 8.0, 12.0), room)
