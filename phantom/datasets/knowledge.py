"""What is known of a picture beyond its pixels: masks, annotations, and what is to be found."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from phantom.datasets.design import Design
from phantom.datasets.draws import ends
from phantom.encode.coco import coco
from phantom.imaging import Truth, Visibility
from phantom.requests.radiograph import RadiographPlan

if TYPE_CHECKING:
    from phantom.scene import Phantom


def mask(truth: Truth, *, of_findings: bool) -> NDArray[np.uint8]:
    """Return 255 where something of the findings, or else of any named leaf, is seen."""
    names = {name for _, leaves in truth.findings for name in leaves}
    found = np.zeros(truth.size[::-1], dtype=np.bool_)
    for leaf in truth.leaves:
        if leaf.box is not None and (not of_findings or leaf.name in names):
            found |= leaf.mask
    return found.astype(np.uint8) * np.uint8(255)


def annotated(truth: Truth) -> tuple[Mapping[str, Any], ...]:
    """Return the leaves that are seen, as annotations of COCO without their numbers."""
    tree = coco(truth.leaves, truth.size, "", truth.centroids_px)
    names = {c["id"]: (c["name"], c["supercategory"]) for c in tree["categories"]}
    finding = {leaf: name for name, leaves in truth.findings for leaf in leaves}
    found = []
    for annotation in tree["annotations"]:
        name, material = names[annotation["category_id"]]
        told = {k: v for k, v in annotation.items() if not k.endswith("id")}
        own = {"finding": finding[name]} if name in finding else {}
        found.append({"name": name, "material": material, **told, **own})
    return tuple(found)


def best_seen(
    design: Design, planned: RadiographPlan, seen: tuple[Visibility, ...]
) -> dict[str, float]:
    """Return how well the finding that is seen best is seen; 0 where there is nothing to be seen.

    Every image of a set has the same of these: ``contrast_to_noise`` unless some have no noise, and
    ``jnd`` where the presentation has a display.
    """
    noisy = planned.acquisition is not None and planned.acquisition.draws
    noisy = noisy and "off" not in ends(design.vary.get("quantum_noise"))
    by = "contrast_to_noise" if noisy else "contrast"
    names = [*dict.fromkeys(("contrast", by))]
    if planned.presentation.gsdf is not None:
        names.append("jnd")
    best = max(seen, key=lambda one: abs(getattr(one, by) or 0.0), default=None)
    return {name: getattr(best, name, None) or 0.0 for name in names}


def located(
    phantom: Phantom, truth: Truth | None, seen: tuple[Visibility, ...] = ()
) -> list[dict[str, Any]]:
    """Return what a reader should find, with its place and looks where these are known."""
    found = []
    for k, finding in enumerate(phantom.document.findings):
        told = finding.model_dump(mode="json", exclude_none=True)
        boxes = []
        if truth is not None:
            leaves = [leaf for leaf in truth.leaves if leaf.name in finding.leaves]
            boxes = [leaf.box for leaf in leaves if leaf.box is not None]
        if boxes:
            left, top = min(b.first_column for b in boxes), min(b.first_row for b in boxes)
            right, bottom = max(b.last_column for b in boxes), max(b.last_row for b in boxes)
            told["bbox"] = [left, top, right - left + 1, bottom - top + 1]
        if seen:
            figures = seen[k]._asdict()
            told |= {n: v for n, v in figures.items() if n != "finding" and v is not None}
        found.append(told)
    return found
