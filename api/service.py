"""What every route shares: the settings, the limits they set, and the place where work is done."""

from __future__ import annotations

from dataclasses import dataclass

from api.jobs import Jobs, default_folder
from api.settings import Settings
from api.work import Workshop
from phantom.requests.limits import Limits


@dataclass(frozen=True, slots=True)
class Service:
    """The running service."""

    settings: Settings
    limits: Limits
    workshop: Workshop
    jobs: Jobs

    @classmethod
    def of(cls, settings: Settings) -> Service:
        """Return the service that the settings describe."""
        limits = Limits(
            pixels=settings.max_pixels,
            exposure_rays=settings.max_exposure_rays,
            rays=settings.max_rays,
            result_bytes=settings.max_result_bytes,
        )
        jobs = Jobs(
            settings.jobs_folder or default_folder(),
            ttl_hours=settings.jobs_ttl_hours,
            max_bytes=settings.jobs_max_bytes,
            max_images=settings.jobs_max_images,
            workers=settings.jobs_workers,
            limits=limits,
        )
        return cls(settings, limits, Workshop(settings.renders, settings.queue), jobs)
