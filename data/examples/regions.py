#!/usr/bin/python3
"""The arrival histogram of a region with error bars that hold for photon maps, whose pixels err together: the spread of 16 batches
of passes, which the film keeps where it is asked to.

    PYTHONPATH=build/python data/examples/regions.py regions.png
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np

import darts_tungsten
from darts_tungsten import tools

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

SCENE = Path(__file__).resolve().parents[1] / "scenes/two-pulses/scene.json"

result = darts_tungsten.render(SCENE, passes=32, seed=1, set={
    "camera.resolution": [64, 36], "film.batches": 16, "renderer.spp_step": 1, "integrator.photon_count": 2000,
    "integrator.volume_photon_count": 2000})
rows, columns = slice(8, 28), slice(20, 44)
light, error = tools.region(result, rows, columns)
pixels = result.standard_error[:, rows, columns] @ [0.2126, 0.7152, 0.0722]
independent = np.sqrt(np.square(pixels).sum(axis=(1, 2))) / pixels[0].size
lit = light > 0.1 * light.max()
print(f"standard error of the region {100 * np.median(error[lit] / light[lit]):.1f} %, "
      f"{np.median(error[lit] / independent[lit]):.1f} times what independent pixels would have")
edges = result.time_edges
plt.stairs(light, edges), plt.errorbar((edges[1:] + edges[:-1]) / 2, light, error, fmt="none")
plt.xlabel("time of arrival"), plt.ylabel("radiance"), plt.savefig(sys.argv[1])
