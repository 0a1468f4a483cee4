"""Label volumes, read back by nibabel and by the rules of MetaImage: place, axes, labels, table."""

import json
import zlib

import nibabel
import numpy as np
import pytest

import phantom

SPACING = (2.0, 1.0, 4.0)


def read_mha(path):
    """Header and voxels of a MetaImage file, by its own rules."""
    data = path.read_bytes()
    marker = b"ElementDataFile = LOCAL\n"
    cut = data.index(marker) + len(marker)
    header = dict(line.split(" = ") for line in data[:cut].decode().splitlines())
    kind = {"MET_UCHAR": "<u1", "MET_USHORT": "<u2"}[header["ElementType"]]
    assert int(header["CompressedDataSize"]) == len(data) - cut
    voxels = np.frombuffer(zlib.decompress(data[cut:]), kind)
    shape = [int(n) for n in header["DimSize"].split()]
    return header, voxels.reshape(shape, order="F")


def points_of(volume):
    """Centres of all voxels, (nx, ny, nz, 3), in LPS mm."""
    steps = np.stack(np.indices(volume.labels.shape), axis=-1)
    return np.array(volume.origin_mm) + steps * np.array(volume.spacing_mm)


def test_each_voxel_has_the_label_of_what_is_at_its_centre(figure):
    volume = phantom.label_volume(figure, SPACING)
    counts = phantom.materials_at(figure, points_of(volume).reshape(-1, 3))
    counts = counts.reshape(*volume.labels.shape, -1)
    for row in volume.rows:
        wanted = np.array([row.count_of.get(name, 0) for name in figure.material_names])
        here = volume.labels == row.label
        assert np.all(counts[here] == wanted)
    # Blood is nowhere without the water that it adds to.
    assert np.unique(volume.labels).tolist() == [0, 1, 2, 3, 5]


def test_overlap_has_a_label_of_its_own_with_the_sums_of_both(figure):
    volume = phantom.label_volume(figure, 1.0, energy_kev=50.0)
    rows = {row.name: row for row in volume.rows}
    assert list(rows) == ["absent", "water", "bone", "metal", "blood", "water+blood"]
    both = rows["water+blood"]
    assert both.label == 5
    assert both.density_g_cm3 == pytest.approx(2.06)
    assert both.composition["O"] == pytest.approx((0.8881 * 1.0 + 0.9 * 1.06) / 2.06, abs=2e-3)
    parts = rows["water"].attenuation_per_mm + rows["blood"].attenuation_per_mm
    assert both.attenuation_per_mm == pytest.approx(parts)
    # The heart, on the left, in front, above the middle.
    i, j, k = np.argwhere(volume.labels == 5).mean(axis=0)
    assert np.add(volume.origin_mm, (i, j, k)) == pytest.approx([20, 15, 40], abs=0.1)


def test_volumes_lie_on_one_lattice_with_nothing_all_round(figure):
    volume = phantom.label_volume(figure, SPACING)
    assert (np.array(volume.origin_mm) / SPACING) % 1 == pytest.approx(0.5)
    for axis in range(3):
        for side in (0, -1):
            assert not np.take(volume.labels, side, axis=axis).any()


def test_volumes_add_up_to_those_of_exact_chords():
    knee = phantom.library.build("knee-1993")
    labels = phantom.label_volume(knee, 0.8).labels
    assert np.count_nonzero(labels) * 0.8**3 == pytest.approx(440_200, rel=2e-3)


def test_nifti_is_ras(figure, tmp_path):
    made = phantom.export_volume(figure, tmp_path / "f.nii.gz", spacing_mm=SPACING)
    image = nibabel.load(made.output)
    assert nibabel.aff2axcodes(image.affine) == ("L", "P", "S")
    assert image.header.get_xyzt_units()[0] == "mm"
    assert image.header["qform_code"] == image.header["sform_code"] == 1
    assert image.get_qform() == pytest.approx(image.affine)
    labels = np.asarray(image.dataobj)
    for label, lps in ((2, [15, 26, 80]), (5, [20, 15, 40]), (3, [15, 13, 80])):
        middle = np.argwhere(labels == label).mean(axis=0)
        ras = nibabel.affines.apply_affine(image.affine, middle)
        assert ras * [-1, -1, 1] == pytest.approx(lps, abs=1.5)
    comment = json.loads(image.header.extensions[0].get_content())
    assert [row["name"] for row in comment["materials"]][-1] == "water+blood"


def test_mha_is_lps(figure, tmp_path):
    made = phantom.export_volume(figure, tmp_path / "f.mha", spacing_mm=SPACING)
    header, labels = read_mha(made.output)
    assert header["AnatomicalOrientation"] == "RAI"
    assert header["TransformMatrix"] == "1 0 0 0 1 0 0 0 1"
    origin = np.array([float(x) for x in header["Offset"].split()])
    spacing = np.array([float(x) for x in header["ElementSpacing"].split()])
    for label, lps in ((2, [15, 26, 80]), (5, [20, 15, 40]), (3, [15, 13, 80])):
        middle = np.argwhere(labels == label).mean(axis=0)
        assert origin + middle * spacing == pytest.approx(lps, abs=1.5)
    assert np.array_equal(labels, phantom.label_volume(figure, SPACING).labels)


def test_the_table_may_be_csv(figure, tmp_path):
    table = tmp_path / "labels.csv"
    phantom.export_volume(figure, tmp_path / "f.nii", spacing_mm=3.0, table=table)
    lines = table.read_text().splitlines()
    head = lines[0].split(",")
    assert head[:5] == ["label", "name", "density_g_cm3", "attenuation_per_mm", "C"]
    assert lines[1].startswith("0,absent,0,0,")
    assert [line.split(",")[1] for line in lines[2:]] == [
        "water",
        "bone",
        "metal",
        "blood",
        "water+blood",
    ]
    assert {p.name for p in tmp_path.iterdir()} == {"f.nii", "labels.csv"}


def test_the_same_volume_has_the_same_bytes(figure, tmp_path):
    names = ("v.nii.gz", "v.mha")
    one, two = (
        [
            phantom.export_volume(figure, tmp_path / n, spacing_mm=4.0).output.read_bytes()
            for n in names
        ]
        for _ in range(2)
    )
    assert one == two


def test_progress_counts_rows_and_a_volume_can_be_stopped(figure):
    told = []
    phantom.label_volume(figure, 2.0, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1]
    with pytest.raises(phantom.CancelledError):
        phantom.label_volume(figure, 2.0, cancelled=lambda: True)


@pytest.mark.parametrize("spacing", [0.0, -1, float("nan"), [1, 2], "fine", 1e-3])
def test_a_spacing_that_is_none_or_too_fine_is_refused(figure, spacing):
    with pytest.raises(phantom.InvalidInputError) as caught:
        phantom.label_volume(figure, spacing)
    assert [p.path for p in caught.value.problems] == ["/spacing_mm"]
