"""Fog, milk and tissue that end, seen and lit from outside: what guiding gains where light must get out of a body."""

import numpy as np

from darts_bench.measures import Truth, grey, mse, picture_difference
from darts_bench.plots import panels
from darts_bench.program import Bench, Scene, method
from darts_bench.tables import table

TITLE = "Bodies that end: plain and best sampling"
PRIMITIVES = ["points", "beams", "paths"]


def gate(width):
    return f"integrator.transient_time_width={width}"


# Name, scene, settings, CPU seconds of the reference: long where paths converge slowly.
CASES = [
    ("cloud in haze", "cloud-in-haze", [], 60),
    ("dense cube, 10", "dense-cube-10", [], 60),
    ("dense cube, 60", "dense-cube-60", [], 60),
    ("dense cube, 300", "dense-cube-300", [], 60),
    ("milk behind glass", "milk-behind-glass", [], 240),
    ("milk in an index of 3", "milk-behind-glass", ["bsdfs.milk_surface.ior=3"], 120),
    ("layered tissue", "layered-tissue", [], 240),
    ("layered tissue, gate of 0.5", "layered-tissue", [gate(0.5)], 120),
    ("layered tissue, gate of 4", "layered-tissue", [gate(4)], 60),
    ("two rooms", "two-rooms", [], 60),
    ("lamp in fog", "lamp-in-fog", [], 60),
    ("several lights", "several-lights", [], 60),
]


def cost(images, cpu, truth, part=1.0):
    """MSE x CPU s relative to the reference's mean squared, without the pixels of largest MSE but for this part."""
    errors = np.mean([(grey(image) - truth.grey) ** 2 for image in images], axis=0) - grey(truth.error) ** 2
    kept = np.sort(errors.ravel())[: int(np.ceil(part * errors.size))]
    return float(kept.sum() / errors.size / truth.scale * cpu)


class Case:
    """What the seeds of one case and method say."""

    def __init__(self, renders, truth):
        images = [render.image() for render in renders]
        cpu = float(np.mean([render.cpu[-1] for render in renders]))
        self.cost, self.trimmed = cost(images, cpu, truth), cost(images, cpu, truth, 0.99)
        self.by_seed = [max(mse(image, truth), 1e-12) * render.cpu[-1] for image, render in zip(images, renders)]
        means = [image.mean() / truth.image.mean() for image in images]
        self.mean, self.error = float(np.mean(means)), float(np.std(means, ddof=1) / np.sqrt(len(means)))
        self.flip = float(np.mean([picture_difference(image[0], truth.image[0]) for image in images]))
        self.passes = float(np.mean([render.passes[-1] for render in renders]))

    def ratio(self):
        return f"{self.mean:.3f}", f"{self.error:.3f}"


def picture(bench, gains):
    """Of {case: {primitive: (gain, least and largest over pairs of seeds)}}."""
    figure, (panel,) = panels(1, 7.0, 4.4)
    for shift, (primitive, colour) in enumerate(zip(PRIMITIVES, ("tab:blue", "tab:orange", "tab:green"))):
        for row, found in enumerate(gains.values()):
            gain, low, high = found[primitive]
            place = row + 0.22 * (shift - 1)
            panel.plot([low, high], [place, place], color=colour, linewidth=3, alpha=0.35)
            panel.plot(gain, place, marker="o", markersize=4, color=colour, label=primitive if row == 0 else None)
    panel.set_xscale("log")
    panel.axvline(1, color="0.3", linewidth=0.8)
    panel.axvline(5, color="0.3", linewidth=0.8, linestyle=":")
    panel.set_yticks(range(len(gains)), list(gains))
    panel.invert_yaxis()
    panel.set_xlabel("MSE × CPU seconds of plain over best", fontsize=9)
    panel.legend(fontsize=8)
    bench.plot(figure, "bodies")


def run(bench: Bench):
    rows, gains = [], {}
    side, seeds = bench.short(32, 16), bench.short(6, 2)
    for name, scene, settings, reference in bench.short(CASES, CASES[2:3]):
        place = Scene.own(scene, side, *settings)
        truth = Truth(*bench.reference(place, bench.short(reference, 2)))
        cells = {f"{preset} {primitive}": (place, method(f"{preset} {primitive}"))
                 for primitive in PRIMITIVES for preset in ("plain", "best")}
        found = {key: Case(renders, truth)
                 for key, renders in bench.interleaved(cells, seeds, cpu=bench.short(2.5, 0.3)).items()}
        gains[name] = {}
        for primitive in PRIMITIVES:
            plain, best = found[f"plain {primitive}"], found[f"best {primitive}"]
            ratios = [a / b for a, b in zip(plain.by_seed, best.by_seed)]
            gains[name][primitive] = (plain.cost / best.cost, min(ratios), max(ratios))
            rows.append([name, primitive, f"{plain.cost:.3g}", f"{best.cost:.3g}", f"{plain.cost / best.cost:.3g}",
                         f"{plain.trimmed / best.trimmed:.3g}", f"{plain.flip:.3f}", f"{best.flip:.3f}", *plain.ratio(), *best.ratio(),
                         f"{plain.passes:.0f}", f"{best.passes:.0f}"])
    picture(bench, gains)
    bench.write(TITLE, "MSE × CPU seconds over (reference mean)², the reference's own noise taken off: " + str(seeds) + " seeds. "
                "*Gain*: plain over best; *99 %*: without the hundredth of the pixels of largest error, which tells what single bright "
                "samples make of it. *FLIP*: of the pictures, plain and best, the reference's own noise in it. Means over the reference's, with the standard error over seeds: kernels are a few per cent off, and where "
                "plain sampling has not seen the light its mean is low and its MSE, about 1, too. Bars: least and largest ratio of one seed's. "
                "Gains are least in gates that hold most of the light (tissue, gate of 4), "
                "and for beams where light hardly diffuses (two rooms).",
                "![gains](bodies.svg)",
                "All figures: " + bench.keep("bodies", ["scene", "kind", "plain", "best", "gain", "gain, 99 %", "FLIP, plain", "FLIP, best", "plain: mean",
                                                        "plain: its error", "best: mean", "best: its error", "passes, plain", "passes, best"], rows) + ".",
                table(["scene", "gain: points", "beams", "paths"], [[name, *(f"{found[primitive][0]:.3g}" for primitive in PRIMITIVES)]
                                                                    for name, found in gains.items()]))
