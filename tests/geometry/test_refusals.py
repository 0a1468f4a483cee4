"""What is not a solid is refused, with the place and the figure; nothing of it is traced."""

import json
import re

import pytest

import phantom
from phantom.cli import main
from tests.oracles.refused_quadrics import QUADRICS
from tests.oracles.refused_tubes import AXES, BODIES, SECTIONS
from tests.oracles.tubes import document

REFUSED = AXES | SECTIONS | BODIES | QUADRICS


def problems(tree):
    with pytest.raises(phantom.InvalidDocumentError) as refused:
        phantom.load(tree)
    return refused.value.problems


def only(tree):
    found = problems(tree)
    assert len(found) == 1, [str(p) for p in found]
    return found[0]


@pytest.mark.parametrize("name", REFUSED, ids=lambda name: name.replace(" ", "-"))
def test_refused_with_place_and_figure(name):
    solid, path, kind, message = REFUSED[name]
    found = only(document(solid))
    assert (found.path, found.kind) == (path, kind), str(found)
    assert re.search(message, found.message), str(found)
    assert "expected" in found.message


@pytest.mark.parametrize("name", REFUSED, ids=lambda name: name.replace(" ", "-"))
def test_refused_wherever_it_stands(name):
    """Deep in a tree and in definitions, used or not, with the path of the field itself."""
    solid, path, kind, _ = REFUSED[name]
    rest = path.removeprefix("/solid")
    box = {"type": "box", "center": [0, 0, 0], "size": [1, 1, 1], "material": "m"}
    deep = {"type": "transformed", "solid": {"type": "union", "solids": [box, solid]}, "scale": 1.5}
    tree = document(box, deep, definitions={"unused": solid})
    found = {(p.path, p.kind) for p in problems(tree)}
    wanted = {("/solid/solids/1/solid/solids/1" + rest, kind), ("/definitions/unused" + rest, kind)}
    assert found == wanted


def test_all_are_told_at_once():
    solids = [solid for solid, *_ in REFUSED.values()]
    found = [(p.path, p.kind) for p in problems(document(*solids))]
    wanted = [
        (f"/solid/solids/{i}" + path.removeprefix("/solid"), kind)
        for i, (_, path, kind, _) in enumerate(REFUSED.values())
    ]
    assert sorted(found) == sorted(wanted)


def test_an_instance_is_told_of_where_it_is_defined():
    bad, path, kind, _ = REFUSED["a tube thicker than its bend"]
    uses = [{"type": "instance", "of": "bad", "name": name} for name in ("a", "b")]
    found = only(document(*uses, definitions={"bad": bad}))
    assert (found.path, found.kind) == ("/definitions/bad" + path.removeprefix("/solid"), kind)


def test_nothing_is_drawn_from_a_refused_document(tmp_path, capsys, monkeypatch):
    source, picture = tmp_path / "bad.json", tmp_path / "bad.png"
    source.write_text(json.dumps(document(REFUSED["a seam that stays open"][0])))
    command = ["phantom", "radiograph", str(source), "--view", "ap", "-o", str(picture)]
    monkeypatch.setattr("sys.argv", command)
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code not in (0, None)
    assert not picture.exists()
    assert "/solid/sweep" in capsys.readouterr().err
