"""Makes the pictures of docs/phantoms/hand.md: uv run python docs/make_hand_strip.py."""

from __future__ import annotations

from typing import Any

from make_contact_sheet import IMAGES, framed, side_by_side

from phantom import library

WHOLE: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("pa", "pa", {}),
    ("oblique (rao)", "rao", {}),
    ("lateral (mediolateral)", "mediolateral", {}),
    ("a left hand, a woman of 80", "pa", {"sex": "female", "age_years": 80.0, "side": "left"}),
)
CLOSE: tuple[tuple[str, dict[str, Any], list[dict[str, Any]]], ...] = (
    ("fracture of the little metacarpal", {}, [{"type": "fracture"}]),
    (
        "osteoarthritis, grades 4 and 3",
        {"sex": "female", "age_years": 65.0},
        [
            {"type": "osteoarthritis", "grade": 4, "joint": "index distal interphalangeal"},
            {"type": "osteoarthritis", "grade": 3, "joint": "index proximal interphalangeal"},
        ],
    ),
    ("lytic lesion; steel, 5 mm", {}, [
        {"type": "lytic_lesion"},
        {"type": "foreign_body", "substance": "steel", "bone": "middle proximal phalanx"},
    ]),
    ("blastic lesion; erosion", {}, [{"type": "blastic_lesion"}, {"type": "erosion"}]),
)  # fmt: skip
FIELD_MM = 70.0


def main() -> None:
    """Write the strip."""
    pictures = [
        framed({"phantom": {"name": "hand", "parameters": given}, "view": {"preset": view}}, title)
        for title, view, given in WHOLE
    ]
    for title, given, wrong in CLOSE:
        center = library.document("hand", given, wrong).findings[0].center
        request: dict[str, object] = {
            "phantom": {"name": "hand", "parameters": given, "abnormalities": wrong},
            "view": {"preset": "pa", "isocentre": center},
            "detector": {"columns": 640, "rows": 640, "pitch_mm": FIELD_MM / 640},
        }
        pictures.append(framed(request, title))
    side_by_side(pictures).save(IMAGES / "hand.png")


if __name__ == "__main__":
    main()
