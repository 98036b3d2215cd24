"""What arrives at a patch over time: 60 bins by several methods with their error bands, beside a reference."""

import numpy as np

from darts_bench.measures import grey
from darts_bench.plots import look, panels
from darts_bench.program import Bench, Scene, method
from darts_bench.tables import table

TITLE = "The arrival histogram of a patch"
METHODS = ["plain points", "best points", "best beams", "plain paths", "best paths"]
START, WIDTH, BINS = 4.0, 0.1, 60
LIT = 0.02  # bins that hold at least this part of the brightest count


def histogram(render, patch):
    """Mean over the patch's pixels, by bin."""
    return grey(render.image())[:, patch, patch].mean(axis=(1, 2))


def figures(histograms, reference, doubt):
    """Mean histogram of the seeds and its standard error; over the bins that are lit: its rms relative error as it says
    and as it is, and the mean square deviation in standard errors of both (1: as it should be), and the worst."""
    mean, error = histograms.mean(axis=0), histograms.std(axis=0, ddof=1) / np.sqrt(len(histograms))
    lit = reference > LIT * reference.max()
    # The spread of few seeds is smoothed over three bins; t statistics of so few would be meaningless bin by bin.
    smooth = np.sqrt(np.convolve(error**2, np.ones(3) / 3, "same") + doubt**2)
    deviation = ((mean - reference) / smooth)[lit]
    return mean, error, [f"{np.sqrt(np.mean((error / reference)[lit] ** 2)):.2%}", f"{np.sqrt(np.mean((mean / reference - 1)[lit] ** 2)):.2%}",
                         f"{np.mean(deviation**2):.2f}", f"{np.abs(deviation).max():.1f}", f"{mean.sum() / reference.sum():.4f}"]


def run(bench: Bench):
    side = bench.short(24, 8)
    patch = slice(side // 3, 2 * side // 3)
    frames = [f"integrator.start_time={START}", f"integrator.transient_time_width={WIDTH}", f"integrator.frame_num={BINS}",
              "integrator.photon_count=30000", "integrator.volume_photon_count=15000"]
    scene = Scene.own("cornell-fog", side, *frames)
    best = {"reference": (scene, method("best paths"))}
    long = np.array([histogram(r, patch) for r in bench.interleaved(best, bench.short(4, 2), 1001, cpu=bench.short(8, 1.5))["reference"]])
    reference, doubt = long.mean(axis=0), long.std(axis=0, ddof=1) / np.sqrt(len(long))
    found = bench.interleaved({name: (scene, method(name)) for name in METHODS}, bench.short(5, 2), cpu=bench.short(1.5, 0.3))
    times = START + WIDTH * (np.arange(BINS) + 0.5)
    figure, axes = panels(2, 4.6, 3.4)
    axes[0].semilogy(times, reference, color="black", linewidth=1, label="reference")
    rows = []
    for name, renders in found.items():
        mean, error, row = figures(np.array([histogram(r, patch) for r in renders]), reference, doubt)
        rows.append([name, f"{np.mean([r.cpu[-1] for r in renders]):.1f}", *row])
        axes[0].semilogy(times, mean, label=name, linewidth=0.8, **look(name))
        axes[0].fill_between(times, np.maximum(mean - error, reference.max() * 1e-4), mean + error, color=look(name)["color"], alpha=0.2, linewidth=0)
        if name != "plain paths":  # its band would hide the others
            axes[1].plot(times, mean / reference, linewidth=0.8, **look(name))
            axes[1].fill_between(times, (mean - error) / reference, (mean + error) / reference, color=look(name)["color"], alpha=0.2, linewidth=0)
    axes[0].set_title("radiance of the patch", fontsize=9)
    axes[1].set_title("over the reference", fontsize=9)
    axes[1].set_ylim(0.7, 1.3)
    axes[0].legend(fontsize=7)
    for panel in axes:
        panel.set_xlabel("time", fontsize=9)
    bench.plot(figure, "transient")
    bench.write(TITLE, f"cornell-fog, {side} x {side} pixels, the middle ninth of the picture, {BINS} bins of {WIDTH} from {START} on. Mean of "
                f"{bench.short(5, 2)} seeds, bands: its standard error, from their spread (pixels of a photon map are not independent). Reference: "
                f"best paths, {bench.short(4, 2)} seeds of {bench.short(8, 1.5)} CPU seconds. Over the bins that hold at least {LIT:.0%} of the "
                "brightest's: relative standard error and error made, rms; mean square of the deviation in standard errors (about 1 where there "
                "is noise alone, with so few seeds up to about 1.7); its largest.",
                "![histogram and ratio](transient.svg)",
                table(["method", "CPU s a seed", "standard error", "error made", "mean square of deviation / σ", "worst", "sum / reference"], rows))
