"""How each abnormality changes the plan of a knee."""

from __future__ import annotations

import math
from collections.abc import Sequence

from phantom.document import Cut, Cylinder, Finding, Point, ReferenceMaterial, Solid, Sphere
from phantom.errors import InvalidInputError
from phantoms.knee import abnormalities as known
from phantoms.knee import condyles, femur, plateau
from phantoms.knee.abnormalities import Wrong
from phantoms.knee.arthritis import osteoarthritis
from phantoms.knee.plan import Plan
from phantoms.knee.sites import Site, in_bone, in_joint, under_skin
from phantoms.parts import ellipsoid
from phantoms.people import MINERAL_IN_SPONGIOSA


def applied(plan: Plan, wanted: Sequence[Wrong]) -> Plan:
    """Return the plan with every abnormality in it.

    Raises
    ------
    InvalidInputError
        With every one that does not fit.
    """
    names = _names(wanted)
    # Osteoarthritis moves the tibia, on which others may be.
    order = sorted(range(len(wanted)), key=lambda i: wanted[i].type != "osteoarthritis")
    for index in order:
        one, name = wanted[index], names[index]
        if names.index(name) != index:
            plan.refuse(index, "name", "repeated", f"found {name!r} again; expected another name")
        elif isinstance(one, known.Osteoarthritis):
            osteoarthritis(plan, index, name, one)
        elif isinstance(one, known.Fracture):
            _fracture(plan, index, name, one)
        elif isinstance(one, known.LyticLesion | known.BlasticLesion):
            _lesion(plan, index, name, one)
        elif isinstance(one, known.Effusion):
            _effusion(plan, name, one)
        elif isinstance(one, known.LooseBody):
            _loose_body(plan, index, name, one)
        elif isinstance(one, known.ForeignBody):
            _foreign_body(plan, index, name, one)
    if plan.problems:
        raise InvalidInputError(plan.problems)
    return plan


def _names(wanted: Sequence[Wrong]) -> list[str]:
    """Return the findings' names: given, or the type with a number where it comes again."""
    found: list[str] = []
    for one in wanted:
        plain = one.type.replace("_", " ")
        count = sum(other.type == one.type for other in wanted[: len(found)])
        found.append(one.name or (plain if count == 0 else f"{plain} {count + 1}"))
    return found


def _placed(
    plan: Plan, index: int, site: Site, offset: Point, radius: float, field: str
) -> Point | None:
    """Return the middle of a ball at a site, or refuse it."""
    away = math.hypot(*offset)
    if away + radius > site.room:
        if away > 0.0 and radius <= site.room:
            field, size, room = "offset_mm", away, site.room - radius
            message = f"found {size:.4g} mm from the site's middle; expected {room:.3g} at most"
        else:
            message = f"found {2 * radius:.4g}; expected {2 * site.room:.3g} at most at this site"
        plan.refuse(index, field, "does_not_fit", message)
        return None
    x, y, z = (a + b for a, b in zip(site.middle, offset, strict=True))
    return (x, y, z)


def _lesion(
    plan: Plan, index: int, name: str, one: known.LyticLesion | known.BlasticLesion
) -> None:
    site = in_bone(plan, one.site)
    if site.bone in plan.broken:
        message = f"found {one.site!r}; expected no lesion of a broken bone"
        return plan.refuse(index, "site", "does_not_fit", message)
    radius = one.diameter_mm / 2.0
    middle = _placed(plan, index, site, one.offset_mm, radius, "diameter_mm")
    if middle is None:
        return None
    sign = -1.0 if isinstance(one, known.LyticLesion) else 1.0
    density = plan.sizes.spongiosa_density * (
        1.0 + sign * MINERAL_IN_SPONGIOSA * one.mineral_change
    )
    plan.lesions.add(site.bone)
    _ball(plan, name, one, middle, radius, ("spongiosa_icru44", density))
    return None


def _loose_body(plan: Plan, index: int, name: str, one: known.LooseBody) -> None:
    radius = one.diameter_mm / 2.0
    site = in_joint(plan, one.site)
    middle = _placed(plan, index, site, one.offset_mm, radius, "diameter_mm")
    if middle is not None:
        _ball(plan, name, one, middle, radius, ("cortical_bone_icru44", 1.5))


def _ball(
    plan: Plan,
    name: str,
    one: Wrong,
    middle: Point,
    radius: float,
    material: tuple[str, float],
) -> None:
    reference, density = material
    plan.materials[name] = ReferenceMaterial(reference=reference, density_g_cm3=round(density, 4))
    plan.inside.append(
        Sphere(type="sphere", name=name, material=name, center=middle, radius=radius)
    )
    _found(plan, name, one, [name], middle, 2.0 * radius)


def _foreign_body(plan: Plan, index: int, name: str, one: known.ForeignBody) -> None:
    site = under_skin(plan, one.site)
    radius = one.thickness_mm / 2.0
    middle = _placed(plan, index, site, (0.0, 0.0, 0.0), radius, "thickness_mm")
    if middle is None:
        return
    x, y, z = middle
    half = one.length_mm / 2.0
    plan.materials[name] = ReferenceMaterial(reference=one.material)
    body: Solid = Cylinder(
        type="cylinder",
        name=name,
        material=name,
        start=(x, y, z - half),
        end=(x, y, z + half),
        radius=radius,
    )
    plan.inside.append(body)
    size = (one.thickness_mm, one.thickness_mm, one.length_mm)
    _found(plan, name, one, [name], middle, size)


def _effusion(plan: Plan, name: str, one: known.Effusion) -> None:
    """Fluid before the femur: the strip grows forward from the bone."""
    across, along = condyles.scales(plan.sizes)
    half = one.depth_mm / 2.0
    middle = (-3.0 * across, -16.0 * along - half, 68.0 * along + plan.at.femur_z)
    axes = (20.0 * across, half + 1.0, 25.0 * along)
    plan.materials[name] = ReferenceMaterial(reference="water", density_g_cm3=1.02)
    plan.around.append(ellipsoid(name, middle, axes, name))
    size = (2.0 * axes[0], one.depth_mm, 2.0 * axes[2])
    _found(plan, name, one, [name], middle, size)


def _fracture(plan: Plan, index: int, name: str, one: known.Fracture) -> None:
    """Break a bone: the piece on the side of the plane's normal moves out and along the plane."""
    bone, point, normal, down, width = _breaks(plan, one)
    if bone in plan.broken:
        message = f"found {one.site!r}; expected one fracture of a bone at most"
        return plan.refuse(index, "site", "does_not_fit", message)
    if bone in plan.lesions:
        message = f"found {one.site!r}; expected no fracture of a bone with a lesion"
        return plan.refuse(index, "site", "does_not_fit", message)
    x, y, z = (one.gap_mm * n + one.step_mm * d for n, d in zip(normal, down, strict=True))
    piece = f"{bone} fragment" if name == "fracture" else name
    plan.broken[bone] = (Cut(point=point, normal=normal), (x, y, z), piece)
    leaves = [f"{piece}/cortex", f"{piece}/spongiosa"]
    size = (width, width, one.gap_mm)
    _found(plan, name, one, leaves, point, size)
    return None


def _breaks(plan: Plan, one: known.Fracture) -> tuple[str, Point, Point, Point, float]:
    """Return bone, point and normal of the plane, the direction of the step, and the width."""
    tilt = math.radians(one.tilt_deg)
    sizes, at = plan.sizes, plan.at
    if one.site == "femoral_shaft":
        z = min(92.0 * condyles.scales(sizes)[1] + at.femur_z, sizes.limb - 16.0)
        x = femur.lean_x(sizes, z)
        up = (math.sin(tilt), 0.0, math.cos(tilt))
        return "femur", (x, -1.0, z), up, (math.cos(tilt), 0.0, -math.sin(tilt)), 34.0
    across, along = plateau.scales(sizes)
    if one.site == "tibial_shaft":
        point = plan.shin.point((0.0, 6.0, -68.0 * along))
        below = (math.sin(tilt), 0.0, -math.cos(tilt))
        return "tibia", point, below, (math.cos(tilt), 0.0, math.sin(tilt)), 28.0 * across
    if one.site == "patella":
        x, y, z = at.ridge
        point = (x, y - sizes.patella_thickness / 2.0, z - 0.08 * sizes.patella_height)
        below = (0.0, math.sin(tilt), -math.cos(tilt))
        return "patella", point, below, (0.0, -math.cos(tilt), -math.sin(tilt)), sizes.patella_width
    # A wedge of the lateral plateau, in front of the fibula: out, forward and up; it steps down.
    lean, turn = math.radians(22.0) + tilt, math.radians(35.0)
    out = (-math.cos(lean) * math.cos(turn), -math.cos(lean) * math.sin(turn), math.sin(lean))
    down = (-math.sin(lean) * math.cos(turn), -math.sin(lean) * math.sin(turn), -math.cos(lean))
    point = plan.shin.point((-14.0 * across, 12.0 * along, -1.0))
    return "tibia", point, out, down, 40.0 * along


def _found(
    plan: Plan,
    name: str,
    one: Wrong,
    leaves: list[str],
    middle: Point,
    size: float | tuple[float, float, float],
) -> None:
    kind = one.type
    plan.findings.append(
        Finding(name=name, kind=kind, leaves=tuple(leaves), center=middle, size_mm=size)
    )
