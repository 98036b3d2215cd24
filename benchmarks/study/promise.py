#!/usr/bin/python3
"""How often is a render further off than its --target-error promised? Many seeds of each method and scene, each stopped
by the renderer itself, against a long path-traced reference: noise and the bias of kernels. Writes a table.

    benchmarks/study/promise.py FOLDER [--seeds 200] [--target 0.2] [--reference 120] [--scenes NAME ...]
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
RENDERER = PROJECT / "build/bin/tungsten"
RESOLUTION = "24x24"
PHOTONS = ["integrator.photon_count=2000", "integrator.volume_photon_count=2000"]

# Scene, and by method the values that are set. Points and beams are of one pass's size: small, so that there are many.
SCENES = ["cornell-fog", "two-pulses"]
METHODS = {
    "best paths": ["integrator.type=transient_path_tracer", "integrator.darts=best"],
    "plain points": ["integrator.volume_photon_type=points", "integrator.darts=off", *PHOTONS],
    "best points": ["integrator.volume_photon_type=points", "integrator.darts=best", *PHOTONS],
    "best beams": ["integrator.volume_photon_type=beams", "integrator.volume_gather_radius=0.05",
                   "integrator.darts=best", *PHOTONS],
}
# Radii shrink, or a bias beyond the target would stay.
COMMON = ["integrator.type=progressive_transient_photon_map", "renderer.spp_step=1"]


def render(scene, settings, seed, stop, folder):
    """The image and the statistics of one render that stops as these options say."""
    image, statistics = folder / "image.npy", folder / "statistics.json"
    command = [RENDERER, "--quiet", "-t", "1", "--seed", str(seed), "--resolution", RESOLUTION, "--spp", "1000000",
               *stop, "-d", folder, "-e", image.name, "--stats", statistics]
    for value in COMMON + settings:
        command += ["--set", value]
    done = subprocess.run([*command, PROJECT / "data/scenes" / scene / "scene.json"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{scene}: {done.stderr}")
    return np.load(image).astype(np.float64), json.loads(statistics.read_text())


def measure(scene, settings, truth, arguments):
    """A row: parts beyond the standard error, the bound and the target; medians of bound / error, bias and passes."""
    exact, noise = truth
    stop = ["--target-error", str(arguments.target)]
    errors, claims, bounds, biases, passes = [], [], [], [], []
    for seed in range(1, arguments.seeds + 1):
        image, statistics = render(scene, settings, seed, stop, arguments.folder)
        squared = max(np.mean((image - exact) ** 2) / np.mean(exact) ** 2 - noise**2, 0.0)
        errors.append(np.sqrt(squared))
        biases.append(statistics.get("relative bias", 0.0))
        claims.append(np.hypot(statistics["relative standard error"], biases[-1]))
        bounds.append(np.hypot(statistics["relative error bound"], statistics.get("relative bias bound", 0.0)))
        passes.append(statistics["passes"])
    errors, claims, bounds = map(np.array, (errors, claims, bounds))
    return [np.mean(errors > claims), np.mean(errors > bounds), np.mean(errors > arguments.target),
            np.median(bounds / errors), np.median(biases), np.median(passes)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--target", type=float, default=0.2)
    parser.add_argument("--reference", type=int, default=120, help="seconds")
    parser.add_argument("--scenes", nargs="*", default=SCENES)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    lines = [f"{arguments.seeds} seeds each of `benchmarks/study/promise.py FOLDER --seeds {arguments.seeds} --target "
             f"{arguments.target}`, {RESOLUTION} pixels. A bound (of noise and bias together), and a target, are to hold for 95 % of the renders.", "",
             "| scene | method | beyond the standard error | beyond the bound | beyond the target | bound / error | bias | passes |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for scene in arguments.scenes:
        exact, statistics = render(scene, METHODS["best paths"], 10**6, ["--timeout", f"{arguments.reference}s"],
                                   arguments.folder)
        truth = exact, statistics["relative standard error"]
        print(f"{scene}: reference known to {truth[1]:.2%}", flush=True)
        for method, settings in METHODS.items():
            row = measure(scene, settings, truth, arguments)
            lines.append(f"| {scene} | {method} | {row[0]:.1%} | {row[1]:.1%} | {row[2]:.1%} | {row[3]:.2f} | "
                         f"{row[4]:.1%} | {row[5]:.0f} |")
            print(lines[-1], flush=True)
    (arguments.folder / "PROMISE.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
