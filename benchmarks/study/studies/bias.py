"""Does a render know what its kernels leave? Photon maps with --bias against long path-traced references."""

import numpy as np

from darts_bench.program import PATHS, Bench, Scene, method
from darts_bench.run import PROJECT

TITLE = "Does a render know what its kernels leave?"
METHODS = ["plain points", "best points", "plain beams", "best beams"]
HEAD = ["scene", "method", "radius", "passes", "standard error", "bias", "known to", "estimate", "bound", "correlation"]
TYPES = {"fixed": "transient_photon_map", "shrinking": "progressive_transient_photon_map"}
COUNTS = ["integrator.photon_count=20000", "integrator.volume_photon_count=20000", "integrator.fixed_volume_radius=true"]


def scenes(bench):
    """Scene, radii, methods: plain sampling of the slab has a noise above 50 %."""
    side = bench.short(48, 16)
    found = [(Scene.own("cornell-fog", side), [0.1, 0.2], METHODS)]
    slab = PROJECT / "benchmarks/study/scenes/dense-cube-10.json"
    return found if bench.quick else [*found, (Scene("slab", slab, (side, side), ("media.milk.sigma_s=1",)), [0.08, 0.16], ["best points", "best beams"])]


def row_of(render, exact, doubt):
    """Relative: standard error, true bias and how well it is known, estimate and bound; correlation of the images."""
    mean, error, bias, entry = render.image(), render.image(name="standard error"), render.image(name="bias"), render.entries[-1]
    noise, scale = np.mean(error**2) + np.mean(doubt**2), np.mean(exact)
    square = max(np.mean((mean - exact) ** 2) - noise, 0.0)
    claims = [np.nan if entry[name] is None else entry[name] for name in ("relative bias", "relative bias bound")]
    return [render.passes[-1], *(f"{100 * value:.2f}" for value in (np.sqrt(np.mean(error**2)) / scale, np.sqrt(square) / scale, np.sqrt(noise) / scale, *claims)),
            f"{np.corrcoef((mean - exact).ravel(), bias.ravel())[0, 1]:.2f}"]


def summary(rows):
    """How often the bound holds, and how large the estimate is where the bias is known."""
    figures = [dict(zip(HEAD, row)) for row in rows]
    known = [figure for figure in figures if float(figure["bias"]) > float(figure["known to"])]
    held = sum(float(figure["bound"]) >= float(figure["bias"]) for figure in known)
    shares = [float(figure["estimate"]) / float(figure["bias"]) for figure in known] or [np.nan]
    return (f"Of {len(rows)} renders the bias of {len(known)} stands out of the noise. There the bound holds {held} times, and the estimate is {np.median(shares):.2f} of the "
            f"bias in the median ({min(shares):.2f} to {max(shares):.2f}).")


def run(bench: Bench):
    rows = []
    for scene, radii, methods in scenes(bench):
        # A step of a few samples: passes of one are mostly the film's own work.
        exact, doubt = bench.reference(scene, bench.short(50, 2), (*PATHS, "integrator.darts=best", "renderer.spp_step=16"))
        cells = {(name, f"{radius}, {schedule}"): (scene, [*method(name), f"integrator.type={kind}", *COUNTS,
                                                          *(f"integrator.{field}={radius}" for field in ("volume_gather_radius", "gather_radius"))])
                 for name in methods for schedule, kind in TYPES.items() for radius in radii}
        found = bench.interleaved(cells, 1, cpu=bench.short(4, 0.5), options=["--bias"])
        rows += [[scene.name, *key, *row_of(renders[0], exact, doubt)] for key, renders in found.items()]
    bench.write(TITLE, f"{bench.short(48, 16)} x {bench.short(48, 16)} pixels, passes of 20 000 paths, {bench.short(4, 0.5)} CPU seconds each, against best paths of "
                f"{bench.short(50, 2)} CPU seconds (slab: dense-cube-10 with sigma_s = 1, whose outline is a sharp edge). Relative to the mean, rms over the "
                "pixels. *Bias* is the error made without the noise of render and reference, which is in *known to*; below that a figure says "
                "nothing. *Estimate* and *bound*: the render's own. *Correlation*: of its image of the bias with the error made.",
                "All figures, in %: " + bench.keep("bias", HEAD, rows) + ".\n\n" + summary(rows))
