"""Which format holds what, and files that are whole or not there."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from phantom.encode import FORMATS, encode, format_named, format_of_path, save, write_atomically
from phantom.errors import InvalidInputError

STACK = np.random.default_rng(3).normal(50, 30, (6, 5, 3))


class Still:
    """The least that can be encoded: a stack of numbers that presents itself at 8 bits."""

    def quantity(self, name: str) -> Any:
        return STACK if name == "path_lengths" else STACK[..., 0]

    def presented(self, name: str, presentation: int | None) -> Any:
        return np.full((6, 5), presentation or 0, np.uint8)

    def shown(self, name: str, presentation: int | None) -> dict[str, Any]:
        return {"bits": presentation or 8}

    def metadata(self) -> dict[str, Any]:
        return {"phantom": {"name": "still"}, "quantity_of": 1.5}


@pytest.mark.parametrize("quantity", ["signal", "transmission", "line_integral", "path_lengths"])
def test_npy_holds_any_quantity_in_single_precision(quantity: str) -> None:
    data, media_type, _ = encode(Still(), quantity, format="npy")
    found = np.load(io.BytesIO(data))
    assert media_type == "application/x-npy"
    assert found.dtype == np.dtype("<f4")
    np.testing.assert_array_equal(found, Still().quantity(quantity).astype(np.float32))
    assert encode(Still(), quantity, format="npy").data == data


def test_png_holds_what_the_presentation_gives(read_png: Callable[..., Any]) -> None:
    data, media_type, _ = encode(Still(), "signal", 77)
    assert media_type == "image/png"
    assert (read_png(data).pixels == 77).all()


def test_png_refuses_what_is_no_image() -> None:
    with pytest.raises(InvalidInputError) as refusal:
        encode(Still(), "path_lengths", format="image/png")
    (problem,) = refusal.value.problems
    assert problem.path == "/quantity"
    assert "line_integral" in problem.message


def test_extensions_and_media_types_name_the_same_formats() -> None:
    for known in FORMATS:
        assert format_named(known.name) is format_named(known.media_type) is known
        for extension in known.extensions:
            assert format_of_path(f"a/b{extension}") is known
            assert format_of_path(Path(f"b{extension.upper()}")) is known


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("knee.tif", "tiff"), ("knee.F32.TIF", "tiff-float32"), ("a.b/k.v2.u16.npy", "npy-uint16"),
        ("knee.u16.v2.npy", "npy"), ("knee.raw.dcm", "dicom-processing"), ("knee.raw.png", "png"),
    ],
)  # fmt: skip
def test_the_longest_extension_that_is_known_counts(path: str, name: str) -> None:
    assert format_of_path(path).name == name


def test_no_library_of_images_is_loaded_before_it_is_needed() -> None:
    code = (
        "import sys, phantom.encode;"
        "sys.exit(bool({'pydicom', 'OpenImageIO', 'scipy', 'numba'} & sys.modules.keys()))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("path", ["knee.gif", "knee", "png", "knee.png.", "a.npy/knee"])
def test_an_unknown_extension_is_refused_with_the_known_ones(path: str) -> None:
    with pytest.raises(InvalidInputError, match=r"\.png, \.npy") as refusal:
        format_of_path(path)
    assert refusal.value.problems[0].path == "/output"


def test_an_unknown_media_type_is_refused_with_the_known_ones() -> None:
    with pytest.raises(InvalidInputError, match="image/png") as refusal:
        encode(Still(), format="image/gif")
    assert refusal.value.problems[0].path == "/format"


def test_a_saved_file_is_what_was_encoded(tmp_path: Path) -> None:
    save(Still(), tmp_path / "still.npy", "path_lengths", sidecar=True)
    assert (tmp_path / "still.npy").read_bytes() == encode(
        Still(), "path_lengths", format="npy"
    ).data
    beside = json.loads((tmp_path / "still.json").read_text())
    assert beside.pop("file") == {"format": "npy", "holds": "numbers", "quantity": "path_lengths"}
    assert beside == Still().metadata()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["still.json", "still.npy"]


def test_no_sidecar_is_written_unless_asked_for(tmp_path: Path) -> None:
    save(Still(), tmp_path / "still.png")
    assert [p.name for p in tmp_path.iterdir()] == ["still.png"]


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"old and longer")
    write_atomically(path, b"new")
    assert path.read_bytes() == b"new"


def test_a_failed_write_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"old")

    def fails(*_: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr("os.fsync", fails)
    with pytest.raises(OSError, match="disk full"):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.bin"]


def test_a_missing_folder_and_a_folder_are_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "no" / "a.png", tmp_path):
        with pytest.raises(InvalidInputError) as refusal:
            write_atomically(path, b"")
        assert refusal.value.problems[0].path == "/output"
