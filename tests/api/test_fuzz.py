"""Sound requests with a few of their parts broken at random: answered or refused, never a fault."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Iterator
from typing import Any

import pytest

POSE = {"center": [0, 100, 0], "right": [1, 0, 0], "down": [0, 0, -1]}
BOX = {"type": "box", "center": [0, 0, 0], "size": [10, 20, 30], "material": "a"}
SOUND: list[dict[str, Any]] = [
    {
        "phantom": {"name": "sphere", "parameters": {"radius_mm": 10, "material": "water"}},
        "view": {"preset": "c_arm", "source_detector_mm": 1000, "primary_angle_deg": 10},
        "detector": {"columns": 8, "rows": 8, "pitch_mm": [1, 2]},
        "beam": {"energy_kev": 60},
        "presentation": {"mode": "stretch", "polarity": "bones_white", "bits": 8},
        "blind": False,
    },
    {
        "phantom": {
            "document": {
                "format": "phantom/1",
                "materials": {"a": {"reference": "water"}},
                "definitions": {"box": BOX | {"cuts": [{"point": [0, 0, 0], "normal": [1, 1, 1]}]}},
                "landmarks": {"isocentre": [0, 0, 0]},
                "solid": {
                    "type": "transformed",
                    "scale": 2,
                    "rotate": {"axis": [0, 0, 1], "angle_deg": 30},
                    "solid": {"type": "instance", "of": "box"},
                },
            }
        },
        "view": {"source": None, "direction": [0, 1, 0], "detector": POSE},
        "detector": {"columns": 8},
    },
]
SEEN: list[dict[str, Any]] = [
    {
        "phantom": SOUND[0]["phantom"],
        "camera": {
            "eye": [0, -90, 5],
            "target": [0, 0, 0],
            "up": [0, 0, 1],
            "columns": 8,
            "rows": 9,
        },
        "hide": [],
        "lighting": {
            "ambient": [1, 1, 1],
            "lights": [
                {"type": "directional", "to_light": [1, 2, 3], "intensity": 2},
                {"type": "point", "position": [9, 9, 9], "color": [1, 0, 0], "fixed_to": "camera"},
            ],
            "shadows": True,
        },
        "background": [0, 0.5, 1],
        "samples_per_pixel": 2,
        "tone": {"mode": "stretch", "bits": 16},
    },
    {
        "phantom": SOUND[1]["phantom"],
        "camera": {
            "azimuth_deg": 20,
            "elevation_deg": 80,
            "parallel": True,
            "zoom": 2,
            "columns": 8,
        },
    },
    {"phantom": SOUND[1]["phantom"], "hide": ["a"], "camera": {"preset": "top", "columns": 8}},
]
CALLS = {"/v1/radiographs": SOUND, "/v1/renders": SEEN}
ODD: list[Any] = [
    float("nan"), float("inf"), -1, 0, 1e-9, 1e18, 1e300, 10**400, "", "x", "\ud800",
    None, True, [], {}, [1, 2], [1, 2, 3], {"a": 1},
]  # fmt: skip


def places(tree: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    keys = tree if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    for key in keys:
        yield (*place, key)
        yield from places(tree[key], (*place, key))


def broken(sound: list[dict[str, Any]], random: random.Random) -> dict[str, Any]:
    tree = copy.deepcopy(random.choice(sound))
    for _ in range(random.choice([1, 1, 2, 3])):
        *parents, key = random.choice(list(places(tree)) or [("x",)])
        node = tree
        for parent in parents:
            node = node[parent]
        if random.random() < 0.15:
            node.pop(key, None) if isinstance(node, dict) else node.pop(key)
        else:
            node[key] = copy.deepcopy(random.choice(ODD))
    return tree


@pytest.mark.parametrize("address", CALLS)
@pytest.mark.parametrize("seed", range(4))
def test_a_broken_request_is_answered_or_refused(service, seed, address):
    client, rng = service(max_pixels=4096), random.Random(seed)
    for _ in range(100):
        body = json.dumps(broken(CALLS[address], rng))
        response = client.post(address, content=body, headers={"Content-Type": "application/json"})
        assert response.status_code in (200, 422), body
        if response.status_code == 422:
            assert response.json()["problems"], body
