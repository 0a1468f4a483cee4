"""What every route shares: the settings, the limits they set, and the place where work is done."""

from __future__ import annotations

from dataclasses import dataclass

from api.settings import Settings
from api.work import Workshop
from phantom.requests.limits import Limits


@dataclass(frozen=True, slots=True)
class Service:
    """The running service."""

    settings: Settings
    limits: Limits
    workshop: Workshop

    @classmethod
    def of(cls, settings: Settings) -> Service:
        """Return the service that the settings describe."""
        limits = Limits(
            pixels=settings.max_pixels,
            exposure_rays=settings.max_exposure_rays,
            rays=settings.max_rays,
            result_bytes=settings.max_result_bytes,
        )
        return cls(settings, limits, Workshop(settings.renders, settings.queue))
