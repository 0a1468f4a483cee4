"""How long a picture in visible light takes: ``uv run python -m bench.visible``.

Wall time on every processor, and processor time, which a busy machine does not stretch as much:
over the number of processors it is about what an idle machine takes.
"""

import statistics
import time

import phantom
from phantom.tracing import default_workers, warm

SIDE, ROUNDS = 1024, 5
CASES = (
    ("knee-1993", {}),
    ("knee-1993", {"samples_per_pixel": 2}),
    ("knee-1993", {"lighting": phantom.Lighting(shadows=True)}),
    ("knee", {}),
    ("deformed", {}),
    ("fan", {}),
)


def main() -> None:
    warm()
    print(f"{SIDE}² pixels, {default_workers()} processors, median of {ROUNDS}")
    for name, more in CASES:
        shape = phantom.library.build(name)
        camera = phantom.CameraPreset(preset="three_quarter", columns=SIDE, rows=SIDE)
        options = {"samples_per_pixel": 1, **more}
        wall, used = [], []
        for _ in range(ROUNDS):
            begun, spent = time.perf_counter(), time.process_time()
            picture = phantom.render(shape, camera, **options)
            wall.append(time.perf_counter() - begun)
            used.append(time.process_time() - spent)
        told = " ".join("shadows" if k == "lighting" else f"{v}²" for k, v in options.items())
        print(
            f"{name:10s} {told:12s} covered {picture.coverage.mean():4.0%}"
            f"  wall {statistics.median(wall):.2f} s (least {min(wall):.2f})"
            f"  processors {statistics.median(used):.2f} s"
        )


if __name__ == "__main__":
    main()
