"""Documents in a folder are phantoms of the library."""

from __future__ import annotations

import json

import pytest

import phantom
from phantom import library
from phantom.errors import InvalidInputError, UnknownPhantomError

BALL = {
    "format": "phantom/1",
    "title": "My ball",
    "materials": {"stuff": {"attenuation_per_mm": 0.02}},
    "solid": {"type": "sphere", "center": [0, 0, 0], "radius": 7, "material": "stuff"},
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("PHANTOM_DOCUMENTS", str(tmp_path))
    return tmp_path


def test_a_document_on_disk_is_listed_and_traced_by_its_files_name(folder):
    (folder / "my-ball.json").write_text(json.dumps(BALL))
    (folder / "notes.txt").write_text("no phantom")
    assert "my-ball" in library.names()
    assert "notes" not in library.names()
    assert library.entry("my-ball").title == "My ball"
    ball = library.build("my-ball")
    assert phantom.path_lengths(ball, [[-50, 0, 0]], [[1, 0, 0]])[0] == pytest.approx([14.0])


def test_an_installed_phantom_goes_before_a_file_of_its_name(folder):
    (folder / "sphere.json").write_text(json.dumps(BALL))
    assert library.entry("sphere").title == "Sphere"
    assert library.names().count("sphere") == 1


def test_a_file_that_is_no_document_is_told_with_its_problems(folder):
    (folder / "broken.json").write_text(json.dumps({**BALL, "solid": {"type": "egg"}}))
    with pytest.raises(InvalidInputError) as refusal:
        library.build("broken")
    assert [(p.path, p.kind) for p in refusal.value.problems] == [
        ("/document/solid/type", "unknown_type")
    ]


def test_the_list_goes_on_where_a_file_is_no_document(folder):
    (folder / "broken.json").write_text("{")
    listed = {line.name: line for line in library.catalogue()}
    assert set(library.names()) == set(listed)
    assert "no document" in listed["broken"].title
    assert listed["sphere"].title == "Sphere"


def test_parameters_of_a_document_are_refused(folder):
    (folder / "my-ball.json").write_text(json.dumps(BALL))
    with pytest.raises(InvalidInputError) as refusal:
        library.build("my-ball", radius_mm=3)
    assert [p.path for p in refusal.value.problems] == ["/parameters/radius_mm"]


def test_without_a_folder_there_is_none(monkeypatch):
    monkeypatch.setenv("PHANTOM_DOCUMENTS", "/nowhere/at/all")
    with pytest.raises(UnknownPhantomError):
        library.entry("my-ball")
