"""Whether eyes can bear a pair, in numbers and in words.

Within 1° a pair is comfortable to most. Of 392 young people 84 % could still fuse 2.04° uncrossed
and 1.84° crossed, and half of them 3.05° and 3.34° (S. Nagata, *Trans. Virtual Reality Soc. Japan*
7 (2002) 239). The bounds here are those, rounded to whole degrees.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final, Literal

from phantom.stereo.disparity import Disparity
from phantom.stereo.screen import Screen

COMFORTABLE_DEG: Final = 1.0
FUSIBLE_DEG: Final = 2.0
HALF_DEG: Final = 3.0
WORTH_TELLING_DEG: Final = 0.01
"""Less than this of vertical disparity is not mentioned."""

Level = Literal["flat", "comfortable", "fusible", "hard", "not_fusible"]


@dataclass(frozen=True, slots=True)
class Comfort:
    """What a pair asks of the eyes.

    Attributes
    ----------
    level
        ``flat`` (no depth), ``comfortable`` (within 1°), ``fusible`` (within 2°, by about 84 % of
        people), ``hard`` (within 3°, by about half) or ``not_fusible``.
    verdict
        A sentence or two for people.
    crossed_deg, uncrossed_deg
        Greatest disparity nearer than the screen, and farther, both from 0; None where part of the
        phantom lies beside or behind an eye.
    vertical_deg
        Greatest difference in height.
    """

    level: Level
    verdict: str
    crossed_deg: float | None
    uncrossed_deg: float | None
    vertical_deg: float | None

    def told(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        return asdict(self)


def comfort(whole: Disparity, parts: Sequence[Disparity], screen: Screen) -> Comfort:
    """Judge a pair.

    Parameters
    ----------
    whole
        The disparity of everything that can be seen.
    parts
        Those of the structures, of which the worst is named.
    screen
        Where the pair is shown.
    """
    if whole.degrees is None or whole.pixels is None or whole.vertical_px is None:
        words = "cannot be fused: part of the phantom lies beside or behind the place of an eye"
        return Comfort("not_fusible", words, None, None, None)
    crossed, uncrossed = max(whole.degrees[1], 0.0), max(-whole.degrees[0], 0.0)
    vertical = float(screen.vertical_degrees(whole.vertical_px))
    level, words = _judged(max(crossed, uncrossed), _worst(parts))
    if -whole.pixels[0] > screen.parallel_px:
        level, words = "not_fusible", f"{words}; the eyes would have to look outward"
    if vertical > WORTH_TELLING_DEG:
        words = f"{words}; left and right differ by up to {vertical:.2g}° in height"
    return Comfort(level, words, crossed, uncrossed, vertical)


def _judged(worst_deg: float, name: str) -> tuple[Level, str]:
    asked = f"{worst_deg:.2f}° from the screen{name}"
    if worst_deg == 0.0:
        return "flat", "flat: both eyes see the same"
    # What was chosen to be within a bound may lie on it, but for rounding.
    if worst_deg <= COMFORTABLE_DEG + 1e-9:
        return "comfortable", f"comfortable: nothing is more than {asked}, within 1°"
    if worst_deg <= FUSIBLE_DEG:
        return "fusible", f"fusible by about 84 % of people, not comfortable: up to {asked}"
    if worst_deg <= HALF_DEG:
        return "hard", f"hard: fusible by about half of all people: up to {asked}"
    return "not_fusible", f"not fusible by most people: up to {asked}"


def _worst(parts: Sequence[Disparity]) -> str:
    """Return the name of the leaf with the greatest disparity, as the sentence ends with it."""
    sizes = [
        (max(abs(part.degrees[0]), abs(part.degrees[1])), part.name)
        for part in parts
        if part.degrees is not None and part.kind == "leaf"
    ]
    return f" ({max(sizes)[1]})" if sizes else ""
