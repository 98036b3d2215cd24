#!/usr/bin/python3
"""What kernels lose: image means of plain photon maps against paths, at the radii that scenes name, and error^2 x CPU.

usage: means.py TUNGSTEN SCENES [--seconds 2] [--seeds 2] [--methods points,beams] [--only NAME,...] [--csv FILE] [--like CSV]
                [--set FIELD=VALUE]...

SCENES holds NAME.json and reference/NAME.npz (arrays mean and halfdifference, half the difference of two independent
halves). For every scene and method:
  mean      of the image over the reference's
  error     its standard error, from the spread of seeds and the reference's halves
  error2    mean square over pixels, channels and frames of what an image is off the reference, the reference's noise
            taken off, but never below the square of the renderer's own standard error; over the square of the mean
  cost      error2 x CPU seconds, mean over seeds
Lights of a single direction have no reference by paths: such scenes are left out."""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

METHODS = {"points": "points", "beams": "beams", "slices": "mis_volumes_balls"}
SINGLE_DIRECTION = ("collimated", "directional_point")
FIELDS = ["scene", "method", "mean", "error", "error2", "cpu", "cost", "passes"]


def render(args, scene, method, seed, folder):
    out = os.path.join(folder, "image.npz")
    settings = {"integrator.type": "transient_photon_map", "integrator.volume_photon_type": METHODS[method], "integrator.darts": "off", "renderer.spp_step": 1}
    sets = [f"{key}={value}" for key, value in settings.items()] + args.set
    command = [args.tungsten, os.path.join(args.scenes, scene + ".json"), "--quiet", "--no-frames", "-t", "1", "-s", str(seed),
               "-d", folder, "-e", out, "--allow-outside"]
    passes = args.passes_like.get((scene, method))
    command += ["--spp", str(passes)] if passes else ["--timeout", f"{args.seconds}s", "--spp", "100000000"]
    run = subprocess.run(command + [part for text in sets for part in ("--set", text)], capture_output=True, text=True)
    if run.returncode:
        raise RuntimeError((run.stderr + run.stdout).strip()[:300])
    result = np.load(out)
    statistics = json.loads(bytes(result["metadata.json"]))["statistics"]
    return result["mean"].astype(float), result["standard_error"].astype(float), statistics["process CPU seconds"], statistics.get("passes", 0)


def row_of(args, scene, method, reference):
    """The figures of FIELDS."""
    exact, half = reference["mean"].astype(float), reference["halfdifference"].astype(float)
    level, noise = exact.mean(), np.square(half).mean()
    means, errors, cpus, passes = [], [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, args.seeds + 1):
            image, own, cpu, count = render(args, scene, method, seed, folder)
            means.append(image.mean() / level)
            errors.append(max(np.square(own).mean(), np.square(image - exact).mean() - noise) / level**2)
            cpus.append(cpu)
            passes += count
    spread = np.std(means, ddof=1) / np.sqrt(args.seeds) if args.seeds > 1 else 0.0
    doubt = np.hypot(spread, np.sqrt(noise / exact.size) / level)
    return dict(zip(FIELDS, [scene, method, np.mean(means), doubt, np.mean(errors), np.mean(cpus), np.mean(np.multiply(errors, cpus)), passes]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tungsten")
    parser.add_argument("scenes")
    parser.add_argument("--seconds", type=float, default=2)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--methods", default="points,beams")
    parser.add_argument("--only", default="")
    parser.add_argument("--csv", default="", help="the table, beside what is printed")
    parser.add_argument("--like", default="", help="table of an earlier run: as many passes as there, so that biases are compared at equal noise")
    parser.add_argument("--set", action="append", default=[], help="of the scenes, as the command has it")
    args = parser.parse_args()
    args.passes_like = {}
    if args.like:
        with open(args.like, newline="") as file:
            args.passes_like = {(row["scene"], row["method"]): int(row["passes"]) // args.seeds for row in csv.DictReader(file)}
    names = sorted(file[:-5] for file in os.listdir(args.scenes) if file.endswith(".json"))
    rows = []
    for name in names:
        reference = os.path.join(args.scenes, "reference", name + ".npz")
        lights = json.load(open(os.path.join(args.scenes, name + ".json")))["primitives"]
        if args.only and name not in args.only.split(",") or not os.path.exists(reference) or any(p["type"] in SINGLE_DIRECTION for p in lights):
            continue
        for method in args.methods.split(","):
            try:
                rows.append(row_of(args, name, method, np.load(reference)))
            except RuntimeError as problem:
                print(f"{name}, {method}: {problem}", file=sys.stderr)
                continue
            print("{scene:30s} {method:7s} mean {mean:.4f} +- {error:.4f}  error2 {error2:.3e}  cost {cost:.3e}  passes {passes}".format(**rows[-1]), flush=True)
    if args.csv:
        with open(args.csv, "w", newline="") as file:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows)


if __name__ == "__main__":
    main()
