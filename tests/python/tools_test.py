#!/usr/bin/python3
"""darts_tungsten.tools against closed forms."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import darts_tungsten
from darts_tungsten import tools

EDGES = np.linspace(2.0, 12.0, 401)
CENTRES = (EDGES[1:] + EDGES[:-1]) / 2
WIDTH = 0.025


def gaussian(centre, sigma, total=1.0):
    density = np.exp(-0.5 * ((CENTRES - centre) / sigma) ** 2)
    return total * density / density.sum()


class Phasors(unittest.TestCase):
    def test_a_flash_has_its_time_as_phase(self):
        for frame in (0, 57, 399):
            flash = np.zeros(400)
            flash[frame] = 3.0
            for frequency in (0.0, 0.3, 1.7, 11.0):
                expected = 3 * np.exp(2j * np.pi * frequency * CENTRES[frame]) * np.sinc(frequency * WIDTH)
                self.assertAlmostEqual(tools.phasor(flash, EDGES, frequency), expected, 12)

    def test_light_of_a_box_and_of_an_exponential(self):
        omega = 2 * np.pi * 0.7
        box = tools.phasor(np.full(400, WIDTH), EDGES, 0.7)
        self.assertAlmostEqual(box, (np.exp(12j * omega) - np.exp(2j * omega)) / (1j * omega), 12)
        decay = np.exp(-(EDGES[:-1] - 2)) - np.exp(-(EDGES[1:] - 2))
        expected = np.exp(2j * omega) * (1 - np.exp(10 * (1j * omega - 1))) / (1 - 1j * omega)
        self.assertLess(abs(tools.phasor(decay, EDGES, 0.7) - expected), 2e-3)

    def test_shapes(self):
        light = np.random.default_rng(1).random((400, 2, 3))
        images = tools.phasor(light, EDGES, [0.1, 0.2])
        self.assertEqual((tools.phasor(light, EDGES, 0.1).shape, images.shape), ((2, 3), (2, 2, 3)))
        np.testing.assert_allclose(images[1, 1, 2], tools.phasor(light[:, 1, 2], EDGES, 0.2))

    def test_four_phases_give_back_the_phasor(self):
        light = np.random.default_rng(1).random((400, 2, 3))
        c = tools.correlation(light, EDGES, 0.4, np.pi / 2 * np.arange(4), contrast=0.6)
        np.testing.assert_allclose(c[0] - c[2] + 1j * (c[1] - c[3]), 0.6 * tools.phasor(light, EDGES, 0.4))
        np.testing.assert_allclose(c.mean(axis=0), light.sum(axis=0) / 2)

    def test_distances(self):
        for distance in (1.2, 3.4, 5.9):
            flash = np.histogram([2 * distance / 0.99], EDGES)[0].astype(float)
            found = tools.phase_distance(tools.phasor(flash, EDGES, 0.05), 0.05, speed=0.99)
            self.assertAlmostEqual(found, distance, delta=0.5 * WIDTH)
        # Beyond speed / (2 frequency) it starts anew.
        self.assertAlmostEqual(tools.phase_distance(np.exp(2j * np.pi * 0.5 * 11.0), 0.5), 0.5)


class Times(unittest.TestCase):
    def test_peak_of_a_gaussian_between_frames(self):
        centres = np.linspace(5.0, 5.1, 23)
        light = np.stack([gaussian(c, 0.08) for c in centres], axis=1)
        np.testing.assert_allclose(tools.peak_time(light, EDGES), centres, atol=1e-9)

    def test_peaks_at_the_ends_and_alone(self):
        light = np.zeros((400, 3))
        light[0, 0] = light[399, 1] = light[200, 2] = 1.0
        np.testing.assert_allclose(tools.peak_time(light, EDGES), CENTRES[[0, 399, 200]])

    def test_no_light(self):
        light = np.zeros((400, 2))
        light[7, 0] = 0.5
        for value in (tools.peak_time(light, EDGES), tools.mean_time(light, EDGES), tools.spread(light, EDGES)):
            np.testing.assert_array_equal(np.isnan(value), [False, True])
        self.assertTrue(np.isnan(tools.peak_time(light, EDGES, threshold=0.6)).all())

    def test_mean_and_spread(self):
        box = np.where((CENTRES > 4) & (CENTRES < 7), 1.0, 0.0)
        self.assertAlmostEqual(tools.mean_time(box, EDGES), 5.5)
        self.assertAlmostEqual(tools.spread(box, EDGES), 3 / np.sqrt(12))

    def test_uneven_frames(self):
        edges = np.array([0.0, 1.0, 3.0, 4.0])
        self.assertEqual(tools.peak_time(np.array([1.0, 1.5, 0.1]), edges), 0.5)  # densest, not brightest
        self.assertAlmostEqual(tools.mean_time(np.array([1.0, 2.0, 1.0]), edges), 2.0)


class Spad(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(3)

    def test_rates(self):
        light = np.full((400, 2), 0.02)
        np.testing.assert_allclose(tools.detect(light, EDGES, 0.3, 0.1), 0.3 * 0.02 + 0.1 * WIDTH)

    def test_jitter_adds_its_variance(self):
        light = gaussian(7.0, 0.3)
        moved = tools.jitter(light, EDGES, 0.4)
        self.assertAlmostEqual(moved.sum(), 1.0, 9)
        self.assertAlmostEqual(tools.mean_time(moved, EDGES), 7.0, 9)
        # Into frames once more, and even over these: width^2 / 12 for each.
        expected = tools.spread(light, EDGES) ** 2 + 0.4 ** 2 + WIDTH ** 2 / 6
        self.assertAlmostEqual(tools.spread(moved, EDGES) ** 2, expected, 8)

    def test_jitter_of_a_flash(self):
        flash = np.zeros((400, 1))
        flash[200] = 1.0
        expected = np.exp(-0.5 * ((CENTRES - CENTRES[200]) / 0.5) ** 2) * WIDTH / (0.5 * np.sqrt(2 * np.pi))
        np.testing.assert_allclose(tools.jitter(flash, EDGES, 0.5)[:, 0], expected, atol=2e-5)
        np.testing.assert_array_equal(tools.jitter(flash, EDGES, 0.0), flash)
        even = tools.jitter(np.ones(400), EDGES, 0.5)
        np.testing.assert_allclose(even[200], 1.0)
        self.assertAlmostEqual(even[0], 0.5, delta=0.02)  # half of the first frame's has left, and none came in

    def test_poisson(self):
        drawn = tools.counts(np.full((2, 20000), 0.003), 1000, self.random)
        self.assertAlmostEqual(drawn.mean(), 3.0, delta=4 * (3 / 40000) ** 0.5)
        self.assertAlmostEqual(drawn.var(), 3.0, delta=0.1)

    def test_pile_up_and_its_inverse(self):
        rate = np.stack([gaussian(4.0, 0.5, 2.0) + gaussian(8.0, 0.3, 1.0), np.full(400, 0.005)], axis=1)
        expected = tools.expected_counts(rate, 1e6)
        np.testing.assert_allclose(expected.sum(axis=0), 1e6 * -np.expm1(-rate.sum(axis=0)))
        # Of an even rate: an exponential.
        np.testing.assert_allclose(expected[:, 1], 1e6 * np.exp(-0.005 * np.arange(400)) * -np.expm1(-0.005))
        np.testing.assert_allclose(tools.coates(expected, 1e6), rate, rtol=1e-9, atol=1e-15)
        drawn = tools.counts(rate, 10 ** 6, self.random, dead_time="period")
        away = (drawn - expected) / np.sqrt(np.maximum(expected, 1.0))
        self.assertLess(np.abs(away).max(), 5.5)
        self.assertGreater(np.abs(away).max(), 1.5)
        self.assertAlmostEqual(tools.coates(drawn, 10 ** 6)[300:, 1].mean(), 0.005, delta=4 * (0.005 / 1e8 / 0.15) ** 0.5)

    def test_dead_time_of_an_even_rate(self):
        for rate, dead in ((0.5, 1.0), (2.0, 1.3), (8.0, 0.4)):
            for paralysable in (False, True):
                found = tools.counts(np.full(400, rate * WIDTH), 20000, self.random, dead, EDGES, paralysable=paralysable)
                expected = tools.dead_time_rate(rate, dead, paralysable) * 10 * 20000
                # Renewals: less noise than Poisson's.
                self.assertAlmostEqual(found.sum(), expected, delta=5 * expected ** 0.5 + 2)
        self.assertAlmostEqual(tools.dead_time_rate(2.0, 1.3), 2 / 3.6)
        self.assertAlmostEqual(tools.dead_time_rate(2.0, 1.3, True), 2 * np.exp(-2.6))

    def test_dead_time_hides_what_follows(self):
        # An early flash that is always seen, dead for 3; then even light.
        rate = np.full(400, 0.001)
        rate[0] = 50.0
        found = tools.counts(rate, 20000, self.random, 3.0, EDGES, period=20.0)
        self.assertEqual(found[0], 20000)
        self.assertEqual(found[1:119].sum(), 0)
        self.assertGreater(found[121:].sum(), 0)
        # A dead time beyond the period: every second pulse only.
        rate[1:] = 0.0
        self.assertEqual(tools.counts(rate, 20000, self.random, 21.0, EDGES, period=20.0)[0], 10000)

    def test_photon_by_photon_is_the_rule(self):
        times = np.sort(self.random.random(3000) * 100)
        seen = np.ones(3000, dtype=bool)
        seen[1:] = np.diff(times) >= 0.2
        tools.spad._resume(times, 0.2, seen)
        last, expected = -1.0, []
        for time in times:
            expected.append(time >= last + 0.2)
            last = time if expected[-1] else last
        np.testing.assert_array_equal(seen, expected)

    def test_bad_input(self):
        rate = np.full(400, 0.1)
        for bad, word in ((lambda: tools.detect(-rate, EDGES), "negative"), (lambda: tools.detect(rate, EDGES, 1.5), "efficiency"),
                          (lambda: tools.detect(rate, EDGES, 1, np.nan), "dark_rate"), (lambda: tools.jitter(rate, EDGES, -1), "sigma"),
                          (lambda: tools.jitter(rate, EDGES[1:], 1), "one edge more"), (lambda: tools.phasor(rate, EDGES[::-1], 1), "increas"),
                          (lambda: tools.counts(rate * np.nan, 5, self.random), "rate"), (lambda: tools.counts(rate, 0, self.random), "pulses"),
                          (lambda: tools.counts(rate, 5, self.random, "always"), "dead_time"),
                          (lambda: tools.counts(rate, 5, self.random, 1.0), "edges"),
                          (lambda: tools.counts(rate, 5, self.random, -1.0, EDGES), "dead_time"),
                          (lambda: tools.counts(rate, 5, self.random, 1.0, EDGES, 3.0), "period"),
                          (lambda: tools.coates([3.0, 3.0], 5), "pulses"), (lambda: tools.phase_distance(1j, 0.0), "frequency"),
                          (lambda: tools.correlation(rate, EDGES, 1, 0, 2), "contrast")):
            with self.assertRaisesRegex(ValueError, word):
                bad()


class Film(unittest.TestCase):
    SCENE = {
        "primitives": [{"name": "wall", "type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5},
                        "transform": {"scale": [9, 1, 9]}},
                       {"name": "lamp", "type": "point", "emission": [4, 6, 8], "transform": {"position": [0, 2, 0]}}],
        "camera": {"type": "pinhole", "resolution": [4, 3], "fov": 30,
                   "transform": {"position": [0, 2, 0.5], "look_at": [0, 0, 0], "up": [0, 0, 1]}},
        "integrator": {"type": "path_tracer", "max_bounces": 2, "start_time": 3, "transient_time_width": 0.25, "frame_num": 16}}

    def test_light_of_a_result_and_of_its_files(self):
        result = darts_tungsten.render(self.SCENE, samples=4)
        light, edges = tools.per_frame(result)
        self.assertEqual(light.shape, (16, 3, 4))
        green, _ = tools.per_frame(result, 1)
        np.testing.assert_allclose(green, result.mean[..., 1] * 0.25)
        np.testing.assert_allclose(light, result.mean @ [0.2126, 0.7152, 0.0722] * 0.25)
        integral = darts_tungsten.render(self.SCENE, samples=4, set={"integrator.time_normalization": "integral"})
        np.testing.assert_allclose(tools.per_frame(integral, 1)[0], green, rtol=1e-6)
        grey = darts_tungsten.render(self.SCENE, samples=4, set={"film": {"channels": "luminance"}})
        np.testing.assert_allclose(tools.per_frame(grey)[0], light, rtol=1e-4)
        with tempfile.TemporaryDirectory() as folder:
            with np.load(result.write(Path(folder) / "film.npz")[0]) as file:
                np.testing.assert_array_equal(tools.per_frame(file)[0], light)
        # Light goes 2 down to the wall and about 2 up again.
        self.assertTrue(np.all(np.abs(tools.peak_time(light, edges) - 4.2) < 0.3))
        steady = {"integrator.frame_num": 0, "integrator.transient_time_width": 0}
        with self.assertRaisesRegex(ValueError, "frames"):
            tools.per_frame(darts_tungsten.render(self.SCENE, samples=1, set=steady))
        with self.assertRaisesRegex(ValueError, "channel"):
            tools.per_frame(result, 3)

    def test_the_error_of_a_region_is_that_of_several_renders(self):
        """Photons are seen by many pixels at once: independent pixels would tell too little."""
        scene = {
            "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.5, "sigma_a": 0.05}],
            "primitives": [{"type": "point", "power": 10, "ext_medium": "fog", "transform": {"position": [0.5, 0.5, 0]}}],
            "camera": {"type": "pinhole", "resolution": [18, 14], "fov": 40, "medium": "fog",
                       "transform": {"position": [0, 0, 4], "look_at": [0, 0, 0]}},
            "film": {"batches": 16}, "renderer": {"spp_step": 1},
            "integrator": {"type": "progressive_transient_photon_map", "photon_count": 200, "volume_photon_count": 200,
                           "fixed_volume_radius": True, "volume_gather_radius": 0.3, "max_bounces": 4,
                           "transient_time_center": 6, "transient_time_width": 2}}
        means, told, independent = [], [], []
        for seed in range(24):
            result = darts_tungsten.render(scene, passes=32, seed=seed)
            mean, error = tools.region(result, slice(4, None), slice(4, 16), 1)
            pixels = np.s_[0, 4:, 4:16, 1]
            self.assertAlmostEqual(mean[0] / result.mean[pixels].mean(), 1, delta=1e-5)
            means.append(mean[0])
            told.append(error[0])
            independent.append(np.sqrt(np.square(result.standard_error[pixels]).sum()) / result.standard_error[pixels].size)
        true = np.std(means, ddof=1)
        told, independent = (np.sqrt(np.mean(np.square(errors))) for errors in (told, independent))
        spread = np.hypot(1 / np.sqrt(2 * 23), 1 / np.sqrt(2 * 15 * 24))  # of the true error by 24 seeds, and of what is told
        self.assertLess(abs(told / true - 1), 4 * spread)
        self.assertLess(independent, 0.5 * true)
        with tempfile.TemporaryDirectory() as folder:
            with np.load(result.write(Path(folder) / "film.npz")[0]) as file:
                np.testing.assert_array_equal(tools.region(file, slice(4, None), slice(4, 16), 1)[1], error)
        for rows, complaint in ((slice(2, 8), "multiple of 4"), (slice(0, 13), "edge at 14"), (slice(8, 4), "rows")):
            with self.assertRaisesRegex(ValueError, complaint):
                tools.region(result, rows, slice(0, 4))
        with self.assertRaisesRegex(ValueError, "no batches"):
            tools.region(darts_tungsten.render(self.SCENE, samples=4), slice(0, 1), slice(0, 1))
        with self.assertRaisesRegex(darts_tungsten.InputError, "one batch tells no error"):
            darts_tungsten.render(self.SCENE, samples=4, set={"film.batches": 1})


if __name__ == "__main__":
    unittest.main()
