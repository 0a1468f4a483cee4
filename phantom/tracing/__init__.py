"""Rays through a phantom: checks, threads and the kernels."""

from phantom.tracing.measure import Measure, measure
from phantom.tracing.points import materials_at
from phantom.tracing.pool import default_workers, warm
from phantom.tracing.raster import raster, raster_bands
from phantom.tracing.rays import Intervals, intervals, path_lengths
from phantom.tracing.seen import FirstHits, first_hits

__all__ = [
    "FirstHits",
    "Intervals",
    "Measure",
    "default_workers",
    "first_hits",
    "intervals",
    "materials_at",
    "measure",
    "path_lengths",
    "raster",
    "raster_bands",
    "warm",
]
