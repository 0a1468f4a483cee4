"""What a request may cost, counted before anything is allocated for it."""

from __future__ import annotations

from dataclasses import dataclass

from phantom.errors import InvalidInputError, Problem

BYTES_PER_NUMBER = 8
IMAGES_PER_RADIOGRAPH = 4
"""Line integral, transmission, signal and the picture are held beside the path lengths."""

IMAGES_PER_SAMPLE = 3
"""What each sample of a pixel adds to the detector's three sums, beside its path lengths."""

IMAGES_PER_EXPOSURE = 24
"""The sums, noise, and the parts of a blur, while the detector's image is made."""

MAPS_PER_LEAF = 2
"""Thickness and entry depth of each leaf, where it fills the picture."""

NUMBERS_PER_COLOR = 13
"""Light, coverage, and what stands between them and the levels of a file, of one pixel."""


@dataclass(frozen=True, slots=True)
class Limits:
    """The most that one request may ask for.

    Attributes
    ----------
    pixels
        Of one radiograph, or one picture in visible light.
    exposure_rays
        Of one radiograph: pixels, times the samples of each, times the points of the focal spot;
        of one picture in visible light: pixels times samples.
    rays
        Of one path-length call.
    result_bytes
        Of the arrays that are computed.
    """

    pixels: int = 16384 * 16384
    exposure_rays: int = 2**34
    rays: int = 10_000_000
    result_bytes: int = 8 * 2**30

    def check_radiograph(self, columns: int, rows: int, materials: int, images: int = 1) -> None:
        """Refuse radiographs that have too many pixels, or too many of them times materials."""
        pixels = columns * rows * images
        if pixels > self.pixels:
            found = f"found {_times(images)}{columns} × {rows} pixels"
            _refuse("/detector", found, f"{self.pixels} at most")
        self._check_bytes("/detector", pixels * (materials + IMAGES_PER_RADIOGRAPH))

    def check_exposure(
        self,
        columns: int,
        rows: int,
        materials: int,
        samples: int,
        points: int,
        bins: int,
        images: int = 1,
    ) -> None:
        """Refuse a detector's image that takes too many rays, or too much memory.

        Parameters
        ----------
        samples, points
            Rays a pixel, and points of the focal spot, of which one at a time is in memory.
        bins
            Images of photons that are held at once: one an energy where each is drawn by itself.
        images
            Exposures, such as the two of a pair, one after the other.
        """
        pixels = columns * rows
        rays = pixels * samples * points * images
        if rays > self.exposure_rays:
            found = f"found {_times(images)}{columns} × {rows} pixels × {samples} samples"
            found = f"{found} × {points} points"
            _refuse("/acquisition", f"{found} of the focal spot", f"{self.exposure_rays} at most")
        sampled = 0 if samples == points == 1 else samples * (materials + IMAGES_PER_SAMPLE)
        kept = (materials + IMAGES_PER_RADIOGRAPH) * images
        self._check_bytes("/acquisition", pixels * (kept + IMAGES_PER_EXPOSURE + bins + sampled))

    def check_truth(self, columns: int, rows: int, leaves: int, images: int = 1) -> None:
        """Refuse ground truth of too many pixels times leaves, thickness and depth of each."""
        self._check_bytes("/truth", columns * rows * leaves * MAPS_PER_LEAF * images)

    def check_render(self, columns: int, rows: int, samples: int, images: int = 1) -> None:
        """Refuse pictures in visible light of too many pixels, or of too many rays.

        ``samples`` are those along a side of a pixel.
        """
        pixels = columns * rows * images
        if pixels > self.pixels:
            found = f"found {_times(images)}{columns} × {rows} pixels"
            _refuse("/camera", found, f"{self.pixels} at most")
        if pixels * samples**2 > self.exposure_rays:
            found = f"found {_times(images)}{columns} × {rows} pixels × {samples**2} samples"
            _refuse("/samples_per_pixel", found, f"{self.exposure_rays} at most")
        self._check_bytes("/camera", pixels * NUMBERS_PER_COLOR)

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


def _times(images: int) -> str:
    return "" if images == 1 else f"{images} × "


def _refuse(path: str, found: str, expected: str) -> None:
    raise InvalidInputError([Problem(path, "too_large", f"{found}; expected {expected}")])
