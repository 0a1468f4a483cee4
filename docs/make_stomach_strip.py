"""Makes the picture of docs/phantoms/stomach-and-liver.md.

uv run python docs/make_stomach_strip.py
"""

from __future__ import annotations

from typing import Any

from make_contact_sheet import IMAGES, framed, side_by_side

NAME = "stomach-and-liver"
SMALL = {"sex": "female", "height_cm": 150.0, "weight_kg": 45.0}
LARGE = {"sex": "male", "height_cm": 190.0, "weight_kg": 120.0}
THIN = {"barium_g_ml": 0.05}
POLYP = {"type": "filling_defect", "diameter_mm": 32.0}
ULCER = {"type": "ulcer_niche", "depth_mm": 12.0, "width_mm": 12.0}
CASES: tuple[tuple[str, str, dict[str, Any], list[dict[str, Any]]], ...] = (
    ("ap", "ap", {}, []),
    ("filling 0.25", "ap", {"filling": 0.25}, []),
    ("a woman of 150 cm and 45 kg", "ap", SMALL, []),
    ("filled to the top", "ap", {"filling": 1.0}, []),
    ("filling defect of 32 mm, thin barium", "ap", THIN, [POLYP]),
    ("ulcer niche of 12 mm", "ap", {}, [ULCER]),
    ("a man of 190 cm and 120 kg", "ap", LARGE, []),
    ("without ribs, 78 years old", "ap", {"ribs": False, "age_years": 78.0}, []),
)  # fmt: skip


def main() -> None:
    """Write the strip."""
    pictures = []
    for title, view, given, wrong in CASES:
        phantom = {"name": NAME, "parameters": given, "abnormalities": wrong}
        request: dict[str, object] = {
            "phantom": phantom,
            "view": {"preset": view},
            "detector": {"columns": 640, "rows": 640},
        }
        if wrong:
            request["view"] = {"preset": view, "isocentre": [45.0, 0.0, 30.0]}
            request["detector"] = {"columns": 640, "rows": 640, "pitch_mm": 0.36}
        pictures.append(framed(request, title))
    side_by_side(pictures).save(IMAGES / "stomach-and-liver.png")


if __name__ == "__main__":
    main()
