"""What the operators leave of every leaf, as closed meshes with the volumes of exact chords."""

import sys

import numpy as np
import pytest

import phantom
from phantom.tessellation import tessellate
from phantom.tessellation.regions import leaf_regions, merged
from tests.oracles import documents, meshes

A = {"type": "box", "name": "a", "material": "bone", "center": [0, 0, 0], "size": [4, 4, 4]}
B = {"type": "box", "name": "b", "material": "soft", "center": [1, 1, 1], "size": [4, 4, 4]}
TABLE = {
    # Volumes of 64 each that share 27 (document.md, Table 1).
    "union": (64, 37),
    "intersection": (27, 0),
    "difference": (37, 0),
    "overlap": (64, 64),
    "replace": (37, 64),
}


def regions(shape, tolerance):
    document = shape.document
    found = leaf_regions(document.solid, document.definitions, tessellate(shape, tolerance))
    for mesh in found:
        assert meshes.open_edges(mesh.triangles) == []
    return found


@pytest.mark.parametrize("operator", TABLE)
def test_each_operator_keeps_what_table_1_says(operator):
    shape = phantom.load(documents.document({"type": operator, "solids": [A, B]}))
    volumes = [mesh.volume_mm3 for mesh in regions(shape, 0.1)]
    assert volumes == pytest.approx(TABLE[operator], abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_random_trees_have_the_volume_of_every_material(seed):
    rng = np.random.default_rng(seed)
    while True:
        try:
            shape = phantom.load(documents.document(documents.tree(rng, 3)))
            break
        except phantom.InvalidDocumentError:
            continue
    tolerance = 0.05
    found, area = np.zeros(3), 0.0
    for mesh, material in zip(regions(shape, tolerance), shape.leaf_materials, strict=True):
        if material >= 0:
            found[material] += mesh.volume_mm3
        corners = mesh.vertices[mesh.triangles]
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area += np.linalg.norm(cross, axis=1).sum() / 2
    exact = meshes.volume_mm3(shape, 120)
    assert found == pytest.approx(exact, abs=tolerance * area + 1e-2 * exact.sum())


def test_a_union_of_parts_counts_what_they_share_once():
    one, two = tessellate(phantom.load(documents.document({"type": "union", "solids": [A, B]})), 1)
    assert merged([one, two]).volume_mm3 == pytest.approx(64 + 37)


def test_without_the_extra_it_is_said_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "manifold3d", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    shape = phantom.load(documents.document({"type": "union", "solids": [A, B]}))
    with pytest.raises(phantom.InvalidInputError, match="pip install") as caught:
        leaf_regions(shape.document.solid, {}, tessellate(shape, 1))
    assert [(p.path, p.kind) for p in caught.value.problems] == [("/what", "missing_extra")]
