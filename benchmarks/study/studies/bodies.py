"""Fog, milk and tissue that end, seen and lit from outside: what guiding gains where light must get out of a body."""

import numpy as np

from darts_bench.measures import Truth, grey, parts
from darts_bench.plots import panels, ranges
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


def cost_without(renders, truth, part):
    """MSE x CPU s relative to the reference's mean squared, without the pixels of largest MSE but for this part."""
    errors = np.sort((np.mean([(grey(render.image()) - truth.grey) ** 2 for render in renders], axis=0) - grey(truth.error) ** 2).ravel())
    return errors[: int(np.ceil(part * errors.size))].sum() / errors.size / truth.scale * np.mean([render.cpu[-1] for render in renders])


def run(bench: Bench):
    rows, gains = [], {}
    side, seeds = bench.short(32, 16), bench.short(6, 2)
    for name, scene, settings, reference in bench.short(CASES, CASES[2:3]):
        place = Scene.own(scene, side, *settings)
        truth = Truth(*bench.reference(place, bench.short(reference, 2)))
        cells = {f"{preset} {primitive}": (place, method(f"{preset} {primitive}"))
                 for primitive in PRIMITIVES for preset in ("plain", "best")}
        renders = bench.interleaved(cells, seeds, cpu=bench.short(2.5, 0.3))
        gains[name] = {}
        for primitive in PRIMITIVES:
            both = [renders[f"{preset} {primitive}"] for preset in ("plain", "best")]
            (plain, best), trimmed = (parts(one, truth) for one in both), [cost_without(one, truth, 0.99) for one in both]
            ratios = [a / b for a, b in zip(plain.costs, best.costs)]
            gains[name][primitive] = (plain.cost / best.cost, min(ratios), max(ratios))
            rows.append([name, primitive, f"{plain.cost:.3g}", f"{best.cost:.3g}", f"{plain.cost / best.cost:.3g}", f"{trimmed[0] / trimmed[1]:.3g}",
                         f"{plain.flip:.3f}", f"{best.flip:.3f}", *(f"{value:.3f}" for p in (plain, best) for value in (p.mean, p.mean_error)),
                         f"{plain.passes:.0f}", f"{best.passes:.0f}"])
    figure, (panel,) = panels(1, 7.0, 4.4)
    ranges(panel, gains, "MSE × CPU seconds of plain over best")
    panel.axvline(5, color="0.3", linewidth=0.8, linestyle=":")
    panel.legend(fontsize=8)
    bench.plot(figure, "bodies")
    bench.write(TITLE, "MSE × CPU seconds over (reference mean)², the reference's own noise taken off: " + str(seeds) + " seeds. "
                "*Gain*: plain over best; *99 %*: without the hundredth of the pixels of largest error, which tells what single bright "
                "samples make of it. *FLIP*: of the pictures, plain and best, the reference's own noise in it. Means over the reference's, with the standard error over seeds: kernels are a few per cent off, and where "
                "plain sampling has not seen the light its mean is low and its MSE, about 1, too. Bars: least and largest ratio of one seed's. "
                "Gains are least in gates that hold most of the light (tissue, gate of 4).",
                "![gains](bodies.svg)",
                "All figures: " + bench.keep("bodies", ["scene", "kind", "plain", "best", "gain", "gain, 99 %", "FLIP, plain", "FLIP, best", "plain: mean",
                                                        "plain: its error", "best: mean", "best: its error", "passes, plain", "passes, best"], rows) + ".",
                table(["scene", "gain: points", "beams", "paths"], [[name, *(f"{found[primitive][0]:.3g}" for primitive in PRIMITIVES)]
                                                                    for name, found in gains.items()]))
