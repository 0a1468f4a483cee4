"""A right knee before it is a document: where bones stand, what is broken and what is added."""

from __future__ import annotations

from dataclasses import dataclass, field

from phantom.document import (
    Cut,
    Finding,
    ReferenceMaterial,
    Solid,
    Vector,
)
from phantom.errors import Problem
from phantoms.knee import patella as knee_cap
from phantoms.knee.femur import femur
from phantoms.knee.placing import Placed
from phantoms.knee.poses import Pose
from phantoms.knee.shin import fibula, tibia
from phantoms.knee.sizes import Sizes
from phantoms.knee.soft_tissue import envelope, inner_parts
from phantoms.parts import layered


@dataclass(slots=True)
class Plan:
    """What abnormalities change of a knee.

    Attributes
    ----------
    shin
        The motion of tibia and fibula from where they are drawn.
    broken
        Bone to plane and shift: the piece that the plane's normal points to has moved.
    lesions
        Bones with a lesion.
    around, inside
        What is added before the bones, which take its place, and after them.
    """

    sizes: Sizes
    at: Placed
    shin: Pose
    broken: dict[str, tuple[Cut, Vector, str]] = field(default_factory=dict)
    lesions: set[str] = field(default_factory=set)
    around: list[Solid] = field(default_factory=list)
    inside: list[Solid] = field(default_factory=list)
    materials: dict[str, ReferenceMaterial] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    @property
    def thigh(self) -> Pose:
        """The motion of the femur from where it is drawn."""
        return Pose((0.0, 0.0, self.at.femur_z))

    @property
    def cap(self) -> Pose:
        """The motion of the patella from where it is drawn."""
        return Pose(self.at.ridge)

    def pose(self, bone: str) -> Pose:
        """Return the motion of a bone from where it is drawn."""
        return {"femur": self.thigh, "patella": self.cap}.get(bone, self.shin)

    def solid(self) -> Solid:
        """Return the knee."""
        at = self.at
        cartilage = knee_cap.cartilage(self.sizes)
        soft = [*envelope(self.sizes), *inner_parts(self.sizes, at)]
        return layered(
            *soft,
            self.cap.solid("patellofemoral", cartilage),
            *self.around,
            *self._bone("femur"),
            *self._bone("tibia"),
            *self._bone("fibula"),
            *self._bone("patella"),
            *self.inside,
        )

    def _bone(self, name: str) -> list[Solid]:
        """Return a bone, or its two pieces."""
        draw = {"femur": femur, "tibia": tibia, "fibula": fibula, "patella": knee_cap.patella}[name]
        limb, pose = self.sizes.limb, self.pose(name)
        ends = (
            Cut(point=(0.0, 0.0, limb), normal=(0.0, 0.0, 1.0)),
            Cut(point=(0.0, 0.0, -limb), normal=(0.0, 0.0, -1.0)),
        )
        level = {"femur": ends[:1], "patella": ()}.get(name, ends[1:])
        if name not in self.broken:
            kept = tuple(pose.back(end) for end in level)
            return [pose.solid(name, draw(self.sizes, kept))]
        plane, shift, piece = self.broken[name]
        x, y, z = plane.normal
        other = Cut(point=plane.point, normal=(-x, -y, -z))
        moved = pose.then(shift)
        rest = (pose.back(plane), *(pose.back(end) for end in level))
        broken_off = (pose.back(other), *(moved.back(end) for end in level))
        return [
            pose.solid(name, draw(self.sizes, rest)),
            moved.solid(piece, draw(self.sizes, broken_off)),
        ]

    def refuse(self, index: int, name: str, kind: str, message: str) -> None:
        """Note what does not fit of the abnormality at an index."""
        self.problems.append(Problem(f"/abnormalities/{index}/{name}", kind, message))
