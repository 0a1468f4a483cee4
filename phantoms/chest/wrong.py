"""How each abnormality changes a chest: what is added, where in the order, and what is found."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from phantom.document import (
    Cylinder,
    Difference,
    Ellipsoid,
    Instance,
    Intersection,
    Point,
    ReferenceMaterial,
    Solid,
    Sphere,
    Transformed,
)
from phantom.errors import InvalidInputError
from phantom.library import Abnormality
from phantoms.chest import abnormalities as known
from phantoms.chest import lungs
from phantoms.chest.bones import fracture, rib_lesion, vertebral_lesion
from phantoms.chest.cage import Cage, FloatArray
from phantoms.chest.changes import Changes, as_point
from phantoms.chest.courses import TRACHEA
from phantoms.chest.shapes import cone, tube
from phantoms.parts import union

SITES: Final[Mapping[str, Point]] = {
    "right apex": (-48.0, 26.0, 102.0),
    "right upper lobe": (-74.0, 16.0, 62.0),
    "right middle lobe": (-84.0, -44.0, -44.0),
    "right lower lobe": (-90.0, 52.0, -64.0),
    "left apex": (48.0, 26.0, 102.0),
    "left upper lobe": (74.0, 12.0, 58.0),
    "lingula": (104.0, -30.0, -34.0),
    "left lower lobe": (92.0, 52.0, -66.0),
}
"""Drawn places of the words that say where in the lungs."""
_HILA: Final[Mapping[str, Point]] = {"right": (-40.0, 6.0, 10.0), "left": (44.0, 10.0, 16.0)}
_COINS: Final[Mapping[str, Point]] = {
    "upper oesophagus": (3.0, 24.0, 104.0),
    "lower oesophagus": (6.0, 26.0, -50.0),
    "stomach": (62.0, -20.0, -150.0),
}
_MENISCUS_MM: Final = 15.0
"""By which the fluid's surface stands higher at the wall than where it is lowest."""
Fits = Callable[[FloatArray], "np.ndarray[Any, np.dtype[np.bool_]]"]


def changes(cage: Cage, wanted: Sequence[Abnormality], in_lung: Callable[[], Fits]) -> Changes:
    """Return what the abnormalities change.

    Parameters
    ----------
    in_lung
        Gives a function that tells which points ``(P, 3)`` are in a healthy lung.

    Raises
    ------
    InvalidInputError
        With every one that does not fit, under ``/abnormalities/i``.
    """
    result = Changes()
    names = _names(wanted)
    drawn_in: set[str] = {one.side for one in wanted if isinstance(one, known.Pneumothorax)}
    if "left" in drawn_in:
        drawn_in |= {"lingula"}
    for index, (one, name) in enumerate(zip(wanted, names, strict=True)):
        if name in names[:index]:
            message = f"found {name!r} again; expected another name"
            result.refuse(index, "name", "repeated", message)
            continue
        match one:
            case known.Nodule() | known.Mass() if one.site.split()[0] in drawn_in:
                message = f"found {one.site!r}, a lung drawn in by a pneumothorax; expected another"
                result.refuse(index, "site", "does_not_fit", message)
            case known.Nodule() | known.Mass():
                _in_lung(cage, result, index, one, name, in_lung())
            case known.Effusion():
                _effusion(cage, result, one, name)
            case known.Pneumothorax():
                _pneumothorax(cage, result, one, name)
            case known.RibFracture():
                fracture(cage, result, index, one, name)
            case known.RibLesion():
                rib_lesion(cage, result, one, name)
            case known.VertebralLesion():
                vertebral_lesion(cage, result, index, one, name)
            case known.Coin():
                _coin(cage, result, one, name)
            case known.TrachealTube():
                _tracheal_tube(cage, result, one, name)
    if result.problems:
        raise InvalidInputError(result.problems)
    return result


def _names(wanted: Sequence[Abnormality]) -> list[str]:
    """Return the findings' names: given, or the type with a number where it comes again."""
    found: list[str] = []
    for one in wanted:
        plain = str(one.type).replace("_", " ")  # type: ignore[attr-defined]
        before = sum(type(other) is type(one) for other in wanted[: len(found)])
        found.append(one.name or (plain if before == 0 else f"{plain} {before + 1}"))
    return found


def _ball_points(count: int = 300) -> FloatArray:
    """Return points spread evenly over the unit sphere."""
    at = np.arange(count) + 0.5
    polar, turn = np.arccos(1.0 - 2.0 * at / count), np.pi * (1.0 + 5.0**0.5) * at
    return np.stack(
        [np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], axis=1
    )


def _in_lung(
    cage: Cage,
    result: Changes,
    index: int,
    one: known.Nodule | known.Mass,
    name: str,
    fits: Fits,
) -> None:
    """Add a ball in a lung, with spicules that end at the pleura."""
    centre = np.array(cage.frame.at(*SITES[one.site])) + np.array(one.offset_mm)
    radius = one.diameter_mm / 2
    ball = _ball_points()
    if not fits(centre + radius * ball).all() or not fits(centre[None]).all():
        sizes = np.arange(1.0, radius, 0.5)
        room = [r for r in sizes if fits(np.vstack([centre[None], centre + r * ball])).all()]
        where = ", ".join(f"{v:.0f}" for v in centre)
        least = 2.0 if isinstance(one, known.Nodule) else 20.0
        if room and 2 * max(room) >= least:
            message = (
                f"found {one.diameter_mm:g} mm at [{where}], which reaches out of the lung;"
                f" expected {least:g} to {2 * max(room):g} mm there"
            )
            result.refuse(index, "diameter_mm", "does_not_fit", message)
        else:
            message = (
                f"found [{', '.join(f'{v:g}' for v in one.offset_mm)}] from the {one.site}, at"
                f" [{where}], outside the lung or at its edge; expected a place within it"
            )
            result.refuse(index, "offset_mm", "does_not_fit", message)
        return
    result.materials[name] = ReferenceMaterial(
        reference="soft_tissue_icru44", density_g_cm3=one.density_g_cm3
    )
    core = Sphere(type="sphere", name=name, material=name, center=as_point(centre), radius=radius)
    leaves = [name]
    solid: Solid = core
    if isinstance(one, known.Mass):
        generator = np.random.default_rng(one.seed)
        # Lumps within the core's ball make its edge uneven.
        parts: list[Solid] = [core.model_copy(update={"radius": 0.72 * radius})]
        for number, way in enumerate(_ball_points(9), 1):
            share = float(generator.uniform(0.42, 0.62))
            at = as_point(centre + (1.0 - share) * radius * way)
            lump = f"{name} lump {number}"
            parts.append(
                Sphere(type="sphere", name=lump, material=name, center=at, radius=share * radius)
            )
            leaves.append(lump)
        for number, way in enumerate(_ball_points(max(one.spicules, 1))[: one.spicules], 1):
            way = way + 0.35 * generator.standard_normal(3)
            way /= np.linalg.norm(way)
            length = one.spicule_mm * generator.uniform(0.5, 1.0)
            label = f"{name} spicule {number}"
            ends = (centre + 0.75 * radius * way, centre + (radius + length) * way)
            widths = (0.09 * radius + 0.6, 0.25)
            parts.append(cone(label, as_point(ends[0]), as_point(ends[1]), widths, name))
            leaves.append(label)
        side = "left" if centre[0] > 0 else "right"
        bound = Instance(type="instance", of=f"{side} lung", name=f"bounds of {name}")
        solid = Intersection(type="intersection", solids=(union(*parts), bound))
    result.in_lungs.append(solid)
    result.found(one, name, leaves, centre, one.diameter_mm)


def _effusion(cage: Cage, result: Changes, one: known.Effusion, name: str) -> None:
    """Add fluid: the part of a lung under a bowl, whose rim is the meniscus."""
    rows = np.array(sorted(lungs.lung_rows(cage, one.side)))
    angle = lungs.angle_z(cage, one.side)
    top = angle + one.depth_mm + _MENISCUS_MM
    sign = 1.0 if one.side == "left" else -1.0
    low, high, front, back = (np.interp(top, rows[:, 0], rows[:, i]) for i in (1, 2, 3, 4))
    x, y = (low + high) / 2, (front + back) / 2
    half, deep = 0.75 * (high - low), 0.75 * (back - front)
    rise = 60.0
    bowl_z = angle + one.depth_mm - _MENISCUS_MM + rise
    floor = rows[0, 0] - 1.0
    slab = Cylinder(
        type="cylinder",
        name=name,
        material="fluid",
        start=(float(x), float(y), float(floor)),
        end=(float(x), float(y), float(top)),
        radius=250.0,
    )
    bowl = Ellipsoid(
        type="ellipsoid",
        name=f"bowl over {name}",
        center=(float(x), float(y), float(bowl_z)),
        semi_axes=(float(half), float(deep), rise),
    )
    bound = Instance(type="instance", of=f"{one.side} lung", name=f"bounds of {name}")
    # The bowl goes on upward, so that no fluid is left over it.
    above = Cylinder(
        type="cylinder",
        name=f"space over {name}",
        start=(float(x), float(y), float(bowl_z)),
        end=(float(x), float(y), float(max(top, bowl_z) + 100.0)),
        semi_axes=(float(half), float(deep)),
        up=(1.0, 0.0, 0.0),
    )
    fluid = Difference(type="difference", solids=(slab, bowl, above))
    result.in_lungs.append(Intersection(type="intersection", solids=(fluid, bound)))
    result.materials.setdefault("fluid", ReferenceMaterial(reference="water", density_g_cm3=1.02))
    size = (float(high - low), float(back - front), one.depth_mm)
    place = angle + 0.4 * one.depth_mm
    reach = float(np.interp(place, rows[:, 0], np.abs(rows[:, 1:3]).max(axis=1)))
    at = np.array([sign * (reach - 3.0), y, place])
    result.found(one, name, [name], at, size)


def _pneumothorax(cage: Cage, result: Changes, one: known.Pneumothorax, name: str) -> None:
    """Add the air between a lung and the same lung drawn in toward its hilum."""
    rows = np.array(sorted(lungs.lung_rows(cage, one.side)))
    hilum = np.array(cage.frame.at(*_HILA[one.side]))
    apex = rows[-1, 0]
    scale = 1.0 - one.rim_mm / float(apex - hilum[2])
    air = lungs.lung(cage, one.side, name).model_copy(update={"material": "air"})
    inside = Transformed(
        type="transformed",
        name=f"lung within {name}",
        solid=Instance(type="instance", of=f"{one.side} lung"),
        scale=scale,
        translate=as_point((1.0 - scale) * hilum),
    )
    result.in_lungs.append(Difference(type="difference", solids=(air, inside)))
    at = np.array(
        [(rows[-3, 1] + rows[-3, 2]) / 2, (rows[-3, 3] + rows[-3, 4]) / 2, apex - one.rim_mm / 2]
    )
    result.found(one, name, [name], at, one.rim_mm)


def _coin(cage: Cage, result: Changes, one: known.Coin, name: str) -> None:
    """Add a coin, its face to the front."""
    at = np.array(cage.frame.at(*_COINS[one.site]))
    half = np.array([0.0, one.thickness_mm / 2, 0.0])
    result.materials.setdefault("steel", ReferenceMaterial(reference="steel"))
    result.at_last.append(
        Cylinder(
            type="cylinder",
            name=name,
            material="steel",
            start=as_point(at - half),
            end=as_point(at + half),
            radius=one.diameter_mm / 2,
        )
    )
    result.found(one, name, [name], at, (one.diameter_mm, one.thickness_mm, one.diameter_mm))


def _tracheal_tube(cage: Cage, result: Changes, one: known.TrachealTube, name: str) -> None:
    """Add a tube from the neck down the trachea, and the air in it."""
    f = cage.frame
    path = np.array(f.path([p for p, _ in TRACHEA]))
    tip_z = f.at(0.0, 0.0, 50.0)[2] + one.tip_above_carina_mm
    kept = path[path[:, 2] > tip_z + 12.0]
    tip = [float(np.interp(tip_z, path[::-1, 2], path[::-1, i])) for i in range(3)]
    points = [as_point(p) for p in (*kept, np.array(tip))]
    result.materials.setdefault("tube", ReferenceMaterial(reference="pmma", density_g_cm3=1.5))
    for label, radius, material in ((name, 5.4, "tube"), (f"air in {name}", 4.0, "air")):
        result.at_last.append(
            tube(label, points, [radius * math.sqrt(f.bone)] * len(points), material)
        )
    result.found(one, name, [name], np.array(tip), 10.8)
