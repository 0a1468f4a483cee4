"""Makes the picture of docs/phantoms/knee.md: uv run python docs/make_knee_strip.py."""

from __future__ import annotations

from typing import Any

from make_contact_sheet import IMAGES, RENDERED, framed, side_by_side

FIELD_MM = 200.0
CASES: tuple[tuple[str, str, dict[str, Any], list[dict[str, Any]]], ...] = (
    ("a man of 45", "ap", {}, []),
    ("a woman of 80: thin walls, wide canal", "ap", {"sex": "female", "age_years": 80.0}, []),
    ("osteoarthritis, grade 3", "ap", {}, [{"type": "osteoarthritis"}]),
    (
        "grade 4, lateral",
        "ap",
        {},
        [{"type": "osteoarthritis", "grade": 4, "compartment": "lateral"}],
    ),
    ("lateral plateau broken, step 4", "ap", {}, [{"type": "fracture", "step_mm": 4.0}]),
    (
        "tibial shaft broken",
        "ap",
        {},
        [{"type": "fracture", "site": "tibial_shaft", "step_mm": 4.0, "tilt_deg": 20.0}],
    ),
    ("lytic lesion, 20 mm", "ap", {}, [{"type": "lytic_lesion", "diameter_mm": 20.0}]),
    (
        "blastic lesion, 20 mm",
        "ap",
        {},
        [{"type": "blastic_lesion", "site": "lateral_femoral_condyle", "diameter_mm": 20.0}],
    ),
    ("from the side", "mediolateral", {}, []),
    ("effusion, 14 mm", "mediolateral", {}, [{"type": "effusion", "depth_mm": 14.0}]),
    (
        "patella broken, gap 3",
        "mediolateral",
        {},
        [{"type": "fracture", "site": "patella", "gap_mm": 3.0, "step_mm": 0.0}],
    ),
    (
        "loose body; glass behind",
        "mediolateral",
        {},
        [
            {"type": "loose_body", "diameter_mm": 9.0},
            {"type": "foreign_body", "site": "back_of_the_knee", "thickness_mm": 3.0},
        ],
    ),
)

if __name__ == "__main__":
    pictures = [
        framed(
            {
                "phantom": {"name": "knee", "parameters": given, "abnormalities": wrong},
                "view": {"preset": view},
                "detector": {
                    "columns": RENDERED,
                    "rows": RENDERED,
                    "pitch_mm": FIELD_MM / RENDERED,
                },
            },
            caption,
        )
        for caption, view, given, wrong in CASES
    ]
    side_by_side(pictures).save(IMAGES / "knee.png", optimize=True)
