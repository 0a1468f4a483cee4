"""How long each format takes to write, and how large its files are.

The picture is a ball's shadow with quantum noise of 10,000 photons a pixel, three materials, 16
bits where the format has grey levels: noise is what real radiographs have, and what compresses
badly. The arrays are there before; encoding in memory is timed, not the disk.

Run with ``python -m bench.encoding`` from the root of the project; ``--write`` puts the table into
docs/performance.md.
"""

import sys

import numpy as np

from bench.page import fill, table
from bench.timing import Case, in_turns
from phantom.encode import FORMATS, encode

SIDES = (1024, 4096)
PHOTONS = 10_000


class Ball:
    """A picture of side × side pixels whose arrays are made beforehand."""

    def __init__(self, side):
        y, x = (np.mgrid[:side, :side] + 0.5) / side * 2 - 1
        chord_mm = 80 * np.sqrt(np.maximum(0, 0.8 - x**2 - y**2))
        self.thickness = np.stack([chord_mm * part for part in (0.7, 0.2, 0.1)], axis=-1)
        line_integral = self.thickness @ [0.02, 0.05, 0.1]
        transmission = np.exp(-line_integral)
        noisy = np.random.default_rng(1).poisson(PHOTONS * transmission) / PHOTONS
        self.quantities = {
            "line_integral": line_integral,
            "transmission": transmission,
            "signal": noisy,
            "path_lengths": self.thickness,
        }
        scaled = (noisy - noisy.min()) / (noisy.max() - noisy.min())
        self.grey = (65535 - np.rint(scaled * 65535)).astype(np.uint16)
        detector = {
            "center": [0, 100, 0], "right": [1, 0, 0], "down": [0, 0, -1],
            "columns": side, "rows": side, "pitch_mm": 0.1,
        }  # fmt: skip
        self.told = {
            "software": {"name": "phantom-xray", "version": "0"},
            "phantom": {
                "name": "ball",
                "document_sha256": "0" * 64,
                "material_names": ["soft", "spongy", "bone"],
            },
            "units": {"signal": "1"},
            "view": {"source": [0, -1000, 0], "direction": None, "detector": detector},
            "beam": {"energy_kev": 60.0},
            "pitch_mm": [0.1, 0.1],
        }

    def quantity(self, name):
        return self.quantities[name]

    def presented(self, name, presentation):
        return self.grey

    def shown(self, name, presentation):
        return {"stage": "presentation", "mode": "stretch", "bits": 16}

    def metadata(self):
        return self.told


def figures():
    """Return the table: ms and MiB of every format at every side."""
    written, times = {}, {}
    for side in SIDES:
        ball = Ball(side)

        def run(name, ball=ball, side=side):
            written[name, side] = len(encode(ball, "signal", format=name).data)

        cases = [Case(f.name, lambda name=f.name: run(name)) for f in FORMATS if f.name != "json"]
        times[side] = in_turns(cases, 7 if side <= 1024 else 3)
    head = ["format"] + [f"{unit} at {side}²" for side in SIDES for unit in ("ms", "MiB")]
    rows = [
        [name]
        + [
            cell
            for side in SIDES
            for cell in (times[side][name].ms(), f"{written[name, side] / 2**20:.1f}")
        ]
        for name in times[SIDES[0]]
    ]
    return table(head, rows)


if __name__ == "__main__":
    result = figures()
    print(result)
    if "--write" in sys.argv[1:]:
        fill({"encoding": result})
