"""The fan of 1993: one blade, three times, against volumes and chords in closed form."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

from phantom import library
from phantom.scene import Phantom, load
from phantom.tracing import Intervals, measure, path_lengths


@pytest.fixture(scope="module")
def fan() -> Phantom:
    return library.build("fan")


class Blade:
    """The blade of a fan's document as functions of u, by scipy's splines."""

    def __init__(self, fan: Phantom) -> None:
        blade: Any = fan.document.definitions["blade"]
        self.root, self.tip = blade.axis.start[2], blade.axis.end[2]
        self.half_length, self.half_thickness = (
            CubicSpline(*np.transpose(profile.knots)) for profile in blade.sweep.scale
        )
        self.shift = CubicSpline(*np.transpose(blade.sweep.offset[0].knots))

    @property
    def volume(self) -> float:
        area, _ = quad(lambda u: self.half_length(u) * self.half_thickness(u), 0, 1)
        return float(np.pi * area * (self.tip - self.root))


def hub_volume(fan: Phantom) -> float:
    """Volume of the ellipsoid between its two planes."""
    hub: Any = fan.document.solid.solids[0]  # type: ignore[union-attr]
    a, b, c = hub.semi_axes
    front, back = sorted(cut.point[1] / b for cut in hub.cuts)
    return float(np.pi * a * b * c * ((back - back**3 / 3) - (front - front**3 / 3)))


def test_one_blade_is_defined_and_stands_three_times(fan: Phantom) -> None:
    assert list(fan.document.definitions) == ["blade"]
    assert fan.leaf_names == ("hub", "blade-1", "blade-2", "blade-3")


def test_third_of_a_turn_changes_nothing(fan: Phantom) -> None:
    rng = np.random.default_rng(9)
    origins = rng.uniform(-300.0, 300.0, (2000, 3))
    directions = rng.uniform(-90.0, 90.0, (2000, 3)) - origins
    cos, sin = -0.5, np.sqrt(0.75)
    turn = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    before = path_lengths(fan, origins, directions)
    after = path_lengths(fan, origins @ turn.T, directions @ turn.T)
    assert (before > 0).mean() > 0.1
    assert np.allclose(after, before, rtol=0, atol=1e-6)


def test_volume_is_hub_and_blades_less_what_they_share(
    fan: Phantom, overlapping: Callable[..., Any]
) -> None:
    blade = Blade(fan)
    tree = fan.document.model_dump(mode="json")
    whole = hub_volume(fan) + 3 * blade.volume
    # Where densities add, everything counts as often as it is there.
    added = load({**tree, "solid": overlapping(tree["solid"])})
    assert measure(added).volume_mm3 == pytest.approx(whole, rel=1e-3)
    hub, first = tree["solid"]["solids"][:2]
    shared = load({**tree, "solid": {"type": "intersection", "solids": [hub, first]}})
    rest = whole - 3 * measure(shared).volume_mm3
    assert measure(fan).volume_mm3 == pytest.approx(rest, rel=1e-3)


@pytest.mark.parametrize(("root_pitch", "tip_pitch"), [(55.0, 15.0), (-30.0, 60.0)])
def test_blade_twists_from_root_to_tip(
    root_pitch: float, tip_pitch: float, along: Callable[..., Intervals]
) -> None:
    """A ray along the fan's axis crosses a section as it crosses an ellipse at that pitch."""
    fan = library.build("fan", root_pitch_deg=root_pitch, tip_pitch_deg=tip_pitch)
    blade = Blade(fan)
    for u in (0.3, 0.5, 0.7, 0.9):
        pitch = np.radians(root_pitch + u * (tip_pitch - root_pitch))
        chord = 2 / np.hypot(
            np.sin(pitch) / blade.half_length(u), np.cos(pitch) / blade.half_thickness(u)
        )
        z = blade.root + u * (blade.tip - blade.root)
        found = along(fan, "y", blade.shift(u), z)
        assert [found.leaf_names[leaf] for leaf in found.leaf] == ["blade-1"]
        assert found.exit_mm[0] - found.entry_mm[0] == pytest.approx(chord, abs=1e-6)


def test_every_corner_of_the_range_is_a_fan() -> None:
    ranges = ((10.0, 300.0), (0.15, 0.35), (-80.0, 80.0), (-80.0, 80.0))
    names = ("radius_mm", "hub_share", "root_pitch_deg", "tip_pitch_deg")
    for corner in product(*ranges):
        fan = library.build("fan", **dict(zip(names, corner, strict=True)))
        assert fan.bounds[1, 2] == pytest.approx(corner[0], rel=0.02)


@pytest.mark.parametrize(
    "changed",
    [
        {"radius_mm": 100.0},
        {"hub_share": 0.3},
        {"root_pitch_deg": 40.0},
        {"tip_pitch_deg": 0.0},
        {"attenuation_per_mm": 0.1},
    ],
)
def test_every_parameter_changes_the_document(changed: dict[str, object]) -> None:
    usual, other = library.document("fan"), library.document("fan", changed)
    assert (usual.solid, usual.definitions, usual.materials) != (
        other.solid,
        other.definitions,
        other.materials,
    )
