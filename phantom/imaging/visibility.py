"""How well a finding can be seen: its contrast, over the noise, and on a display.

All three hold the picture against that of the twin without the finding, of which nothing else
differs: so what is measured is the finding, and not the ribs behind it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.beam import Beam
from phantom.imaging.detection import Acquisition, NoiseKey
from phantom.imaging.exposure import radiograph
from phantom.imaging.presentation import Presentation, contrast_jnd
from phantom.imaging.result import Radiograph
from phantom.imaging.truth_trace import ground_truth
from phantom.imaging.view import View

if TYPE_CHECKING:
    from phantom.scene import Phantom

BoolArray = NDArray[np.bool_]

LEAST_BOX: Final = 16
"""Pixels each way that noise is measured over, as far as the field goes: 256 tell it to 4 %."""


class Visibility(NamedTuple):
    """How well one finding can be seen.

    Attributes
    ----------
    finding
        Its name.
    pixels
        How many pixels its leaves cover.
    contrast
        Mean over these of (signal - twin's) / twin's, without noise; below 0 where the finding
        takes photons away. None where it covers no pixel that the twin has any signal in.
    contrast_to_noise
        Mean over these of signal - twin's, over the standard deviation of the noise in the box
        around them, of `LEAST_BOX` pixels each way or more; of one pixel, so that it does not grow
        with the finding's size. None where there is no noise, or where the finding covers no pixel.
    jnd
        Mean over these of the just-noticeable differences between picture and twin on a display,
        positive where the finding is brighter; None where no display is given.
    """

    finding: str
    pixels: int
    contrast: float | None
    contrast_to_noise: float | None
    jnd: float | None


def visibility(
    phantom: Phantom,
    twin: Phantom,
    view: View,
    beam: Beam | None = None,
    *,
    acquisition: Acquisition | None = None,
    noise: NoiseKey | None = None,
    presentation: Presentation | None = None,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[Visibility, ...]:
    """Tell how well each finding of a phantom can be seen.

    Parameters
    ----------
    phantom, twin
        With its findings, and without them; where it has several they are seen together.
    view, beam, acquisition, noise
        As in :func:`phantom.imaging.radiograph`.
    presentation
        For just-noticeable differences: with a ``gsdf``, and a scope that is fixed, since both
        pictures must have the same greys.

    Raises
    ------
    InvalidInputError
        The presentation has no display, or its greys depend on the image (``/presentation``).
    """
    if presentation is not None:
        check_display(presentation)

    def trace(of: Phantom, exposed: Acquisition | None) -> Radiograph:
        return radiograph(
            of,
            view,
            beam,
            acquisition=exposed,
            noise=noise if exposed is not None and exposed.draws else None,
            workers=workers,
            cancelled=cancelled,
        )

    quiet = _quiet(acquisition)
    seen, usual = trace(phantom, quiet), trace(twin, quiet)
    grain = None
    if acquisition is not None and acquisition.draws:
        grain = trace(twin, acquisition).signal - usual.signal
    truth = ground_truth(phantom, view, ("masks",), workers=workers, cancelled=cancelled)
    found = []
    for finding in phantom.document.findings:
        mask = np.zeros(usual.signal.shape, dtype=np.bool_)
        for leaf in truth.leaves:
            if leaf.name in finding.leaves:
                mask |= leaf.mask
        found.append(_seen(finding.name, mask, seen, usual, grain, presentation))
    return tuple(found)


def check_display(presentation: Presentation) -> None:
    """Refuse a presentation in which just-noticeable differences mean nothing.

    Raises
    ------
    InvalidInputError
        It has no display, or its greys depend on the image (``/presentation``).
    """
    if presentation.gsdf is None or presentation.mode != "window":
        message = "expected a window and a gsdf, so that both pictures have one scale of greys"
        raise InvalidInputError([Problem(presentation.place, "missing", message)])


def _quiet(acquisition: Acquisition | None) -> Acquisition | None:
    """Return the exposure without its noise."""
    if acquisition is None:
        return None
    detector = acquisition.detector.model_copy(update={"electronic_noise": 0.0})
    return acquisition.model_copy(update={"quantum_noise": "off", "detector": detector})


def _seen(
    name: str,
    mask: BoolArray,
    seen: Radiograph,
    usual: Radiograph,
    grain: NDArray[np.float64] | None,
    presentation: Presentation | None,
) -> Visibility:
    if not mask.any():
        return Visibility(name, 0, None, None, None)
    before = usual.signal[mask]
    change = seen.signal[mask] - before
    some = before > 0.0
    spread = None if grain is None else float(np.std(grain[_box(mask)]))
    jnd = None
    if presentation is not None:
        # One picture under the other: the finding above, the same place of the twin below.
        both = np.concatenate([r.presented("signal", presentation) for r in (seen, usual)])
        nothing = np.zeros_like(mask)
        above, below = np.concatenate([mask, nothing]), np.concatenate([nothing, mask])
        jnd = contrast_jnd(both, above, below, presentation)
    return Visibility(
        name,
        int(np.count_nonzero(mask)),
        float(np.mean(change[some] / before[some])) if some.any() else None,
        float(change.mean() / spread) if spread else None,
        jnd,
    )


def _box(mask: BoolArray) -> tuple[slice, slice]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return _wide(rows, mask.shape[0]), _wide(columns, mask.shape[1])


def _wide(at: NDArray[np.intp], size: int) -> slice:
    """Return the range of these pixels, widened to both sides where it is too narrow."""
    begin, end = int(at[0]), int(at[-1]) + 1
    missing = max(0, LEAST_BOX - (end - begin))
    begin = max(0, min(begin - missing // 2, size - LEAST_BOX))
    return slice(begin, max(begin + LEAST_BOX, end))
