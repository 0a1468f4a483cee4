"""What an operator may set, through environment variables that begin with ``PHANTOM_``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from phantom.errors import InvalidInputError, Problem

PREFIX = "PHANTOM_"


class Settings(BaseModel):
    """Every setting; each field is the environment variable of its name in capitals."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    api_key: str | None = Field(None, min_length=16, pattern=r"^[\x21-\x7e]+$")
    """Key that every call but ``/healthz`` and the documentation must carry; none: open to all."""

    root_path: str = Field("", pattern=r"^(/[A-Za-z0-9._~-]+)*$")
    """Path under which a proxy publishes the service."""

    max_json_bytes: int = Field(4 * 2**20, ge=1024)
    """Longest JSON body."""

    max_npy_bytes: int = Field(64 * 2**20, ge=1024)
    """Longest NPY body."""

    max_pixels: int = Field(4096 * 4096, ge=1)
    """Most pixels of one radiograph."""

    max_exposure_rays: int = Field(2**28, ge=1)
    """Most rays of one radiograph: pixels times samples of each times points of the focal spot."""

    max_rays: int = Field(1_000_000, ge=1)
    """Most rays of one path-length call."""

    max_result_bytes: int = Field(2 * 2**30, ge=2**20)
    """Most memory that the arrays of one call may take."""

    renders: int = Field(2, ge=1, le=64)
    """Calls that trace at the same time."""

    queue: int = Field(32, ge=0)
    """Calls that may wait for their turn; beyond them the answer is 429."""

    jobs_folder: Path | None = None
    """Where data sets are made and kept; by default with the user's other states."""

    jobs_ttl_hours: float = Field(168, gt=0, allow_inf_nan=False)
    """Hours that a data set is kept after it is finished."""

    jobs_max_bytes: int = Field(100 * 10**9, ge=1)
    """Most that all data sets may take together."""

    jobs_max_images: int = Field(1_000_000, ge=1)
    """Most images of one data set."""

    jobs_workers: int = Field(1, ge=1, le=1024)
    """Processes that make the images of data sets."""

    @classmethod
    def from_environment(cls, environment: Mapping[str, str]) -> Settings:
        """Read the settings; a variable that is not set keeps its default.

        Raises
        ------
        InvalidInputError
            Every variable whose value does not do; the values themselves are not repeated.
        """
        given = {
            name: environment[PREFIX + name.upper()]
            for name in cls.model_fields
            if PREFIX + name.upper() in environment
        }
        try:
            return cls.model_validate(given)
        except ValidationError as error:
            raise InvalidInputError(
                Problem(PREFIX + str(e["loc"][0]).upper(), "bad_setting", e["msg"])
                for e in error.errors(include_input=False)
            ) from None
