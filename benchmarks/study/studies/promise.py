"""How often is a render further off than its --target-error promised? Many seeds, each stopped by the renderer itself."""

import numpy as np

from darts_bench.program import Bench, Scene, method
from darts_bench.tables import table

TITLE = "How often a render is further off than it promised"
TARGET = 0.4
SMALL = ["integrator.photon_count=2000", "integrator.volume_photon_count=2000"]  # passes, so that there are many
SETTINGS = {"best paths": [], "plain points": SMALL, "best points": SMALL, "best beams": [*SMALL, "integrator.volume_gather_radius=0.05"]}


def row_of(renders, exact, doubt):
    """Parts of the renders whose error is beyond their standard error, bound and target; medians of bound / error, bias and passes."""
    squares = [np.mean((render.image() - exact) ** 2) - np.mean(doubt**2) for render in renders]
    errors = np.sqrt(np.maximum(squares, 0.0)) / np.mean(exact)

    def told(name, of_bias):
        return np.array([np.hypot(render.stats[name], render.stats.get(of_bias) or 0.0) for render in renders])

    claims, bounds = told("relative standard error", "relative bias"), told("relative error bound", "relative bias bound")
    biases = [render.stats.get("relative bias") or 0.0 for render in renders]
    return [*(f"{np.mean(errors > limit):.1%}" for limit in (claims, bounds, TARGET)), f"{np.median(bounds / errors):.2f}",
            f"{np.median(biases):.1%}", f"{np.median([render.passes[-1] for render in renders]):.0f}"]


def run(bench: Bench):
    scene, seeds = Scene.own("cornell-fog", bench.short(24, 12)), bench.short(200, 5)
    exact, doubt = bench.reference(scene, bench.short(40, 2))
    rows = []
    for name, settings in list(SETTINGS.items())[:bench.short(4, 1)]:
        renders = [bench.render(scene, [*method(name), *settings], seed, options=["--target-error", str(TARGET)]) for seed in range(1, seeds + 1)]
        rows.append([scene.name, name, *row_of(renders, exact, doubt)])
        print(rows[-1], flush=True)
    bench.write(TITLE, f"{seeds} seeds each, {scene.words()} pixels, `--target-error {TARGET}`, against best paths of {bench.short(40, 2)} CPU seconds. A bound (of noise "
                "and bias together), and a target, are to hold for 95 % of the renders; the standard error is the error to be expected.",
                table(["scene", "method", "beyond the standard error", "beyond the bound", "beyond the target", "bound / error", "bias", "passes"], rows))
