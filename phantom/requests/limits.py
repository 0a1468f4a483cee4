"""What a request may cost, counted before anything is allocated for it."""

from __future__ import annotations

from dataclasses import dataclass

from phantom.errors import InvalidInputError, Problem

BYTES_PER_NUMBER = 8
IMAGES_PER_RADIOGRAPH = 4
"""Line integral, transmission, signal and the picture are held beside the path lengths."""


@dataclass(frozen=True, slots=True)
class Limits:
    """The most that one request may ask for.

    Attributes
    ----------
    pixels
        Of one radiograph.
    rays
        Of one path-length call.
    result_bytes
        Of the arrays that are computed.
    """

    pixels: int = 16384 * 16384
    rays: int = 10_000_000
    result_bytes: int = 8 * 2**30

    def check_radiograph(self, columns: int, rows: int, materials: int) -> None:
        """Refuse a radiograph that has too many pixels, or too many of them times materials."""
        pixels = columns * rows
        if pixels > self.pixels:
            _refuse("/detector", f"found {columns} × {rows} pixels", f"{self.pixels} at most")
        self._check_bytes("/detector", pixels * (materials + IMAGES_PER_RADIOGRAPH))

    def check_rays(self, rays: int, materials: int) -> None:
        """Refuse too many rays, or too many of them times materials."""
        if rays > self.rays:
            _refuse("/origins", f"found {rays} rays", f"{self.rays} at most")
        self._check_bytes("/origins", rays * materials)

    def _check_bytes(self, path: str, numbers: int) -> None:
        needed = numbers * BYTES_PER_NUMBER
        if needed > self.result_bytes:
            megabytes = f"{needed / 2**20:.0f} MiB of results"
            _refuse(path, f"found {megabytes}", f"{self.result_bytes / 2**20:.0f} MiB at most")


def _refuse(path: str, found: str, expected: str) -> None:
    raise InvalidInputError([Problem(path, "too_large", f"{found}; expected {expected}")])
