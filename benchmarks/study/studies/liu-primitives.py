"""Liu et al.'s sliced primitives beside points, beams and paths, plain and guided: four scenes, time with and without the way to the
camera, at a moment and in a gate; and what `volume_photon_type: auto` makes of them."""

import re

import numpy as np

from darts_bench.measures import Truth, grey, parts
from darts_bench.plots import frames_of, panels, ranges, save, show, show_difference
from darts_bench.program import MAP, PRESETS, Bench, Scene, method

TITLE = "Liu et al.'s primitives beside points, beams and paths"
SLICES = ["planes", "volumes", "balls", "mis_volumes_balls", "hypervolumes"]
SHOWN = ["plain points", "plain beams", "plain mis_volumes_balls", "best mis_volumes_balls"]
UNBLURRED = 0.01  # radius of the beams, and half of their time, of what references are made by

# Name, resolution, moments (without and with the way to the camera), light paths of slices at a moment, settings.
SCENES = [
    ("fogged-box", (96, 96), (1.6, 5.3), 2000, ["integrator.include_surfaces=false"]),
    ("laser-in-fog", (96, 72), (1.8, 6.0), 5000, []),
    ("amber-half-space", (128, 72), (2.4, 5.9), 2000, []),
    ("volumetric-caustic", (128, 72), (2.45, 6.3), 2000, []),
]
SAYS = """- **Nothing but fog and a beam of light** (laser-in-fog): slices win at every gate, by 2.1 to 5.8 over the best of beams and points.
- **A half-space that absorbs, time stopped at what is seen** (amber-half-space, unwarped): hypervolumes with guiding win, by 1.7
  over guided points at the delta gate, by 2.5 in the gate that lasts. With the way to the camera counted plain beams do, by 1.6 over slices.
- **Surfaces all about** (fogged-box): beams win (guided points once), by 1.3 to 6 over slices, which pay for shadow rays at every pixel.
- **A caustic** (volumetric-caustic): light that scatters once behind the glass is left to beams by every slice. Planes, which
  blur nothing else and cost little, win without the way to the camera, guided beams by a little with it; the others get a part of the time only and
  lose. At the unwarped moment blur is nearly all of the error: all primitives are within a factor of two there.
- **`auto`** is within 1.24 of the best primitive in every row; by variance alone within 1.45 (the caustic at the unwarped moment, beams for planes).
- **Size decides**: the time of slices is in proportion to the pixels, that of beams is not. All this is of images of 7000 to 9000 pixels
  ([others](../../../docs/photon-primitives.md#32-which-one-auto-chooses))."""
NOTES = {
    "fogged-box": "paths would show what light from the fog makes of the surfaces",
    "amber-half-space": "light of a single direction, scattered once, is met by camera paths with probability zero",
    "volumetric-caustic": "a point of light behind glass is met with probability zero",
}


class Case:
    """A scene at a moment or in a gate."""

    def __init__(self, scene, unwarped, delta):
        name, resolution, moments, paths, settings = scene
        self.scene, self.unwarped, self.delta = name, unwarped, delta
        self.name = f"{name}, {'unwarped' if unwarped else 'warped'}, {'delta' if delta else 'box'}"
        self.place = Scene(name, Scene.own(name, 1).file, resolution, (
            f"integrator.camera_unwarped={str(unwarped).lower()}", f"integrator.delta_time_gate={str(delta).lower()}",
            f"integrator.transient_time_center={moments[0 if unwarped else 1]}",
            f"integrator.transient_time_width={0.06 if delta else 0.1}", *settings))
        self.paths = paths if delta else 1000

    def photons(self, primitive, preset):
        counts = {"points": (100000, 200000), "beams": (10000, 20000)}.get(primitive, (self.paths, 20000))
        return [MAP, f"integrator.volume_photon_type={primitive}", f"integrator.photon_count={counts[0]}",
                f"integrator.volume_photon_count={counts[1]}", f"integrator.darts={PRESETS[preset]}"]

    def methods(self):
        found = {f"{preset} {primitive}": self.photons(primitive, preset)
                 for preset in ("plain", "best") for primitive in ["points", "beams", *SLICES]}
        if self.scene not in NOTES:
            found.update({name: method(name) for name in ("plain paths", "best paths") if name != "plain paths" or not self.delta})
        return found

    def reference(self):
        """By the less noisy of two: slices, which blur nothing but what beams make, and beams; both blurred little."""
        sliced = self.scene == "laser-in-fog" or (self.scene == "amber-half-space" and self.unwarped)
        return self.photons("mis_volumes_balls" if sliced else "beams", "plain") + [f"integrator.volume_gather_radius={UNBLURRED}"] + (
            [f"integrator.transient_time_width={2 * UNBLURRED}"] if self.delta else [])

    def automatic(self, bench):
        """What `auto` chooses, and why."""
        render = bench.render(self.place, [MAP, "integrator.volume_photon_type=auto", "integrator.darts=best"], passes=1)
        reasons = [effect["reason"] for effect in render.stats["effects"] if effect["on"]]
        return next(found.groups() for reason in reasons if (found := re.match(rf"({'|'.join(['points', 'beams', *SLICES])}): (.*)", reason)))


def three(value):
    return f"{value:.3g}"


def picture(bench, case, truth, found):
    """The first seed's image of some methods, and the seeds' mean less the reference."""
    figure, axes = frames_of(2, len(SHOWN) + 1, 2.6, 4.4)
    white = float(np.percentile(truth.image, 99))
    show(axes[0, 0], truth.image[0], white, "reference")
    for column, name in enumerate(SHOWN, 1):
        images = [render.image()[0] for render in found[name]]
        show(axes[0, column], images[0], white, name)
        shown = show_difference(axes[1, column], (grey(np.mean(images, axis=0)) - truth.grey[0]) / truth.mean, f"mean of {len(images)} − reference")
    figure.colorbar(shown, ax=axes[1, 0], shrink=0.8, location="left", label="over the reference's mean")
    save(figure, bench.results / f"{case.scene}.png", dpi=80)


def gains(bench, chosen):
    """Of {case: (cost of the best sliced primitive, of the best of beams and points, of auto's choice)}."""
    figure, (panel,) = panels(1, 7.0, 4.6)
    colours = {"best sliced primitive": "tab:green", "best of points and beams": "tab:orange", "auto": "black"}
    ranges(panel, {case: {label: [cost] * 3 for label, cost in zip(colours, costs)} for case, costs in chosen.items()},
           "MSE × CPU seconds, plain or guided, whichever is less", colours)
    panel.legend(fontsize=8)
    bench.plot(figure, "liu-primitives")


def run(bench: Bench):
    rows, automatic, means, chosen = [], [], [], {}
    for scene in bench.short(SCENES, SCENES[1:2]):
        seeds = bench.short(5, 2)
        for unwarped, delta in ((True, True), (True, False), (False, True), (False, False)):
            case = Case(scene, unwarped, delta)
            truth = Truth(*bench.reference(case.place, bench.short(16, 2), case.reference()))
            cells = {name: (case.place, settings) for name, settings in case.methods().items()}
            found = bench.interleaved(cells, seeds, cpu=bench.short(0.4, 0.2))
            said = {name: parts(renders, truth) for name, renders in found.items()}
            costs, spreads = ({name: value(one) for name, one in said.items()} for value in (lambda one: one.cost, lambda one: one.variance * one.cpu))
            rows += [[case.name, *name.split(" "), three(cost), f"{spreads[name]:.2g}"] for name, cost in costs.items()]
            primitive, reason = case.automatic(bench)
            photons = {name: cost for name, cost in costs.items() if not name.endswith("paths")}
            best = {name: cost for name, cost in photons.items() if name.startswith("best")}
            winner = min(best, key=best.get)
            auto = costs[f"best {primitive}"]
            calm = min(spread for name, spread in spreads.items() if name in best)
            automatic.append([case.name, primitive, three(auto), winner.split()[1], three(best[winner]), f"{auto / best[winner]:.2f}",
                              f"{spreads[f'best {primitive}'] / calm:.2f}", reason])
            sliced = [cost for name, cost in photons.items() if name.split()[1] in SLICES]
            chosen[case.name] = (min(sliced), min(cost for name, cost in photons.items() if name.split()[1] not in SLICES), auto)
            means.append([case.name, *(f"{said[name].mean:.3f}" for name in SHOWN),
                          f"{np.sqrt(truth.variance / truth.scale):.2f}"])
            if unwarped and delta:
                picture(bench, case, truth, found)
    gains(bench, chosen)
    notes = "; ".join(f"{name}: {why}" for name, why in NOTES.items())
    bench.write(TITLE, "MSE × CPU seconds over (reference mean)², the reference's own noise taken off, and the same of the variance "
                "alone: what is left is blur, most of all at the front of light and in the focus of the caustic. 5 seeds; "
                "lower is better. `volumes_balls` makes at these gates what `volumes` makes. References: plain "
                f"`mis_volumes_balls` with beams of radius {UNBLURRED}, or, where they are less noisy, such beams (fogged-box, volumetric-caustic, "
                "amber-half-space warped), by another seed. No paths in " + notes + "; nor plain ones at a moment.",
                "## What it says", SAYS, "![costs](liu-primitives.svg)",
                "## Figures", "- " + bench.keep("costs", ["scene", "preset", "primitive", "MSE × CPU s", "variance × CPU s"], rows) + "\n- "
                + bench.keep("auto", ["scene", "auto", "cost of auto", "best", "cost of best", "ratio", "ratio of variances", "reason"], automatic)
                + ": `volume_photon_type: \"auto\"` with `\"darts\": \"best\"`, its cost, that of the best primitive guided alike, and the ratio of both; "
                "of variances: its variance × CPU over the least\n- " + bench.keep("means", ["scene", *SHOWN, "reference"], means)
                + ": means over the reference's, and the reference's own standard error per pixel over its mean",
                "## Pictures", "Single moments, time stopped at what is seen.",
                *(f"![{scene[0]}]({scene[0]}.png)" for scene in bench.short(SCENES, SCENES[1:2])))
