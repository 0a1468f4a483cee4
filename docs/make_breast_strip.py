"""Makes the pictures of docs/phantoms/breast.md: uv run python docs/make_breast_strip.py."""

from __future__ import annotations

from make_contact_sheet import IMAGES, framed, side_by_side

OFFSET_MM = [62.0, 12.0, 0.0]
CLOSE = {
    "view": {"preset": "cc", "isocentre": [58.0, -38.0, 0.0]},
    "detector": {"columns": 480, "rows": 480, "pitch_mm": 0.1},
}
"""41 mm about the lesions, before the gland's edge."""

CASES = (
    ("fatty, glandular share 0.06", "cc", {"glandular": 0.06, "seed": 3}, []),
    ("the mean, 0.19", "cc", {}, []),
    ("dense, 0.45", "cc", {"glandular": 0.45, "seed": 5}, []),
    ("mlo", "mlo", {"compression": "mlo"}, []),
    (
        "a mass of 10 mm with spicules",
        "cc",
        {"seed": 3},
        [
            {
                "type": "mass",
                "diameter_mm": 10.0,
                "spicules": 40,
                "spicule_mm": 12.0,
                "offset_mm": OFFSET_MM,
            }
        ],
    ),
    (
        "a mass without spicules",
        "cc",
        {"seed": 3},
        [{"type": "mass", "diameter_mm": 10.0, "spicules": 0, "offset_mm": OFFSET_MM}],
    ),
    (
        "calcifications of 0.5 mm in 12 mm",
        "cc",
        {"seed": 3},
        [
            {
                "type": "calcification_cluster",
                "number": 14,
                "diameter_mm": 0.5,
                "cluster_mm": 12.0,
                "offset_mm": OFFSET_MM,
            }
        ],
    ),
    (
        "the same on a shell",
        "cc",
        {"seed": 3},
        [
            {
                "type": "calcification_cluster",
                "number": 14,
                "diameter_mm": 0.5,
                "cluster_mm": 12.0,
                "arrangement": "shell",
                "offset_mm": OFFSET_MM,
            }
        ],
    ),
)

if __name__ == "__main__":
    pictures = [
        framed(
            {
                "phantom": {"name": "breast", "parameters": given, "abnormalities": wrong},
                "view": {"preset": view},
                **(CLOSE if wrong else {}),
            },
            caption,
        )
        for caption, view, given, wrong in CASES
    ]
    side_by_side(pictures).save(IMAGES / "breast.png", optimize=True)
