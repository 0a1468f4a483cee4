"""A whole radiograph against chords of spheres, and what it says of itself."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom.errors import CancelledError, InvalidInputError
from phantom.imaging import (
    QUANTITIES,
    Beam,
    Detector,
    Presentation,
    View,
    document_sha256,
    preset_view,
    radiograph,
)
from phantom.scene import Phantom

Ball = Callable[..., Phantom]
Chord = Callable[..., float]


@pytest.mark.parametrize("word", ["ap", "pa", "left_lateral", "rpo", "cc"])
def test_every_pixel_is_beers_law_over_the_chords(balls: Phantom, chord: Chord, word: str) -> None:
    view = preset_view(balls, word, columns=23, rows=17)
    image = radiograph(balls, view, Beam(energy_kev=40))
    water, fixed = image.attenuation_per_mm
    assert water == pytest.approx(0.0268, rel=0.01)
    assert fixed == 0.03
    for row in range(17):
        for column in range(23):
            pixel = view.detector.pixel(column, row)
            large = chord(view.source, pixel, (0, 0, 0), 30)
            small = chord(view.source, pixel, (25, 0, 10), 8)
            found = image.path_lengths[row, column]
            np.testing.assert_allclose(found, (large, small), atol=1e-9)
            line_integral = water * large + fixed * small
            assert image.line_integral[row, column] == pytest.approx(line_integral, abs=1e-9)
            assert image.transmission[row, column] == pytest.approx(np.exp(-line_integral))


def test_a_parallel_beam_starts_before_the_whole_scene(balls: Phantom, chord: Chord) -> None:
    detector = Detector(
        center=[0, 0, 0], right=[1, 0, 0], down=[0, 0, -1], columns=9, rows=9, pitch_mm=5
    )
    image = radiograph(balls, View(source=None, direction=[0, 2, 0], detector=detector))
    pixel = detector.pixel(2, 3)
    whole = chord(pixel - [0, 100, 0], pixel, (0, 0, 0), 30)
    assert image.path_lengths[3, 2, 0] == pytest.approx(whole / 2)
    assert image.magnification == 1
    assert image.pitch_at_isocentre_mm == (5, 5)


def test_the_dense_ball_at_the_left_is_at_the_images_right_and_above(balls: Phantom) -> None:
    for word in ("ap", "pa"):
        image = radiograph(balls, preset_view(balls, word, columns=64, rows=64))
        rows, columns = np.nonzero(image.path_lengths[..., 1])
        assert columns.mean() > 40
        assert rows.mean() < 28
        at = image.projection.project(np.array([[25.0, 0, 10]]))[0]
        np.testing.assert_allclose((columns.mean(), rows.mean()), at, atol=0.5)


def test_magnification_and_pitch_at_the_isocentre(ball_at: Ball) -> None:
    phantom = ball_at((3, 4, 5), 20)
    image = radiograph(phantom, preset_view(phantom, "ap", columns=8, rows=8, pitch_mm=(6, 7)))
    assert image.magnification == pytest.approx(1150 / 1050)
    assert image.pitch_at_isocentre_mm == pytest.approx((6 * 1050 / 1150, 7 * 1050 / 1150))


def test_leaves_that_leave_the_field_are_named(balls: Phantom) -> None:
    def cut(**detector: Any) -> tuple[str, ...]:
        return radiograph(
            balls, preset_view(balls, "ap", columns=50, rows=50, **detector)
        ).truncated

    assert cut() == ()
    assert cut(pitch_mm=1.5, isocentre=[0, 0, 0]) == ()
    assert cut(pitch_mm=1.4, isocentre=[0, 0, 0]) == ("left",)
    assert cut(pitch_mm=1.2, isocentre=[0, 0, 0]) == ("large", "left")
    assert cut(pitch_mm=0.1, isocentre=[0, 0, 0]) == ("large", "left")
    assert cut(pitch_mm=0.4, isocentre=[25, 0, 10]) == ("large",)
    assert cut(pitch_mm=0.4, isocentre=[-25, 0, 10]) == ("large", "left")


def test_a_ball_behind_the_detector_is_not_cut_by_its_border(ball_at: Ball) -> None:
    phantom = ball_at((0, 300, 0), 20)
    detector = Detector(
        center=[0, 0, 0], right=[1, 0, 0], down=[0, 0, -1], columns=9, rows=9, pitch_mm=2
    )
    image = radiograph(phantom, View(source=[0, -500, 0], detector=detector))
    assert not image.path_lengths.any()
    assert any("behind the detector" in warning for warning in image.warnings)


def test_an_energy_that_does_nothing_is_told(ball_at: Ball, balls: Phantom) -> None:
    fixed = ball_at((0, 0, 0), 20)
    view = preset_view(fixed, "ap", columns=4, rows=4)
    assert radiograph(fixed, view).warnings == ()
    (warning,) = radiograph(fixed, view, Beam(energy_kev=80)).warnings
    assert "80 keV has no effect" in warning
    assert (
        radiograph(balls, preset_view(balls, "ap", columns=4, rows=4), Beam(energy_kev=80)).warnings
        == ()
    )


def test_a_source_within_the_phantom_is_legal_and_told(ball_at: Ball) -> None:
    phantom = ball_at((0, 0, 0), 40)
    detector = Detector(
        center=[0, 90, 0], right=[1, 0, 0], down=[0, 0, -1], columns=3, rows=3, pitch_mm=1
    )
    image = radiograph(phantom, View(source=[0, 10, 0], detector=detector))
    assert image.path_lengths[1, 1, 0] == pytest.approx(30)
    assert any("within the phantom" in warning for warning in image.warnings)


def test_metadata_is_plain_json_and_says_where_everything_was(balls: Phantom) -> None:
    view = preset_view(balls, "pa", columns=12, rows=10)
    image = radiograph(balls, view)
    told = json.loads(json.dumps(image.metadata(), allow_nan=False))
    assert told == image.metadata()
    assert told["phantom"]["name"] == "balls"
    assert told["phantom"]["material_names"] == ["water", "fixed"]
    assert told["phantom"]["document_sha256"] == document_sha256(balls.document)
    np.testing.assert_array_equal(told["projection_matrix"], image.projection_matrix)
    assert told["intrinsics"][0][0] < 0
    assert [stage["stage"] for stage in told["stages"]] == [
        "path_lengths",
        "beer_lambert",
        "signal",
    ]
    assert told["stages"][1]["attenuation_per_mm"]["fixed"] == 0.03
    assert View.model_validate(told["view"]) == view


def test_the_document_hash_tells_documents_apart(balls: Phantom, ball_at: Ball) -> None:
    one, same, other = ball_at((0, 0, 0), 20), ball_at((0, 0, 0), 20.0), ball_at((0, 0, 0), 21)
    hashes = [document_sha256(p.document) for p in (one, same, other, balls)]
    assert hashes[0] == hashes[1]
    assert len(set(hashes)) == 3


def test_quantities_are_had_by_name_and_cannot_be_overwritten(balls: Phantom) -> None:
    image = radiograph(balls, preset_view(balls, "ap", columns=5, rows=6))
    for name in QUANTITIES:
        assert image.quantity(name).shape[:2] == (6, 5)
        with pytest.raises(ValueError, match="read-only"):
            image.quantity(name)[0] = 1
    with pytest.raises(InvalidInputError, match="line_integral") as refusal:
        image.quantity("dose")
    assert refusal.value.problems[0].path == "/quantity"


def test_a_picture_is_made_of_images_only(balls: Phantom) -> None:
    image = radiograph(balls, preset_view(balls, "ap", columns=30, rows=30))
    for name in ("signal", "line_integral"):
        grey = image.presented(name, Presentation(bits=16))
        assert grey[15, 15] > grey[0, 0] == 0
    with pytest.raises(InvalidInputError, match="no image"):
        image.presented("path_lengths")


def test_a_cancelled_trace_stops(balls: Phantom) -> None:
    with pytest.raises(CancelledError):
        radiograph(balls, preset_view(balls, "ap", columns=64, rows=64), cancelled=lambda: True)


def test_progress_ends_with_the_whole(balls: Phantom) -> None:
    told: list[tuple[int, int]] = []
    view = preset_view(balls, "ap", columns=64, rows=64)
    radiograph(balls, view, progress=lambda done, whole: told.append((done, whole)))
    assert told
    assert told[-1][0] == told[-1][1]
