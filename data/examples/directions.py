#!/usr/bin/python3
"""Where a guided walk goes: directions and control vertices by what is left of the path, as the paper on DARTS (He et al. 2024)
plots them. Curves are densities, bars are what Guide draws.

    PYTHONPATH=build/python data/examples/directions.py directions.png
"""

import sys

import matplotlib
import numpy as np

import darts_tungsten.sampling as sampling

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

SIGMA_A, SIGMA_S, C = 0.1, 0.9, 2.0  # a target two mean free paths away
EXCESS = (0.1, 0.5, 2.0, 8.0)        # what a path may be longer than the straight way
COUNT = 200_000


def directions(axes):
    """Densities over h = 1 - cos to the target: the paper's table, and the closed form of the connection's lobe."""
    table = sampling.EdaTable(SIGMA_S, 0.0)
    h = np.linspace(1e-3, 2, 400)
    for colour, excess in enumerate(EXCESS):
        axes.plot(1 - h, 4 * np.pi * table.pdf(C, excess, 1.0, h), f"C{colour}", label=f"{C + excess:g}")
        axes.plot(1 - h, 4 * np.pi * sampling.path_lobe_pdf(h, C, excess), f"C{colour}--")
    axes.set(xlabel="cosine to the target", ylabel="density, isotropic = 1", yscale="log", title="table; dashed: lobe")
    axes.legend(title="path length", fontsize=7, loc="upper left")


def vertices(axes):
    """Control vertices along a ray at right angles, for connections in a gate."""
    guide = sampling.Guide("best", "path", SIGMA_A, SIGMA_S)
    h = 1.0
    for colour, excess in enumerate(EXCESS[1:], 1):
        low, high = C + 0.5 * excess, C + excess
        first, last = (sampling.first_leg(C, length - C, h) for length in (low, high))
        t = np.linspace(first, last, 400)
        axes.plot(t, guide.vertex_pdf(C, low, high, h, t), f"C{colour}")
    axes.set(xlabel="distance along the ray", ylabel="density per length", yscale="log", title="control vertices, 90° off")


def drawn(axes):
    """A whole step, many times: directions drawn against the density that weighs them."""
    for colour, preset in enumerate(("published", "best")):
        step = sampling.Guide(preset, "path", SIGMA_A, SIGMA_S).sample(C, C + 0.4, C + 0.5, COUNT, seed=1)
        axes.hist(1 - step["h"], 60, density=True, histtype="step", color=f"C{colour}", label=preset)
        good = step["vertex_inverse_pdf"] > 0
        light = np.zeros(COUNT)
        light[good] = (SIGMA_S * np.exp(-step["length"]) * step["phase"] * step["direction_inverse_pdf"]
                       * step["vertex_inverse_pdf"] / step["to_target"] ** 2)[good]
        print(f"{preset}: light scattered once {light.mean():.6f} +- {light.std() / COUNT ** 0.5:.6f}")
    axes.set(xlabel="cosine to the target", ylabel="drawn directions", yscale="log", title="drawn")
    axes.legend(fontsize=7, loc="upper left")


left, middle, right = plt.subplots(1, 3, figsize=(11, 3.2))[1]
directions(left), vertices(middle), drawn(right)
S = np.linspace(C + 0.4, C + 0.5, 10001)
light = np.exp(-S) * np.log((S + C) / (S - C)) / (C * S)
print(f"exactly: {SIGMA_S * np.trapz(light, S):.6f}")
plt.tight_layout(), plt.savefig(sys.argv[1], dpi=120)
