"""Mesh files, read back by trimesh: parts, names, axes, units, volumes."""

import io
import json
import math
import zipfile

import numpy as np
import pytest
import trimesh

import phantom
from phantom.tessellation import tessellate
from tests.oracles import meshes

BALL = 4 / 3 * math.pi


def read(path):
    return trimesh.load(path)


def test_stl_is_in_the_documents_millimetres_and_watertight(figure, tmp_path):
    made = phantom.export_mesh(figure, tmp_path / "figure.stl", tolerance_mm=0.05)
    mesh = read(made.output)
    assert mesh.is_watertight
    assert mesh.bounds[0] == pytest.approx([-10, 5, 0], abs=0.05)
    assert mesh.bounds[1] == pytest.approx([30, 35, 90], abs=0.05)
    assert mesh.volume == pytest.approx(72000 + BALL * (1000 + 64 + 216), rel=1e-3)


def test_glb_has_a_named_part_a_leaf_in_metres_with_the_head_up_and_the_nose_in_front(
    figure, tmp_path
):
    made = phantom.export_mesh(figure, tmp_path / "figure.glb", tolerance_mm=0.05)
    scene = read(made.output)
    assert set(scene.geometry) == {"body", "head", "nose", "left/heart"}
    # glTF: y up, the front of a thing toward +z, so its left at +x.
    centers = {name: part.centroid for name, part in scene.geometry.items()}
    assert centers["body"] == pytest.approx([0.010, 0.030, -0.020], abs=1e-4)
    assert centers["head"] == pytest.approx([0.015, 0.080, -0.025], abs=1e-4)
    assert centers["nose"][2] > centers["head"][2]
    for part in scene.geometry.values():
        assert part.is_watertight
        assert part.volume > 0
    assert scene.geometry["head"].metadata["material"] == "bone"
    assert scene.geometry["head"].metadata["density_g_cm3"] == pytest.approx(1.92)


def test_obj_has_an_object_a_leaf(figure, tmp_path):
    made = phantom.export_mesh(figure, tmp_path / "figure.obj", tolerance_mm=0.05)
    lines = [line.split() for line in made.output.read_text().splitlines()]
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float)
    volumes = {}
    for line in lines:
        if line[0] == "o":
            name = line[1]
            volumes[name] = 0.0
        if line[0] == "f":
            volumes[name] += np.linalg.det(vertices[[int(k) - 1 for k in line[1:]]]) / 6
    exact = {"body": 72000, "head": BALL * 1000, "nose": BALL * 64, "left/heart": BALL * 216}
    assert volumes == pytest.approx(exact, rel=0.02)
    assert read(made.output).bounds[1] == pytest.approx([30, 35, 90], abs=0.05)


def test_an_archive_has_a_file_a_part_and_the_table(figure, tmp_path):
    made = phantom.export_mesh(figure, tmp_path / "figure.stl.zip", tolerance_mm=0.05)
    with zipfile.ZipFile(made.output) as archive:
        assert archive.namelist() == [
            "body.stl",
            "head.stl",
            "nose.stl",
            "left-heart.stl",
            "materials.json",
        ]
        head = trimesh.load(io.BytesIO(archive.read("head.stl")), file_type="stl")
        table = json.loads(archive.read("materials.json"))
    assert head.is_watertight
    assert head.centroid == pytest.approx([15, 25, 80], abs=1e-3)
    assert [part["name"] for part in table["parts"]] == ["body", "head", "nose", "left/heart"]


def test_the_result_has_a_mesh_a_material_and_overlap_covers_a_place_twice(figure, tmp_path):
    made = phantom.export_mesh(figure, tmp_path / "r.glb", what="result", tolerance_mm=0.005)
    parts = read(made.output).geometry
    volumes = {name: part.volume * 1e9 for name, part in parts.items()}
    exact = dict(zip(figure.material_names, meshes.volume_mm3(figure), strict=True))
    assert volumes == pytest.approx(exact, rel=5e-3)
    # The nose loses to the head what both hold; the heart adds to the body, which loses nothing.
    assert volumes["metal"] < BALL * 64
    assert volumes["water"] == pytest.approx(72000)
    assert all(part.is_watertight for part in parts.values())


def test_parts_are_what_is_left_of_each_leaf_and_what_is_gone_has_none(tmp_path):
    knee = phantom.library.build("knee-1993")
    made = phantom.export_mesh(knee, tmp_path / "knee.glb", what="parts", tolerance_mm=0.2)
    names = [part["name"] for part in made.told["parts"]]
    assert names == ["femur", "patella", "tibia", "fibula", "fibular head"]
    whole = dict(zip(knee.leaf_names, tessellate(knee, 0.2), strict=True))
    left = {part["name"]: part["volume_mm3"] for part in made.told["parts"]}
    assert left["femur"] < whole["femur"].volume_mm3 - 1000
    assert left["patella"] == pytest.approx(whole["patella"].volume_mm3)


def test_the_table_tells_every_material(figure, tmp_path):
    made = phantom.export_mesh(figure, tmp_path / "f.stl", energy_kev=30.0)
    assert made.table == tmp_path / "f.materials.json"
    table = json.loads(made.table.read_text())
    rows = {row["name"]: row for row in table["materials"]}
    assert list(rows) == ["absent", "water", "bone", "metal", "blood"]
    assert table["energy_kev"] == 30.0
    assert rows["water"]["density_g_cm3"] == pytest.approx(1.0)
    assert rows["water"]["composition"]["H"] == pytest.approx(0.1119, abs=2e-3)
    # NIST XCOM: water at 30 keV has 0.3756 cm2/g.
    assert rows["water"]["attenuation_per_mm"] == pytest.approx(0.03756, rel=0.01)
    assert rows["metal"]["density_g_cm3"] is None
    assert rows["metal"]["attenuation_per_mm"] == 0.5


def test_the_same_export_has_the_same_bytes(figure, tmp_path):
    for name in ("a.glb", "a.stl.zip", "a.obj"):
        one = phantom.export_mesh(figure, tmp_path / name, what="result").output.read_bytes()
        two = phantom.export_mesh(figure, tmp_path / name, what="result").output.read_bytes()
        assert one == two


@pytest.mark.parametrize(
    ("output", "options", "path"),
    [
        ("f.ply", {}, "/output"),
        ("nowhere/f.stl", {}, "/output"),
        ("f.stl", {"table": "f.txt"}, "/table"),
        ("f.stl", {"what": "all"}, "/what"),
        ("f.stl", {"tolerance_mm": -1.0}, "/tolerance_mm"),
        ("f.stl", {"energy_kev": 1e4}, "/energy_kev"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_written(figure, tmp_path, output, options, path):
    with pytest.raises(phantom.InvalidInputError) as caught:
        phantom.export_mesh(figure, tmp_path / output, **options)
    assert [p.path for p in caught.value.problems] == [path]
    assert list(tmp_path.iterdir()) == []


def test_without_the_extra_it_is_said_how_to_get_it(figure, tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    for output, export in (("f.glb", phantom.export_mesh), ("f.nii.gz", phantom.export_volume)):
        with pytest.raises(phantom.InvalidInputError, match="pip install") as caught:
            export(figure, tmp_path / output)
        assert [(p.path, p.kind) for p in caught.value.problems] == [("/output", "missing_extra")]
    # What needs no package is written all the same.
    assert phantom.export_mesh(figure, tmp_path / "f.stl").output.exists()


def test_a_mesh_of_triangles_holds_its_normals_outward(figure, tmp_path):
    made = phantom.export_mesh(figure, tmp_path / "f.stl", tolerance_mm=0.5)
    data = made.output.read_bytes()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0])
    assert len(data) == 84 + 50 * count
    assert count == sum(part["triangles"] for part in made.told["parts"])
