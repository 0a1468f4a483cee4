"""Builds phantoms of many random people: how many documents are refused, and how long it takes.

    uv run python -m bench.people knee chest hand breast --count 1000

A person is drawn from the usual population by (0, i) and given to the phantom's ``of_person``; the
document is built and compiled, which refuses whatever is no solid. Times are of one process.
"""

from __future__ import annotations

import argparse
import json
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

import numpy as np

from phantom import library
from phantom.errors import InvalidInputError


def person(name: str, index: int) -> tuple[int, float, str]:
    """Build the phantom of person ``index``; return it, the seconds and what was refused."""
    entry = library.entry(name)
    seeds = np.random.SeedSequence(0, spawn_key=(index,))
    generator = np.random.Generator(np.random.Philox(seeds))
    people = library.Population(female=1.0 if name == "breast" else 0.5)
    if entry.of_person is None:
        raise SystemExit(f"{name} is of no person")
    parameters = entry.of_person(people.draw(generator), generator)
    start = time.perf_counter()
    try:
        library.prepare(name, parameters.model_dump(mode="json"))
    except InvalidInputError as error:
        return index, time.perf_counter() - start, str(error.problems[0])
    return index, time.perf_counter() - start, ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="+")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    for name in asked.names:
        indices = range(asked.first, asked.first + asked.count)
        with ProcessPoolExecutor(asked.workers, mp_context=get_context("spawn")) as pool:
            done = list(pool.map(partial(person, name), indices, chunksize=4))
        refused = [(index, why) for index, _, why in done if why]
        times = np.sort([seconds for _, seconds, _ in done])
        print(
            json.dumps(
                {
                    "phantom": name,
                    "people": len(done),
                    "refused": len(refused),
                    "median_s": round(float(np.median(times)), 3),
                    "p95_s": round(float(times[int(0.95 * (len(times) - 1))]), 3),
                }
            )
        )
        for index, why in refused[:20]:
            print(f"  person {index}: {why}")


if __name__ == "__main__":
    main()
