#!/usr/bin/python3
"""How often is a render further off than its --target-error promised? Many seeds of each method and scene, each stopped
by the renderer itself, against the mean of all of them. Writes a table.

    benchmarks/study/promise.py FOLDER [--seeds 200] [--target 0.2]
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
# Radii stay as they are: the mean of all seeds then has the same kernels, and noise alone is measured.
COMMON = ["integrator.type=transient_photon_map", "renderer.spp_step=1"]


def render(scene, settings, seed, target, folder):
    """The image and the statistics of one render that stops at its target."""
    image, statistics = folder / "image.npy", folder / "statistics.json"
    command = [RENDERER, "--quiet", "-t", "1", "--seed", str(seed), "--resolution", RESOLUTION, "--spp", "1000000",
               "--target-error", str(target), "-d", folder, "-e", image.name, "--stats", statistics]
    for value in COMMON + settings:
        command += ["--set", value]
    done = subprocess.run([*command, PROJECT / "data/scenes" / scene / "scene.json"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{scene}: {done.stderr}")
    return np.load(image).astype(np.float64), json.loads(statistics.read_text())


def measure(scene, settings, seeds, target, folder):
    """A row: parts beyond the standard error, the bound and the target; medians of error / bound and of passes."""
    renders = [render(scene, settings, seed, target, folder) for seed in range(1, seeds + 1)]
    # Renders that stopped early by luck are of few passes: weighed, they do not bend the mean.
    weights = np.array([statistics["passes"] for _, statistics in renders], float)
    images = np.array([image for image, _ in renders])
    truth = np.tensordot(weights / weights.sum(), images, axes=1)
    errors, claims, bounds = [], [], []
    for (image, statistics), weight in zip(renders, weights):
        own = weight / weights.sum()  # the render's part of the mean that it is compared with
        errors.append(np.sqrt(np.mean((image - truth) ** 2) / (1.0 - own)) / np.mean(truth))
        claims.append(statistics["relative standard error"])
        bounds.append(statistics["relative error bound"])
    errors, claims, bounds = map(np.array, (errors, claims, bounds))
    return [np.mean(errors > claims), np.mean(errors > bounds), np.mean(errors > target),
            np.median(bounds / errors), np.median(weights)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--target", type=float, default=0.2)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    lines = [f"{arguments.seeds} seeds each of `benchmarks/study/promise.py FOLDER --seeds {arguments.seeds} --target "
             f"{arguments.target}`, {RESOLUTION} pixels. A bound, and a target, are to hold for 95 % of the renders.", "",
             "| scene | method | beyond the standard error | beyond the bound | beyond the target | bound / error | passes |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for scene in SCENES:
        for method, settings in METHODS.items():
            row = measure(scene, settings, arguments.seeds, arguments.target, arguments.folder)
            lines.append(f"| {scene} | {method} | {row[0]:.1%} | {row[1]:.1%} | {row[2]:.1%} | {row[3]:.2f} | {row[4]:.0f} |")
            print(lines[-1], flush=True)
    (arguments.folder / "PROMISE.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
