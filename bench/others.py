"""Other programs on the same rays; each gives (rows, columns) of the line integral, no unit.

Each function returns what to run for one image. What can be prepared once (meshes, search trees,
rays) is prepared here, unmeasured.
"""

import tempfile
from pathlib import Path

import numpy as np

import phantom
from bench.floor import CENTER, ELLIPSOIDS, SOURCE, WIDTH_MM
from bench.scenes import rays
from phantom.tessellation import tessellate

TOLERANCE_MM = 0.01
"""Of the triangles: edges of about a millimetre, as in meshes that are segmented from CT."""


def leaves(tree):
    """Each leaf's vertices and triangles, and its attenuation in 1/mm, in the document's order."""
    meshes = tessellate(phantom.load(tree), TOLERANCE_MM)
    return [
        (
            (mesh.vertices, mesh.triangles),
            tree["materials"][leaf["material"]]["attenuation_per_mm"],
        )
        for mesh, leaf in zip(meshes, tree["solid"]["solids"], strict=True)
    ]


def triangles(tree):
    """Count the triangles of a scene."""
    return sum(len(faces) for (_, faces), _ in leaves(tree))


class Open3D:
    """Embree through Open3D: all hits of all rays, summed in numpy."""

    def __init__(self, tree, view):
        import open3d

        core = open3d.core
        self.scene = open3d.t.geometry.RaycastingScene()
        self.mu, normals = [], []
        for (vertices, faces), mu in leaves(tree):
            self.scene.add_triangles(
                core.Tensor(vertices.astype(np.float32)), core.Tensor(faces.astype(np.uint32))
            )
            a, b, c = (vertices[faces[:, k]] for k in range(3))
            normals.append(np.cross(b - a, c - a))
            self.mu.append(mu)
        self.mu = np.array(self.mu)
        self.first = np.concatenate([[0], np.cumsum([len(n) for n in normals])])[:-1]
        self.normals = np.concatenate(normals).astype(np.float32)
        origins, directions = rays(view)
        directions = directions / np.linalg.norm(directions, axis=1)[:, None]
        self.directions = directions.astype(np.float32)
        joined = np.concatenate([origins, directions], axis=1).astype(np.float32)
        self.rays = core.Tensor(joined)
        self.shape = view.detector.rows, view.detector.columns

    def _hits(self):
        """Ray, distance, solid and +1 on the way out, -1 on the way in, of every hit."""
        found = {k: v.numpy() for k, v in self.scene.list_intersections(self.rays).items()}
        ray, solid = found["ray_ids"].astype(np.int64), found["geometry_ids"].astype(np.int64)
        normal = self.normals[self.first[solid] + found["primitive_ids"]]
        way = np.einsum("ij,ij->i", normal, self.directions[ray])
        return ray, found["t_hit"].astype(np.float64), solid, np.where(way > 0, 1, -1)

    def signed_sum(self):
        """Densities add where solids overlap: one signed sum, no order."""
        ray, t, solid, way = self._hits()
        count = self.shape[0] * self.shape[1]
        return np.bincount(ray, way * t * self.mu[solid], count).reshape(self.shape)

    def replaced(self):
        """The last solid counts where solids overlap: hits in order, one state a solid."""
        ray, t, solid, way = self._hits()
        order = np.lexsort((t, ray))
        ray, t, solid, way = ray[order], t[order], solid[order], way[order]
        starts = np.flatnonzero(np.diff(ray, prepend=-1))
        which = np.cumsum(np.diff(ray, prepend=-1) > 0) - 1
        mu = np.zeros(len(ray))
        for k in range(len(self.mu)):
            inside = np.cumsum(np.where(solid == k, -way, 0))
            # What a leak left over from earlier rays is taken off.
            before = np.concatenate([[0], inside])[starts]
            mu[inside - before[which] > 0] = self.mu[k]
        step = np.diff(t, append=0.0)
        step[np.diff(ray, append=-1) != 0] = 0.0
        count = self.shape[0] * self.shape[1]
        return np.bincount(ray, step * mu, count).reshape(self.shape)


class Gvxr:
    """gVirtualXray on a processor, through Mesa: signed sums, densities add."""

    def __init__(self, tree, view):
        from gvxrPython3 import gvxr

        self.gvxr = gvxr
        gvxr.createWindow(-1, 0, "EGL")
        detector = view.detector
        gvxr.setSourcePosition(*view.source, "mm")
        gvxr.usePointSource()
        gvxr.setMonoChromatic(60.0, "keV", 1)
        gvxr.setDetectorPosition(*detector.center, "mm")
        gvxr.setDetectorUpVector(*(-np.array(detector.down)).tolist())
        gvxr.setDetectorRightVector(*detector.right)
        gvxr.setDetectorNumberOfPixels(detector.columns, detector.rows)
        gvxr.setDetectorPixelSize(*detector.pitch_xy_mm, "mm")
        with tempfile.TemporaryDirectory() as folder:
            for k, ((vertices, faces), mu) in enumerate(leaves(tree)):
                path = Path(folder) / f"{k}.stl"
                write_stl(path, vertices, faces)
                gvxr.loadMeshFile(f"s{k}", str(path), "mm")
                gvxr.setLinearAttenuationCoefficient(f"s{k}", 10 * mu, "cm-1")

    def line_integral(self):
        """One image; what arrives, over what arrives where nothing is met, as a line integral."""
        arrived = np.array(self.gvxr.computeXRayImage(), dtype=np.float64)
        # gVXR's rows rise along the detector's up vector.
        return -np.log(arrived / arrived.max())[::-1]

    def close(self):
        self.gvxr.terminate()


def write_stl(path, vertices, faces):
    """Write a binary STL."""
    record = np.zeros(
        len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]
    )
    record["corners"] = vertices[faces]
    with path.open("wb") as file:
        file.write(bytes(80) + np.uint32(len(faces)).tobytes() + record.tobytes())


class Rtk:
    """ITK-RTK's exact projector of quadrics: the floor's ellipsoids from the side."""

    def __init__(self, side):
        import itk

        self.itk, self.rtk = itk, itk.RTK
        self.image = itk.Image[itk.D, 3]
        self.geometry = self.rtk.ThreeDCircularProjectionGeometry.New()
        self.geometry.AddProjection(float(SOURCE[2]), float(SOURCE[2] - CENTER[2]), 0.0)
        self.side, self.pitch = side, WIDTH_MM / side
        self.folder = tempfile.TemporaryDirectory()
        self.scene = Path(self.folder.name) / "scene.txt"
        words = ("x", "y", "z", "dx", "dy", "dz")
        lines = []
        for k, e in enumerate(ELLIPSOIDS):
            values = " ".join(f"{w}={v:g}" for w, v in zip(words, e, strict=True))
            # RTK takes off the density of every earlier solid that holds the centre of this one.
            off = (e[:3] - ELLIPSOIDS[:k, :3]) / ELLIPSOIDS[:k, 3:]
            rho = 1.0 + np.count_nonzero((off**2).sum(axis=1) < 1.0)
            lines.append(f"{{[Ellipsoid: {values}] rho={rho}}}\n")
        self.scene.write_text("".join(lines), encoding="ascii")

    def path_length(self):
        """One view in mm, rows from the top."""
        first = -0.5 * (self.side - 1) * self.pitch
        blank = self.rtk.ConstantImageSource[self.image].New()
        blank.SetOrigin([first, first, 0.0])
        blank.SetSpacing([self.pitch, self.pitch, 1.0])
        blank.SetSize([self.side, self.side, 1])
        blank.SetConstant(0.0)
        projector = self.rtk.ProjectGeometricPhantomImageFilter[self.image, self.image].New()
        projector.SetInput(blank.GetOutput())
        projector.SetGeometry(self.geometry)
        projector.SetConfigFile(str(self.scene))
        projector.SetIsForbildConfigFile(True)
        projector.Update()
        return self.itk.GetArrayFromImage(projector.GetOutput())[0, ::-1]
