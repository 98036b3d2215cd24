"""Light vertices of paths where there are many lights: when are there too many for them? Shows LightCaches::helpWith."""

import json

import numpy as np

from darts_bench.plots import look, panels
from darts_bench.program import PATHS, Bench, Scene
from darts_bench.tables import table

TITLE = "Many lights: light vertices of guided paths"
CASES = {"with light vertices": "best", "without": '{"preset":"best","surface_connections":false}'}
CENTRE, WIDTHS = 5.6, (0.05, 0.3)  # of gates


def ceiling(count):
    """So many small lights of the same power in all, spread over the ceiling of a box filled with fog."""
    columns = max(round(count**0.5), 1)
    lights = []
    for i in range(count):
        # Full rows, the last one spread like the others.
        row, column = divmod(i, columns)
        rows = -(-count // columns)
        in_row = columns if row < rows - 1 else count - columns * (rows - 1)
        at = [-0.8 + 1.6 * (column + 0.5) / in_row, 1.95, -0.8 + 1.6 * (row + 0.5) / rows]
        lights.append({"name": f"light {i}", "type": "quad", "bsdf": {"type": "null"}, "ext_medium": "fog", "emission": 400 / count,
                       "transform": {"position": at, "scale": 0.1, "rotation": [180, 0, 0]}})
    return lights


def scene(folder, count, width, side):
    """The file is the same for the same count, so that renders are found again."""
    wall = {"type": "lambert", "albedo": 0.7}
    quads = {"floor": [[0, 0, 0], [0, 0, 0]], "ceiling": [[0, 2, 0], [180, 0, 0]], "back": [[0, 1, -1], [90, 0, 0]],
             "left": [[-1, 1, 0], [0, 0, -90]], "right": [[1, 1, 0], [0, 0, 90]]}
    made = {"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.25, "sigma_a": 0.01}],
            "primitives": [{"name": name, "type": "quad", "bsdf": wall, "transform": {"position": position, "scale": 2, "rotation": rotation}}
                           for name, (position, rotation) in quads.items()]
            + [{"name": "block", "type": "cube", "bsdf": wall, "transform": {"position": [0.3, 0.4, 0.1], "scale": [0.6, 0.8, 0.6],
                                                                             "rotation": [0, 17, 0]}}, *ceiling(count)],
            "camera": {"type": "pinhole", "fov": 37, "medium": "fog", "reconstruction_filter": "box",
                       "transform": {"position": [0, 1, 4.1], "look_at": [0, 1, 0], "up": [0, 1, 0]}},
            "integrator": {"type": "path_tracer", "max_bounces": 16, "transient_time_center": CENTRE,
                           "transient_time_width": width},
            "renderer": {}}
    name = f"{count}-lights-{width}"
    file = folder / f"{name}.json"
    file.write_text(json.dumps(made, indent=1))
    return Scene(name, file, (side, side))


def measure(bench, lit, seconds, seeds):
    """{case: (mean, least, most of seeds' variance x CPU seconds, passes, mean image over that of the reference)}."""
    reference, _ = bench.reference(lit, 2 * seconds, settings=(*PATHS, f"integrator.darts={CASES['without']}"))
    found = bench.interleaved({case: (lit, [*PATHS, f"integrator.darts={darts}"]) for case, darts in CASES.items()}, seeds, cpu=seconds)
    result = {}
    for case, renders in found.items():
        costs = [render.standard_errors[-1] ** 2 * render.cpu[-1] for render in renders]
        mean = np.mean([render.image().mean() for render in renders])
        result[case] = (np.mean(costs), min(costs), max(costs), np.mean([render.passes[-1] for render in renders]), mean / reference.mean())
    return result


def run(bench: Bench):
    side, seconds, seeds = bench.short(48, 16), bench.short(2, 1), bench.short(3, 2)
    counts = bench.short([1, 2, 4, 8, 16, 64], [1, 4])
    rows = []
    figure, axes = panels(len(WIDTHS), 4.2, 3.2)
    for axis, width in zip(axes, WIDTHS):
        found = [measure(bench, scene(bench.work, count, width, side), seconds, seeds) for count in counts]
        for count, cases in zip(counts, found):
            ratio = cases["with light vertices"][0] / cases["without"][0]
            for case, (cost, least, most, passes, mean) in cases.items():
                rows.append([f"{width:g}", count, case, f"{passes:.0f}", f"{cost:.3g}", f"{least:.3g}", f"{most:.3g}", f"{mean:.3f}",
                             f"{ratio:.2f}" if case == "without" else ""])
        for case, line in zip(CASES, ("-", "--")):
            cost, least, most = zip(*(cases[case][:3] for cases in found))
            axis.loglog(counts, cost, marker="o", markersize=3, label=case, color=look("best paths")["color"], linestyle=line)
            axis.fill_between(counts, least, most, color=look("best paths")["color"], alpha=0.15, linewidth=0)
        axis.set_title(f"gate of {width:g}", fontsize=9)
        axis.set_xlabel("lights", fontsize=9)
    axes[0].set_ylabel("variance × CPU seconds", fontsize=9)
    axes[0].legend(fontsize=7)
    bench.plot(figure, bench.name)
    bench.write(TITLE, f"A box of fog, {side} x {side} pixels, under lights of 0.1 x 0.1 that share one power; gates about {CENTRE:g}. Best "
                f"paths of {seconds} CPU seconds, {seeds} seeds, each by its own account of its noise; `surface_connections` on or off. "
                "With more than 64 lights both are the same.",
                f"![variance times CPU seconds]({bench.name}.svg)",
                "Light vertices pay while variance × CPU s with them over that without is below 1. All figures: "
                + bench.keep(bench.name, ["gate", "lights", "best paths", "passes", "variance × CPU s", "least of seeds", "most of seeds", "mean / reference",
                                          "with / without"], rows) + ".",
                table(["gate", *(f"{count} lights" for count in counts)],
                      [[f"{width:g}", *(row[-1] for row in rows if row[0] == f"{width:g}" and row[-1])] for width in WIDTHS]))
