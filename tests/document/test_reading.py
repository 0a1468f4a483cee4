"""Documents come from files, text and trees, and whatever is odd in them has a place."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import phantom.document
from phantom.errors import InvalidDocumentError, InvalidInputError, Problem

Judge = Callable[[object], list[Problem]]
KNEE_LIKE = Path(__file__).parents[2] / "bench" / "knee-like.json"


def test_the_bench_scene_is_read_alike_from_every_source(tmp_path: Path) -> None:
    text = KNEE_LIKE.read_text()
    document = phantom.document.read(KNEE_LIKE)
    assert list(document.materials) == ["soft", "bone", "thin_bone", "lesion"]
    yaml_file = tmp_path / "knee.yaml"
    yaml_file.write_text(text)
    sources: list[Any] = [
        str(KNEE_LIKE),
        text,
        text.encode(),
        json.loads(text),
        yaml_file,
        document,
    ]
    assert [phantom.document.read(source) for source in sources] == [document] * len(sources)


@pytest.mark.parametrize("options", [{}, {"exclude_none": True}, {"exclude_defaults": False}])
def test_a_document_written_out_reads_back_equal(options: dict[str, bool]) -> None:
    document = phantom.document.read(KNEE_LIKE)
    assert phantom.document.parse(document.model_dump(mode="json", **options)) == document


def test_a_document_cannot_be_changed() -> None:
    document = phantom.document.read(KNEE_LIKE)
    with pytest.raises(ValueError, match="frozen"):
        document.name = "other"


def test_no_problem_hides_another(sphere: Any, written: Any, problems: Judge) -> None:
    tree = written(
        {
            "type": "union",
            "solids": [
                sphere(radius=float("nan"), name="a"),
                sphere(material=None, name="a", center=[0, "1", 0]),
                {"type": "spher"},
                {"type": "instance", "of": "gone"},
                {"center": [0, 0, 0]},
                7,
            ],
        },
        materials={"bone": {}, "rest": {"reference": "cheese"}},
        extra=1,
        landmarks={"isocentre": [0, 0]},
    )
    assert [(p.path, p.kind) for p in problems(tree)] == [
        ("/extra", "unknown_field"),
        ("/landmarks/isocentre", "wrong_length"),
        ("/materials/bone", "material_kind"),
        ("/materials/rest/reference", "unknown_reference"),
        ("/solid/solids/0/radius", "not_finite"),
        ("/solid/solids/1/center/1", "not_a_number"),
        ("/solid/solids/1/material", "missing_material"),
        ("/solid/solids/1/name", "repeated_label"),
        ("/solid/solids/2/type", "unknown_type"),
        ("/solid/solids/3/of", "undefined_definition"),
        ("/solid/solids/4/type", "missing"),
        ("/solid/solids/5", "not_an_object"),
    ]


def test_paths_are_not_led_astray_by_fields_named_like_types(written: Any, problems: Judge) -> None:
    solid = {"type": "sphere", "sphere": {"radius": 1}, "material": "bone", "center": [0, 0, 0]}
    assert [p.path for p in problems(written(solid, definitions={"sphere": solid}))] == [
        "/definitions/sphere/radius",
        "/definitions/sphere/sphere",
        "/solid/radius",
        "/solid/sphere",
    ]


@pytest.mark.parametrize("tree", [None, 3, "x", [], True])
def test_a_document_is_an_object(tree: object) -> None:
    with pytest.raises(InvalidDocumentError) as refusal:
        phantom.document.parse(tree)
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("", "not_an_object")]


def test_the_format_is_named(sphere: Any, written: Any, problems: Judge) -> None:
    [problem] = problems(written(sphere(), format="phantom/2"))
    assert (problem.path, problem.kind) == ("/format", "unknown_value")
    assert problem.message == "found 'phantom/2'; expected 'phantom/1'"


SPHERE = '"type": "sphere", "center": [0, 0, 0], "material": "a"'
HEAD = '{"format": "phantom/1", "materials": {"a": {"attenuation_per_mm": 1}}, '


@pytest.mark.parametrize(
    ("radius", "kind", "said"),
    [
        ("NaN", "not_finite", "found NaN; expected a finite number"),
        ("Infinity", "not_finite", "found an infinite number"),
        ("-Infinity", "not_finite", "found an infinite number"),
        ("1e999", "not_finite", "found an infinite number"),
        ("9" * 5_000, "out_of_range", "found an integer of 5000 digits"),
        ("-" + "9" * 350, "out_of_range", "found an integer of about"),
        ("true", "not_a_number", "found true"),
        ('"\\ud800"', "lone_surrogate", "found '\\ud800'"),
        ('1, "radius": 2', "repeated_key", "found this key twice"),
    ],
)
def test_odd_values_in_json_are_told_with_their_place(
    radius: str, kind: str, said: str, problems: Judge
) -> None:
    [problem] = problems(HEAD + '"solid": {' + SPHERE + f', "radius": {radius}' + "}}")
    assert (problem.path, problem.kind) == ("/solid/radius", kind)
    assert said in problem.message
    assert problem.message.encode("utf-8")


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"\xff\xfe{}", "invalid_utf8"),
        (b'{"a": "\xed\xa0\x80"}', "invalid_utf8"),
        (b"", "invalid_json"),
        (b"{", "invalid_json"),
        (b'{"a": 1,}', "invalid_json"),
        (b"{} {}", "invalid_json"),
    ],
)
def test_what_is_not_json_is_refused(data: bytes, kind: str, problems: Judge) -> None:
    assert [(p.path, p.kind) for p in problems(data)] == [("", kind)]
    with pytest.raises(InvalidInputError):
        phantom.document.decode_json(data)


@pytest.mark.parametrize(
    ("key", "kind"),
    [("\ud800", "lone_surrogate"), ("a\x00", "bad_key"), ("k" * 2_000, "bad_key"), (3, "bad_key")],
)
def test_odd_keys_are_told_at_their_object(
    key: object, kind: str, sphere: Any, written: Any, problems: Judge
) -> None:
    [problem] = problems(written(sphere(), parameters={"x": {key: 1}}))
    assert (problem.path, problem.kind) == ("/parameters/x", kind)


def test_an_integer_too_long_to_print_is_refused(
    sphere: Any, written: Any, problems: Judge
) -> None:
    [problem] = problems(written(sphere(radius=10**5_000)))
    assert (problem.path, problem.kind) == ("/solid/radius", "out_of_range")


def test_values_that_are_no_json_are_refused(sphere: Any, written: Any, problems: Judge) -> None:
    [problem] = problems(written(sphere(center={1, 2, 3})))
    assert (problem.path, problem.kind) == ("/solid/center", "unsupported_value")


@pytest.mark.parametrize("name", ["gone.json", "gone.yaml", "gone.JSON"])
def test_a_file_that_is_not_there_is_said_so(name: str, tmp_path: Path, problems: Judge) -> None:
    [problem] = problems(str(tmp_path / name))
    assert (problem.path, problem.kind) == ("", "unreadable")
    assert name in problem.message


YAML = """
format: phantom/1
materials: {a: {attenuation_per_mm: 5e-2}, N: {composition: {No: 1}, density_g_cm3: 1}}
definitions:
  ball: &ball {type: sphere, center: [0, 0, 0], radius: 1, material: a}
solid: *ball
description: no
"""


def test_yaml_says_what_json_would(tmp_path: Path) -> None:
    file = tmp_path / "ball.yml"
    file.write_text(YAML.replace("No: 1", "N: 1"))
    document = phantom.document.read(file)
    assert document.solid == document.definitions["ball"]
    assert document.description == "no"
    assert list(document.materials) == ["a", "N"]


BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join(['*' + a] * 9)}]\n"
    for a, b in zip("abcdefghijk", "bcdefghijkl", strict=True)
)


@pytest.mark.parametrize(
    ("text", "path", "kind"),
    [
        ("format: !!python/object:os.system x", "", "invalid_yaml"),
        ("format: [", "", "invalid_yaml"),
        ("a: *b", "", "invalid_yaml"),
        ("? [a]\n: b", "", "bad_key"),
        ("a: 1\n---\nb: 2", "", "invalid_yaml"),
        ("[" * 5_000, "", "too_deep"),
        ("a: &a\n  b: *a", "", "too_deep"),
        (BOMB, "", "too_large"),
        ("", "", "not_an_object"),
    ],
)
def test_yaml_tricks_are_refused(
    text: str, path: str, kind: str, tmp_path: Path, problems: Judge
) -> None:
    file = tmp_path / "odd.yaml"
    file.write_text(text)
    [problem] = problems(file)
    assert problem.kind == kind
    assert problem.path.startswith(path)


def test_yaml_reports_repeated_keys_and_odd_numbers(tmp_path: Path, problems: Judge) -> None:
    file = tmp_path / "odd.yaml"
    file.write_text(YAML.replace("radius: 1", "radius: .nan, radius: .inf").replace("No", "N"))
    found = {(p.path, p.kind) for p in problems(file)}
    assert ("/definitions/ball/radius", "repeated_key") in found
    assert ("/solid/radius", "not_finite") in found


def _described(schema: dict[str, Any]) -> list[str]:
    return [
        f"{model}.{name}"
        for model, part in schema["$defs"].items()
        for name, field in part["properties"].items()
        if name != "type"
        and not (field.get("title") and field.get("unit") and field["description"])
    ]


def test_the_schema_tells_title_unit_and_meaning_of_every_field() -> None:
    schema = phantom.document.Document.model_json_schema()
    assert len(schema["$defs"]) >= 35
    assert _described(schema) == []
    assert "\\u0000" not in json.dumps(schema)
