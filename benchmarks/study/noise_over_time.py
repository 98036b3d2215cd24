#!/usr/bin/env python3
"""Noise against time on scenes that ship: points, beams and paths, plain and best.

Writes FOLDER/noise-over-time.png and prints the figures. Noise is the relative standard error that a render reports of
itself; what a kernel blurs is not in it. Time is the processor's, so that a busy machine matters little.
"""

import argparse
import json
import subprocess
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402

PROJECT = Path(__file__).resolve().parents[2]
SCENES = {"cornell-fog, 128 x 128": ("data/scenes/cornell-fog/scene.json", "128x128"),
          "dense-cube-60, 48 x 48": ("benchmarks/study/scenes/dense-cube-60.json", "48x48")}
MAP = "integrator.type=progressive_transient_photon_map"
BEAMS = ["integrator.volume_photon_type=beams", "integrator.photon_count=40000", "integrator.volume_photon_count=4000"]
PRIMITIVES = {"points": [MAP, "integrator.volume_photon_type=points"], "beams": [MAP, *BEAMS],
              "paths": ["integrator.type=path_tracer"]}
PRESETS = {"plain": "off", "best": "best"}
COLOURS = {"points": "tab:blue", "beams": "tab:orange", "paths": "tab:green"}


def render(options, scene, primitive, preset, seconds):
    """CPU seconds and relative standard error (none after a single pass) of one render on one thread."""
    file, resolution = SCENES[scene]
    folder = options.folder.resolve()
    settings = [f"integrator.darts={PRESETS[preset]}", *PRIMITIVES[primitive]]
    subprocess.run([options.tungsten, "-t", "1", "-s", "1", "--timeout", f"{seconds:g}s", "--quiet", "--spp", "1000000",
                    "--resolution", resolution, *(word for value in settings for word in ("--set", value)),
                    "-d", folder, "-o", "image.png", "-e", "image.exr", "--stats", folder / "stats.json",
                    PROJECT / file], check=True)
    report = json.loads((folder / "stats.json").read_text())
    return report["process CPU seconds"], report["relative standard error"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tungsten", type=Path, default=PROJECT / "build/bin/tungsten")
    parser.add_argument("--seconds", type=float, nargs="+", default=[4, 8, 16])
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)

    figure, panels = plt.subplots(1, len(SCENES), figsize=(8.0, 3.3), constrained_layout=True)
    print("| scene | method | " + " | ".join(f"{s:g} s" for s in options.seconds) + " |")
    print("| --- | --- |" + " --- |" * len(options.seconds))
    for scene, axes in zip(SCENES, panels):
        for primitive in PRIMITIVES:
            for preset in PRESETS:
                measured = [render(options, scene, primitive, preset, s) for s in options.seconds]
                axes.loglog(*zip(*(m for m in measured if m[1] is not None)), marker="o", markersize=3,
                            color=COLOURS[primitive], linestyle="-" if preset == "best" else "--",
                            label=f"{preset} {primitive}")
                cells = " | ".join("-" if error is None else f"{error:.3f}" for _, error in measured)
                print(f"| {scene} | {preset} {primitive} | {cells} |", flush=True)
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("CPU seconds")
        axes.grid(which="both", alpha=0.3)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("")
    panels[0].set_ylabel("relative standard error")
    panels[0].legend(fontsize=7, ncol=3, loc="center")
    figure.savefig(options.folder / "noise-over-time.png", dpi=100)


if __name__ == "__main__":
    main()
