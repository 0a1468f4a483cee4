"""Times taken in turns, so that a slow minute of the machine falls on every case alike."""

import os
import platform
import statistics
import time
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Case:
    """Something to time.

    ``rounds`` is the most often it is run, for cases so slow that five times are enough.
    """

    name: str
    run: object
    rounds: int = 1000


@dataclass(frozen=True)
class Times:
    """Seconds of one case, in the order in which they were taken.

    ``processor`` is what all threads spent together: it counts nothing that others run.
    """

    seconds: tuple[float, ...]
    processor: tuple[float, ...]

    @property
    def median(self):
        return statistics.median(self.seconds)

    @property
    def spread(self):
        return min(self.seconds), max(self.seconds)

    @property
    def processor_median(self):
        return statistics.median(self.processor)

    def ms(self):
        """Median and spread for a table, in ms."""
        low, high = self.spread
        return f"{_short(1e3 * self.median)} ({_short(1e3 * low)} … {_short(1e3 * high)})"


def _short(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def in_turns(cases, rounds, say=print):
    """Run every case once unmeasured, then all of them in turns; return their times by name."""
    found = {case.name: [] for case in cases}
    for case in cases:
        start = time.perf_counter()
        case.run()
        say(f"  first run of {case.name}: {time.perf_counter() - start:.2f} s")
    for k in range(rounds):
        for case in cases:
            if k < case.rounds:
                start, spent = time.perf_counter(), time.process_time()
                case.run()
                spent = time.process_time() - spent
                found[case.name].append((time.perf_counter() - start, spent))
    return {name: Times(*map(tuple, zip(*pairs, strict=True))) for name, pairs in found.items()}


def machine():
    """One line: processor, how many of its cores, memory, system."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        text = cpuinfo.read_text(encoding="utf-8")
        fields = dict(line.split(":", 1) for line in text.splitlines() if ":" in line)
        named = {key.strip(): value.strip() for key, value in fields.items()}
        model = named.get("model name", model)
        if "model" in named:
            model += f" (family {named['cpu family']}, model {named['model']})"
        wide = [w for w in ("avx512f", "avx2") if w in named.get("flags", "").split()]
        model += f", {wide[0]}" if wide else ""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{model}; {cores} cores; {memory:.0f} GiB; {platform.system()} {platform.machine()}"
