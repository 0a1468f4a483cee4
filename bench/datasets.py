"""How many images of a data set an hour gives, and where the time goes.

``uv run python -m bench.datasets --write`` fills docs/performance.md. Processor time is told beside
the clock's, since other programs that run at the same time slow the one and not the other.
"""

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from bench.page import fill, table
from phantom.datasets import Run, make, read_design
from phantom.datasets.ledger import Ledger
from phantom.datasets.making import Maker
from phantom.datasets.places import place, units
from phantom.datasets.storage import LocalFolder
from phantom.imaging import radiograph

SIDES = (512, 1024)
TIMED = 6
WORKERS = 2
IMAGES = 16


def design(side, people):
    return read_design(
        {
            "phantom": {
                "name": "knee-1993",
                "parameters": {"valgus_deg": {"type": "uniform", "low": 2.0, "high": 10.0}},
            },
            "people": people,
            "detector": {"columns": side},
            "beam": {"kvp": 65},
            "splits": {"train": 1.0},
        }
    )


class Stages:
    """Seconds of the processor, and of the clock, by stage."""

    def __init__(self):
        self.processor, self.clock = {}, {}

    def run(self, name, work, *given, **named):
        began, processor = time.perf_counter(), time.process_time()
        found = work(*given, **named)
        self.processor.setdefault(name, []).append(time.process_time() - processor)
        self.clock.setdefault(name, []).append(time.perf_counter() - began)
        return found

    def median(self, name, of="processor"):
        return statistics.median(getattr(self, of)[name])


def write(where, made):
    for ending, data in made.files.items():
        where.put(f"train/{made.place.key}.{ending}", data)


def stages(side):
    """Make some images on one thread, stage by stage."""
    wanted = design(side, TIMED + 1)
    found = Stages()
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder:
        where = LocalFolder(Path(folder) / "set")
        ledger = Ledger(Path(folder) / "ledger.sqlite")
        ledger.open_for(wanted.digest(), "bench", units(wanted))
        for number in range(TIMED + 1):
            times = Stages() if number == 0 else found  # the first loads what all use
            maker, at = Maker(wanted, threads=1), place(wanted, number)
            claim = times.run("ledger", ledger.claim, "bench", time.time(), 600.0)
            of = times.run("phantom built", maker.case, at)
            planned = times.run("planned", maker.plan, at, of)
            times.run("traced", radiograph, planned.phantom, planned.view, planned.beam, workers=1)
            shot = times.run("exposed", maker.shoot, planned)
            truth = times.run("masks", maker.tell, planned, shot)
            made = times.run("encoded", maker.kept, at, of, planned, shot, truth, None)
            times.run("written", write, where, made)
            record = "x" * 8000  # that of a knee is about as long
            times.run("ledger done", ledger.done, "bench", [(claim.images[0], "", record)])
        ledger.close()
    return found


def throughput(side):
    """Make a set with two processes; return images an hour by the clock, without their start."""
    wanted = design(side, IMAGES)
    times = []
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder:
        make(
            wanted,
            Path(folder) / "set",
            Run(workers=WORKERS),
            progress=lambda counts: times.append((time.perf_counter(), counts.done)),
        )
    first = next(k for k, (_, done) in enumerate(times) if done >= WORKERS)
    last = next(k for k, (_, done) in enumerate(times) if done == IMAGES)
    seconds = times[last][0] - times[first][0]
    return 3600 * (times[last][1] - times[first][1]) / seconds


def figures():
    """Return the table."""
    rows = []
    columns = {}
    for side in SIDES:
        load = os.getloadavg()[0]
        found = stages(side)
        parts = {
            "phantom built": found.median("phantom built") + found.median("planned"),
            "traced": found.median("traced"),
            "dose, noise, detector": max(found.median("exposed") - found.median("traced"), 0.0),
            "masks and COCO traced": found.median("masks"),
            "encoded": found.median("encoded"),
            "files written and synchronised": found.median("written"),
            "ledger": found.median("ledger") + found.median("ledger done"),
        }
        whole = sum(parts.values())
        ledger_s = found.median("ledger", "clock") + found.median("ledger done", "clock")
        clock_s = sum(
            found.median(name, "clock")
            for name in ("phantom built", "planned", "exposed", "masks", "encoded", "written")
        )
        told = {name: f"{1e3 * s:.0f} ms, {100 * s / whole:.1f} %" for name, s in parts.items()}
        told["all, on one thread"] = f"{1e3 * whole:.0f} ms"
        told["images an hour, two processors of one's own"] = f"{WORKERS * 3600 / whole:,.0f}"
        told["images an hour, by the clock"] = f"{throughput(side):,.0f}"
        told["ledger, by the clock"] = (
            f"{1e3 * ledger_s:.1f} ms, {100 * ledger_s / (clock_s + ledger_s):.1f} % (limit: 5 %)"
        )
        told["load average before"] = f"{load:.1f}"
        columns[side] = told
    rows = [[name, *(columns[side][name] for side in SIDES)] for name in columns[SIDES[0]]]
    return table(["knee-1993, an image each of new people", *(f"{s}²" for s in SIDES)], rows)


if __name__ == "__main__":
    result = figures()
    print(result)
    if "--write" in sys.argv[1:]:
        fill({"datasets": result})
