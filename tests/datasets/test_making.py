"""What is kept of an image says what the image is; twins differ in the lesion alone."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest
from PIL import Image

import phantom
from phantom.datasets.making import LINEAR_CODES, Maker
from phantom.encode import METADATA_KEY

NODULE = {
    "type": "nodule",
    "prevalence": 1.0,
    "parameters": {"radius_mm": 5.0, "x_mm": 6.0},
}
IDEAL = {"acquisition": {"quantum_noise": "off"}, "population": None}


def _pixels(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(data)))


def test_a_linear_picture_is_in_proportion_to_the_signal(design):
    wanted = design(**IDEAL, outputs={"codes": True})
    made = Maker(wanted).make(3)
    picture = _pixels(made.files["png"]).astype(float)
    # The block is 40 mm thick of 0.02 / mm; beside it the field is open.
    assert picture[0, 0] == LINEAR_CODES
    assert picture[16, 16] / LINEAR_CODES == pytest.approx(np.exp(-0.8), rel=2e-3)
    codes = np.load(io.BytesIO(made.files["u16.npy"]))
    assert codes.dtype == np.uint16
    assert np.array_equal(codes, picture)
    full = made.row["open_field"]
    assert picture[0, 0] / made.row["codes_per_unit"] == pytest.approx(full, rel=1e-12)


def test_a_presentation_is_the_phantoms_window(design):
    outputs = {"form": "presentation"}
    made = Maker(design(**IDEAL, outputs=outputs, presentation={"bits": 8})).make(0)
    # Window from 0 to 1.6 about 0.8: a line integral of 0.8 is its middle, 0 its low end.
    picture = _pixels(made.files["png"])
    assert picture[0, 0] == 0
    assert abs(int(picture[16, 16]) - 127.5) <= 1


def test_the_mask_is_the_shadow_of_the_finding(design):
    side = {"columns": 128, "pitch_mm": 0.5}
    wanted = design(**IDEAL, detector=side, abnormalities=[NODULE])
    made = Maker(wanted).make(0)
    mask = _pixels(made.files["mask.png"])
    # A ball of 5 mm, 6 mm to the left of the patient, 440 mm from the source of 500 mm.
    columns = np.arange(128) - 63.5
    x, z = np.meshgrid(columns * 0.5, columns * 0.5)
    rays = np.stack([x, np.full_like(x, 500.0), z], axis=-1)
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    center = np.array([6.0, 440.0, 0.0])
    distance = np.linalg.norm(np.cross(rays, center), axis=-1)
    assert np.array_equal(mask > 0, distance < 5.0)
    assert set(np.unique(mask)) == {0, 255}
    (found,) = json.loads(made.row["findings"])
    inside = np.argwhere(mask > 0)
    (top, left), (bottom, right) = inside.min(axis=0), inside.max(axis=0)
    assert found["bbox"] == [left, top, right - left + 1, bottom - top + 1]
    assert made.row["label"] == made.row["has_nodule"] == 1
    assert json.loads(made.row["abnormalities"]) == [
        {"type": "nodule", "radius_mm": 5.0, "x_mm": 6.0}
    ]


def _chords(radius_mm, x_mm):
    """Chords of a ball on the axis' plane over the pixels of 0.5 mm that it covers."""
    at = (np.arange(128) - 63.5) * 0.5
    x, z = np.meshgrid(at, at)
    rays = np.stack([x, np.full_like(x, 500.0), z], axis=-1)
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    distance = np.linalg.norm(np.cross(rays, [x_mm, 440.0, 0.0]), axis=-1)
    return 2.0 * np.sqrt(radius_mm**2 - distance[distance < radius_mm] ** 2)


def test_visibility_is_what_the_chords_take_away(design):
    """A ball of 0.06 / mm in a slab of 0.02 / mm, 40 mm thick; P-values of 1022 JNDs in all."""
    display = {"l_min_cd_m2": 0.05, "l_max_cd_m2": 3993.404, "l_ambient_cd_m2": 0.0}
    wanted = design(
        population=None,
        detector={"columns": 128, "pitch_mm": 0.5},
        acquisition={"detector": {"response": "photon_counting"}},
        presentation={"bits": 16, "gsdf": display},
        abnormalities=[{**NODULE, "prevalence": 0.5}],
        outputs={"visibility": True},
    )
    maker = Maker(wanted)
    rows = [maker.make(number).row for number in range(6)]
    ill, well = (next(row for row in rows if row["label"] == k) for k in (1, 0))
    chords = _chords(5.0, 6.0)
    taken = np.exp(-0.04 * chords) - 1.0
    assert ill["contrast"] == pytest.approx(taken.mean(), rel=1e-9)
    # A counting detector's noise is the root of what comes through the slab.
    photons = ill["open_field"] * np.exp(-0.8)
    expected = taken.mean() * np.sqrt(photons)
    assert ill["contrast_to_noise"] == pytest.approx(expected, rel=0.15)
    # The phantom's window spans line integrals of 1.6.
    assert ill["jnd"] == pytest.approx(1022 * 0.04 * chords.mean() / 1.6, rel=2e-3)
    (found,) = json.loads(ill["findings"])
    assert found["pixels"] == len(chords)
    assert found["contrast"] == ill["contrast"]
    assert [well[name] for name in ("contrast", "contrast_to_noise", "jnd")] == [0.0] * 3
    assert len({tuple(row) for row in rows}) == 1


def test_of_several_findings_the_row_tells_the_one_that_is_seen_best(design):
    void = {"type": "void", "prevalence": 1.0, "parameters": {"radius_mm": 3.0}}
    small = {**NODULE, "parameters": {"name": "small", "radius_mm": 1.0, "x_mm": -8.0}}
    side = {"columns": 128, "pitch_mm": 0.5}
    wanted = design(
        **IDEAL,
        detector=side,
        abnormalities=[void, small, NODULE],
        outputs={"visibility": True},
    )
    row = Maker(wanted).make(0).row
    of = {f["kind"] + str(f["size_mm"]): f for f in json.loads(row["findings"])}
    assert of["nodule10.0"]["contrast"] == row["contrast"]
    assert of["nodule2.0"]["contrast"] == pytest.approx(
        np.mean(np.exp(-0.04 * _chords(1.0, -8.0)) - 1.0), rel=1e-9
    )
    assert of["void6.0"]["pixels"] == 0, "what is not there has no leaf that is seen"
    assert "contrast_to_noise" not in row, "no noise"
    assert "jnd" not in row, "no display"


@pytest.mark.parametrize("noise", ["off", "compound"])
def test_twins_differ_inside_the_lesion_alone_to_the_last_bit(design, noise):
    """Scatter and blur off. With noise too: twins share their luck, pixel by pixel."""
    wanted = design(
        detector={"columns": 96, "pitch_mm": 0.7},
        acquisition={"quantum_noise": noise},
        abnormalities=[NODULE, {"type": "void", "prevalence": 1.0}],
        twins=True,
    )
    maker = Maker(wanted)
    for number in range(3):
        at = _place(wanted, number)
        of = maker.case(at)
        planned = maker.plan(at, of)
        shot = maker.shoot(planned)
        lesioned, healthy = shot.left, maker.twin(of, shot).left
        truth = planned.tell()
        shadow = truth["nodule"].mask
        # What a void takes away has no leaf of its own: its silhouette is where less is left.
        thickness = lesioned.path_lengths.sum(axis=-1) - healthy.path_lengths.sum(axis=-1)
        silhouette = shadow | (thickness != 0.0)
        assert 100 < np.count_nonzero(silhouette) < 2500
        assert np.array_equal(
            lesioned.path_lengths[~shadow][:, 1], healthy.path_lengths[~shadow][:, 1]
        )
        assert np.array_equal(lesioned.signal[~silhouette], healthy.signal[~silhouette])
        differs = np.mean(lesioned.signal[shadow] != healthy.signal[shadow])
        assert differs > 0.9, "and inside it they do"


def _place(design, number):
    from phantom.datasets.places import place

    return place(design, number)


def test_a_twin_is_kept_of_abnormal_images_alone(design):
    wrong = [{**NODULE, "prevalence": 0.5}]
    wanted = design(abnormalities=wrong, twins=True)
    maker = Maker(wanted)
    for number in range(6):
        made = maker.make(number)
        assert ("twin.png" in made.files) == bool(made.row["label"])


def test_no_value_of_a_row_is_null_and_each_image_has_the_same_columns(design):
    wanted = design(
        abnormalities=[{**NODULE, "prevalence": 0.5}], views=[{"preset": "ap"}, {"preset": "pa"}]
    )
    maker = Maker(wanted)
    rows = [maker.make(number).row for number in range(6)]
    assert len({tuple(row) for row in rows}) == 1
    assert all(value is not None for row in rows for value in row.values())
    types = [{name: type(value) for name, value in row.items()} for row in rows]
    assert all(found == types[0] for found in types)


def test_views_of_a_case_share_its_state_and_not_its_noise(design):
    wanted = design(views=[{"preset": "ap"}, {"preset": "ap"}])
    one, other = (Maker(wanted).make(number) for number in (0, 1))
    assert one.row["document_sha256"] == other.row["document_sha256"]
    assert not np.array_equal(_pixels(one.files["png"]), _pixels(other.files["png"]))
    assert "document.json" in one.files
    assert "document.json" not in other.files


def test_what_is_drawn_for_an_image_reaches_the_exposure(design):
    kvp = {"type": "uniform", "low": 50, "high": 70}
    wanted = design(vary={"kvp": kvp, "dose_ugy": {"type": "choice", "values": [1.0, 4.0]}})
    maker = Maker(wanted)
    for number in range(4):
        made = maker.make(number)
        metadata = json.loads(Image.open(io.BytesIO(made.files["png"])).text[METADATA_KEY])
        assert metadata["beam"]["kvp"] == made.row["kvp"]
        kerma = metadata["exposure"]["detector_air_kerma_ugy"]
        assert kerma == pytest.approx(made.row["dose_ugy"], rel=1e-9)


def test_more_ground_truth_comes_as_an_archive(design):
    made = Maker(design(truth=["thickness"], abnormalities=[NODULE])).make(0)
    with zipfile.ZipFile(io.BytesIO(made.files["truth.zip"])) as archive:
        names = archive.namelist()
    assert "truth.json" in names
    assert any(name.startswith("thickness/") for name in names)
    assert not any(name.startswith("masks/") for name in names)


def test_a_maker_gives_the_same_in_any_order_and_on_any_number_of_threads(design):
    wanted = design(cases_per_person=2, views=[{"preset": "ap"}, {"preset": "pa"}])
    one, other = Maker(wanted, threads=1), Maker(wanted, threads=2)
    forward = {number: one.make(number).files for number in (0, 1, 2, 5)}
    backward = {number: other.make(number).files for number in (5, 2, 1, 0)}
    assert forward == backward


def test_two_eyes_give_two_pictures_of_the_pair_and_their_twins(design):
    wanted = design(
        abnormalities=[NODULE],
        twins=True,
        stereo={"baseline_mm": 20.0},
        detector={"columns": 64, "pitch_mm": 1.0},
        acquisition={"quantum_noise": "off"},
    )
    maker = Maker(wanted)
    made = maker.make(0)
    assert {"png", "right.png", "mask.png", "right.mask.png", "twin.png", "twin.right.png"} <= (
        set(made.files)
    )
    assert made.row["stereo_baseline_mm"] == 20.0
    of = maker.case(_place(wanted, 0))
    view = maker.plan(_place(wanted, 0), of).view
    pair = phantom.stereo_pair(of.phantom, view, phantom.Beam(kvp=60), baseline_mm=20.0)
    for name, image in (("", pair.left), ("right.", pair.right)):
        shown = np.asarray(_pixels(made.files[f"{name}png"]), dtype=float) / LINEAR_CODES
        assert np.abs(shown - image.transmission).max() < 0.51 / LINEAR_CODES
        twin, mask = (_pixels(made.files[k]) for k in (f"twin.{name}png", f"{name}mask.png"))
        differs = twin != _pixels(made.files[f"{name}png"])
        assert np.array_equal(differs & (mask == 0), np.zeros_like(differs))
        assert np.mean(differs[mask > 0]) > 0.9


@pytest.mark.parametrize(("mono", "both"), [("same_image", True), ("single", False)])
def test_the_arm_without_depth_shows_one_image(design, mono, both):
    made = Maker(design(stereo={"mono": mono})).make(0)
    assert ("right.png" in made.files) == both
    if both:
        assert np.array_equal(_pixels(made.files["png"]), _pixels(made.files["right.png"]))
