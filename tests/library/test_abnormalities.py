"""What is wrong with a phantom is asked for, checked and refused as its parameters are."""

from __future__ import annotations

from typing import Annotated, Literal

import pytest

from phantom import library
from phantom.document import Document, told
from phantom.document.base import Length
from phantom.errors import InvalidInputError
from phantom.library import Abnormality, Entry, registry
from phantoms import sphere


class Bubble(Abnormality):
    """A bubble in the middle."""

    type: Literal["bubble"] = "bubble"
    radius_mm: Annotated[Length, told("Radius", "mm", "Of the bubble.")] = 2.0


def _build(parameters: sphere.Parameters, abnormalities: tuple[Abnormality, ...] = ()) -> Document:
    built = sphere.build(parameters)
    found = [{"name": a.name or "bubble", "size_mm": a.radius_mm} for a in abnormalities]
    return Document.model_validate({**built.model_dump(), "findings": found})


@pytest.fixture(autouse=True)
def _with_a_flawed_ball(monkeypatch):
    flawed = Entry(
        name="flawed",
        title="A ball with bubbles",
        summary="For tests.",
        parameters=sphere.Parameters,
        build=_build,
        abnormalities={"bubble": Bubble},
    )
    known = registry.entry
    monkeypatch.setattr(registry, "entry", lambda name: flawed if name == "flawed" else known(name))


def test_abnormalities_reach_the_builder_checked():
    made = library.document("flawed", {}, [{"type": "bubble", "radius_mm": 3}])
    assert [(f.name, f.size_mm) for f in made.findings] == [("bubble", 3.0)]


def test_without_any_the_twin_is_healthy():
    assert library.document("flawed").findings == ()


def test_every_bad_abnormality_is_told_beside_bad_parameters():
    wrong = [{"type": "bubble", "radius_mm": -1, "x": 0}, {"type": "crack"}, {}, "bubble"]
    with pytest.raises(InvalidInputError) as refusal:
        library.document("flawed", {"radius_mm": 1000}, wrong)
    assert {(p.path, p.kind) for p in refusal.value.problems} == {
        ("/parameters/radius_mm", "out_of_range"),
        ("/abnormalities/0/radius_mm", "out_of_range"),
        ("/abnormalities/0/x", "unknown_field"),
        ("/abnormalities/1/type", "unknown_type"),
        ("/abnormalities/2/type", "missing"),
        ("/abnormalities/3", "not_an_object"),
    }


def test_a_phantom_without_abnormalities_says_so():
    with pytest.raises(InvalidInputError, match="sphere has none"):
        library.document("sphere", {}, [{"type": "bubble"}])
