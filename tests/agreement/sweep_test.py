#!/usr/bin/python3
"""The sweep of small scenes (benchmarks/bench.py sweep): its comparisons on synthetic means, its copies, and its scenes in the
built renderer, named by the environment's TUNGSTEN."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
TUNGSTEN = os.environ.get("TUNGSTEN", str(PROJECT / "build/bin/tungsten"))
sys.path.insert(0, str(PROJECT / "benchmarks"))

from agreement.sweep_scenes import FAST, all_scenes  # noqa: E402
from agreement.sweep_slices import SLICE_FAST, slice_scenes  # noqa: E402
from darts_bench.measures import BLOCKS, Samples, compare, compare_pairs, means, normal_sigmas, without_kernel  # noqa: E402
from darts_bench.scene_words import write_assets  # noqa: E402
from darts_bench.sweep import METHODS, SLICE_METHODS, Renderer, compare_scene, methods_of, scene_json  # noqa: E402
from darts_bench.sweep_copies import moved, scaled  # noqa: E402
from darts_bench.sweep_report import report, tables  # noqa: E402

COUNT = 3 + 3 * BLOCKS * BLOCKS  # means of an image of one frame


def samples(generator, mean, noise, groups=2, seeds=8, blur=0.0):
    return Samples([mean * (1 + noise * generator.standard_normal((seeds, COUNT))) for _ in range(groups)], np.full(COUNT, blur), 1)


class Comparisons(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(1)

    def test_noise_alone_agrees(self):
        for _ in range(200):
            self.assertTrue(compare(samples(self.random, 1.0, 0.05), samples(self.random, 1.0, 0.1)).agrees)

    def test_a_wrong_image_disagrees(self):
        found = compare(samples(self.random, 1.0, 0.02), samples(self.random, 0.8, 0.02))
        self.assertFalse(found.agrees)
        self.assertAlmostEqual(found.ratio, 0.8, delta=0.03)

    def test_a_wrong_block_disagrees(self):
        second = samples(self.random, 1.0, 0.02)
        for group in second.groups:
            group[:, 3 + 3 * 6 + 1] *= 1.3
        found = compare(samples(self.random, 1.0, 0.02), second)
        self.assertFalse(found.agrees)
        self.assertEqual(found.where, "block 1,2 G")

    def test_what_the_kernel_blurs_is_allowed(self):
        wrong = samples(self.random, 1.1, 0.005)
        self.assertFalse(compare(samples(self.random, 1.0, 0.005), wrong).agrees)
        blurred = Samples(wrong.groups, np.full(COUNT, 0.15), 1)
        self.assertTrue(compare(samples(self.random, 1.0, 0.005), blurred).agrees)

    def test_values_that_are_not_numbers_disagree(self):
        second = samples(self.random, 1.0, 0.02)
        second.groups[0][0, 5] = np.nan
        self.assertFalse(compare(samples(self.random, 1.0, 0.02), second).agrees)

    def test_pairs_see_what_noise_would_hide(self):
        first = samples(self.random, 1.0, 0.3, groups=1)
        self.assertTrue(compare_pairs(first, first).agrees)
        brighter = Samples([first.groups[0] + 0.03 + 1e-4 * self.random.standard_normal((8, COUNT))], first.blur, 1)
        self.assertTrue(compare(first, brighter).agrees)
        self.assertFalse(compare_pairs(first, brighter).agrees)

    def test_few_seeds_know_their_error_badly(self):
        # Two-sided chances of Student's t: 5 at 3 degrees of freedom 0.0154, at 200 the normal one.
        self.assertAlmostEqual(float(normal_sigmas(5.0, 3)), 2.42, delta=0.03)
        self.assertAlmostEqual(float(normal_sigmas(3.0, 200)), 2.96, delta=0.02)

    def test_blocks_and_frames(self):
        image = np.zeros((2, 16, 16, 3))
        image[1, 4:8, 8:12, 2] = 1.0
        values = means(image)
        self.assertAlmostEqual(values[5], 1 / 16)             # blue of the second frame
        self.assertAlmostEqual(values[6 + 3 * 6 + 2], 0.5)    # over both frames
        self.assertEqual(np.count_nonzero(values), 2)

    def test_extrapolation_removes_a_quadratic_bias(self):
        [fine], blur = without_kernel(np.array([[1.01]]), np.array([[1.04]]))
        self.assertAlmostEqual(fine[0, 0], 1.0)
        self.assertAlmostEqual(blur[0], 0.03)


class Copies(unittest.TestCase):
    def test_scaling_back_gives_the_scene(self):
        for scene in all_scenes():
            there_and_back = scaled(scaled(scene, 7.0, 3.0), 1 / 7, 1 / 3)
            self.assert_close(self.numbers(there_and_back), self.numbers(scene), scene.name)

    def test_units(self):
        scene = next(s for s in all_scenes() if s.name == "laser")
        copy = scaled(scene, 7.0, 3.0)
        laser, its_copy = scene.primitives[-1], copy.primitives[-1]
        self.assertAlmostEqual(its_copy["radius"], 7 * laser["radius"])
        self.assertAlmostEqual(its_copy["emission"], 3 * laser["emission"])
        self.assertAlmostEqual(copy.media[0]["sigma_s"], scene.media[0]["sigma_s"] / 7)
        self.assertAlmostEqual(copy.media[0]["speed_of_light"], 7 / 3)
        self.assertAlmostEqual(copy.integrator["transient_time_width"], 3 * scene.integrator["transient_time_width"])
        self.assertAlmostEqual(np.linalg.det(copy.camera["transform"]), 1.0)

    def test_moving_keeps_distances(self):
        scene = all_scenes()[0]
        copy = moved(scene)
        eye, places = self.places(scene)
        new_eye, new_places = self.places(copy)
        np.testing.assert_allclose(np.linalg.norm(new_places - new_eye, axis=1), np.linalg.norm(places - eye, axis=1))
        self.assertGreater(np.linalg.norm(new_eye - eye), 1.0)

    @staticmethod
    def places(scene):
        return scene.camera["transform"][:3, 3], np.array([p["transform"][:3, 3] for p in scene.primitives])

    @staticmethod
    def numbers(scene):
        text = json.dumps(scene_json(scene, METHODS[2], scene.radius), default=lambda value: value.ravel().tolist())
        found = []
        json.loads(text, parse_float=lambda n: found.append(float(n)), parse_int=lambda n: found.append(float(n)))
        return np.array(found)

    def assert_close(self, found, expected, name):
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12, err_msg=name)


class Scenes(unittest.TestCase):
    def test_names(self):
        for scenes, fast in ((all_scenes(), FAST), (slice_scenes(), SLICE_FAST)):
            names = [scene.name for scene in scenes]
            self.assertGreaterEqual(len(names), 30)
            self.assertEqual(len(names), len(set(names)))
            self.assertLessEqual(set(fast), set(names))

    def test_delta_gates_are_those_of_slices_alone(self):
        scene = next(s for s in slice_scenes() if s.name.endswith("delta"))
        for method in SLICE_METHODS:
            self.assertEqual("delta_time_gate" in scene_json(scene, method, scene.radius)["integrator"], method.sliced)

    def test_slices_are_held_against_references(self):
        names = [method.name for method in SLICE_METHODS]
        random = np.random.default_rng(1)
        rendered = {name: ({}, samples(random, 2.0 if name == "best balls" else 1.0, 0.02), 0.0) for name in names}
        methods, copies = compare_scene(rendered, names[:3])
        self.assertEqual({b for (_, b), c in methods.items() if not c.agrees}, {"best balls"})
        self.assertEqual({a for a, _ in methods}, set(names[:3]))
        self.assertEqual(copies, {})

    def test_the_page_names_what_disagrees_and_the_files_have_all_figures(self):
        scene, random = all_scenes()[0], np.random.default_rng(1)
        rendered = {name: ({}, samples(random, mean, 0.02), 1.0) for name, mean in (("plain paths", 1.0), ("best paths", 2.0))}
        results = {scene.name: (scene, rendered, *compare_scene(rendered, ["plain paths"]))}
        page, agree = report("SWEEP", "# Sweep", results, {}, set())
        self.assertFalse(agree)
        self.assertIn("0 of 1 scenes agree, 2 CPU seconds", page)
        self.assertIn(f"- {scene.name}: best paths against plain paths", page)
        files = tables("SWEEP", results)
        self.assertEqual({name for name in files if name in page}, {"SWEEP-scenes.csv", "SWEEP-methods.csv"})
        by_scene, by_method = (list(csv.DictReader(text.splitlines())) for text in files.values())
        self.assertEqual([(row["scene"], row["agrees"]) for row in by_scene], [(scene.name, "0")])
        self.assertEqual([row["method"] for row in by_method], list(rendered))
        self.assertAlmostEqual(float(by_method[1]["mean_over_first"]), 2.0, delta=0.05)

    def test_the_renderer_accepts_them_without_a_warning(self):
        with tempfile.TemporaryDirectory() as folder:
            renderer = Renderer(Path(TUNGSTEN), Path(folder))
            (Path(folder) / "scenes").mkdir()
            write_assets(Path(folder) / "assets")
            files = []
            both = [(scene, METHODS) for scene in all_scenes()] + [(scene, SLICE_METHODS) for scene in slice_scenes()]
            for scene, methods in both:
                for method in methods_of(scene, methods):
                    name = f"{scene.name}-{method.name}"
                    renderer.store(name, scene_json(scene, method, scene.radius))
                    files.append(Path(folder) / "scenes" / f"{name}.json")
            done = subprocess.run([TUNGSTEN, "--quiet", "--allow-outside", "--explain", *files], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            told = [line for line in done.stderr.splitlines() if line.startswith("warning")]
            meant = [line for line in told if "late light cut by max_bounces" in line]  # in all methods alike
            self.assertTrue(any("/few-bounces" in line for line in meant))
            self.assertEqual([line for line in told if line not in meant], [])


if __name__ == "__main__":
    unittest.main()
