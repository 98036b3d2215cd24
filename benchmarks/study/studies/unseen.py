"""Scenes that nobody tuned on, written when the methods were done: what best costs beside plain, whatever it shows."""

import math

import numpy as np

from darts_bench.measures import Truth, mse
from darts_bench.plots import panels
from darts_bench.program import Bench, Scene, method
from darts_bench.run import PROJECT
from darts_bench.tables import table

TITLE = "Twelve scenes that nobody tuned on"
PRIMITIVES = ["paths", "points", "beams"]
AUTO = "integrator.volume_photon_type=auto"


def scenes():
    return [f"unseen/{file.stem}" for file in sorted((PROJECT / "benchmarks/study/scenes/unseen").glob("*.json"))]


class Cost:
    """MSE x CPU s of one method's seeds over the reference's mean squared, the reference's own noise taken off."""

    def __init__(self, renders, truth):
        each = [mse(render.image(), truth) * render.cpu[-1] for render in renders]
        self.mean, self.error = float(np.mean(each)), float(np.std(each, ddof=1) / math.sqrt(len(each)))
        means = [render.image().mean() / truth.image.mean() for render in renders]
        self.light, self.light_error = float(np.mean(means)), float(np.std(means, ddof=1) / math.sqrt(len(means)))


def geometric_mean(values):
    return math.exp(float(np.mean(np.log(values))))


def picture(bench, ratios):
    figure, (panel,) = panels(1, 7.0, 4.2)
    for shift, (kind, colour) in enumerate(zip(PRIMITIVES, ("tab:green", "tab:blue", "tab:orange"))):
        for row, found in enumerate(ratios.values()):
            panel.plot(found[kind], row + 0.22 * (shift - 1), marker="o", markersize=4, color=colour, label=kind if row == 0 else None)
    panel.set_xscale("log")
    panel.axvline(1, color="0.3", linewidth=0.8)
    panel.set_yticks(range(len(ratios)), list(ratios))
    panel.invert_yaxis()
    panel.set_xlabel("MSE × CPU seconds of best over plain", fontsize=9)
    panel.legend(fontsize=8)
    bench.plot(figure, "unseen")


def run(bench: Bench):
    rows, ratios, auto = [], {}, {}
    seeds = bench.short(4, 2)
    for name in bench.short(scenes(), scenes()[:1]):
        place = Scene.own(name, bench.short(24, 12))
        truth = Truth(*bench.reference(place, bench.short(60, 2)))
        cells = {f"{preset} {kind}": (place, method(f"{preset} {kind}")) for kind in PRIMITIVES for preset in ("plain", "best")}
        cells["best auto"] = (place, [*method("best beams"), AUTO])
        found = {key: Cost(renders, truth) for key, renders in bench.interleaved(cells, seeds, cpu=bench.short(4, 0.3)).items()}
        short = name.removeprefix("unseen/")
        ratios[short] = {kind: found[f"best {kind}"].mean / found[f"plain {kind}"].mean for kind in PRIMITIVES}
        auto[short] = found["best auto"].mean / min(found["best points"].mean, found["best beams"].mean)
        rows += [[short, key, f"{cost.mean:.3g}", f"{cost.error:.2g}", f"{cost.light:.3f}", f"{cost.light_error:.3f}"]
                 for key, cost in found.items()]
    picture(bench, ratios)
    body = [[name, *(f"{found[kind]:.3g}" for kind in PRIMITIVES), f"{auto[name]:.3g}"] for name, found in ratios.items()]
    mean = ["geometric mean", *(f"{geometric_mean([found[kind] for found in ratios.values()]):.3g}" for kind in PRIMITIVES),
            f"{geometric_mean(list(auto.values())):.3g}"]
    bench.write(TITLE, f"MSE × CPU seconds of best over plain, {seeds} seeds of 4 s each: below 1 best is the cheaper. *auto*: "
                "`volume_photon_type: auto` over the better of best points and best beams. References are best paths of 60 s.",
                "![ratios](unseen.svg)", table(["scene", *PRIMITIVES, "auto"], [*body, mean]),
                "Of each method, with means over the reference's and standard errors over seeds: "
                + bench.keep("unseen", ["scene", "method", "MSE x CPU s", "its error", "mean", "its error"], rows) + ".")
