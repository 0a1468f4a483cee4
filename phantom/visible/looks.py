"""How each leaf looks: as the document says, else as its material does.

Colours are given as sRGB and kept as linear light. A material is known by a word in its name
(``bone``, ``soft tissue``, ``steel``), else in the name of its reference; any other gets a colour
by its place in the document, so that neighbours differ.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.placed import placed_leaves
from phantom.scene import Phantom

Floats = NDArray[np.float64]

_MATT: Final = (0.14, 0.76, 0.06, 10.0)
_WAXY: Final = (0.14, 0.70, 0.14, 24.0)
_MOIST: Final = (0.14, 0.64, 0.20, 40.0)
_METAL: Final = (0.12, 0.48, 0.40, 60.0)


@dataclass(frozen=True)
class Kind:
    """A kind of material: the words it is known by, its colour as sRGB, and K_a, K_d, K_s, n."""

    words: str
    color: str
    phong: tuple[float, float, float, float]


KINDS: Final = (
    Kind("marrow", "#c98b6b", _MOIST),
    Kind("spongiosa cancellous trabecular", "#e3cfa4", _MATT),
    Kind("bone cortical cortex hydroxyapatite calcium calcification stone", "#eee3cb", _WAXY),
    Kind("cartilage meniscus", "#c9dfe6", _MOIST),
    Kind("tendon ligament", "#e6dfd0", _MOIST),
    Kind("muscle", "#b0564b", _MOIST),
    Kind("skin", "#e6bb9f", _WAXY),
    Kind("adipose fat", "#f0d589", _WAXY),
    Kind("lung", "#dba9a3", _MATT),
    Kind("gland breast", "#e8bfae", _WAXY),
    Kind("blood vessel", "#a5262a", _MOIST),
    Kind("tissue", "#d9a593", _WAXY),
    Kind("water", "#86bbdb", _MOIST),
    Kind("air", "#dde8f0", _MATT),
    Kind("steel titanium cobalt metal screw", "#b4b8bd", _METAL),
    Kind("aluminium", "#cdd1d6", _METAL),
    Kind("pmma plastic cement polyethylene", "#d6e2ea", _WAXY),
    Kind("glass", "#c3e0d9", _MOIST),
    Kind("iodine contrast", "#5f93d4", _MOIST),
    Kind("barium", "#f4f1e8", _WAXY),
)
"""Kinds, the first whose word a name holds; "bone marrow" is marrow, "soft tissue" tissue."""

PALETTE: Final = ("#c9b79c", "#8fb0a9", "#c98f7a", "#8d9cc0", "#b7b071", "#b58fae")


def looks(phantom: Phantom) -> Floats:
    """Return (L, 7): linear red, green and blue, then K_a, K_d, K_s and n of every leaf."""
    materials = list(phantom.document.materials.items())
    usual = [_usual(name, material, i) for i, (name, material) in enumerate(materials)]
    rows = []
    for (leaf, _), channel in zip(
        placed_leaves(phantom.document), phantom.leaf_materials, strict=True
    ):
        own = leaf.appearance
        if own is not None:
            phong = (own.ambient, own.diffuse, own.specular, own.exponent)
            rows.append((*own.color, *phong))
        else:
            rows.append(usual[channel] if channel >= 0 else (*linear(PALETTE[0]), *_WAXY))
    return np.array(rows, dtype=np.float64)


def _usual(name: str, material: doc.Material, place: int) -> tuple[float, ...]:
    reference = material.reference if isinstance(material, doc.ReferenceMaterial) else ""
    for text in (name, reference):
        spoken = set(re.split(r"[^a-z]+", text.lower()))
        for kind in KINDS:
            if spoken & set(kind.words.split()):
                return (*linear(kind.color), *kind.phong)
    return (*linear(PALETTE[place % len(PALETTE)]), *_WAXY)


def linear(color: str) -> tuple[float, float, float]:
    """Return the linear light of an sRGB colour written ``#rrggbb`` (IEC 61966-2-1)."""
    value = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    light = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    red, green, blue = (float(channel) for channel in light)
    return red, green, blue
