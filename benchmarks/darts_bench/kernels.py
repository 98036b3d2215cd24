"""What kernels of photons lose at surfaces, and what it costs that they end there.

means SCENES: image means of plain photon maps against paths, at the radii that scenes name, and error^2 x CPU. SCENES holds NAME.json and
reference/NAME.npz (arrays mean and halfdifference, half the difference of two independent halves). For every scene and method:
  mean      of the image over the reference's
  error     its standard error, from the spread of seeds and the reference's halves
  error2    mean square over pixels, channels and frames of what an image is off the reference, the reference's noise
            taken off, but never below the square of the renderer's own standard error; over the square of the mean
  cost      error2 x CPU seconds, mean over seeds
Lights of a single direction have no reference by paths: such scenes are left out.

cost SCENE.json...: CPU seconds of as many passes with kernels that end and without, in turns, and variances."""

import argparse
import csv
import json
import sys
from pathlib import Path

import numpy as np

from darts_bench.measures import standard_error
from darts_bench.run import BenchError, add_renderer, film, require_renderer
from darts_bench.tables import comma_separated

METHODS = {"points": "points", "beams": "beams", "slices": "mis_volumes_balls"}
SINGLE_DIRECTION = ("collimated", "directional_point")
FIELDS = ["scene", "method", "mean", "error", "error2", "cpu", "cost", "passes"]


def settings_of(options, method, *more):
    return ["integrator.type=transient_photon_map", f"integrator.volume_photon_type={METHODS[method]}", "renderer.spp_step=1", *more, *options.set]


def row_of(options, scene, method, passes):
    """The figures of FIELDS; so many passes, or as many as there is time for."""
    with np.load(scene.parent / f"reference/{scene.stem}.npz") as reference:
        exact, half = reference["mean"].astype(float), reference["halfdifference"].astype(float)
    level, noise = exact.mean(), np.square(half).mean()
    films = [film(options.tungsten, scene, settings_of(options, method, "integrator.darts=off"), passes, options.seconds, seed)
             for seed in range(1, options.seeds + 1)]
    means, cpu = [one.mean.mean() / level for one in films], [one.statistics["process CPU seconds"] for one in films]
    errors = [max(np.square(one.error).mean(), np.square(one.mean - exact).mean() - noise) / level**2 for one in films]
    doubt = np.hypot(standard_error(means) if len(means) > 1 else 0.0, np.sqrt(noise / exact.size) / level)
    return dict(zip(FIELDS, [scene.stem, method, np.mean(means), doubt, np.mean(errors), np.mean(cpu), np.mean(np.multiply(errors, cpu)),
                             sum(one.statistics["passes"] for one in films)]))


def has_reference(scene):
    """By paths, which meet no light of a single direction."""
    lights = json.loads(scene.read_text())["primitives"]
    return (scene.parent / f"reference/{scene.stem}.npz").exists() and not any(p["type"] in SINGLE_DIRECTION for p in lights)


def means(options):
    passes = {}
    if options.like:
        with options.like.open(newline="") as file:
            passes = {(row["scene"], row["method"]): int(row["passes"]) // options.seeds for row in csv.DictReader(file)}
    rows = []
    for scene in sorted(options.scenes.glob("*.json")):
        if options.only and scene.stem not in options.only.split(",") or not has_reference(scene):
            continue
        for method in options.methods.split(","):
            try:
                rows.append(row_of(options, scene, method, passes.get((scene.stem, method))))
            except BenchError as problem:
                print(f"{scene.stem}, {method}: {problem}", file=sys.stderr)
                continue
            print("{scene:30s} {method:7s} mean {mean:.4f} +- {error:.4f}  error2 {error2:.3e}  cost {cost:.3e}  passes {passes}".format(**rows[-1]), flush=True)
    if options.csv:
        options.csv.write_text(comma_separated(FIELDS, [[f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row.values()] for row in rows]))


def cost(options):
    for scene in options.scenes:
        for method in options.methods.split(","):
            def render(ends, passes=None, seed=1):
                return film(options.tungsten, scene, settings_of(options, method, f"integrator.boundary_kernels={ends}"), passes, options.seconds, seed)

            passes = max(2, render("false").statistics["passes"])
            pairs = [[render(ends, passes, seed) for ends in ("false", "true")] for seed in range(1, options.seeds + 1)]
            cpu = np.sum([on.cpu for _, on in pairs]) / np.sum([off.cpu for off, _ in pairs])
            variance = np.sum([np.square(on.error).mean() for _, on in pairs]) / np.sum([np.square(off.error).mean() for off, _ in pairs])
            print(f"{scene.name:30} {method:7} {passes:5d} passes: CPU x {cpu:.3f}, variance x {variance:.3f}", flush=True)


def main(arguments):
    parser = argparse.ArgumentParser(prog="bench.py kernels", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    both = argparse.ArgumentParser(add_help=False)
    add_renderer(both)
    both.add_argument("--seconds", type=float, default=2, help="of a render, by the wall's clock")
    both.add_argument("--seeds", type=int, default=2)
    both.add_argument("--methods", default="points,beams", help="of " + ", ".join(METHODS))
    both.add_argument("--set", action="append", default=[], metavar="FIELD=VALUE", help="of the scenes, as the command has it")
    what = parser.add_subparsers(dest="what", required=True)
    one = what.add_parser("means", parents=[both])
    one.add_argument("scenes", type=Path, help="the folder")
    one.add_argument("--only", default="", help="names of scenes, with commas")
    one.add_argument("--csv", type=Path, help="the table, beside what is printed")
    one.add_argument("--like", type=Path, help="table of an earlier run: as many passes as there, so that biases are compared at equal noise")
    other = what.add_parser("cost", parents=[both])
    other.add_argument("scenes", nargs="+", type=Path)
    options = parser.parse_args(arguments)
    require_renderer(options.tungsten)
    (means if options.what == "means" else cost)(options)
