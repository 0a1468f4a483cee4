"""Every figure of docs/performance.md, in one run.

``uv run python -m bench.speed`` from the root of the project, on an idle machine; ``--write`` fills
the page, ``--quick`` looks once or twice at each case and at small images only. With the group
``bench`` installed (``uv sync --group bench``) other programs are measured on the same rays.
"""

import argparse
import contextlib
import datetime
import importlib.util
import os

import numpy as np

import phantom
from bench import accuracy, memory, page, scenes
from bench.floor import floor_image
from bench.timing import Case, in_turns, machine
from phantom.tracing import default_workers

SIDE = 1024
SIZES = (512, 1024, 2048, 4096)
TWIN_PIXELS = 300
SEED = 20240117
LIMITS = {
    "knee-like, from the side": (5.0, "floor"),
    "knee-like, end-on": (20.0, "floor"),
    "knee-1993, ap": (8.0, "floor"),
    "knee-1993, ap, 512²": (8.0 / 3, "floor"),
    "chest-like": (8.0, "knee-1993, ap"),
}
"""What we hold ourselves to: at most so many times as long as another case."""


def shot(shape, view, workers=None):
    """One radiograph as a user asks for it, its signal included."""
    return lambda: phantom.radiograph(shape, view, workers=workers).signal


def floor_case():
    return Case("floor", floor_image)


def main_cases():
    """The scenes, from everywhere."""
    like, knee = phantom.load(scenes.knee_like()), phantom.library.build("knee-1993")
    chest = phantom.load(scenes.chest())
    views = [*scenes.KNEE_VIEWS, scenes.AXIAL]
    return [
        floor_case(),
        Case("knee-like, from the side", shot(like, scenes.side_view())),
        Case("knee-like, end-on", shot(like, scenes.end_on_view())),
        *(Case(f"knee-1993, {v}", shot(knee, scenes.knee_view(knee, v))) for v in views),
        Case("knee-1993, ap, 512²", shot(knee, scenes.knee_view(knee, "ap", 512))),
        Case("chest-like", shot(chest, phantom.preset_view(chest, "ap", columns=SIDE, rows=SIDE))),
        Case(
            "seven ellipsoids",
            shot(phantom.load(scenes.ellipsoids()), scenes.side_view()),
        ),
    ]


def main_table(times):
    rows = []
    for name, found in times.items():
        ratio = found.median / times["floor"].median
        limit, than = LIMITS.get(name, (None, None))
        held = ""
        if limit is not None:
            held = f"{found.median / times[than].median:.2f} of {limit:.3g} × {than}"
        spent = found.processor_median / times["floor"].processor_median
        rows.append((name, found.ms(), f"{ratio:.1f}", f"{spent:.1f}", held))
    head = ("1024², two views of one thing a line", "ms", "× floor", "in processor time", "limit")
    return page.table(head, rows)


def views_line(times):
    knee = [t.median for n, t in times.items() if n.startswith("knee-1993") and "512" not in n]
    return f"The dearest view of `knee-1993` takes {max(knee) / min(knee):.2f} × the cheapest."


def sizes(rounds, most):
    """Time a pixel against the number of pixels."""
    like = phantom.load(scenes.knee_like())
    chosen = [s for s in SIZES if s <= most]
    cases = [
        Case(f"{s}²", shot(like, scenes.side_view(s)), max(1, rounds * 1024 // s)) for s in chosen
    ]
    times = in_turns(cases, rounds)
    a_pixel = [1e9 * times[f"{s}²"].median / s**2 for s in chosen]
    rows = [
        (f"{s}²", times[f"{s}²"].ms(), f"{p:.1f}", f"{100 * (p / a_pixel[1] - 1):+.0f} %")
        for s, p in zip(chosen, a_pixel, strict=True)
    ]
    return page.table(("pixels", "ms", "ns a pixel", "against 1024²"), rows)


def threads(rounds):
    """One thread against all, beside the floor's own gain."""
    like, side = phantom.load(scenes.knee_like()), scenes.side_view()
    cases = []
    for count in (1, default_workers()):
        cases.append(Case(f"floor {count}", lambda count=count: floor_image(workers=count)))
        cases.append(Case(f"ours {count}", shot(like, side, count)))
    times, all_ = in_turns(cases, rounds), default_workers()
    gains = {w: times[f"{w} 1"].median / times[f"{w} {all_}"].median for w in ("floor", "ours")}
    rows = [
        (w, times[f"{w} 1"].ms(), times[f"{w} {all_}"].ms(), f"{gains[w]:.2f}")
        for w in ("floor", "ours")
    ]
    head = ("", "one thread, ms", f"{all_} threads, ms", "gain")
    share = f"\n\nOurs has {gains['ours'] / gains['floor']:.2f} of the floor's gain (limit: 0.9)."
    return page.table(head, rows) + share


def contours(rounds):
    """The same three tubes with other contours."""
    cases = []
    for name in scenes.CONTOURS:
        shape = phantom.load(scenes.tubes(name))
        cases.append(Case(name, shot(shape, scenes.side_view())))
    times = in_turns(cases, rounds)
    circle = times["circle"].median
    spent = times["circle"].processor_median
    rows = [
        (n, t.ms(), f"{t.median / circle:.2f}", f"{t.processor_median / spent:.2f}")
        for n, t in times.items()
    ]
    head = ("contour of three tubes", "ms", "× circle (limit: 2.5)", "in processor time")
    return page.table(head, rows)


def whole_processes(most):
    """What a person at a terminal waits for, and the memory it takes."""
    memory.command_line("knee-1993", 1024)
    helps = min(memory.help_seconds() for _ in range(3))
    seconds, mib = min(memory.command_line("knee-1993", 1024) for _ in range(3))
    rows = [
        ("`phantom --help`", f"{helps:.2f} s (limit: 0.3)", ""),
        ("`phantom radiograph knee-1993`, 1024²", f"{seconds:.2f} s (limit: 2)", f"{mib:.0f} MiB"),
    ]
    seconds, mib = memory.knee_like(most)
    limit = " (limit: 1024)" if most == max(SIZES) else ""
    rows.append((f"knee-like, {most}²", f"{seconds:.2f} s", f"{mib:.0f} MiB{limit}"))
    return page.table(("whole process", "time", "memory at most"), rows)


def our_errors():
    """Implied displacement of both views of the knee-like scene."""
    tree, rng = scenes.knee_like(), np.random.default_rng(SEED)
    shape, found = phantom.load(tree), {}
    for name, view in (("side", scenes.side_view()), ("end-on", scenes.end_on_view())):
        lengths = phantom.radiograph(shape, view).path_lengths
        found[name] = accuracy.implied_displacement_mm(tree, view, lengths, TWIN_PIXELS, rng)
    return found


def installed(module):
    return importlib.util.find_spec(module) is not None


def others(rounds):
    """Other programs on the rays of the knee-like scene's side view, times and errors."""
    view, tree = scenes.side_view(), scenes.knee_like()
    ours = {op: phantom.load(scenes.knee_like(op)) for op in ("replace", "overlap")}
    quadrics = phantom.load(scenes.ellipsoids())
    cases = [
        floor_case(),
        Case("phantom, replace", shot(ours["replace"], view)),
        Case("phantom, densities add", shot(ours["overlap"], view)),
        Case("phantom, seven ellipsoids", shot(quadrics, view)),
    ]
    exact = {op: phantom.radiograph(shape, view).line_integral / 0.05 for op, shape in ours.items()}
    images, slow = {}, max(1, min(rounds, 5))
    with contextlib.ExitStack() as closing:
        if installed("open3d"):
            from bench.others import Open3D

            embree = Open3D(tree, view)
            for name, run, op in (
                ("Open3D, signed sum: densities add", embree.signed_sum, "overlap"),
                ("Open3D, in order: replace", embree.replaced, "replace"),
            ):
                cases.append(Case(name, run, slow))
                images[name] = run() / 0.05, exact[op], op
        if installed("gvxrPython3"):
            from bench.others import Gvxr

            gvxr = Gvxr(tree, view)
            closing.callback(gvxr.close)
            name = "gVXR on Mesa: densities add"
            cases.append(Case(name, gvxr.line_integral, slow))
            images[name] = gvxr.line_integral() / 0.05, exact["overlap"], "overlap"
        if installed("itk"):
            from bench.others import Rtk

            rtk = Rtk(SIDE)
            name = "ITK-RTK, seven ellipsoids"
            cases.append(Case(name, rtk.path_length, slow))
            truth = phantom.radiograph(quadrics, view).path_lengths[..., 0]
            images[name] = rtk.path_length(), truth, "ellipsoids"
        times = in_turns(cases, rounds)
    same = {
        "overlap": "phantom, densities add",
        "replace": "phantom, replace",
        "ellipsoids": "phantom, seven ellipsoids",
    }
    rows = []
    for name, found in times.items():
        ratio, error = "", ""
        if name in images:
            image, truth, op = images[name]
            ratio = f"{found.median / times[same[op]].median:.1f} × ours"
            error = " / ".join(f"{e:.1g}" for e in accuracy.chord_errors_mm(image, truth))
        rows.append((name, found.ms(), f"{found.median / times['floor'].median:.1f}", ratio, error))
    head = ("1024²", "ms", "× floor", "same scene", "error, mm: median / 99.9 % / worst")
    text = page.table(head, rows)
    if any(name.startswith(("Open3D", "gVXR")) for name in images):
        from bench.others import triangles

        text += f"\n\nThe meshes have {triangles(tree):,} triangles."
    return text


def scenes_text(rounds):
    times = in_turns(main_cases(), rounds)
    return main_table(times) + "\n\n" + views_line(times)


def errors_text():
    told = ", ".join(f"{name} {value:.1e} mm" for name, value in our_errors().items())
    return (
        f"Implied displacement against the slow twin, {TWIN_PIXELS} pixels each: {told} "
        "(limit: 1e-8 mm)."
    )


def run(arguments):
    rounds, most = (2, 1024) if arguments.quick else (arguments.rounds, max(SIZES))
    parts = {
        "machine": f"{machine()}. {datetime.date.today().isoformat()}, version"
        f" {phantom.__version__}; load average before: {os.getloadavg()[0]:.1f}."
    }
    print(parts["machine"], flush=True)

    def tell(name, measure):
        if arguments.only and name not in arguments.only:
            return
        parts[name] = text = measure()
        print(f"\n{name}\n{text}\n", flush=True)

    fewer = max(1, rounds // 2)
    tell("scenes", lambda: scenes_text(rounds))
    tell("threads", lambda: threads(rounds))
    tell("contours", lambda: contours(fewer))
    tell("sizes", lambda: sizes(fewer, most))
    tell("processes", lambda: whole_processes(most))
    tell("errors", errors_text)
    tell("others", lambda: others(fewer))
    if arguments.write:
        page.fill(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--write", action="store_true", help="fill docs/performance.md")
    parser.add_argument("--quick", action="store_true", help="two rounds, small images")
    parser.add_argument("--only", nargs="+", help="these tables alone, by their names in the page")
    parser.add_argument("--rounds", type=int, default=11, help="images of each case")
    run(parser.parse_args())


if __name__ == "__main__":
    main()
