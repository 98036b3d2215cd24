"""What the parts of the sampling bring: those of the paper one by one, and those of `best` each left out alone."""

import json

import numpy as np

from darts_bench.measures import Truth, parts
from darts_bench.plots import panels, plain_log, ranges
from darts_bench.program import PRIMITIVES, Bench, Scene

TITLE = "Ablation: the parts of the sampling, with the same photons and radii"
DARTS = "integrator.darts="
PAPER = {
    "vanilla": [DARTS + "off"],
    "DA: distances only": [DARTS + '{"preset":"published","direction":"phase"}', "integrator.enable_elliptical=false"],
    "EDA and elliptical only": [DARTS + '{"preset":"published","direction":"eda","distance":"plain"}'],
    "published: all of it": [DARTS + '{"preset":"published","direction":"eda"}'],
    "best": [DARTS + "best"],
}
# What `best` has, and the switch that takes it away.
PARTS = {
    "guided distances": {"distance": "plain"},
    "guided directions": {"direction": "phase"},
    "length before direction": {"length_first": False},
    "Green's function": {"greens_function": "none"},
    "candidates (1)": {"candidates": 1},
    "flat candidates": {"proposals": "exponential"},
    "bounds by time": {"bounded": False},
    "roulette": {"roulette": 0},
    "surface connections": {"surface_connections": False},
    "glossy camera subpaths": {"glossy_sensor_paths": False},
    "bodies": {"bodies": False},
}
# Small passes: many of them in little time.
PHOTONS = ["integrator.photon_count=30000", "integrator.volume_photon_count=15000"]


def variants(primitive):
    found = dict(PAPER)
    found["best without control vertices"] = [DARTS + "best", "integrator.enable_elliptical=false"]
    for part, switch in PARTS.items():
        found[f"best without {part}"] = [DARTS + json.dumps({"preset": "best", **switch}, separators=(",", ":"))]
    return {key: [*PRIMITIVES[primitive], *PHOTONS, *values] for key, values in found.items()}


def groups(bench):
    """Scene, what renders its reference, and the primitives that are taken apart."""
    side = bench.short(64, 16)
    paths, points = (*PRIMITIVES["paths"], DARTS + "best"), (*PRIMITIVES["points"], *PHOTONS, DARTS + "best")
    found = [(Scene.own("cornell-fog", side), paths, ["points", "paths"])]
    if not bench.quick:
        found += [(Scene.others("cbox", side), paths, ["points", "paths"]), (Scene.others("dragon", side), points, ["points"]),
                  (Scene.own("lamp-in-fog", 32), paths, ["points", "paths"])]
    return [group for group in found if group[0]]


def rows_of(found, truth):
    """The table's rows, and by variant the cost over that of best: mean, least and largest of the seeds."""
    figures = {key: parts(renders, truth) for key, renders in found.items()}
    vanilla, best = (np.mean(figures[key].costs) for key in ("vanilla", "best"))
    rows, losses = [], {}
    for key, p in figures.items():
        costs = np.mean(p.costs), min(p.costs), max(p.costs)
        rows.append([key, f"{p.told:.3f}", f"{p.median:.3f}", f"{p.flip:.3f}", f"{p.mean:.3f}", *(f"{cost:.3g}" for cost in costs),
                     f"{vanilla / costs[0]:.3g}", f"{costs[0] / best:.3g}"])
        losses[key] = {"loss": [cost / best for cost in costs]}
    return rows, losses


def picture(bench, pictures):
    """Of [(title, losses)]."""
    figure, axes = panels(len(pictures), 2.3, 4.6)
    for (title, losses), panel in zip(pictures, axes):
        ranges(panel, losses, "MSE × CPU seconds, over that of best" if panel is axes[len(axes) // 2] else "")
        plain_log(panel.xaxis)
        panel.set_title(title, fontsize=8)
        if panel is not axes[0]:
            panel.set_yticklabels([])
    bench.plot(figure, "ablation")


def dearest(table):
    """By scene and primitive, the parts whose loss costs most."""
    lines = []
    for scene, primitive in dict.fromkeys((row[0], row[1]) for row in table):
        parts = [(float(row[-1]), row[2].removeprefix("best without ")) for row in table if row[:2] == [scene, primitive] and row[2].startswith("best without ")]
        lines.append(f"- {scene}, {primitive}: " + ", ".join(f"{part} {times:.3g}" for times, part in sorted(parts, reverse=True)[:4]))
    return "\n".join(lines)


def run(bench: Bench):
    table, pictures = [], []
    for scene, by, primitives in groups(bench):
        truth = Truth(*bench.reference(scene, bench.short(25, 2), by))
        for primitive in primitives:
            cells = {key: (scene, values) for key, values in variants(primitive).items()}
            found = bench.interleaved(cells, 2, cpu=bench.short(1.0, 0.3))
            rows, losses = rows_of(found, truth)
            table += [[scene.words(), primitive, *row] for row in rows]
            pictures.append((f"{scene.name}, {primitive}", losses))
    picture(bench, pictures)
    bench.write(TITLE, "Above the line `best` the paper's parts, from none to all; below it `best` with one part off. Above 1 in the "
                "figure: the part is worth its time. FLIP: of the pictures, the reference's own noise in it. Dots: two seeds, bars: one and the other. MSE over (reference "
                "mean)²; a heavy tail that two seeds have not seen is in no figure, and where the mean is far from the reference's (points of "
                "lamp-in-fog) a render that shows nothing has a low MSE: there the figures rank nothing.", "![cost over that of best](ablation.svg)",
                "Parts that `best` can spare least, with its cost without them over that with them:", dearest(table),
                "All figures: " + bench.keep("ablation", ["scene", "primitive", "variant", "standard error", "error, median", "FLIP", "mean / reference",
                                                          "MSE × CPU s", "least of seeds", "most of seeds", "gain over vanilla", "times best's"], table) + ".")
