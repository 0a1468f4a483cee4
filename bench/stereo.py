"""What a pair costs beside one radiograph.

The paper's knee, 1024 × 1024, from the front, ideal and exposed. The ratio is the median of the
turns' ratios: a pair and the radiograph before it share the state of the machine.

Run with ``python -m bench.stereo`` from the root of the project.
"""

import statistics
import sys

import phantom
from bench.timing import Case, in_turns, machine

PIXELS = 1024
TURNS = 11
MOST = 2.1
"""The ratio that a pair is to stay within."""


def main():
    """Print a line for each kind of image; leave with 1 where a pair costs too much."""
    knee = phantom.library.build("knee-1993")
    view = phantom.preset_view(knee, "ap", columns=PIXELS, rows=PIXELS)
    print(machine())
    worst = 0.0
    for name, acquisition in (("ideal", None), ("exposed", phantom.Acquisition())):
        cases = [
            Case("one", lambda a=acquisition: phantom.radiograph(knee, view, acquisition=a)),
            Case("two", lambda a=acquisition: phantom.stereo_pair(knee, view, acquisition=a)),
        ]
        times = in_turns(cases, TURNS, say=lambda _: None)
        one, two = times["one"], times["two"]
        ratio = statistics.median(b / a for a, b in zip(one.seconds, two.seconds, strict=True))
        print(f"{name}: a radiograph {one.ms()} ms, a pair {two.ms()} ms, {ratio:.2f} times")
        worst = max(worst, ratio)
    return 0 if worst <= MOST else 1


if __name__ == "__main__":
    sys.exit(main())
