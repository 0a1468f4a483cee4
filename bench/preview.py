"""How long a preview takes: ``python -m bench.preview``; tessellation, then pictures, warm.

One worker and all of them, in turns, beside an exact picture of the same size.
"""

import time

import phantom
from bench.timing import Case, in_turns

SIDE, ROUNDS = 512, 15
NAMES = ("knee-1993", "fan", "deformed")


def main():
    camera = phantom.CameraPreset(columns=SIDE, rows=SIDE)
    cases = []
    for name in NAMES:
        shape = phantom.library.build(name)
        start = time.perf_counter()
        triangles = phantom.preview(shape, camera).told["triangles"]
        first = time.perf_counter() - start
        print(f"{name}: {triangles} triangles, the first picture after {first:.2f} s")
        for workers in (1, None):
            cases.append(
                Case(
                    f"{name}, {workers or 'all'} workers",
                    lambda shape=shape, workers=workers: phantom.preview(
                        shape, camera, workers=workers
                    ),
                )
            )
        cases.append(
            Case(
                f"{name}, exact",
                lambda shape=shape: phantom.render(shape, camera, samples_per_pixel=1),
                rounds=3,
            )
        )
    print(f"| {SIDE}² | ms: median (least … most) |\n| --- | --- |")
    for name, times in in_turns(cases, ROUNDS, say=lambda text: None).items():
        print(f"| {name} | {times.ms()} |")


if __name__ == "__main__":
    main()
