#!/usr/bin/python3
"""The two-peak experiment of He et al. 2024, figure 7: a sensor that is open at two short times, plain against guided.

Renders data/scenes/two-peaks with both for the same time, writes FOLDER/two-peaks.png with the images side by side, and
prints how much of what the light paths offer arrives while the sensor is open, and each image's noise.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "benchmarks/study"))

from images import read_exr, tone_map  # noqa: E402

METHODS = {"plain points": "off", "published points": "published", "best points": "best"}
SHOWN = ("plain points", "best points")
WHITE_PERCENTILE = 99.5  # of the guided image: what is brighter is white


def render(tungsten, folder, method, seconds):
    """Image, standard errors and counters of one method."""
    name = method.replace(" ", "-")
    image, stats = folder / f"{name}.exr", folder / f"{name}.json"
    subprocess.run([tungsten, "-t", "2", "-s", "1", "--timeout", f"{seconds:g}s", "--quiet", "--spp", "1000000",
                    "--set", f"integrator.darts={METHODS[method]}", "-d", folder, "-o", f"{name}.png", "-e", image.name,
                    "--stats", stats.name, PROJECT / "data/scenes/two-peaks/scene.json"], check=True)
    layers = read_exr(image)
    return layers[""], layers["stderr"], json.loads(stats.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tungsten", type=Path, default=PROJECT / "build/bin/tungsten")
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    results = {m: render(options.tungsten, options.folder.resolve(), m, options.seconds) for m in METHODS}

    white = np.percentile(results[SHOWN[-1]][0], WHITE_PERCENTILE)
    figure, axes = plt.subplots(1, len(SHOWN), figsize=(6.4, 2.7), layout="constrained")
    for cell, method in zip(axes, SHOWN):
        cell.imshow(tone_map(results[method][0], white))
        cell.set_title(f"{method}, {options.seconds:g} s", fontsize=9)
        cell.axis("off")
    figure.savefig(options.folder / "two-peaks.png", dpi=85)

    print("| method | passes | outside the response | relative standard error | mean |")
    print("| --- | --- | --- | --- | --- |")
    for method, (image, error, stats) in results.items():
        counters = stats["counters"]
        outside = 1.0 - counters["volume deposits that may count"] / counters["volume deposits"]
        noise = np.sqrt(np.mean(error ** 2)) / image.mean()
        print(f"| {method} | {stats['passes']} | {100.0 * outside:.2f} % | {noise:.3f} | {image.mean():.5f} |")


if __name__ == "__main__":
    main()
