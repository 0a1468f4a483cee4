"""The phantom document, format ``phantom/1``."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from phantom.document.base import Length, Model, Name, Point, Text, by_shape, refuse, told
from phantom.document.solids import Solid
from phantom.document.substances import Material

Words = Annotated[str, Field(strict=True, max_length=1_000)]

REGION_CODE = "AnatomicRegionSequence"
"""The DICOM header (0008,2218) that a code of the anatomy may be for."""

CODE_PARTS = frozenset({"value", "scheme", "meaning"})


class Anatomy(Model):
    """What part of a body a phantom stands for."""

    region: Annotated[Words | None, told("Region", "none", "Part of the body, such as knee.")] = (
        None
    )
    laterality: Annotated[Words | None, told("Laterality", "none", "Side, such as left.")] = None
    codes: Annotated[
        dict[Name, Any],
        told(
            "Codes",
            "none",
            "Codes for image headers, by header; AnatomicRegionSequence, an object of value, scheme"
            " and meaning, is DICOM's.",
        ),
    ] = Field(default_factory=dict)

    @field_validator("codes")
    @classmethod
    def _region_has_a_code(cls, codes: dict[str, Any]) -> dict[str, Any]:
        code = codes.get(REGION_CODE)
        parts = code if isinstance(code, dict) else {}
        if code is not None and (
            set(parts) != CODE_PARTS or not all(isinstance(part, str) for part in parts.values())
        ):
            message = f"expected an object of the texts {', '.join(sorted(CODE_PARTS))}"
            refuse("wrong_shape", ((REGION_CODE,), message))
        return codes


class Finding(Model):
    """What a reader should find."""

    name: Annotated[Name, told("Name", "none", "Name of the finding.")]
    kind: Annotated[Words | None, told("Kind", "none", "What it is, such as fracture.")] = None
    leaves: Annotated[
        tuple[Words, ...], told("Leaves", "none", "Labels of the leaves that make it up.")
    ] = ()
    center: Annotated[Point | None, told("Centre", "mm", "Where it is.")] = None
    size_mm: Annotated[
        Annotated[
            Length | tuple[Length, Length, Length],
            by_shape("number", "array", expected="a number or three numbers"),
        ]
        | None,
        told("Size", "mm", "Its diameter, or its widths along x, y and z."),
    ] = None


class Document(Model):
    """A phantom as a person writes it."""

    format: Annotated[Literal["phantom/1"], told("Format", "none", "The format's name.")]
    name: Annotated[Name, told("Name", "none", "Short name, for files and requests.")] = "phantom"
    title: Annotated[Words, told("Title", "none", "One line for people.")] = ""
    description: Annotated[Text, told("Description", "none", "What the phantom shows.")] = ""
    materials: Annotated[
        dict[Name, Material], told("Materials", "none", "Name to material; the order is kept.")
    ] = Field(default_factory=dict)
    definitions: Annotated[
        dict[Name, Solid], told("Definitions", "none", "Name to a solid that instances can use.")
    ] = Field(default_factory=dict)
    solid: Annotated[Solid, told("Solid", "none", "The phantom itself.")]
    landmarks: Annotated[
        dict[Name, Point],
        told("Landmarks", "mm", "Name to point; presets aim at isocentre."),
    ] = Field(default_factory=dict)
    anatomy: Annotated[Anatomy | None, told("Anatomy", "none", "What part of a body this is.")] = (
        None
    )
    sources: Annotated[tuple[Words, ...], told("Sources", "none", "Citations.")] = ()
    parameters: Annotated[
        dict[Name, Any], told("Parameters", "none", "What the document was built from.")
    ] = Field(default_factory=dict)
    findings: Annotated[
        tuple[Finding, ...], told("Findings", "none", "What a reader should find.")
    ] = ()
