#!/usr/bin/python3
"""Does a render know what its kernels leave? Photon maps with --bias against long path-traced references. Writes a table
of relative errors: standard error, bias as it is, as the render estimates it, and its bound.

    benchmarks/study/bias.py FOLDER [--reference 120] [--seconds 20] [--resolution 48x48]
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
RENDERER = PROJECT / "build/bin/tungsten"

# Scene file, radii, and what all its renders set.
SCENES = {
    "cornell-fog": ("data/scenes/cornell-fog/scene.json", [0.1, 0.2], []),
    "slab": ("benchmarks/study/scenes/dense-cube-10.json", [0.08, 0.16], ["media.milk.sigma_s=1"]),
    "lamp-in-fog": ("benchmarks/study/scenes/lamp-in-fog.json", [0.1, 0.2], []),
}
PHOTONS = ["integrator.photon_count=20000", "integrator.volume_photon_count=20000"]
METHODS = {
    "plain points": ["integrator.volume_photon_type=points", "integrator.darts=off"],
    "best points": ["integrator.volume_photon_type=points", "integrator.darts=best"],
    "plain beams": ["integrator.volume_photon_type=beams", "integrator.darts=off"],
    "best beams": ["integrator.volume_photon_type=beams", "integrator.darts=best"],
}
TYPES = {"fixed": "transient_photon_map", "shrinking": "progressive_transient_photon_map"}


def render(scene, settings, seconds, resolution, folder, seed):
    """Mean, standard error and, where there is one, bias (frames, height, width, 3), and the trace's last entry."""
    file, _, own = SCENES[scene]
    command = [RENDERER, "--quiet", "-t", "1", "--bias", "--seed", str(seed), "--resolution", resolution,
               "--spp", "1000000000", "--timeout", f"{seconds}s", "-d", folder, "--trace", folder / "trace"]
    for value in ["renderer.spp_step=1", *own, *settings]:
        command += ["--set", value]
    done = subprocess.run([*command, PROJECT / file], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{scene}: {done.stderr}")
    entry = json.loads((folder / "trace/trace.json").read_text())["entries"][-1]
    images = [np.load(folder / "trace" / entry[name]).astype(np.float64) if name in entry else None
              for name in ("mean", "standard error", "bias")]
    return *images, entry


def reference(scene, seconds, resolution, folder):
    """Of paths, kept from an earlier run of the same folder."""
    kept = folder / f"{scene}-{resolution}-{seconds}.npz"
    if not kept.exists():
        # A step of a few samples: passes of one are mostly the film's own work.
        settings = ["integrator.type=transient_path_tracer", "integrator.darts=best", "renderer.spp_step=16"]
        mean, error, _, _ = render(scene, settings, seconds, resolution, folder, 7)
        np.savez(kept, mean=mean, error=error)
    data = np.load(kept)
    return data["mean"], data["error"]


def compare(scene, truth, settings, arguments):
    """Relative: standard error, true bias and how well it is known, estimate and bound; correlation of the images."""
    exact, doubt = truth
    mean, error, bias, entry = render(scene, settings, arguments.seconds, arguments.resolution, arguments.folder, 1)
    scale = np.mean(exact)
    noise = np.mean(error**2) + np.mean(doubt**2)
    square = np.mean((mean - exact) ** 2) - noise
    known = np.sqrt(noise) / scale
    claims = [np.nan if entry[name] is None else entry[name] for name in ("relative bias", "relative bias bound")]
    return (np.sqrt(np.mean(error**2)) / scale, np.sqrt(max(square, 0.0)) / scale, known, *claims,
            np.corrcoef((mean - exact).ravel(), bias.ravel())[0, 1], entry["passes"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--reference", type=int, default=120, help="seconds")
    parser.add_argument("--seconds", type=int, default=20)
    parser.add_argument("--resolution", default="48x48")
    parser.add_argument("--scenes", nargs="*", default=list(SCENES))
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    lines = ["| scene | method | radius | passes | standard error | bias | known to | estimate | bound | correlation |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    print("\n".join(lines), flush=True)
    for scene in arguments.scenes:
        truth = reference(scene, arguments.reference, arguments.resolution, arguments.folder)
        for method, settings in METHODS.items():
            for schedule, kind in TYPES.items():
                for radius in SCENES[scene][1]:
                    row = compare(scene, truth,
                                  [f"integrator.type={kind}", f"integrator.volume_gather_radius={radius}",
                                   f"integrator.gather_radius={radius}", "integrator.fixed_volume_radius=true",
                                   *settings, *PHOTONS], arguments)
                    error, bias, known, estimate, bound, correlation, passes = row
                    lines.append(f"| {scene} | {method} | {radius}, {schedule} | {passes} | {error:.2%} | {bias:.2%} | "
                                 f"{known:.2%} | {estimate:.2%} | {bound:.2%} | {correlation:.2f} |")
                    print(lines[-1], flush=True)
    (arguments.folder / "BIAS.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
