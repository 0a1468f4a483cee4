"""Making an image: from its number to the files that are kept of it, and what is said of it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from phantom import library
from phantom.datasets.contact import shown, thumbnail
from phantom.datasets.design import Design, DrawnPhantom, view_name
from phantom.datasets.knowledge import annotated, best_seen, located, mask
from phantom.datasets.names import file_name
from phantom.datasets.places import Place, place
from phantom.datasets.sampling import Case, Subject, case, exposure, request
from phantom.document import validate_model
from phantom.encode import archive, encode, npy, png, truth_files
from phantom.encode.coding import Coding, coding
from phantom.encode.content import Content
from phantom.imaging import (
    Radiograph,
    StereoPair,
    Truth,
    Visibility,
    document_sha256,
    ground_truth,
    radiograph,
    visibility,
)
from phantom.imaging.stereo import EyePicture, pair_of
from phantom.requests.limits import Limits
from phantom.requests.radiograph import RadiographPlan, RadiographRequest, plan_of

if TYPE_CHECKING:
    from phantom.scene import Phantom

LINEAR_CODES: Final = 32_768
"""Codes of the open field in a linear picture of the signal: noise may go to twice of it."""

OF_MASKS: Final = ("masks", "boxes")
"""Kinds of ground truth that masks, COCO and the places of findings come from."""


@dataclass(frozen=True, slots=True)
class Made:
    """What is kept of an image.

    Attributes
    ----------
    place
        Where it stands.
    files
        Content by ending, such as ``png`` or ``mask.png``.
    row
        What is said of it, as plain JSON values; never null, so that tables have one type a column.
    annotations
        Its leaves, as in COCO, each with its ``name`` and ``material`` in place of a category.
    thumbnail
        Of those that the contact sheet shows.
    """

    place: Place
    files: Mapping[str, bytes]
    row: Mapping[str, Any]
    annotations: tuple[Mapping[str, Any], ...] = ()
    thumbnail: str | None = None


class Shot(NamedTuple):
    """What an exposure gives: a picture, or one for each eye.

    Attributes
    ----------
    left
        The picture; the left eye's.
    right
        The right eye's; the same one for the arm without depth.
    pair
        Both of them, of a pair.
    """

    left: Radiograph
    right: Radiograph | None = None
    pair: StereoPair | None = None

    @property
    def images(self) -> tuple[Radiograph, ...]:
        """One or two."""
        return (self.left,) if self.right is None else (self.left, self.right)

    @property
    def pictures(self) -> dict[str, Radiograph | EyePicture]:
        """The same as they are shown, by what their files' endings begin with."""
        shown: list[Any] = [*self.images]
        if self.pair is not None:
            shown = [*self.pair.pictures.values()]
        return dict(zip(("", "right."), shown, strict=False))


@dataclass(slots=True)
class Maker:
    """Makes the images of one design, one at a time; the last case is kept for its next view.

    Parameters
    ----------
    design
        Whose.
    threads
        To trace with; None for one a processor. The images do not depend on it.
    """

    design: Design
    threads: int | None = None
    _own: Phantom | None = field(default=None, init=False)
    _last: tuple[tuple[int, int], Case] | None = field(default=None, init=False)

    def make(self, index: int) -> Made:
        """Return image ``index``.

        Raises
        ------
        InvalidInputError
            Nothing that was drawn for it fits.
        """
        at = place(self.design, index)
        of = self.case(at)
        planned = self.plan(at, of)
        shot = self.shoot(planned)
        twin = self.twin(of, shot) if self.design.twins else None
        return self.kept(at, of, planned, shot, self.tell(planned, shot), twin)

    def case(self, at: Place) -> Case:
        """Return the case of an image."""
        number = (at.person, at.case)
        if self._last is None or self._last[0] != number:
            self._last = None
            self._last = number, case(self.design, at, self._prepared)
        return self._last[1]

    def _prepared(self, subject: Subject) -> Phantom:
        asked = self.design.phantom
        if isinstance(asked, DrawnPhantom):
            return library.prepare(asked.name, subject.parameters, subject.abnormalities)
        if self._own is None:
            from phantom.scene import load

            self._own = load(asked.document)
        return self._own

    def plan(self, at: Place, of: Case, limits: Limits | None = None) -> RadiographPlan:
        """Return the radiograph that an image is, ready to be traced."""
        design = self.design
        tree = request(design, at, exposure(design, at))
        asked = design.phantom
        subject: dict[str, Any] = {"document": {}}
        if isinstance(asked, DrawnPhantom):
            subject = {"name": asked.name}
        kept = design.outputs
        if kept.masks or kept.coco or design.abnormalities:
            tree["truth"] = [*{*tree["truth"], *OF_MASKS}]
        asked_for = validate_model(RadiographRequest, {**tree, "phantom": subject})
        pair = design.stereo is not None and design.stereo.mono is None
        return plan_of(asked_for, of.phantom, limits, images=2 if pair else 1)

    def shoot(self, planned: RadiographPlan) -> Shot:
        """Return the picture, or the pair where the design has two eyes."""
        eyes = self.design.stereo
        if eyes is None:
            return Shot(planned.render(workers=self.threads))
        pair = pair_of(
            planned.phantom,
            planned.view,
            planned.beam,
            eyes,
            acquisition=planned.acquisition,
            noise=planned.noise,
            workers=self.threads,
        )
        return Shot(pair.left, None if eyes.mono == "single" else pair.right, pair)

    def tell(self, planned: RadiographPlan, shot: Shot) -> tuple[Truth, ...]:
        """Return the ground truth of each image of a shot; none where none is kept."""
        if not planned.truth:
            return ()
        return tuple(
            ground_truth(planned.phantom, image.view, planned.truth, workers=self.threads)
            for image in shot.images
        )

    def twin(self, of: Case, shot: Shot) -> Shot | None:
        """Return the same pictures, of the same noise, with nothing wrong; None without a twin.

        Views are those of the shot, which may have been placed around what is wrong.
        """
        if of.twin is None:
            return None
        phantom = of.twin

        def again(image: Radiograph) -> Radiograph:
            return radiograph(
                phantom,
                image.view,
                image.beam,
                acquisition=image.acquisition,
                noise=image.noise,
                workers=self.threads,
            )

        left = again(shot.left)
        if shot.right is None or shot.right is shot.left:
            return Shot(left, None if shot.right is None else left)
        return Shot(left, again(shot.right))

    def seen(self, of: Case, planned: RadiographPlan, shot: Shot) -> tuple[Visibility, ...]:
        """Return how well each finding is seen, by the left eye of a pair; none of healthy cases.

        What a display shows counts where the presentation has one.
        """
        if of.twin is None or not self.design.outputs.visibility:
            return ()
        shown_as, image = planned.presentation, shot.left
        return visibility(
            of.phantom,
            of.twin,
            image.view,
            image.beam,
            acquisition=image.acquisition,
            noise=image.noise,
            presentation=None if shown_as.gsdf is None else shown_as,
            workers=self.threads,
        )

    def kept(
        self,
        at: Place,
        of: Case,
        planned: RadiographPlan,
        shot: Shot,
        truths: tuple[Truth, ...],
        twin: Shot | None,
    ) -> Made:
        """Return what is kept of an image, encoded."""
        design, kept, made = self.design, self.design.outputs, shot.left
        files: dict[str, bytes] = {}
        pictures = shot.pictures
        for prefix, picture in pictures.items():
            files |= self._pictures(planned, picture, prefix)
        if twin is not None:
            for prefix, picture in twin.pictures.items():
                files |= self._pictures(planned, picture, f"twin.{prefix}")
        for prefix, truth in zip(pictures, truths, strict=False):
            if kept.masks:
                white = mask(truth, of_findings=bool(design.abnormalities))
                files[f"{prefix}mask.png"] = png(white, {})
            if design.truth:
                told = replace(truth, kinds=tuple(k for k in truth.kinds if k in design.truth))
                name = file_name(design, at, f"{prefix}png")
                files[f"{prefix}truth.zip"] = archive(truth_files(told, name))
        first = truths[0] if truths else None
        annotations = annotated(first) if first is not None and kept.coco else ()
        document = of.phantom.document
        if kept.documents and at.view == 0:
            tree = document.model_dump(mode="json", exclude_none=True)
            files["document.json"] = f"{text(tree)}\n".encode()
        row = self._row(at, of, planned, shot, first)
        small = thumbnail(made, design.quantity) if at.number in shown(design) else None
        return Made(at, files, row, annotations, small)

    def _pictures(
        self, planned: RadiographPlan, made: Radiograph | EyePicture, prefix: str
    ) -> dict[str, bytes]:
        """Return the picture, and the codes beside it where they are asked for."""
        design, quantity = self.design, self.design.quantity
        own = made.radiograph if isinstance(made, EyePicture) else made
        chosen = linear(own, quantity)
        files: dict[str, bytes] = {}
        codes = chosen.codes(made.quantity(quantity))
        if design.outputs.form == "linear":
            said = {"format": "png", "holds": "codes", **chosen.told()}
            content = Content({quantity: codes}, said, made.metadata(), design.blind)
            files[f"{prefix}png"] = png(content.only, content.told)
        else:
            shown_as = planned.presentation
            files[f"{prefix}png"] = encode(made, quantity, shown_as, "png", blind=design.blind).data
        if design.outputs.codes:
            files[f"{prefix}u16.npy"] = npy(codes)
        return files

    def _row(
        self,
        at: Place,
        of: Case,
        planned: RadiographPlan,
        shot: Shot,
        truth: Truth | None,
    ) -> dict[str, Any]:
        design, made = self.design, shot.left
        seen = self.seen(of, planned, shot)
        recommended = "ap"
        if isinstance(design.phantom, DrawnPhantom):
            recommended = library.entry(design.phantom.name).views[0]
        row: dict[str, Any] = {
            "index": at.number,
            "key": at.key,
            "split": at.split,
            "person": at.person,
            "case": at.case_number(design),
            "view": view_name(design.views[at.view], recommended),
        }
        if of.subject.person is not None:
            row |= of.subject.person.model_dump(mode="json")
        wrong = of.subject.abnormalities
        row["label"] = int(bool(wrong))
        for asked in design.abnormalities:
            row[f"has_{asked.type}"] = int(any(a["type"] == asked.type for a in wrong))
        row |= exposure(design, at)
        row["parameters"] = text(of.phantom.document.parameters)
        row["abnormalities"] = text(wrong)
        row["findings"] = text(located(of.phantom, truth, seen))
        if design.outputs.visibility:
            row |= best_seen(design, planned, seen)
        row["columns"], row["rows"] = made.view.detector.columns, made.view.detector.rows
        row["pitch_mm"] = made.view.detector.pitch_xy_mm[0]
        row["open_field"] = made.open_field
        row["codes_per_unit"] = linear(made, design.quantity).codes_per_unit
        if shot.pair is not None and shot.pair.stereo.mono is None:
            eyes = shot.pair.eyes
            apart = {"baseline_mm": eyes.baseline_mm, "angle_deg": eyes.angle_deg}
            row |= {f"stereo_{name}": value for name, value in apart.items() if value is not None}
            row["disparity_deg"] = shot.pair.whole.worst_deg
        row["document_sha256"] = document_sha256(of.phantom.document)
        return row


def linear(made: Radiograph, quantity: str) -> Coding:
    """Return the coding of a linear picture, the same for every image of the same open field."""
    if quantity == "signal" and made.signal_unit != "codes":
        return Coding(quantity, LINEAR_CODES / made.open_field)
    unit = made.signal_unit if quantity == "signal" else "1"
    return coding(quantity, np.zeros(0), unit)


def text(tree: object) -> str:
    """Return JSON in ASCII, without spaces."""
    return json.dumps(tree, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
