"""ITK-RTK's analytic projector and this engine on one scene of quadrics.

Run with ``uv run --group compare pytest -m compare``. RTK reads the scene from a file in the form
of the FORBILD phantoms. There ``rho`` is the value at a solid's centre; RTK adds to the scene what
that is more than the solids before it have there. Here only the last one's centre is in another.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import phantom

pytestmark = [
    pytest.mark.compare,
    # SWIG's modules warn as they load; made an error, that warning ends the process.
    pytest.mark.filterwarnings("ignore:builtin type .* has no __module__:DeprecationWarning"),
]

TOLERANCE_MM = 1e-5

TILTED = np.linalg.qr(np.array([[1.0, 0.3, -0.2], [0.4, 1.0, 0.5], [0.1, -0.6, 1.0]]))[0]
AXIS = np.array([0.48, -0.36, 0.8])
CONE_AXIS = np.array([-0.6, 0.64, 0.48])


def vector(values: Any) -> str:
    return "(" + ",".join(f"{value:.17f}" for value in values) + ")"


def cylinder(center: Any, axis: Any, length: float, **sides: Any) -> dict[str, Any]:
    half = 0.5 * length * np.asarray(axis)
    return {
        "start": (np.asarray(center) - half).tolist(),
        "end": (np.asarray(center) + half).tolist(),
        **sides,
    }


def cut(point: Any, normal: Any) -> dict[str, Any]:
    return {"point": list(point), "normal": list(normal)}


# What RTK reads and what a document says, of solids whose densities add where they overlap.
SCENE: dict[str, tuple[str, dict[str, Any]]] = {
    "sphere": (
        "[Sphere: x=-70 y=-10 z=45 r=22]",
        {"type": "sphere", "center": [-70, -10, 45], "radius": 22},
    ),
    "ellipsoid with three cuts": (
        "[Ellipsoid: x=10 y=5 z=-5 dx=60 dy=45 dz=35 x<50 y>-30 r(0.6,0,0.8)<28]",
        {
            "type": "ellipsoid",
            "center": [10, 5, -5],
            "semi_axes": [60, 45, 35],
            "cuts": [
                cut([50, 0, 0], [1, 0, 0]),
                cut([0, -30, 0], [0, -1, 0]),
                cut([0.6 * 28, 0, 0.8 * 28], [0.6, 0, 0.8]),
            ],
        },
    ),
    "cylinder along x": (
        "[Cylinder_x: x=0 y=-60 z=-45 r=12 l=80]",
        {"type": "cylinder", **cylinder([0, -60, -45], [1, 0, 0], 80, radius=12)},
    ),
    "cylinder along any axis, cut": (
        f"[Cylinder: x=65 y=45 z=40 r=9 l=70 axis{vector(AXIS)} z<55]",
        {
            "type": "cylinder",
            **cylinder([65, 45, 40], AXIS, 70, radius=9),
            "cuts": [cut([0, 0, 55], [0, 0, 1])],
        },
    ),
    "elliptic cylinder": (
        "[Ellipt_Cyl: x=-60 y=50 z=-40 dx=18 dy=8 l=50"
        f" a_x{vector(TILTED[:, 0])} a_y{vector(TILTED[:, 1])}]",
        {
            "type": "cylinder",
            **cylinder([-60, 50, -40], np.cross(TILTED[:, 0], TILTED[:, 1]), 50),
            "semi_axes": [18, 8],
            "up": TILTED[:, 0].tolist(),
        },
    ),
    "cone along z": (
        "[Cone_z: x=-30 y=-75 z=50 l=40 r1=18 r2=6]",
        {
            "type": "cone",
            **cylinder([-30, -75, 50], [0, 0, 1], 40),
            "start_radius": 18,
            "end_radius": 6,
        },
    ),
    "cone along any axis, cut": (
        f"[Cone: x=70 y=-60 z=-50 l=44 r1=20 r2=9 axis{vector(CONE_AXIS)} x>55]",
        {
            "type": "cone",
            **cylinder([70, -60, -50], CONE_AXIS, 44),
            "start_radius": 20,
            "end_radius": 9,
            "cuts": [cut([55, 0, 0], [-1, 0, 0])],
        },
    ),
    "cone up to its tip": (
        "[Cone_y: x=-75 y=-60 z=-50 l=50 r1=16 r2=0]",
        {
            "type": "cone",
            **cylinder([-75, -60, -50], [0, 1, 0], 50),
            "start_radius": 16,
            "end_radius": 0,
        },
    ),
    "box": (
        "[Box: x=15 y=85 z=60 dx=50 dy=24 dz=36]",
        {"type": "box", "center": [15, 85, 60], "size": [50, 24, 36]},
    ),
}

# What overlaps: a turned ellipsoid inside the first one, with its own value.
INSIDE = (
    "[Ellipsoid_free: x=5 y=0 z=-8 dx=22 dy=12 dz=8"
    f" a_x{vector(TILTED[:, 0])} a_y{vector(TILTED[:, 1])} a_z{vector(TILTED[:, 2])}]"
)


def turned_ellipsoid() -> dict[str, Any]:
    """The quadric |diag(1/a) Rᵀ (x - c)|² <= 1 by its ten coefficients."""
    form = TILTED @ np.diag(1 / np.array([22.0, 12.0, 8.0]) ** 2) @ TILTED.T
    center = np.array([5.0, 0.0, -8.0])
    linear = -2 * form @ center
    mixed = [2 * form[0, 1], 2 * form[1, 2], 2 * form[2, 0]]
    coefficients = [*np.diag(form), *mixed, *linear, center @ form @ center - 1]
    return {"type": "quadric", "coefficients": [float(value) for value in coefficients]}


def document(leaves: list[dict[str, Any]]) -> dict[str, Any]:
    """Every leaf in a material of its own, densities adding."""
    materials = {f"m{index}": {"attenuation_per_mm": 0.01} for index in range(len(leaves))}
    solids = [{**leaf, "material": f"m{index}"} for index, leaf in enumerate(leaves)]
    solid = solids[0] if len(solids) == 1 else {"type": "overlap", "solids": solids}
    return {"format": "phantom/1", "name": "quadrics", "materials": materials, "solid": solid}


@pytest.fixture(scope="module")
def itk() -> Any:
    return pytest.importorskip("itk", reason="uv run --group compare")


class Projector:
    """Views of RTK around the scene, and the rays of their pixels."""

    def __init__(self, itk: Any) -> None:
        self.itk, self.rtk = itk, itk.RTK
        self.image = itk.Image[itk.D, 3]
        self.geometry = self.rtk.ThreeDCircularProjectionGeometry.New()
        for gantry, out_of_plane in ((0.0, 0.0), (37.0, 0.0), (115.0, 20.0), (250.0, -35.0)):
            self.geometry.AddProjection(700.0, 1100.0, gantry, 0.0, 0.0, out_of_plane)
        self.views = 4
        self.count, self.pitch = 201, 2.17
        self.first = -0.5 * (self.count - 1) * self.pitch + 0.031

    def projections(self, text: str, folder: Path) -> Any:
        """Integrals of rho along every pixel's ray, (views, rows, columns)."""
        scene = folder / "scene.txt"
        scene.write_text(text, encoding="ascii")
        blank = self.rtk.ConstantImageSource[self.image].New()
        blank.SetOrigin([self.first, self.first, 0.0])
        blank.SetSpacing([self.pitch, self.pitch, 1.0])
        blank.SetSize([self.count, self.count, self.views])
        blank.SetConstant(0.0)
        projector = self.rtk.ProjectGeometricPhantomImageFilter[self.image, self.image].New()
        projector.SetInput(blank.GetOutput())
        projector.SetGeometry(self.geometry)
        projector.SetConfigFile(str(scene))
        projector.SetIsForbildConfigFile(True)
        projector.Update()
        return self.itk.GetArrayFromImage(projector.GetOutput())

    def rays(self) -> tuple[Any, Any]:
        """Sources and pixels in RTK's fixed system, ``(views * rows * columns, 3)`` each."""
        v, u = self.first + self.pitch * np.indices((self.count, self.count))
        pixels = np.stack([u, v, np.zeros_like(u), np.ones_like(u)], axis=-1)
        sources, ends = [], []
        for view in range(self.views):
            matrix = self.geometry.GetProjectionCoordinatesToFixedSystemMatrix(view)
            place = np.array([[matrix(i, j) for j in range(4)] for i in range(4)])
            found = (pixels @ place.T).reshape(-1, 4)
            source = [self.geometry.GetSourcePosition(view)[i] for i in range(3)]
            ends.append(found[:, :3] / found[:, 3:])
            sources.append(np.broadcast_to(source, ends[-1].shape))
        return np.concatenate(sources), np.concatenate(ends)


@pytest.fixture(scope="module")
def projector(itk: Any) -> Projector:
    return Projector(itk)


def ours(leaves: list[dict[str, Any]], weights: list[float], projector: Projector) -> Any:
    sources, ends = projector.rays()
    lengths = phantom.path_lengths(phantom.load(document(leaves)), sources, ends - sources)
    return (lengths @ np.array(weights)).reshape(projector.views, projector.count, -1)


@pytest.mark.parametrize("name", SCENE)
def test_one_solid(name: str, projector: Projector, tmp_path: Path) -> None:
    text, leaf = SCENE[name]
    theirs = projector.projections(f"{{{text} rho=1.0}}\n", tmp_path)
    mine = ours([leaf], [1.0], projector)
    assert (theirs > 1.0).sum() > 500, "rays hit the solid"
    worst = float(np.abs(mine - theirs).max())
    print(f"{name}: worst difference {worst:.2e} mm over {(theirs > 0).sum()} rays that hit")
    assert worst <= TOLERANCE_MM


def test_the_whole_scene(projector: Projector, tmp_path: Path) -> None:
    """The densities 1, 2, 3 ... and one solid within another, all at once."""
    texts, leaves = zip(*SCENE.values(), strict=True)
    weights = [1.0 + 0.25 * index for index in range(len(texts))]
    scene = "".join(
        f"{{{text} rho={weight}}}\n" for text, weight in zip(texts, weights, strict=True)
    )
    host = weights[list(SCENE).index("ellipsoid with three cuts")]
    scene += f"{{{INSIDE} rho={host + 3.0}}}\n"
    theirs = projector.projections(scene, tmp_path)
    mine = ours([*leaves, turned_ellipsoid()], [*weights, 3.0], projector)
    worst = float(np.abs(mine - theirs).max() / max(*weights, 3.0))
    print(f"scene: worst difference {worst:.2e} mm over {(theirs > 0).sum()} rays that hit")
    assert worst <= TOLERANCE_MM
