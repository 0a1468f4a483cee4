"""The (u, v) net of a phantom's leaves as a drawing of lines (paper figures 8 and 9).

Every line is sampled on the surface itself. Hidden lines are found by the exact renderer: a point
is seen where the first hit of the line of sight to it is the point itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.placed import placed_leaves
from phantom.document.identity import identity
from phantom.errors import CancelledError, InvalidInputError, Problem
from phantom.scene import Phantom
from phantom.tessellation.lines import Kind, Line, lines_of
from phantom.tracing.seen import first_hits
from phantom.tracing.shown import shown_leaves
from phantom.visible.camera import Camera
from phantom.visible.lights import Color
from phantom.visible.picture import COLOR, Picture
from phantom.visible.presets import CameraPreset
from phantom.visible.rendering import camera_of
from phantom.visible.strokes import covered
from phantom.visible.svg import svg
from phantom.visible.tone import srgb

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

DEFAULT_RINGS: Final = 24
DEFAULT_LINES: Final = 24
INK: Final[Color] = (0.0, 0.0, 0.0)
PAPER: Final[Color] = (1.0, 1.0, 1.0)
WIDTH: Final = 1.0
DRAWING: Final = "drawing"
"""What an SVG holds, as formats and requests call it."""

MAX_LINES: Final = 1000

_EDGES = 1e-3
_ON_SURFACE = 2e-4
"""A point nearer than this share of the phantom's diagonal to the first hit is the first hit."""

_PROBES = np.array([[0.36, 0.48, 0.8], [0.8, -0.6, 0.0], [0.48, 0.64, -0.6]])
"""Unit vectors across one another, along which a surface near a point is met."""

_SPACING = 2.0
_SHORTEST = 0.3
"""Stretches shorter than this, in pixels, are the ends of hidden lines at a corner that is seen."""

_HALVINGS = 4


@dataclass(frozen=True, eq=False)
class Stroke:
    """What is seen of one line.

    Attributes
    ----------
    leaf
        Label of the leaf on whose surface it lies.
    kind
        ``ring``, ``line`` or ``edge``.
    runs
        Its stretches, each ``(n, 2)`` columns and rows in pixels.
    """

    leaf: str
    kind: Kind
    runs: tuple[Floats, ...]


@dataclass(frozen=True, eq=False)
class Wireframe(Picture):
    """A drawing of lines: a picture with smooth edges, and the lines themselves.

    Attributes
    ----------
    strokes
        All lines of which something is seen, leaf by leaf.
    """

    strokes: tuple[Stroke, ...] = ()

    def quantity(self, name: str = COLOR) -> Floats:
        """Return the intensities, or of ``drawing`` the bytes of :meth:`svg`."""
        if name == DRAWING:
            return np.frombuffer(self.svg(), dtype=np.uint8)
        return super().quantity(name)

    def svg(self) -> bytes:
        """Return the drawing as SVG, in pixels."""
        return svg(
            self.strokes,
            self.camera.columns,
            self.camera.rows,
            title=str(self.told["phantom"]["name"]),
            ink=_hex(self.told["ink"]),
            paper=_hex(self.told["background"]),
            width=float(self.told["line_width_px"]),
        )


def wireframe(
    phantom: Phantom,
    camera: Camera | CameraPreset | None = None,
    *,
    rings: int = DEFAULT_RINGS,
    lines: int = DEFAULT_LINES,
    hidden_lines: bool = True,
    ink: Color = INK,
    background: Color = PAPER,
    line_width_px: float = WIDTH,
    hide: Sequence[str] = (),
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Wireframe:
    """Draw the net of a phantom's leaves.

    Parameters
    ----------
    phantom
        What is drawn.
    camera, hide
        As of :func:`phantom.render`; hidden leaves are not drawn.
    rings, lines
        Sections of each leaf, and lines along it, 2 to 1000 each. The flat faces of cuts are drawn
        by their edges, and a box by its own.
    hidden_lines
        True draws every line of every leaf that can surface, as through glass. False leaves out
        what lies behind a surface: then the operators hold too, for a line that they have taken
        away is not on the surface that is seen, and the walls that a difference cuts are drawn by
        the net of the leaf that cut them.
    ink, background
        Linear red, green and blue.
    line_width_px
        Of the lines.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts leaves.

    Raises
    ------
    InvalidInputError
        At ``/rings``, ``/lines``, ``/line_width_px`` or ``/hide/i``.
    CancelledError
        Where ``cancelled`` said yes.
    """
    check_drawing(rings, lines, line_width_px)
    shown = shown_leaves(phantom, hide)
    camera = camera_of(phantom, camera, shown)
    size = float(np.linalg.norm(phantom.bounds[1] - phantom.bounds[0]))
    surfacing = set(phantom.surfacing_leaves)
    placed = list(placed_leaves(phantom.document))
    strokes: list[Stroke] = []
    for index, (leaf, to) in enumerate(placed):
        if cancelled is not None and cancelled():
            raise CancelledError("the drawing was cancelled")
        if shown[index] and (not hidden_lines or index in surfacing):
            drawn = lines_of(leaf, rings, lines, _EDGES * size / to.scale)
            moved = [Line(line.kind, tuple(to.points(run) for run in line.runs)) for line in drawn]
            strokes += _strokes(phantom, camera, moved, index, hidden_lines, hide, size)
        if progress is not None:
            progress(index + 1, len(placed))
    share = covered(
        [run for stroke in strokes for run in stroke.runs],
        camera.rows,
        camera.columns,
        line_width_px,
    )
    rgb = share[..., None] * np.array(ink) + (1.0 - share)[..., None] * np.array(background)
    told = {
        **identity(phantom.document),
        "rings": rings,
        "lines": lines,
        "hidden_lines": hidden_lines,
        "ink": list(ink),
        "background": list(background),
        "line_width_px": line_width_px,
        "hidden": list(hide),
        "warnings": [] if share.any() else ["nothing of the phantom is in the picture"],
    }
    return Wireframe(rgb, share, camera, "wireframe", told, tuple(strokes))


def check_drawing(rings: int, lines: int, line_width_px: float) -> None:
    """Refuse numbers that are out of range.

    Raises
    ------
    InvalidInputError
        At ``/rings``, ``/lines`` or ``/line_width_px``.
    """
    problems = [
        Problem(f"/{name}", "out_of_range", f"found {value}; expected 2 to {MAX_LINES}")
        for name, value in (("rings", rings), ("lines", lines))
        if not 2 <= value <= MAX_LINES
    ]
    if not 0.1 <= line_width_px <= 100:
        message = f"found {line_width_px:g}; expected 0.1 to 100 pixels"
        problems.append(Problem("/line_width_px", "out_of_range", message))
    if problems:
        raise InvalidInputError(problems)


def _strokes(
    phantom: Phantom,
    camera: Camera,
    lines: list[Line],
    leaf: int,
    hidden_lines: bool,
    hide: Sequence[str],
    size: float,
) -> list[Stroke]:
    """Project a leaf's lines, and leave out what is hidden where that is asked for."""
    runs = [(k, run) for k, line in enumerate(lines) for run in line.runs]
    if not hidden_lines:
        close = [(k, _closer(camera, run)) for k, run in runs]
        runs = _seen(phantom, camera, close, hide, _ON_SURFACE * size)
    found: dict[int, list[Floats]] = {}
    for k, run in runs:
        at, _ = camera.project(run)
        sound = np.isfinite(at).all(axis=1)
        # What passes behind the eye ends there.
        for part in np.split(at, np.flatnonzero(np.diff(sound)) + 1):
            if len(part) > 1 and np.isfinite(part).all() and _length(part) >= _SHORTEST:
                found.setdefault(k, []).append(_thinned(part))
    label = phantom.leaf_names[leaf]
    return [Stroke(label, lines[k].kind, tuple(parts)) for k, parts in found.items()]


def _closer(camera: Camera, run: Floats) -> Floats:
    """Return a run with points between, until two are at most a few pixels apart."""
    at, _ = camera.project(run)
    lengths = np.nan_to_num(np.linalg.norm(np.diff(at, axis=0), axis=1))
    parts = np.clip(np.ceil(lengths / _SPACING), 1, 1000).astype(np.int64)
    owner = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(owner)) - (np.cumsum(parts) - parts)[owner]) / parts[owner]
    inner = run[owner] + share[:, None] * np.diff(run, axis=0)[owner]
    return np.concatenate([inner, run[-1:]])


def _seen(
    phantom: Phantom,
    camera: Camera,
    runs: list[tuple[int, Floats]],
    hide: Sequence[str],
    near_mm: float,
) -> list[tuple[int, Floats]]:
    """Return the stretches of runs that the camera sees, their ends found by halving."""
    if not runs:
        return []
    seen = _visible(phantom, camera, np.concatenate([run for _, run in runs]), hide, near_mm)
    flags = np.split(seen, np.cumsum([len(run) for _, run in runs])[:-1])
    turns = [np.flatnonzero(np.diff(flag)) for flag in flags]
    low = np.concatenate([run[turn] for (_, run), turn in zip(runs, turns, strict=True)])
    high = np.concatenate([run[turn + 1] for (_, run), turn in zip(runs, turns, strict=True)])
    first = np.concatenate([flag[turn] for flag, turn in zip(flags, turns, strict=True)])
    for _ in range(_HALVINGS if len(low) else 0):
        middle = 0.5 * (low + high)
        same = _visible(phantom, camera, middle, hide, near_mm) == first
        low, high = np.where(same[:, None], middle, low), np.where(same[:, None], high, middle)
    ends = np.split(0.5 * (low + high), np.cumsum([len(turn) for turn in turns])[:-1])
    found = []
    for (k, run), flag, turn, end in zip(runs, flags, turns, ends, strict=True):
        marks = [0, *(turn + 1).tolist(), len(run)]
        for i in range(len(marks) - 1):
            if not flag[marks[i]]:
                continue
            before = [end[i - 1]] if i else []
            after = [end[i]] if i < len(turn) else []
            part = np.array([*before, *run[marks[i] : marks[i + 1]], *after])
            if len(part) > 1:
                found.append((k, part))
    return found


def _visible(
    phantom: Phantom, camera: Camera, points: Floats, hide: Sequence[str], near_mm: float
) -> Flags:
    """Tell which points are the first that the camera sees on the way to them.

    A line of sight to the rim of a face may just miss it: so what has nothing before it is seen
    too, if it lies on the surface.
    """
    eye, forward = np.asarray(camera.eye, dtype=np.float64), camera.axes[2]
    if camera.parallel_width_mm is not None:
        depth = (points - eye) @ forward
        origins, ways = points - depth[:, None] * forward, np.broadcast_to(forward, points.shape)
    else:
        ways = points - eye
        depth = np.linalg.norm(ways, axis=1)
        origins = np.broadcast_to(eye, points.shape)
        ways = np.where(depth[:, None] > 0, ways, forward)
    off = first_hits(phantom, origins, ways, hide=hide).distance_mm - depth
    seen = np.abs(off) <= near_mm
    doubtful = np.flatnonzero((off > near_mm) & (depth > 0))
    for probe in _PROBES:
        start = points[doubtful] - near_mm * probe
        hits = first_hits(phantom, start, np.broadcast_to(probe, start.shape), hide=hide)
        on = hits.distance_mm <= 2 * near_mm
        seen[doubtful[on]] = True
        doubtful = doubtful[~on]
    return np.asarray(seen)


def _length(run: Floats) -> float:
    return float(np.linalg.norm(np.diff(run, axis=0), axis=1).sum())


def _thinned(run: Floats) -> Floats:
    """Leave out points that lie on the line between their neighbours, to a twentieth of a pixel."""
    kept = [0]
    for k in range(1, len(run) - 1):
        start, way = run[kept[-1]], run[k + 1] - run[kept[-1]]
        length = float(np.hypot(*way))
        inner = run[kept[-1] + 1 : k + 1] - start
        off = np.abs(inner[:, 0] * way[1] - inner[:, 1] * way[0]) / max(length, 1e-12)
        if length <= 0 or off.max() > 0.05 or np.any(inner @ way < 0):
            kept.append(k)
    return run[[*kept, len(run) - 1]]


def _hex(color: Sequence[float]) -> str:
    """Return linear light as sRGB, ``#rrggbb``."""
    levels = np.rint(srgb(np.array(color, dtype=np.float64)) * 255).astype(int)
    return "#" + "".join(f"{level:02x}" for level in levels.tolist())
