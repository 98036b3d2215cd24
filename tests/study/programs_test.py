#!/usr/bin/python3
"""What studies that are programs compute from their renders, on known ones."""

import importlib.util
import sys
import unittest
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
sys.path.insert(0, str(BENCHMARKS))

from darts_bench.measures import Truth, parts  # noqa: E402


def program(name):
    spec = importlib.util.spec_from_file_location(name.replace("-", "_"), BENCHMARKS / f"study/studies/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def render(image, cpu=2.0, told=0.1, stages=None):
    """As Bench.render gives it: a single entry."""
    return SimpleNamespace(image=lambda at=-1, name="mean": image, cpu=np.array([cpu]), passes=np.array([4]), standard_errors=np.array([told]),
                           entries=[{"relative bias": 0.05}], stats={"stages": stages or {}})


def method(variance=(0.09, 0.0), bias=(0.0, 0.0), seconds=(0.5, 0.0), before=1.0):
    law = lambda pair: {"first": pair[0], "exponent": pair[1]}  # noqa: E731
    return {"relative variance of a pass": law(variance), "relative bias of a pass": law(bias), "CPU seconds of a pass": law(seconds),
            "CPU seconds before the first": before}


class AccuracyCost(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.study = program("accuracy-cost")

    def test_prices_of_known_laws(self):
        noise = self.study.Law(method())
        self.assertAlmostEqual(noise.price(0.03), 1.0 + 100 * 0.5)
        self.assertEqual(self.study.Law(method(bias=(0.02, 0.0))).price(0.015), np.inf)
        both = self.study.Law(method(variance=(0.09, 0.2), bias=(0.05, -0.4)))
        passes = round((both.price(0.05) - 1.0) / 0.5)
        n = np.arange(1.0, passes + 1)
        error = np.hypot(np.sqrt(0.09 * np.sum(n**0.2)) / passes, 0.05 * np.sum(n**-0.4) / passes)
        self.assertTrue(0.99 * 0.05 < error <= 0.05, error)

    def test_choice_is_priced_by_the_renders(self):
        cheap, dear = (SimpleNamespace(cpu=2.0, error=error, seconds=lambda e, error=error: 2.0 * (error / e) ** 2) for error in (0.1, 0.3))
        laws = {"a": self.study.Law(method(variance=(0.9, 0))), "b": self.study.Law(method(variance=(0.1, 0)))}
        error, choice, cheapest, times = self.study.choice_of(laws, {"a": cheap, "b": dear})
        self.assertEqual((error, choice, cheapest), (0.1, "b", "a"))
        self.assertAlmostEqual(times, 9.0)

    def test_measured_noise_is_the_spread_of_seeds(self):
        rng = np.random.default_rng(3)
        images = [1 + 0.2 * np.repeat(rng.normal(size=(1, 60, 60, 1)), 3, axis=3) for _ in range(2)]
        stages = {"prepare": {"CPU seconds": 0.5}, "bias": {"CPU seconds": 0.4}}
        found = self.study.Measured([render(image, stages=stages) for image in images])
        self.assertAlmostEqual(found.noise, 0.2, delta=0.01)  # 3600 pixels: 1.2 %
        self.assertAlmostEqual(found.bias, 0.05)
        self.assertAlmostEqual(found.cpu, 0.5 + 0.8 * 2.0)


class Parts(unittest.TestCase):
    def test_noise_of_the_reference_is_no_cost(self):
        """Renders better than their reference: bias is in doubt, and their cost that of their variance. A true one counts."""
        rng = np.random.default_rng(5)
        truth = 2 + np.zeros((1, 64, 64, 3))

        def noisy(deviation, bias=0.0):
            return truth + bias + deviation * np.repeat(rng.normal(size=(1, 64, 64, 1)), 3, axis=3)

        reference = Truth(noisy(0.6), np.full(truth.shape, 0.6))
        found = parts([render(noisy(0.1)) for _ in range(3)], reference)
        self.assertAlmostEqual(found.certain_cost, 2.0 * 0.05**2, delta=2e-4)
        self.assertLess(abs(found.bias), found.doubt)
        biased = parts([render(noisy(0.1, 1.0)) for _ in range(3)], reference)
        self.assertAlmostEqual(biased.certain_cost, 2.0 * (0.05**2 + 0.5**2), delta=0.1)
        self.assertLess(parts([render(truth)] * 2, Truth(truth)).flip, 1e-12)


class Scaling(unittest.TestCase):
    def test_the_ball_is_closed(self):
        study, rings = program("scaling"), 20
        lines = [line.split() for line in study.ball(rings, 2 * rings).splitlines()]
        vertices = np.array([line[1:] for line in lines if line[0] == "v"], float)
        faces = np.array([[corner.partition("//")[0] for corner in line[1:]] for line in lines if line[0] == "f"], int) - 1
        self.assertEqual(len(faces), study.triangles_of(rings))
        a, b, c = (vertices[faces[:, i]] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        self.assertTrue(0.9 * 4 * np.pi < area < 4 * np.pi, area)
        # Every edge twice, once each way.
        edges = Counter((f[i], f[(i + 1) % 3]) for f in faces for i in range(3))
        self.assertTrue(all(count == 1 and edges[there, here] == 1 for (here, there), count in edges.items()))


class Effects(unittest.TestCase):
    def test_stages_count_where_they_took_least(self):
        study = program("effects")
        quiet, busy = ({"splat": {"CPU seconds": s}, "build": {"CPU seconds": b}} for s, b in ((0.4, 0.9), (0.6, 0.3)))
        found = study.times([render(None, 1.5, stages=quiet), render(None, 1.2, stages=busy)])
        self.assertAlmostEqual(found["splat"], 100.0)
        self.assertAlmostEqual(found["build"], 75.0)
        self.assertAlmostEqual(found["passes"], 100.0 + 75.0 + 50.0)  # the rest: 0.2 and 0.3 of 4 passes


if __name__ == "__main__":
    unittest.main()
