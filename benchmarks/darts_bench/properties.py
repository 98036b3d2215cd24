"""Studies of one property of a scene: methods at several of its values, each against a path-traced reference of its own."""

import numpy as np

from darts_bench.measures import Truth, parts
from darts_bench.plots import look, panels
from darts_bench.program import method
from darts_bench.tables import table

SEEDS = 3
METHODS = ["plain points", "best points", "plain beams", "best beams", "plain paths", "best paths"]
# Small passes: every method has several of them in a second.
PHOTONS = {"points": ["integrator.photon_count=30000", "integrator.volume_photon_count=15000"],
           "beams": ["integrator.photon_count=30000", "integrator.volume_photon_count=2000"], "paths": []}


def settings(name):
    return [*method(name), *PHOTONS[name.split(" ")[1]]]


def sweep(bench, scenes, reference_seconds, seconds, seeds):
    """{value: scene} to rows of figures by value and method, {method: [(value, mean cost, least, most)]}, and how well
    references are known."""
    rows, curves, known = [], {name: [] for name in METHODS}, []
    for value, scene in scenes.items():
        truth = Truth(*bench.reference(scene, reference_seconds))
        known.append(np.sqrt(truth.variance / truth.scale))
        found = bench.interleaved({name: (scene, settings(name)) for name in METHODS}, seeds, cpu=seconds)
        for name, renders in found.items():
            p = parts(renders, truth)
            # By seed: its own account of its noise.
            own = [render.standard_errors[-1] ** 2 * (render.image().mean() / truth.mean) ** 2 * render.cpu[-1] for render in renders]
            more = p.certain_cost - p.variance * p.cpu
            curves[name].append((value, p.certain_cost, min(own) + more, max(own) + more))
            bias = (f"{p.bias:.2g}", "") if p.bias > p.doubt else ("", f"{max(p.bias, 0) + p.doubt:.1g}")
            rows.append([f"{value:g}", name, f"{p.passes:.0f}", f"{p.median:.3f}", f"{p.relmse99:.3g}", f"{p.variance:.3g}",
                         *bias, f"{p.flip:.3f}", f"{p.mean:.3f}", f"{p.certain_cost:.3g}"])
    return rows, curves, known


def picture(bench, curves, parameter):
    figure, axes = panels(1, 5.6, 3.8)
    for name, points in curves.items():
        value, cost, least, most = zip(*points)
        axes[0].loglog(value, cost, marker="o", markersize=3, label=name, **look(name))
        axes[0].fill_between(value, least, most, color=look(name)["color"], alpha=0.15, linewidth=0)
    axes[0].set_xlabel(parameter, fontsize=9)
    axes[0].set_ylabel("MSE × CPU seconds", fontsize=9)
    axes[0].legend(fontsize=7)
    bench.plot(figure, bench.name)


def gains(curves):
    """How many times cheaper best is than plain, by value, and which method is the cheapest of all."""
    values = [point[0] for point in curves[METHODS[0]]]
    rows = []
    for i, value in enumerate(values):
        cost = {name: points[i][1] for name, points in curves.items()}
        cheapest = min(cost, key=cost.get)
        rows.append([f"{value:g}", *(f"{cost[f'plain {kind}'] / cost[f'best {kind}']:.3g}" for kind in PHOTONS), cheapest,
                     f"{cost[cheapest] / 0.01**2:.3g}"])
    return rows


def study(bench, title, about, parameter, scenes):
    """The whole of it: renders, plot, tables."""
    seeds = bench.short(SEEDS, 2)
    rows, curves, known = sweep(bench, scenes, bench.short(8, 0.2), bench.short(0.6, 0.12), seeds)
    picture(bench, curves, parameter)
    bench.write(title, f"{about} MSE against best paths of {bench.short(8, 0.2)} CPU seconds, over (reference mean)², the reference's own noise "
                f"({min(known):.1%} to {max(known):.1%} of a pixel) taken off. The cost, lines: variance by the spread of {seeds} seeds, and the "
                "squared bias where it stands out of the noise of seeds and reference; bands: the same with what seeds themselves say of their noise, least and largest. "
                "Photons and radii are the same throughout. FLIP: of the pictures, the reference's own noise in it.", f"![MSE times CPU seconds]({bench.name}.svg)",
                table([parameter, "gain of best over plain: points", "beams", "paths", "cheapest",
                       "its CPU s to 1 % (if MSE fell as 1 / time)"], gains(curves)),
                "All figures: " + bench.keep(bench.name, [parameter, "method", "passes", "error, median", "relMSE 0.99", "variance", "bias²", "bias² below",
                                                          "FLIP", "mean / reference", "cost: MSE × CPU s"], rows) + ". Where the bias does not stand out of "
                "the noise, only what it is below is known.")
