"""Time and memory against pixels, photons, frames, triangles and threads."""

import json

import numpy as np

from darts_bench.plots import look, panels, plain_log
from darts_bench.program import Bench, Scene, method
from darts_bench.scene_words import ball
from darts_bench.tables import table

TITLE = "Time and memory against the size of a scene and its image"
METHODS = ["plain points", "best points", "plain beams", "best paths"]
PHOTONS = {"points": (20000, 20000), "beams": (20000, 2000), "paths": (0, 0)}  # on surfaces, in volumes
REPEATS, PASSES = 2, 2


def counts(name, times=1.0):
    surface, volume = PHOTONS[name.split(" ")[1]]
    return [f"integrator.photon_count={int(surface * times)}", f"integrator.volume_photon_count={int(volume * times)}"] if surface else []


def triangles_of(rings):
    return 4 * rings * (rings - 1)


def ball_scene(bench, rings):
    """A ball of triangles in fog, over a floor."""
    folder = bench.work / f"ball-{rings}"
    folder.mkdir(exist_ok=True)
    (folder / f"sphere-{rings}.obj").write_text(ball(rings, 2 * rings))
    scene = {
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.3, "sigma_a": 0.02}],
        "primitives": [
            {"name": "floor", "type": "quad", "bsdf": {"type": "lambert", "albedo": 0.4}, "transform": {"scale": [5, 1, 4]}},
            {"name": "ball", "type": "mesh", "file": f"sphere-{rings}.obj", "bsdf": {"type": "lambert", "albedo": 0.7},
             "transform": {"position": [0, 0.9, 0], "scale": 0.8}},
            {"name": "lamp", "type": "point", "emission": 50, "ext_medium": "fog", "transform": {"position": [-1.2, 2, 1]}}],
        "camera": {"type": "pinhole", "resolution": [64, 64], "fov": 50, "medium": "fog", "reconstruction_filter": "box",
                   "transform": {"position": [0, 1.6, 5], "look_at": [0, 0.8, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 32, "gather_radius": 0.1, "fixed_volume_radius": True, "volume_gather_radius": 0.1,
                       "transient_time_center": 8, "transient_time_width": 1}, "renderer": {"spp": 1}}
    (folder / "scene.json").write_text(json.dumps(scene, indent=1))
    return Scene(f"ball of {triangles_of(rings)} triangles", folder / "scene.json", (64, 64))


def axes_of(bench):
    """{what grows: ({size: {method: (scene, settings, threads)}})}."""
    def fog(side, *settings):
        return Scene.own("cornell-fog", side, *settings)

    def film(frames):
        return [f"integrator.{v}" for v in (f"frame_num={frames}", "start_time=4", f"transient_time_width={4 / frames!r}")]

    sides = bench.short([32, 64, 128, 256], [8, 16])
    factors = bench.short([0.25, 1, 4, 16], [0.1, 0.4])
    frames = bench.short([1, 8, 64, 512], [1, 4])
    rings = bench.short([8, 32, 128, 512], [4, 8])
    return {
        "pixels": {side**2: {name: (fog(side), [*method(name), *counts(name)], 1) for name in METHODS} for side in sides},
        "photons of a pass": {int(sum(PHOTONS["points"]) * f): {name: (fog(48), [*method(name), *counts(name, f)], 1)
                                                              for name in METHODS if "paths" not in name} for f in factors},
        "frames": {n: {name: (fog(48), [*method(name), *counts(name), *film(n)], 1) for name in METHODS} for n in frames},
        "triangles": {triangles_of(r): {name: (ball_scene(bench, r), [*method(name), *counts(name)], 1) for name in METHODS} for r in rings},
        "threads": {n: {name: (fog(96), [*method(name), *counts(name, 2)], n) for name in METHODS} for n in (1, 2)},
    }


def measured(bench, cells):
    """{size: {method: (CPU seconds of a pass, wall seconds of a pass, load and preparation, peak MB)}}: the least of the repeats."""
    found = {}
    for again in range(1, bench.short(REPEATS, 1) + 1):
        for size, of_size in list(cells.items())[::1 if again % 2 else -1]:
            for name, (scene, settings, threads) in of_size.items():
                render = bench.render(scene, settings, 1, passes=PASSES, threads=threads, again=again)
                last, stages = render.entries[-1], render.stats["stages"]
                before = sum(stages.get(stage, {}).get("CPU seconds", 0.0) for stage in ("load", "prepare"))
                figures = (last["CPU seconds"] / PASSES, last["wall seconds"] / PASSES, before, render.stats["peak memory bytes"] / 1e6)
                known = found.setdefault(size, {}).get(name, figures)
                found[size][name] = tuple(map(min, figures, known))
    return dict(sorted(found.items()))


def exponent(sizes, values):
    """The power of the size between the two largest."""
    return float(np.log(values[-1] / values[-2]) / np.log(sizes[-1] / sizes[-2]))


def rows_of(what, found):
    """All figures."""
    for size, of_size in found.items():
        for name, (cpu, wall, before, memory) in of_size.items():
            yield [what, size, name, f"{1e3 * cpu:.3g}", f"{1e3 * wall:.3g}", f"{memory:.0f}", f"{1e3 * before:.3g}"]


def growth(found, name):
    """The power of the CPU time at the upper end, and by how many bytes memory grows per unit of size there."""
    sizes = list(found)
    if name not in found[sizes[0]]:
        return "–"
    cpu, _, _, memory = zip(*(found[size][name] for size in sizes))
    grows = 1e6 * (memory[-1] - memory[-2]) / (sizes[-1] - sizes[-2])
    return f"{exponent(sizes, cpu):.2f}" + (f", {grows:.3g} B" if memory[-1] > 1.1 * memory[0] else "")


def faster(found):
    """How many times as fast two threads are."""
    return ", ".join(f"{name} {one[1] / found[2][name][1]:.2f}" for name, one in found[1].items())


def picture(bench, found):
    grows = [what for what in found if what != "threads"]
    figure, axes = panels(len(grows), 3.4, 3.4)
    for what, panel in zip(grows, axes):
        for name in next(iter(found[what].values())):
            sizes = [size for size in found[what] if name in found[what][size]]
            panel.loglog(sizes, [found[what][size][name][0] for size in sizes], marker="o", markersize=3, label=name, **look(name))
        plain_log(panel.yaxis)
        panel.set_xlabel(what, fontsize=9)
    axes[0].set_ylabel("CPU seconds of a pass", fontsize=9)
    axes[0].legend(fontsize=7)
    bench.plot(figure, bench.name)


def run(bench: Bench):
    found = {what: measured(bench, cells) for what, cells in axes_of(bench).items()}
    picture(bench, found)
    rows = [row for what, of_what in found.items() for row in rows_of(what, of_what)]
    bench.write(TITLE, "CPU ms of a pass, of one sample for each pixel, and the peak memory of the process, in cornell-fog; triangles: a ball of them in fog. "
                f"The least of {bench.short(REPEATS, 1)} renders of {PASSES} passes each, one thread. The power: of the size, between the two largest. What a scene needs "
                "apart from what grows is in all of them, so that powers are below those of large scenes.", "![CPU seconds against sizes](scaling.svg)",
                "The power of the CPU time, and the bytes for each pixel, photon, frame or triangle where memory grows:",
                table(["what grows", *METHODS], [[what, *(growth(of_what, name) for name in METHODS)] for what, of_what in found.items() if what != "threads"]),
                f"Two threads, on a machine with other work to do, are this many times as fast as one: {faster(found['threads'])}.",
                "All figures: " + bench.keep(bench.name, ["what", "size", "method", "CPU ms of a pass", "wall ms of a pass", "peak MB",
                                                          "load and prepare, ms"], rows) + ".")
