"""What can be wrong with the bones of a chest: fractures and lesions."""

from __future__ import annotations

import numpy as np

from phantom.document import (
    Cut,
    Intersection,
    ReferenceMaterial,
    Replace,
    Solid,
    Sphere,
    Transformed,
)
from phantoms.chest import abnormalities as known
from phantoms.chest import ribs, spine
from phantoms.chest.cage import Cage, FloatArray
from phantoms.chest.changes import Changes, as_point
from phantoms.chest.sides import on_side, point_on_side
from phantoms.parts import union


def _in_rib(
    cage: Cage, one: known.RibFracture | known.RibLesion
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the place, the way forward and the way down along the wall, drawn on the left."""
    from scipy.interpolate import CubicSpline

    line = cage.rib(one.rib)
    steps = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    at = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    curve = CubicSpline(at, line.points)
    place, forward = curve(one.along), curve(one.along, 1)
    forward /= np.linalg.norm(forward)
    normal = CubicSpline(at, line.normals)(one.along)
    down = np.cross(normal, forward)
    down /= np.linalg.norm(down)
    return place, forward, down if down[2] < 0 else -down


def fracture(cage: Cage, result: Changes, index: int, one: known.RibFracture, name: str) -> None:
    """Cut a rib in two and move its front fragment."""
    if (one.side, one.rib) in result.ribs:
        message = f"found {one.side} rib {one.rib} again; expected one fracture of a rib"
        result.refuse(index, "rib", "repeated", message)
        return
    place, forward, down = _in_rib(cage, one)
    whole = ribs.rib(cage, one.rib)
    assert isinstance(whole, Replace)
    fragments: list[Solid] = []
    for word, way in (("back fragment", 1.0), ("front fragment", -1.0)):
        cut = Cut(
            point=as_point(place - 0.5 * way * one.gap_mm * forward), normal=as_point(way * forward)
        )
        parts = tuple(leaf.model_copy(update={"cuts": (cut,)}) for leaf in whole.solids)
        moved = one.step_mm * down if way < 0 else np.zeros(3)
        fragments.append(
            Transformed(
                type="transformed",
                name=word,
                solid=Replace(type="replace", solids=parts),
                translate=as_point(moved),
            )
        )
    label = f"{one.side} rib {one.rib}"
    turn = cage.turn(one.rib)
    result.ribs[one.side, one.rib] = on_side(union(*fragments), one.side, turn, label)
    leaves = [
        f"{label}/{w} fragment/{part}"
        for w in ("back", "front")
        for part in ("cortex", "spongiosa")
    ]
    result.found(
        one,
        name,
        leaves,
        point_on_side(place, one.side, cage.turn(one.rib)),
        max(one.gap_mm, one.step_mm),
    )


def rib_lesion(cage: Cage, result: Changes, one: known.RibLesion, name: str) -> None:
    """Add a ball that is kept within a rib."""
    place, _, _ = _in_rib(cage, one)
    at = point_on_side(place, one.side, cage.turn(one.rib))
    ball = Sphere(
        type="sphere", name=name, material=_lesion(result, one.kind), center=as_point(at),
        radius=one.length_mm / 2,
    )  # fmt: skip
    bound = ribs.in_place(cage, one.side, one.rib, f"bounds of {name}")
    result.at_last.append(Intersection(type="intersection", solids=(ball, bound)))
    result.found(one, name, [name], at, one.length_mm)


def _lesion(result: Changes, kind: str) -> str:
    """Return the material of a lesion of bone, declared."""
    word = f"{kind} bone"
    result.materials.setdefault(
        word,
        ReferenceMaterial(reference="soft_tissue_icru44")
        if kind == "lytic"
        else ReferenceMaterial(reference="cortical_bone_icru44", density_g_cm3=1.75),
    )
    return word


def vertebral_lesion(
    cage: Cage, result: Changes, index: int, one: known.VertebralLesion, name: str
) -> None:
    """Add a ball within the body of a vertebra."""
    f = cage.frame
    level = spine.LEVELS[one.level]
    kind, size = spine.KINDS[level.kind], level.size * f.bone
    half = np.array([kind.half_x, kind.half_y, kind.height / 2]) * size
    room = spine.WAIST * half - np.abs(one.offset_mm) - one.diameter_mm / 2
    if (room < 0).any():
        least = float((spine.WAIST * half - np.abs(one.offset_mm)).min())
        field_name = "diameter_mm" if 2 * least >= 4.0 else "offset_mm"
        message = (
            f"found {one.diameter_mm:g} mm at [{', '.join(f'{v:g}' for v in one.offset_mm)}] in"
            f" {one.level}, whose body reaches {half[0]:.1f}, {half[1]:.1f} and {half[2]:.1f} mm;"
            f" expected 4 to {max(2 * least, 4.0):.1f} mm there"
        )
        result.refuse(index, field_name, "does_not_fit", message)
        return
    at = np.array(spine.centre(f, one.level)) + one.offset_mm
    ball = Sphere(
        type="sphere", name=name, material=_lesion(result, one.kind), center=as_point(at),
        radius=one.diameter_mm / 2,
    )  # fmt: skip
    result.at_last.append(ball)
    result.found(one, name, [name], at, one.diameter_mm)
