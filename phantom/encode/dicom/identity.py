"""Who and what a file is: a made-up patient's id and unique identifiers, hashed from the content.

Equal requests have equal identifiers, whoever makes them and when. A blind file's come from its
pixels alone, so that nobody can find out which request it was by trying requests.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version

from phantom.encode.attributes import json_text
from phantom.encode.content import Content
from phantom.encode.dicom.facts import Facts


@dataclass(frozen=True, slots=True)
class Identity:
    """Patient, study, series and image.

    Attributes
    ----------
    patient_id
        ``PHX-`` and twelve hexadecimal digits: no hospital's.
    study_uid, series_uid, image_uid
        DICOM unique identifiers; one study a phantom, one series a view and form.
    """

    patient_id: str
    study_uid: str
    series_uid: str
    image_uid: str


def identity(content: Content, facts: Facts, form: str) -> Identity:
    """Return the identity of a file that holds this content in this form, a SOP class."""
    pixels = hashlib.sha256(content.only.tobytes()).hexdigest()
    made = [facts.software, facts.version, f"pydicom {version('pydicom')}"]
    if content.blind:
        # The images of a pair are of one person, and two even where their pixels are the same.
        pair = content.metadata.get("stereo", {})
        person, view, image = pair.get("pixels_sha256", pixels), "", pair.get("eye", "")
    else:
        person = facts.document_sha256
        view = json_text({"view": content.metadata["view"], "beam": content.metadata["beam"]})
        image = json_text(content.told)
    return Identity(
        patient_id=f"PHX-{hashlib.sha256(person.encode()).hexdigest()[:12].upper()}",
        study_uid=uid(["study", *made, person]),
        series_uid=uid(["series", *made, person, form, view]),
        image_uid=uid(["image", *made, person, form, view, image, pixels]),
    )


def uid(sources: Sequence[str]) -> str:
    """Return the unique identifier that these texts always have."""
    from pydicom.uid import generate_uid

    return str(generate_uid(entropy_srcs=list(sources)))
