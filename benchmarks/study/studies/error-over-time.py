"""Error against processor time: points, beams and paths, plain, published and best, against long path-traced references."""

from darts_bench.measures import Truth, band, curve, parts
from darts_bench.plots import look, panels
from darts_bench.program import Bench, Scene, method
from darts_bench.tables import table

TITLE = "Error against processor time"
METHODS = ["plain points", "published points", "best points", "plain beams", "best beams", "plain paths", "best paths"]
# From the README beside the shared references: relative standard deviation and block bias of the published implementation, 2 x 30 s.
PUBLISHED = {"points": (60.0, (0.165**2 + 0.063**2) ** 0.5), "paths": (60.0, 0.46)}


def scenes(bench):
    found = {"cbox": Scene.others("cbox", bench.short(128, 32)), "cornell-fog": Scene.own("cornell-fog", bench.short(64, 32))}
    return {name: scene for name, scene in found.items() if scene}


def settings(name, scene):
    """Beams are fewer: each is seen by every pixel that looks across it."""
    fewer = ["integrator.photon_count=60000", "integrator.volume_photon_count=4000"]
    return [*method(name), *(fewer if "beams" in name else [])]


def run(bench: Bench):
    chosen = scenes(bench)
    figure, axes = panels(len(chosen), 4.6, 3.6)
    rows = []
    for (name, scene), panel in zip(chosen.items(), axes):
        truth = Truth(*bench.reference(scene, bench.short(100 if name == "cbox" else 50, 4)))
        cells = {key: (scene, settings(key, scene)) for key in METHODS}
        renders = bench.interleaved(cells, bench.short(3, 2), cpu=bench.short(7, 1))
        for key, of_key in renders.items():
            cpu, middle, least, most = band([curve(render, truth) for render in of_key])
            panel.loglog(cpu, middle, label=key, **look(key))
            panel.fill_between(cpu, least, most, color=look(key)["color"], alpha=0.18, linewidth=0)
            p = parts(of_key, truth)
            rows.append([scene.words(), key, f"{p.cpu:.1f}", f"{p.median:.3f}", f"{p.relmse99:.3g}", f"{p.variance:.3g}",
                         f"{p.bias:.2g}", f"{p.flip:.3f}", f"{p.cost:.3g}"])
        if name == "cbox":
            for primitive, (seconds, error) in PUBLISHED.items():
                panel.loglog(seconds, error, marker="*", markersize=10, linestyle="none", color=look(f"best {primitive}")["color"],
                             label=f"published implementation, {primitive}")
        panel.set_title(scene.words(), fontsize=9)
        panel.set_xlabel("CPU seconds", fontsize=9)
    axes[0].set_ylabel("relative root mean squared error", fontsize=9)
    axes[0].legend(fontsize=6.5, loc="best")
    bench.plot(figure, "error-over-time")
    bench.write(TITLE, "Lines: the median of the seeds, bands: their least and largest. Stars: what a published implementation "
                "reached on a machine of the same kind with 2 threads in 30 s (60 CPU seconds; standard deviation and bias of "
                "blocks as far as they are known).", "![error against CPU seconds](error-over-time.svg)", EXPLAINED,
                "MSE × CPU s (all figures: " + bench.keep(bench.name, ["scene", "method", "CPU s", "error, median", "relMSE 0.99", "variance", "bias²", "FLIP", "MSE × CPU s"],
                                                          rows) + "):",
                table(["method", *(scene.words() for scene in chosen.values())],
                      [[key, *(row[-1] for row in rows if row[1] == key)] for key in METHODS]))


EXPLAINED = """*Error*: root of the mean squared error of the grey image over the reference's mean, the reference's own noise taken
off. *relMSE 0.99*: mean squared error after both images are divided by the 0.99 quantile of the reference. *Variance* over the seeds,
*bias²*: what is left, both over (reference mean)²; below zero it is noise. *FLIP*: of the pictures, the reference's own
noise in it. *MSE × CPU s*: 1 / efficiency."""
