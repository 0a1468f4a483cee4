"""The description of the service: OpenAPI, and a page that reads it without any other network."""

from __future__ import annotations

from importlib import resources
from typing import Any

from fastapi import APIRouter, FastAPI, Request
from fastapi.openapi.utils import get_openapi
from fastapi.responses import HTMLResponse, Response
from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

REF_TEMPLATE = "#/components/schemas/{model}"

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>phantom: the HTTP service</title>
<link rel="stylesheet" href="{root}/docs/swagger-ui.css">
<link rel="icon" type="image/png" href="{root}/docs/favicon-32x32.png">
</head>
<body>
<div id="swagger-ui" data-openapi="{root}/openapi.json"></div>
<script src="{root}/docs/swagger-ui-bundle.js"></script>
<script src="{root}/docs/start.js"></script>
</body>
</html>
"""

START = """const place = document.getElementById("swagger-ui");
SwaggerUIBundle({ url: place.dataset.openapi, domNode: place, deepLinking: true });
"""

ASSETS = {
    "swagger-ui-bundle.js": "text/javascript",
    "swagger-ui.css": "text/css",
    "favicon-32x32.png": "image/png",
}


def routes() -> APIRouter:
    """Serve Swagger UI from the files of the ``fastapi-swagger`` distribution."""
    router = APIRouter(include_in_schema=False)

    @router.get("/docs")
    def page(request: Request) -> HTMLResponse:
        root = request.scope.get("root_path", "")
        return HTMLResponse(PAGE.format(root=root), headers={"Content-Security-Policy": POLICY})

    @router.get("/docs/start.js")
    def start() -> Response:
        return Response(START, media_type="text/javascript")

    def serve(name: str, media_type: str) -> None:
        @router.get(f"/docs/{name}")
        def asset() -> Response:
            content = resources.files("fastapi_swagger.resources").joinpath(name).read_bytes()
            return Response(
                content, media_type=media_type, headers={"Cache-Control": "max-age=86400"}
            )

    for name, media_type in ASSETS.items():
        serve(name, media_type)
    return router


def reference(model: type[BaseModel]) -> dict[str, str]:
    """Return the schema that points at the model among the components."""
    return {"$ref": REF_TEMPLATE.format(model=model.__name__)}


def body(*contents: tuple[str, dict[str, Any]]) -> dict[str, Any]:
    """Return the OpenAPI description of a body that the application decodes itself."""
    return {
        "requestBody": {
            "required": True,
            "content": {media_type: {"schema": schema} for media_type, schema in contents},
        }
    }


def install(app: FastAPI, models: tuple[type[BaseModel], ...], *, with_key: bool) -> None:
    """Make ``/openapi.json`` show the bodies that are not FastAPI's to parse, and the key."""

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            schema = get_openapi(
                title=app.title,
                version=app.version,
                description=app.description,
                routes=app.routes,
            )
            _, bodies = models_json_schema(
                [(model, "validation") for model in models], ref_template=REF_TEMPLATE
            )
            components = schema.setdefault("components", {})
            components["schemas"] = {**bodies["$defs"], **components.get("schemas", {})}
            if with_key:
                components["securitySchemes"] = {"key": {"type": "http", "scheme": "bearer"}}
                schema["security"] = [{"key": []}]
            app.openapi_schema = schema
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]
