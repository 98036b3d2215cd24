"""Scenes that nobody tuned on, written when the methods were done: what best costs beside plain, whatever it shows."""

import numpy as np

from darts_bench.measures import Truth, parts, standard_error
from darts_bench.plots import panels, ranges
from darts_bench.program import Bench, Scene, method
from darts_bench.run import PROJECT
from darts_bench.tables import table

TITLE = "Twelve scenes that nobody tuned on"
PRIMITIVES = ["paths", "points", "beams"]
AUTO = "integrator.volume_photon_type=auto"


def scenes():
    return [f"unseen/{file.stem}" for file in sorted((PROJECT / "benchmarks/study/scenes/unseen").glob("*.json"))]


def geometric_mean(values):
    return float(np.exp(np.mean(np.log(values))))


def picture(bench, ratios):
    figure, (panel,) = panels(1, 7.0, 4.2)
    ranges(panel, {name: {kind: [ratio] * 3 for kind, ratio in found.items()} for name, found in ratios.items()}, "MSE × CPU seconds of best over plain")
    panel.legend(fontsize=8)
    bench.plot(figure, "unseen")


def run(bench: Bench):
    rows, ratios, auto = [], {}, {}
    seeds = bench.short(3, 2)
    for name in bench.short(scenes(), scenes()[:1]):
        place = Scene.own(name, bench.short(24, 12))
        truth = Truth(*bench.reference(place, bench.short(40, 2)))
        cells = {f"{preset} {kind}": (place, method(f"{preset} {kind}")) for kind in PRIMITIVES for preset in ("plain", "best")}
        cells["best auto"] = (place, [*method("best beams"), AUTO])
        found = {key: parts(renders, truth) for key, renders in bench.interleaved(cells, seeds, cpu=bench.short(4, 0.3)).items()}
        costs = {key: np.mean(p.costs) for key, p in found.items()}
        short = name.removeprefix("unseen/")
        ratios[short] = {kind: costs[f"best {kind}"] / costs[f"plain {kind}"] for kind in PRIMITIVES}
        auto[short] = costs["best auto"] / min(costs["best points"], costs["best beams"])
        rows += [[short, key, f"{costs[key]:.3g}", f"{standard_error(p.costs):.2g}", f"{p.mean:.3f}", f"{p.mean_error:.3f}"] for key, p in found.items()]
    picture(bench, ratios)
    body = [[name, *(f"{found[kind]:.3g}" for kind in PRIMITIVES), f"{auto[name]:.3g}"] for name, found in ratios.items()]
    mean = ["geometric mean", *(f"{geometric_mean([found[kind] for found in ratios.values()]):.3g}" for kind in PRIMITIVES),
            f"{geometric_mean(list(auto.values())):.3g}"]
    bench.write(TITLE, f"MSE × CPU seconds of best over plain, {seeds} seeds of 4 s each: below 1 best is the cheaper. *auto*: "
                "`volume_photon_type: auto` over the better of best points and best beams. References are best paths of 40 s.",
                "![ratios](unseen.svg)", table(["scene", *PRIMITIVES, "auto"], [*body, mean]),
                "Of each method, with means over the reference's and standard errors over seeds: "
                + bench.keep("unseen", ["scene", "method", "MSE x CPU s", "its error", "mean", "its error"], rows) + ".")
