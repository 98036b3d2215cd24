#!/usr/bin/python3
"""FLIP against what is known of it: differences of even pictures by hand, and what the paper demands of the measure."""

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

from darts_bench.flip import PIXELS_PER_DEGREE, flip, from_opponent, opponent  # noqa: E402

SIZE = 48


def even(*colour):
    return np.broadcast_to(np.array(colour, float), (SIZE, SIZE, 3))


def picture(seed=1):
    """Smooth colours with an edge."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] / SIZE
    image = 0.5 + 0.3 * np.stack([np.sin(7 * x + seed), np.cos(5 * y), np.sin(3 * (x + y))], axis=-1)
    image[:, SIZE // 2:] *= 0.5
    return image


class Flip(unittest.TestCase):
    def test_the_same_picture(self):
        self.assertEqual(flip(picture(), picture()).max(), 0.0)

    def test_even_colours(self):
        """Nothing to blur, no edges: HyAB distances by hand. CIELAB of sRGB's white (100, 0, 0), green (87.735, -86.183, 83.180) and
        blue (32.297, 79.188, -107.860), the largest there is."""
        largest = (87.735 - 32.297 + np.hypot(0.87735 * 86.183 + 0.32297 * 79.188, 0.87735 * 83.180 + 0.32297 * 107.860)) ** 0.7
        white = 0.95 + 0.05 * (100**0.7 - 0.4 * largest) / (0.6 * largest)
        for one, other, expected in ((even(0, 1, 0), even(0, 0, 1), 1.0), (even(0, 0, 0), even(1, 1, 1), white)):
            for found in (flip(one, other), flip(other, one)):
                np.testing.assert_allclose(found, expected, atol=2e-4)
        # Lightness 50 is a luminance of 18.42 %; below the cut the scale is straight.
        grey = 1.055 * 0.184187 ** (1 / 2.4) - 0.055
        np.testing.assert_allclose(flip(even(0, 0, 0), even(grey, grey, grey)), 0.95 * 50**0.7 / (0.4 * largest), rtol=1e-4)

    def test_bounds_and_symmetry(self):
        noise = np.random.default_rng(3).uniform(size=(SIZE, SIZE, 3))
        there, back = flip(picture(), noise), flip(noise, picture())
        np.testing.assert_allclose(there, back, rtol=1e-12)
        self.assertGreater(there.min(), 0.0)
        self.assertLess(there.max(), 1.0)

    def test_more_noise_is_worse(self):
        rng = np.random.default_rng(5)
        noise = rng.normal(size=(SIZE, SIZE, 3))
        means = [flip(picture(), np.clip(picture() + amount * noise, 0, 1)).mean() for amount in (0.01, 0.03, 0.1, 0.3)]
        self.assertTrue(all(less < more for less, more in zip(means, means[1:])), means)

    def test_what_is_too_fine_is_not_seen(self):
        """A fine pattern in blue and yellow of the same luminance is blurred away from afar, and only from there."""
        checker = np.indices((SIZE, SIZE)).sum(axis=0) % 2
        base, other = even(0.5, 0.5, 0.5), np.array(even(0.5, 0.5, 0.5))
        tinted = opponent(np.array([0.2, 0.2, 0.2])) + np.array([0.0, 0.0, 8.0]) * (2 * checker[..., None] - 1)
        linear = from_opponent(tinted)
        other[:] = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        base = 1.055 * 0.2 ** (1 / 2.4) - 0.055 + 0 * base
        near, far = flip(base, other, 5.0).mean(), flip(base, other, PIXELS_PER_DEGREE).mean()
        self.assertLess(far, 0.2 * near)

    def test_edges_and_points_are_seen(self):
        """The change of colour is the same: beside an edge that it makes it is worse."""
        base, line, even_change = even(0.5, 0.5, 0.5), np.array(even(0.5, 0.5, 0.5)), even(0.55, 0.55, 0.55)
        line[:, SIZE // 2] = 0.55
        step = np.where(np.indices((SIZE, SIZE, 3))[1] < SIZE // 2, 0.5, 0.55)
        self.assertGreater(flip(base, step)[:, SIZE // 2].mean(), flip(base, even_change).mean())
        self.assertGreater(flip(base, line)[:, SIZE // 2].min(), flip(base, line)[:, 0].max())

    def test_opponent_colours_and_back(self):
        rgb = np.random.default_rng(7).uniform(size=(5, 4, 3))
        np.testing.assert_allclose(from_opponent(opponent(rgb)), rgb, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
