"""What code of effects that a scene does not use costs it: takes it out, one effect at a time, builds, and counts the instructions of a
render of cornell-fog, which uses none of these. Counts of valgrind do not depend on what else the machine does; set-up is left out, as
the difference of two lengths. Works in the tree that it is in, restores every file, and builds once more at the end. Some two minutes
an effect."""

import argparse
import os
import tempfile
from pathlib import Path

from darts_bench.run import PROJECT, BenchError, checked, set_options
from darts_bench.tables import comma_separated
from unused.removals import REMOVALS

SCENE = PROJECT / "data/scenes/cornell-fog/scene.json"
PATHS, MAP = "integrator.type=path_tracer", "integrator.volume_photon_type="
SMALLER_MAP = ["integrator.photon_count=6000", "integrator.volume_photon_count=3000", "renderer.spp_step=1"]
#   method: its settings, and samples of a pixel of the shorter and the longer render
METHODS = {
    "plain paths": ([PATHS], (4, 20)),
    "best paths": ([PATHS, "integrator.darts=best"], (2, 6)),
    "plain points": ([MAP + "points", *SMALLER_MAP], (1, 4)),
    "best points": ([MAP + "points", *SMALLER_MAP, "integrator.darts=best"], (1, 4)),
    "plain beams": ([MAP + "beams", *SMALLER_MAP], (1, 4)),
    "best beams": ([MAP + "beams", *SMALLER_MAP, "integrator.darts=best"], (1, 4)),
}
SIDE = 24  # pixels


def instructions(tungsten, method, samples, folder, scene=SCENE, settings=(), seed=1):
    counts = Path(folder) / "counts"
    checked(["valgrind", "--tool=cachegrind", "--cache-sim=no", f"--cachegrind-out-file={counts}", tungsten, scene, "--quiet", "-t", "1", "-d", folder,
             "--resolution", f"{SIDE}x{SIDE}", "--spp", samples, "--seed", seed, *set_options([*METHODS[method][0], *settings])])
    return int(counts.read_text().rsplit("summary:", 1)[1].split()[0])


def of_samples(tungsten, method, **other):
    """What the samples between the shorter and the longer render cost; `other` is the scene, its settings and the seed."""
    shorter, longer = METHODS[method][1]
    with tempfile.TemporaryDirectory() as folder:
        return instructions(tungsten, method, longer, folder, **other) - instructions(tungsten, method, shorter, folder, **other)


def build(folder, jobs):
    checked(["cmake", "--build", folder, f"-j{jobs}", "--target", "tungsten-app", "tungsten-path", "tungsten-photon"])


def without(edits, folder, jobs, methods):
    """Counts of a build that lacks this."""
    kept = {}
    try:
        for file, text, instead in edits:
            path = PROJECT / file
            now = path.read_text()
            kept.setdefault(path, now)
            if now.count(text) != 1:
                raise BenchError(f"{file}: '{text}' is there {now.count(text)} times")
            path.write_text(now.replace(text, instead))
        build(folder, jobs)
        return {method: of_samples(folder / "bin/tungsten", method) for method in methods}
    finally:
        for path, text in kept.items():
            path.write_text(text)


def main(arguments):
    parser = argparse.ArgumentParser(prog="bench.py unused", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=PROJECT / "build")
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--csv", type=Path, help="file for the figures, in %%")
    options = parser.parse_args(arguments)
    folder = options.build.resolve()
    build(folder, options.jobs)
    every = {method: of_samples(folder / "bin/tungsten", method) for method in METHODS}
    rows = [["what the other build lacks", *(f"{method}, %" for method in METHODS)]]
    print(*rows[0], sep=", ", flush=True)
    for what, methods, edits in REMOVALS:
        if options.only not in what:
            continue
        lacking = without(edits, folder, options.jobs, methods)
        rows.append([what, *(f"{100 * (every[m] / lacking[m] - 1):+.2f}" if m in lacking else "" for m in METHODS)])
        print(*rows[-1], sep=", ", flush=True)
    build(folder, options.jobs)
    if options.csv:
        options.csv.write_text(comma_separated(rows[0], rows[1:]))
