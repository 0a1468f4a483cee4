"""Jobs: how far they are, as they go, what they gave, and their end."""

from __future__ import annotations

import hashlib
import json
from collections.abc import AsyncIterator
from http import HTTPStatus
from pathlib import Path
from typing import Final

from anyio import sleep
from anyio.to_thread import run_sync
from fastapi import APIRouter
from fastapi.responses import FileResponse, StreamingResponse
from pydantic import BaseModel, Field

from api.job import OVER, Job
from api.problems import PROBLEMS, RefusedError
from api.service import Service
from phantom.datasets.names import STATE

LOOK_S: Final = 0.5
QUIET_S: Final = 15.0
"""A comment is sent after this long, so that nobody takes a quiet line for a dead one."""

EVENTS: Final = "text/event-stream"


class JobStatus(BaseModel):
    """A job."""

    id: str
    state: str = Field(description="queued, running, out_of_space, done, failed or cancelled")
    images: int = Field(description="of the whole set")
    done: int
    set_aside: int = Field(description="images that could not be made in three tries")
    images_per_s: float | None = None
    seconds_left: float | None = None
    bytes: int = Field(description="of the set; expected until it is done")
    created_unix_s: float
    problem: str | None = Field(None, description="why it failed, or waits")
    results: str = Field(description="where the files are, relative to this")


class ResultFile(BaseModel):
    """A file of a set."""

    name: str
    bytes: int
    href: str = Field(description="relative to this list")


def told(job: Job) -> JobStatus:
    """Return what a caller may know of a job."""
    return JobStatus(
        id=job.id,
        state=job.state,
        images=job.images,
        done=job.done,
        set_aside=job.aside,
        images_per_s=job.images_per_s,
        seconds_left=job.seconds_left,
        bytes=job.bytes,
        created_unix_s=job.created,
        problem=job.problem,
        results=f"{job.id}/results",
    )


def routes(service: Service) -> APIRouter:
    """Tell of jobs, stream how they go, hand out their files, and end them."""
    router = APIRouter(prefix="/v1/jobs", tags=["jobs"], responses=PROBLEMS)
    jobs = service.jobs

    @router.get("", summary="Every job, the newest first")
    def every() -> list[JobStatus]:
        return [told(job) for job in jobs.all()]

    @router.get("/{job}", summary="How far a job is")
    def status(job: str) -> JobStatus:
        return told(jobs.get(job))

    @router.delete("/{job}", summary="Cancel a job, or forget one that is over")
    def cancel(job: str) -> JobStatus:
        return told(jobs.cancel(job))

    @router.get(
        "/{job}/events",
        summary="How it goes, as it goes (server-sent events)",
        response_class=StreamingResponse,
        responses={200: {"content": {EVENTS: {"schema": {"type": "string"}}}}},
    )
    async def events(job: str) -> StreamingResponse:
        await run_sync(jobs.get, job)
        return StreamingResponse(
            _events(service, job), media_type=EVENTS, headers={"Cache-Control": "no-store"}
        )

    @router.get("/{job}/results", summary="The files that are there")
    def results(job: str) -> list[ResultFile]:
        found = _ready(service, jobs.get(job))
        folder = jobs.results(found)
        names = sorted(
            path.relative_to(folder).as_posix()
            for path in folder.rglob("*")
            if path.is_file() and STATE not in path.relative_to(folder).parts
        )
        return [
            ResultFile(name=n, bytes=(folder / n).stat().st_size, href=f"results/{n}")
            for n in names
        ]

    @router.get(
        "/{job}/results/{name:path}",
        summary="One of them",
        response_class=FileResponse,
        responses={200: {"content": {"*/*": {"schema": {"type": "string", "format": "binary"}}}}},
    )
    def result(job: str, name: str) -> FileResponse:
        folder = jobs.results(_ready(service, jobs.get(job))).resolve()
        return FileResponse(_inside(folder, name))

    return router


def _ready(service: Service, job: Job) -> Job:
    """Return a job whose files may be read; 507 where it waits for room."""
    if job.state == "out_of_space":
        detail = f"no room is left; {job.done} of {job.images} images are kept"
        raise RefusedError(HTTPStatus.INSUFFICIENT_STORAGE, detail)
    return job


def _inside(folder: Path, name: str) -> Path:
    """Return a file below a folder; 404 for any other."""
    try:
        path = (folder / name).resolve()
        good = path.is_relative_to(folder) and path.is_file()
        good = good and STATE not in path.relative_to(folder).parts
    except (OSError, ValueError):
        good = False
    if not good:
        raise RefusedError(HTTPStatus.NOT_FOUND, "no such file")
    return path


async def _events(service: Service, number: str) -> AsyncIterator[str]:
    """Yield the state of a job whenever it changes, until it is over."""
    last, quiet = "", 0.0
    while True:
        try:
            job = await run_sync(service.jobs.get, number)
        except RefusedError:
            return  # forgotten meanwhile
        shown = told(job).model_dump(mode="json")
        same = {k: v for k, v in shown.items() if k not in ("images_per_s", "seconds_left")}
        digest = hashlib.sha256(json.dumps(same).encode()).hexdigest()
        if digest != last:
            last, quiet = digest, 0.0
            yield f"event: {job.state}\ndata: {json.dumps(shown)}\n\n"
        elif quiet >= QUIET_S:
            quiet = 0.0
            yield ": still there\n\n"
        if job.state in OVER:
            return
        await sleep(LOOK_S)
        quiet += LOOK_S
