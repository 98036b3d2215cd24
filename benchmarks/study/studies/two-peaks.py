"""A sensor that is open at two short times (He et al. 2024, figure 7): plain, published and guided points."""

import numpy as np

from darts_bench.plots import frames_of, save, show
from darts_bench.program import Bench, Scene, method
from darts_bench.tables import table

TITLE = "A sensor that is open at two short times"
METHODS = ["plain points", "published points", "best points"]
SHOWN = ["plain points", "best points"]
WHITE_PERCENTILE = 99.5  # of the guided image: what is brighter is white


def row_of(name, render):
    """How much of what light paths offer arrives while the sensor is closed, and the image's noise."""
    counters, image = render.stats["counters"], render.image()
    outside = 1 - counters["volume deposits that may count"] / counters["volume deposits"]
    return [name, render.passes[-1], f"{outside:.2%}", f"{render.standard_errors[-1]:.3f}", f"{image.mean():.5f}"]


def run(bench: Bench):
    seconds, scene = bench.short(14, 1), Scene("two-peaks", Scene.own("two-peaks", 0).file, bench.short((320, 240), (32, 24)))
    found = {name: renders[0] for name, renders in bench.interleaved({name: (scene, method(name)) for name in METHODS}, 1, cpu=seconds).items()}
    white = np.percentile(found[SHOWN[-1]].image(), WHITE_PERCENTILE)
    figure, axes = frames_of(1, len(SHOWN), 3.2, 2.7)
    for cell, name in zip(axes[0], SHOWN):
        show(cell, found[name].image()[0], white, f"{name}, {seconds} CPU s")
    save(figure, bench.results / "two-peaks.png", dpi=85)
    bench.write(TITLE, f"The experiment of He et al. 2024, figure 7, in two-peaks, {seconds} CPU seconds each.", "![plain and guided](two-peaks.png)",
                table(["method", "passes", "outside the response", "relative standard error", "mean"], [row_of(*one) for one in found.items()]))
