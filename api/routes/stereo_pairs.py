"""Stereo pairs: what radiographs and pictures in visible light are, for two eyes."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.responses import Response

from api.bodies import JSON, read_json
from api.documentation import body, reference
from api.negotiation import negotiate
from api.problems import PROBLEMS
from api.routes.radiographs import BINARY, FORMS, GEOMETRY, entity_tag
from api.service import Service
from phantom.encode import ZIP_MEDIA_TYPE, Format, format_named
from phantom.imaging import StereoPair, Truth
from phantom.requests.render_pair import RenderPairPlan, RenderPairRequest, plan_render_pair
from phantom.requests.stereo import StereoPlan, StereoRequest, plan_pair
from phantom.requests.stereo_files import archived, encoded, forms_of, settle
from phantom.visible import PicturePair

EITHER: Final = {"anyOf": [reference(StereoRequest), reference(RenderPairRequest)]}
"""The body: radiographs, or in visible light."""

ANSWERS: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "Both images in one picture, two views of an OpenEXR, or an archive",
        "content": {
            **dict.fromkeys(FORMS, BINARY),
            JSON: {"schema": {"type": "object"}},
        },
    },
}

OF_PAIR: Final = (
    "method",
    "mono",
    "baseline_mm",
    "angle_deg",
    "zero_depth_mm",
    "epipolar_matrix",
    "disparity",
    "comfort",
)
"""What of a pair travels in the header ``X-Phantom-Geometry``, beside the geometry of each eye."""


def routes(service: Service) -> APIRouter:
    """Make stereo pairs."""
    router = APIRouter(prefix="/v1/stereo-pairs", tags=["stereo pairs"], responses=PROBLEMS)

    @router.post(
        "",
        summary="Pictures of any phantom for the left and the right eye",
        description="Radiographs, or with a `camera` pictures in visible light.",
        response_class=Response,
        responses=ANSWERS,
        openapi_extra=body((JSON, EITHER)),
    )
    async def post(request: Request) -> Response:
        tree = await read_json(request, service.settings.max_json_bytes)

        def look(_: object) -> tuple[StereoPlan | RenderPairPlan, str]:
            seen = isinstance(tree, Mapping) and "camera" in tree
            plan = plan_render_pair if seen else plan_pair
            planned = plan(tree, (), service.limits)
            form = negotiate(request.headers.get("accept"), forms_of(planned))
            settle(planned, _format(form))
            return planned, form

        planned, form = await service.workshop.run(request, look)

        def make(cancelled: Any) -> tuple[bytes, dict[str, str]]:
            pair, truths = _traced(planned, cancelled)
            files = encoded(planned, pair, _format(form))
            if form == ZIP_MEDIA_TYPE:
                return archived(planned, pair, files, truths), _told(pair, planned)
            (file,) = files.values()
            return file.data, _told(pair, planned)

        content, told = await service.workshop.run(request, make)
        headers = {"ETag": entity_tag(planned.fingerprint(), form), "Vary": "Accept"}
        return Response(content, media_type=form, headers=headers | told)

    return router


def _traced(
    planned: StereoPlan | RenderPairPlan, cancelled: Callable[[], bool]
) -> tuple[StereoPair | PicturePair, Mapping[str, Truth]]:
    """Return both images, and the ground truth of each where that is asked for."""
    if isinstance(planned, RenderPairPlan):
        return planned.render(cancelled=cancelled), {}
    pair = planned.render(cancelled=cancelled)
    return pair, planned.tell(pair, cancelled=cancelled)


def _format(form: str) -> Format | None:
    """Return the format of a media type; None for an archive."""
    return None if form == ZIP_MEDIA_TYPE else format_named(form)


def _told(pair: StereoPair | PicturePair, planned: StereoPlan | RenderPairPlan) -> dict[str, str]:
    """Return the headers that say what the body cannot; none of a blind pair."""
    if planned.blind:
        return {}
    metadata = pair.metadata()
    told: dict[str, Any] = {name: metadata["stereo"][name] for name in OF_PAIR}
    for eye, image in metadata["images"].items():
        told[eye] = {name: image[name] for name in (*GEOMETRY, "camera") if name in image}
    return {"X-Phantom-Geometry": json.dumps(told, separators=(",", ":"))}
