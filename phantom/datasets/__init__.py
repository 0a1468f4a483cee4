"""Data sets: from a design to a finished, checkable set of images whose state is known."""

from __future__ import annotations

from phantom.datasets.design import Design
from phantom.datasets.forecast import Forecast, forecast
from phantom.datasets.opening import read_design
from phantom.datasets.parts import Part
from phantom.datasets.quick import quick
from phantom.datasets.sets import Run, make, merge
from phantom.datasets.streaming import Stream, stream

__all__ = [
    "Design",
    "Forecast",
    "Part",
    "Run",
    "Stream",
    "forecast",
    "make",
    "merge",
    "quick",
    "read_design",
    "stream",
]
