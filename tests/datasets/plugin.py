"""Phantoms of a package that only the tests install: cheap, with findings, and with a deadly one.

Workers are processes of their own, so what they build has to be found by entry points.
"""

from __future__ import annotations

import os
import signal
from typing import Annotated, Literal

from phantom.document import Document, Model, told
from phantom.document.base import Length
from phantom.errors import InvalidInputError, Problem
from phantom.library import Abnormality, Entry, PersonParameters, Technique


class Parameters(PersonParameters):
    half_mm: Annotated[Length, told("Half width", "mm", "Of the block.", le=100.0)] = 20.0


class Nodule(Abnormality):
    """A ball of bone in the block."""

    type: Literal["nodule"] = "nodule"
    radius_mm: Annotated[Length, told("Radius", "mm", "Of the ball.", le=50.0)] = 4.0
    x_mm: Annotated[float, told("Right", "mm", "Of the block's middle.", ge=-50, le=50)] = 0.0


class Void(Abnormality):
    """A ball of nothing."""

    type: Literal["void"] = "void"
    radius_mm: Annotated[Length, told("Radius", "mm", "Of the ball.", le=50.0)] = 3.0


def build(parameters: Parameters, abnormalities: tuple[Abnormality, ...] = ()) -> Document:
    half = parameters.half_mm
    block = {"type": "box", "name": "block", "material": "tissue", "center": [0.0, 0.0, 0.0]}
    solid: dict = {**block, "size": [2 * half] * 3}
    findings = []
    for i, wrong in enumerate(abnormalities):
        center = [getattr(wrong, "x_mm", 0.0), 0.0, 8.0 if wrong.type == "void" else 0.0]
        if abs(center[0]) + wrong.radius_mm > half:
            message = f"found {wrong.radius_mm:g}; expected it to fit into the block"
            raise InvalidInputError(
                [Problem(f"/abnormalities/{i}/radius_mm", "does_not_fit", message)]
            )
        name = wrong.name or wrong.type
        ball = {"type": "sphere", "name": name, "center": center, "radius": wrong.radius_mm}
        operator = "replace" if wrong.type == "nodule" else "difference"
        material = {"material": "bone"} if wrong.type == "nodule" else {}
        solid = {"type": operator, "solids": [solid, {**ball, **material}]}
        findings.append(
            {"name": name, "kind": wrong.type, "leaves": [name], "size_mm": 2 * wrong.radius_mm}
        )
    return Document.model_validate(
        {
            "format": "phantom/1",
            "name": "lesioned",
            "materials": {
                "tissue": {"attenuation_per_mm": 0.02},
                "bone": {"attenuation_per_mm": 0.06},
            },
            "solid": solid,
            "landmarks": {"isocentre": [0.0, 0.0, 0.0]},
            "parameters": parameters.model_dump(mode="json"),
            "findings": findings,
        }
    )


def of_person(person, generator) -> Parameters:
    spread = 1.0 + 0.05 * generator.standard_normal()
    half_mm = 20.0 * person.height_cm / 170.0 * spread
    return Parameters(**person.model_dump(), half_mm=min(max(half_mm, 15.0), 25.0))


lesioned = Entry(
    name="lesioned",
    title="A block with findings",
    summary="For tests.",
    parameters=Parameters,
    build=build,
    views=("ap", "left_lateral"),
    technique=Technique(source_detector_mm=500.0, object_detector_mm=60.0, window=(0.8, 1.6)),
    abnormalities={"nodule": Nodule, "void": Void},
    of_person=of_person,
)


class Fate(Model):
    """What happens when it is built."""

    fate: Annotated[
        Literal["lives", "kills", "raises", "hangs"], told("Fate", "none", "Of who builds it.")
    ] = "lives"
    radius_mm: Annotated[Length, told("Radius", "mm", "Of the ball.", le=100.0)] = 10.0


def build_fatal(parameters: Fate) -> Document:
    if parameters.fate == "kills":
        os.kill(os.getpid(), signal.SIGKILL)
    if parameters.fate == "hangs":
        signal.pause()
    if parameters.fate == "raises":
        raise ZeroDivisionError("a fault of the phantom's own")
    ball = {"type": "sphere", "name": "ball", "material": "m", "center": [0.0, 0.0, 0.0]}
    return Document.model_validate(
        {
            "format": "phantom/1",
            "name": "fatal",
            "materials": {"m": {"attenuation_per_mm": 0.03}},
            "solid": {**ball, "radius": parameters.radius_mm},
            "parameters": parameters.model_dump(mode="json"),
        }
    )


fatal = Entry(
    name="fatal",
    title="A ball that some cannot build",
    summary="For tests.",
    parameters=Fate,
    build=build_fatal,
    views=("ap",),
)
