"""Parts as the bytes of mesh files: STL, OBJ and GLB.

STL and OBJ hold the document's millimetres and axes (LPS: +x to the patient's left, +y to the
back, +z to the head). GLB is in metres with +y up and the front toward +z, as glTF 2.0 (ISO/IEC
12113:2022, section 3.4) has it: ``(x, z, -y) / 1000``, a rotation, so that nothing is mirrored.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any, Final

import numpy as np

from phantom.encode import archive
from phantom.export.models import Part
from phantom.tessellation import Mesh, joined

GLB_FROM_DOCUMENT: Final = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]) / 1000
"""Metres, y up and the front toward +z, of millimetres, z up and the back toward +y."""

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def stl(parts: Sequence[Part]) -> bytes:
    """Return a binary STL of all parts, one closed shell after the other; it holds no names."""
    return _stl(joined([part.mesh for part in parts]))


def stl_archive(parts: Sequence[Part], table: bytes) -> bytes:
    """Return a ZIP with one STL a part and the table of the parts and their materials."""
    names = file_names([part.name for part in parts])
    files = {f"{name}.stl": _stl(part.mesh) for name, part in zip(names, parts, strict=True)}
    return archive({**files, "materials.json": table})


def _stl(mesh: Mesh) -> bytes:
    record = np.zeros(len(mesh.triangles), dtype=_TRIANGLE)
    record["normal"] = mesh.normals()
    record["corners"] = mesh.vertices[mesh.triangles]
    title = b"binary STL; millimetres; LPS: +x patient left, +y back, +z head"
    return title.ljust(80) + np.uint32(len(record)).tobytes() + record.tobytes()


def obj(parts: Sequence[Part]) -> bytes:
    """Return a Wavefront OBJ with an object a part."""
    lines = ["# millimetres; LPS: +x patient left, +y back, +z head"]
    first = 1
    for part in parts:
        lines.append(f"o {_word(part.name)}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in part.mesh.vertices.tolist()]
        rows = part.mesh.triangles + first
        lines += [f"f {a} {b} {c}" for a, b, c in rows.tolist()]
        first += len(part.mesh.vertices)
    return ("\n".join(lines) + "\n").encode()


def glb(parts: Sequence[Part], told: Mapping[str, Mapping[str, Any]]) -> bytes:
    """Return a binary glTF 2.0 with a node and a mesh a part, named and coloured as it is.

    Parameters
    ----------
    parts
        What it holds.
    told
        Of each part by its name, as plain JSON values, for the mesh's ``extras``.
    """
    trimesh: Any = import_module("trimesh")
    scene = trimesh.Scene()
    for part in parts:
        mesh = trimesh.Trimesh(
            part.mesh.vertices @ GLB_FROM_DOCUMENT.T, part.mesh.triangles, process=False
        )
        surface = trimesh.visual.material.PBRMaterial(
            name=part.material or part.name,
            baseColorFactor=[*part.color, 1.0],
            metallicFactor=0.0,
            roughnessFactor=0.6,
        )
        mesh.visual = trimesh.visual.TextureVisuals(material=surface)
        mesh.metadata.update(told.get(part.name, {}))
        scene.add_geometry(mesh, node_name=part.name, geom_name=part.name)
    written = scene.export(file_type="glb")
    return bytes(written)


def file_names(labels: Sequence[str]) -> list[str]:
    """Return labels as names that any file system takes, each once."""
    found: list[str] = []
    for label in labels:
        plain = (
            "".join(c if c.isalnum() or c in "-_." else "-" for c in label).strip("-.") or "part"
        )
        name, count = plain, 2
        while name.lower() in (used.lower() for used in found):
            name, count = f"{plain}-{count}", count + 1
        found.append(name)
    return found


def _word(name: str) -> str:
    """Return a name without the blanks at which readers of OBJ stop."""
    return "_".join(name.split()) or "part"
