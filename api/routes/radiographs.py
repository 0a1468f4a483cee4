"""Radiographs: the same picture from a JSON body, or from a browser's address bar."""

from __future__ import annotations

import hashlib
import json
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.responses import Response

from api.bodies import JSON, read_json
from api.documentation import body, reference
from api.negotiation import negotiate
from api.problems import PROBLEMS
from api.query import DESCRIBED, radiograph_tree
from api.service import Service
from phantom import library
from phantom.encode import FORMATS, ZIP_MEDIA_TYPE, Encoded, encode, format_named
from phantom.errors import InvalidInputError, Problem
from phantom.imaging import Radiograph
from phantom.requests.bundle import bundle, picture_format
from phantom.requests.radiograph import RadiographPlan, RadiographRequest, plan

OFFERS: Final = tuple(format.media_type for format in FORMATS)
"""What an answer may be, the first where the caller does not mind; JSON is all but the pixels."""

FORMS: Final = (*OFFERS, ZIP_MEDIA_TYPE)
"""With the archive of a request that asks for ground truth, which has no other form."""

CODING: Final = ("quantity", "codes_per_unit", "offset")
"""What travels in the header ``X-Phantom-Coding`` of numbers that are sent as codes."""

GEOMETRY: Final = (
    "projection_matrix",
    "intrinsics",
    "rotation",
    "translation_mm",
    "isocentre_mm",
    "magnification",
    "pitch_mm",
    "pitch_at_isocentre_mm",
)
"""Metadata that travels in the header ``X-Phantom-Geometry``; all of it is in the JSON answer."""

BINARY: Final = {"schema": {"type": "string", "format": "binary"}}
ANSWERS: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "The picture, its numbers, what is known of it, or it with its ground truth",
        "content": {
            **dict.fromkeys(FORMS, BINARY),
            JSON: {"schema": {"type": "object"}},
        },
    },
    304: {"description": "Not changed"},
}


def routes(service: Service) -> APIRouter:
    """Make radiographs."""
    router = APIRouter(prefix="/v1/radiographs", tags=["radiographs"], responses=PROBLEMS)

    @router.post(
        "",
        summary="A radiograph of any phantom",
        response_class=Response,
        responses=ANSWERS,
        openapi_extra=body((JSON, reference(RadiographRequest))),
    )
    async def post(request: Request) -> Response:
        wanted = negotiate(request.headers.get("accept"), FORMS)
        tree = await read_json(request, service.settings.max_json_bytes)
        return await _answer(service, request, wanted, tree)

    described = {"parameters": DESCRIBED}

    @router.get(
        "/{name}",
        summary="A radiograph of a library phantom",
        description="Parameters of the phantom itself are written `parameters.radius_mm=30`.",
        response_class=Response,
        responses=ANSWERS,
        openapi_extra=described,
    )
    @router.head("/{name}", response_class=Response, include_in_schema=False)
    async def get(name: str, request: Request) -> Response:
        wanted = negotiate(request.headers.get("accept"), FORMS)
        library.entry(name)
        tree, known = radiograph_tree(name, request.query_params)
        return await _answer(service, request, wanted, tree, known)

    return router


async def _answer(
    service: Service,
    request: Request,
    wanted: str,
    tree: object,
    known: tuple[Problem, ...] = (),
) -> Response:
    """Return the radiograph, or only its headers where the caller has it or asks for no more."""

    def look(_: object) -> tuple[RadiographPlan, str]:
        planned = plan(tree, known, service.limits)
        form = wanted
        if planned.truth:
            form = negotiate(request.headers.get("accept"), (ZIP_MEDIA_TYPE,))
        elif wanted == ZIP_MEDIA_TYPE:
            message = "found no kinds of ground truth; expected some, for an archive holds them"
            raise InvalidInputError([Problem("/truth", "missing", message)])
        planned.check_format(picture_format(planned) if planned.truth else format_named(form))
        return planned, form

    planned, wanted = await service.workshop.run(request, look)
    headers = {"ETag": entity_tag(planned.fingerprint(), wanted), "Vary": "Accept"}
    if request.method != "POST":
        scope = "public" if service.settings.api_key is None else "private"
        headers["Cache-Control"] = f"{scope}, max-age=86400, immutable"
        if _has(request, headers["ETag"]):
            return Response(status_code=304, headers=headers)
        if request.method == "HEAD":
            return _HeadResponse(media_type=wanted, headers=headers)

    def make(cancelled: Any) -> tuple[bytes, dict[str, str]]:
        made = planned.render(cancelled=cancelled)
        if planned.truth:
            data, picture = bundle(planned, made, planned.tell(cancelled=cancelled))
            return data, _told(made, picture, planned)
        encoded = encode(made, planned.quantity, planned.presentation, wanted, blind=planned.blind)
        return encoded.data, _told(made, encoded, planned)

    content, told = await service.workshop.run(request, make)
    return Response(content, media_type=wanted, headers=headers | told)


class _HeadResponse(Response):
    """Headers without the length of a body that was never made (RFC 9110, section 9.3.2)."""

    def init_headers(self, headers: Any = None) -> None:
        super().init_headers(headers)
        del self.headers["content-length"]


def entity_tag(fingerprint: str, wanted: str) -> str:
    """Return the strong entity tag of what a plan gives in a form (RFC 9110, section 8.8.3)."""
    digest = hashlib.sha256(f"{fingerprint} {wanted}".encode()).hexdigest()
    return f'"{digest[:32]}"'


def _has(request: Request, entity_tag: str) -> bool:
    """Tell whether the caller says that it has this very answer (weak comparison, RFC 9110)."""
    known = request.headers.get("if-none-match", "")
    tags = [tag.strip().removeprefix("W/") for tag in known.split(",")]
    return "*" in tags or entity_tag in tags


def _told(made: Radiograph, encoded: Encoded, planned: RadiographPlan) -> dict[str, str]:
    """Return the headers that say what the body cannot."""
    told = {}
    file = encoded.beside["file"]
    if file["holds"] == "codes":
        told["X-Phantom-Coding"] = json.dumps({name: file[name] for name in CODING})
    if not planned.blind:
        metadata = made.metadata()
        geometry = {name: metadata[name] for name in GEOMETRY}
        told["X-Phantom-Geometry"] = json.dumps(geometry, separators=(",", ":"))
    return told
