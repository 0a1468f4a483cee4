"""Pictures in visible light."""

from __future__ import annotations

import json
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.responses import Response

from api.bodies import JSON, read_json
from api.documentation import body, reference
from api.negotiation import negotiate
from api.problems import PROBLEMS
from api.routes.radiographs import BINARY, entity_tag
from api.service import Service
from phantom.encode import FORMATS, encode, format_named
from phantom.encode.content import COLOR
from phantom.encode.formats import SVG
from phantom.requests.draw import DrawPlan, DrawRequest, plan_draw, quantity_of

FORMS: Final = (*(f.media_type for f in FORMATS if COLOR in f.quantities), SVG.media_type)
"""What an answer may be, the first where the caller does not mind; JSON is all but the pixels."""

ANSWERS: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "The picture, its numbers, or what is known of it",
        "content": {
            **dict.fromkeys(FORMS, BINARY),
            JSON: {"schema": {"type": "object"}},
        },
    },
}


def routes(service: Service) -> APIRouter:
    """Look at phantoms."""
    router = APIRouter(prefix="/v1/renders", tags=["renders"], responses=PROBLEMS)

    @router.post(
        "",
        summary="A picture of any phantom in visible light",
        response_class=Response,
        responses=ANSWERS,
        openapi_extra=body((JSON, reference(DrawRequest))),
    )
    async def post(request: Request) -> Response:
        form = negotiate(request.headers.get("accept"), FORMS)
        tree = await read_json(request, service.settings.max_json_bytes)

        def look(_: object) -> DrawPlan:
            return plan_draw(tree, (), service.limits)

        planned = await service.workshop.run(request, look)
        format = format_named(form)
        planned.check_format(format)

        def make(cancelled: Any) -> tuple[bytes, dict[str, str]]:
            made = planned.render(cancelled=cancelled)
            told = {"X-Phantom-Geometry": json.dumps(made.geometry(), separators=(",", ":"))}
            return encode(made, quantity_of(format), planned.request.tone, form).data, told

        content, told = await service.workshop.run(request, make)
        headers = {"ETag": entity_tag(planned.fingerprint(), form), "Vary": "Accept"}
        return Response(content, media_type=form, headers=headers | told)

    return router
