"""How cost grows: with pixels, with leaves, with segments and with threads.

``uv run python -m bench.scaling`` from the root of the project, on an idle machine, draws
``docs/images/scaling.png``; ``--quick`` does so from few and small images, ``--to`` elsewhere.
"""

import argparse
from pathlib import Path

import phantom
from bench import scenes
from bench.floor import floor_image
from bench.speed import shot
from bench.timing import Case, in_turns
from phantom.tracing import default_workers

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "scaling.png"
SIDES = (128, 256, 512, 1024, 2048, 4096)
LEAVES = (1, 3, 10, 30, 100, 300)
WAVES = (1, 4, 8, 16)


def curve(points, rounds):
    """Median ms of ``(x, run)``, in turns with the floor; and the floor's."""
    cases = [Case("floor", floor_image), *(Case(f"{x:g}", run) for x, run in points)]
    times = in_turns(cases, rounds, say=lambda _: None)
    found = [1e3 * times[f"{x:g}"].median for x, _ in points]
    return [x for x, _ in points], found, 1e3 * times["floor"].median


def pixels(rounds, side):
    shape = phantom.load(scenes.knee_like())
    sides = [s for s in SIDES if s <= 4 * side]
    return curve([(s * s, shot(shape, scenes.side_view(s))) for s in sides], rounds)


def leaves(rounds, side):
    view = scenes.side_view(side)
    shapes = [(count, phantom.load(scenes.many_tubes(count))) for count in LEAVES]
    return curve([(count, shot(shape, view)) for count, shape in shapes], rounds)


def segments(rounds, side):
    view = scenes.side_view(side)
    shapes = [phantom.load(scenes.bent_tube(waves)) for waves in WAVES]
    return curve([(len(s.compiled.scene.origins), shot(s, view)) for s in shapes], rounds)


def threads(rounds, side):
    shape, view = phantom.load(scenes.knee_like()), scenes.side_view(side)
    counts = sorted({1, 2, default_workers(), 2 * default_workers()})
    return curve([(count, shot(shape, view, count)) for count in counts], rounds)


def draw(curves, to):
    """Draw four panels, both axes logarithmic, with the floor and a line of equal growth."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt
    from matplotlib.ticker import NullLocator

    figure, panels = plt.subplots(2, 2, figsize=(9, 6.5), layout="constrained")
    for panel, (name, (x, ms, floor)) in zip(panels.flat, curves.items(), strict=True):
        panel.loglog(x, ms, "o-", color="tab:blue", label="phantom.radiograph")
        panel.axhline(floor, color="tab:gray", linestyle="--", label="floor at 1024²")
        up = -1 if name == "threads" else 1
        ideal = [ms[-1 if up > 0 else 0] * (v / x[-1 if up > 0 else 0]) ** up for v in x]
        panel.loglog(x, ideal, ":", color="tab:orange", label="in proportion")
        panel.set_xticks(x, [f"{v:,}" for v in x], rotation=25 if x[-1] > 9999 else 0)
        panel.xaxis.set_minor_locator(NullLocator())
        panel.set_xlabel(name)
        panel.set_ylabel("ms an image")
        panel.grid(visible=True, which="both", alpha=0.25)
    panels[0, 0].legend()
    to.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(to, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--quick", action="store_true", help="one round, small images")
    parser.add_argument("--to", type=Path, default=PICTURE, help="where the picture goes")
    arguments = parser.parse_args()
    rounds, side = (1, 256) if arguments.quick else (5, 1024)
    curves = {
        "pixels": pixels(rounds, side),
        f"leaves (tubes side by side, {side}²)": leaves(rounds, side),
        f"segments (one tube that swings, {side}²)": segments(rounds, side),
        "threads": threads(rounds, side),
    }
    for name, (x, ms, floor) in curves.items():
        told = ", ".join(f"{v:g}: {t:.3g} ms" for v, t in zip(x, ms, strict=True))
        print(f"{name}: {told}; floor {floor:.3g} ms", flush=True)
    draw(curves, arguments.to)


if __name__ == "__main__":
    main()
