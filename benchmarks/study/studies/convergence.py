"""How errors fall with passes, beside theory: paths, and the schedules of shrinking radii, single scattering of a pulse."""

import numpy as np

from darts_bench.measures import Truth, mse, parts, slope
from darts_bench.plots import panels
from darts_bench.program import Bench, Scene, method
from darts_bench.tables import table

TITLE = "Convergence: errors against passes, beside theory"
# Of scenes/pulse-in-fog.json.
SIGMA_S, SIGMA_T, INTENSITY, DISTANCE, FOV, GATE = 0.4, 0.5, 10.0, 4.0, np.radians(30), (4.8, 5.2)


def closed_form(side):
    """Radiance of single scattering, averaged over gate and pixels: along a camera ray at an angle to the lamp, light of
    total length s scatters at the depth t where t + r = s, r being the way from there to the lamp."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    nodes, weights = (nodes + 1) / 2, weights / 2
    at = ((np.arange(side)[:, None] + nodes).ravel() / side * 2 - 1) * np.tan(FOV / 2)
    cosine = 1 / np.sqrt(1 + at[:, None] ** 2 + at[None, :] ** 2)
    radiance = 0.0
    for node, weight in zip(nodes, weights):
        s = GATE[0] + (GATE[1] - GATE[0]) * node
        t = (s**2 - DISTANCE**2) / (2 * (s - DISTANCE * cosine))
        r = s - t
        per_length = r / (r + t - DISTANCE * cosine)  # dt / ds
        radiance = radiance + weight * SIGMA_S / (4 * np.pi) * np.exp(-SIGMA_T * s) * INTENSITY / r**2 * per_length
    both = np.outer(weights, weights)
    pixels = np.einsum("aibj,ij->ab", radiance.reshape(side, 8, side, 8), both)
    return Truth(np.repeat(pixels[None, :, :, None], 3, axis=3))


def schedule(alpha, power, passes, kernel):
    """Variance and bias of means of 1, 2, ... passes as radii gamma^power leave them, up to a factor, for kernels of
    `kernel` dimensions; no kernel: independent samples."""
    k = np.arange(1, passes)
    gamma = np.concatenate([[1.0], np.cumprod((k + alpha) / (k + 1))])
    n = np.arange(1, passes + 1)
    return np.cumsum(gamma ** (-power * kernel)) / n**2, np.cumsum(gamma ** (2 * power)) / n


# Radii by primitive: so wide that bias is seen beside noise, but narrow beside what there is to see.
RADII = {"points": 0.5, "beams": 0.15}
# Method, what it sets more, and its schedule: alpha, power of gamma, dimensions of the kernel.
CASES = {
    "plain paths": ("plain paths", None, None),
    "best paths": ("best paths", None, None),
    "plain points, alpha 0.4": ("plain points", 0.4, (1 / 3, 2)),
    "plain points, alpha 0.7": ("plain points", 0.7, (1 / 3, 2)),
    "best points, alpha 0.7": ("best points", 0.7, (1 / 3, 2)),
    "plain beams, alpha 0.7": ("plain beams", 0.7, (1.0, 1)),
    "plain beams, alpha 0.85": ("plain beams", 0.85, (1.0, 1)),
}


def fitted(passes, values):
    """Exponent with its standard error; a dash where values are lost in noise."""
    kept = values > 0
    return "–" if kept.sum() < 3 else "{:.2f} ± {:.2f}".format(*slope(passes[kept], values[kept]))


def run(bench: Bench):
    scene = Scene.own("pulse-in-fog", 32)
    truth = closed_form(scene.resolution[0])
    passes = np.array([4**i for i in range(1, bench.short(5, 4))])
    cells = {case: (scene, [*method(name), *([f"integrator.volume_gather_radius={RADII[name.split()[1]]}"] if alpha else []),
                            *([f"integrator.{key}={alpha}" for key in ("alpha", "volume_alpha")] if alpha else [])])
             for case, (name, alpha, _) in CASES.items()}
    found = {n: bench.interleaved(cells, bench.short(8, 2), passes=int(n)) for n in passes}
    figure, axes = panels(2, 4.4, 3.6)
    rows = []
    for case, (_, alpha, kernel) in CASES.items():
        of_case = [parts(found[n][case], truth) for n in passes]
        variance, bias = np.array([p.variance for p in of_case]), np.array([p.bias for p in of_case])
        error = np.sqrt([np.mean([max(mse(r.image(), truth), 0) for r in found[n][case]]) for n in passes])
        told = schedule(alpha or 1.0, *(kernel[:1] if kernel else (0,)), passes[-1], kernel[1] if kernel else 0)
        theory = [slope(passes, values[passes - 1])[0] for values in told]
        cpu = np.array([p.cpu for p in of_case])
        # Bias below twice the noise of its own estimate says nothing: neighbours vary together, 16 pixels count as one.
        doubt = 2 * np.sqrt(2 * 16 / scene.resolution[0] ** 2) * variance / len(found[passes[0]][case])
        certain = np.where(bias > doubt, bias, 0.0) if kernel else np.zeros(len(bias))
        rows.append([case, fitted(passes, variance), f"{theory[0]:.2f}", fitted(passes, np.sqrt(np.maximum(certain, 0))) if kernel else "none",
                     f"{theory[1]:.2f}" if kernel else "none", fitted(passes, error), fitted(cpu, error), f"{error[-1]:.4f}",
                     f"{np.mean([r.image().mean() for r in found[passes[-1]][case]]) / truth.image.mean():.4f}"])
        line = axes[0].loglog(passes, variance, marker="o", markersize=3, linestyle="none", label=case)[0]
        n = np.arange(passes[0], passes[-1] + 1)
        scale = np.exp(np.mean(np.log(variance / told[0][passes - 1])))
        axes[0].loglog(n, scale * told[0][n - 1], color=line.get_color(), linewidth=0.8)
        if kernel and (certain > 0).sum() >= 2:
            kept = certain > 0
            axes[1].loglog(passes[kept], np.sqrt(certain[kept]), marker="o", markersize=3, linestyle="none", color=line.get_color(), label=case)
            scale = np.exp(np.mean(np.log(np.sqrt(certain[kept]) / told[1][passes - 1][kept])))
            axes[1].loglog(n, scale * told[1][n - 1], color=line.get_color(), linewidth=0.8)
    for panel, name in zip(axes, ("variance", "bias, rms")):
        panel.set_xlabel("passes", fontsize=9)
        panel.set_title(f"{name} (dots), theory (lines, height fitted)", fontsize=9)
        panel.legend(fontsize=6.5)
    bench.plot(figure, "convergence")
    bench.write(TITLE, f"Single scattering of a pulse in fog (benchmarks/study/scenes/pulse-in-fog.json), {scene.words()} pixels, "
                f"{passes[0]} to {passes[-1]} passes, {bench.short(8, 2)} seeds, against the closed form. Exponents are slopes of straight lines "
                "through logarithms, ± the standard error of the fit. Theory: variance of the mean of passes with kernels of d "
                "dimensions and bias as the square of the width, with the radii of [method](../../../docs/method.md#7-the-photon-pass-and-the-camera-pass) "
                "summed over the passes and fitted at the same ones: what the powers -1, -0.8, ... are before n is large.",
                "![variance and bias against passes](convergence.svg)",
                table(["method", "variance ~ n^", "theory", "bias ~ n^", "theory", "error ~ n^", "error ~ time^", "error in the end",
                       "mean / exact"], rows))
