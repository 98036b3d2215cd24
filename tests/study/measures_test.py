#!/usr/bin/python3
"""The study's measures on synthetic images of known bias and noise, and its image readers on known bytes.

Estimators are averaged over many synthetic studies: their mean is to lie within 5 standard errors of the known value, and
the tests say what would not.
"""

import struct
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

from darts_bench import images, measures  # noqa: E402
from darts_bench.study_runs import average  # noqa: E402

SIZE, BLOCK, SEEDS, STUDIES = 48, 8, 3, 1500
PIXEL_NOISE, SHARED_NOISE, REFERENCE_NOISE = 0.5, 0.2, 0.3  # absolute; shared: one value for each 4x4 pixels


def truth():
    y, x = np.mgrid[0:SIZE, 0:SIZE] / SIZE
    return 2.0 + np.sin(5 * x) * np.cos(3 * y) + x


def block_pattern(amplitude):
    """Bias that is constant on blocks, of alternating sign and varying size, rms `amplitude`."""
    side = SIZE // BLOCK
    pattern = np.cos(np.arange(side * side)).reshape(side, side)
    pattern *= amplitude / np.sqrt(np.mean(pattern**2))
    return np.kron(pattern, np.ones((BLOCK, BLOCK)))


class SyntheticStudies:
    """References and renders with noise that is partly shared by neighbouring pixels, as that of photons is."""

    def __init__(self, bias_amplitude, seed):
        self.rng = np.random.default_rng(seed)
        self.truth = truth()
        self.expected = self.truth + block_pattern(bias_amplitude)
        self.reference_block_variance = REFERENCE_NOISE**2 / BLOCK**2

    def reference(self):
        return self.truth + self.rng.normal(0, REFERENCE_NOISE, self.truth.shape)

    def render(self):
        shared = self.rng.normal(0, SHARED_NOISE, (SIZE // 4, SIZE // 4))
        return (self.expected + self.rng.normal(0, PIXEL_NOISE, self.truth.shape) + np.kron(shared, np.ones((4, 4))))

    def biases(self):
        return [measures.block_bias([self.render() for _ in range(SEEDS)], self.reference(),
                                    self.reference_block_variance, BLOCK) for _ in range(STUDIES)]


class Measures(unittest.TestCase):
    def assert_mean(self, values, expected, message=""):
        error = np.std(values, ddof=1) / np.sqrt(len(values))
        z = (np.mean(values) - expected) / error
        self.assertLess(abs(z), 5, f"{message}: mean {np.mean(values):.6g} +- {error:.2g}, expected {expected:.6g}")
        return error

    def test_bias_is_found_and_noise_is_not_taken_for_it(self):
        for seed, amplitude in enumerate((0.0, 0.05, 0.4)):
            studies = SyntheticStudies(amplitude, seed)
            expected = amplitude**2 / np.mean(studies.truth) ** 2
            error = self.assert_mean([bias.squared for bias in studies.biases()], expected, f"bias {amplitude}")
            if amplitude == 0.0:  # either noise left in would be seen
                mean = np.mean(studies.truth) ** 2
                render_noise = (PIXEL_NOISE**2 / BLOCK**2 + SHARED_NOISE**2 / (BLOCK / 4) ** 2) / SEEDS
                self.assertGreater(render_noise / mean, 10 * error)
                self.assertGreater(studies.reference_block_variance / mean, 10 * error)

    def test_standard_error_of_the_bias(self):
        biases = SyntheticStudies(0.0, 7).biases()
        ratio = np.var([bias.squared for bias in biases], ddof=1) / np.mean([bias.error**2 for bias in biases])
        # Standard error of a variance of nearly normal values is sqrt(2/N) of it; half as much again for their skew.
        self.assertLess(abs(ratio - 1), 5 * 1.5 * np.sqrt(2 / STUDIES))

    def test_significance(self):
        self.assertTrue(measures.Bias(0.0021, 0.001).is_significant)
        self.assertFalse(measures.Bias(0.0019, 0.001).is_significant)
        self.assertAlmostEqual(measures.Bias(-0.5, 0.02).bound, 0.2)
        self.assertAlmostEqual(measures.Bias(0.05, 0.02).bound, 0.3)

    def test_spread_over_seeds(self):
        studies = SyntheticStudies(0.1, 11)
        mean = np.mean(studies.truth)
        variances = [measures.spread_std([studies.render() for _ in range(SEEDS)], mean) ** 2 for _ in range(300)]
        self.assert_mean(variances, (PIXEL_NOISE**2 + SHARED_NOISE**2) / mean**2, "variance over seeds")

    def test_std_of_a_stderr_layer(self):
        """The layer of simulated passes against the known noise of their mean; the channels vary together."""
        rng, passes, colour, reference_mean = np.random.default_rng(13), 50, np.array([1.0, 0.5, 0.2]), 2.0
        found = []
        for _ in range(200):
            grey = rng.normal(1.0, 0.8, (passes, 16, 16, 1)) * colour
            found.append(measures.relative_std(grey.std(axis=0, ddof=1) / np.sqrt(passes), reference_mean) ** 2)
        self.assert_mean(found, (0.8 * colour.mean() / reference_mean) ** 2 / passes, "variance of the mean")

    def test_block_variance_of_independent_pixels(self):
        rng = np.random.default_rng(17)
        error = np.repeat(rng.uniform(0.1, 2.0, (SIZE, SIZE, 1)), 3, axis=2)
        known = measures.block_variance_of_independent_pixels(error, BLOCK)
        noise = [measures.block_means(error[..., 0] * rng.normal(size=(SIZE, SIZE)), BLOCK) for _ in range(2000)]
        self.assert_mean([np.mean(blocks**2) for blocks in noise], known, "block variance")

    def test_block_variance_of_averages(self):
        """References made of renders whose neighbouring pixels vary together, as those of photons do."""
        studies, seeds = SyntheticStudies(0.1, 19), 4
        known = (PIXEL_NOISE**2 / BLOCK**2 + SHARED_NOISE**2 / (BLOCK / 4) ** 2) / seeds
        found = [average([np.repeat(studies.render()[..., None], 3, axis=2) for _ in range(seeds)], BLOCK)[1]
                 for _ in range(300)]
        self.assert_mean(found, known, "block variance")

    def test_differences_from_the_reference(self):
        reference = np.full((SIZE, SIZE), 2.0)
        image = reference + 0.1
        colour, exact = (np.repeat(grey[..., None], 3, axis=2) for grey in (image, reference))
        self.assertAlmostEqual(measures.relmse99(colour, measures.Truth(exact)), 0.0025)
        self.assertAlmostEqual(measures.median_error(image, reference), 0.05)
        image[0, 0] = 1e6
        self.assertAlmostEqual(measures.median_error(image, reference), 0.05, msg="a firefly does not move it")
        colour = np.repeat(truth()[..., None], 3, axis=2)
        self.assertEqual(measures.picture_difference(colour, colour), 0.0)
        self.assertGreater(measures.picture_difference(0.5 * colour, colour), measures.picture_difference(0.9 * colour, colour))

    def test_gain(self):
        self.assertAlmostEqual(measures.mean_squared_error(0.3, 0.16), 0.25)
        self.assertAlmostEqual(measures.mean_squared_error(0.3, -1.0), 0.09)
        self.assertAlmostEqual(measures.gain(1.0, 0.0, 0.1, 0.0), 100.0)
        # Twice the time halves the other's variance, never its bias.
        self.assertAlmostEqual(measures.gain(1.0, 1.0, 1.0, 0.0, time_ratio=0.5), 1.5)

    def test_blocks(self):
        image = np.arange(16.0).reshape(4, 4)
        np.testing.assert_allclose(measures.block_means(image, 2), [[2.5, 4.5], [10.5, 12.5]])
        with self.assertRaisesRegex(ValueError, "do not divide"):
            measures.block_means(image, 3)


class Images(unittest.TestCase):
    def test_average_down_by_three(self):
        image = np.random.default_rng(1).uniform(size=(12, 9, 3))
        expected = image.reshape(4, 3, 3, 3, 3).mean(axis=(1, 3))
        np.testing.assert_allclose(images.average_down(image, (4, 3)), expected, rtol=1e-12)

    def test_average_down_by_a_fraction(self):
        """480 to 128 pixels: 3.75 to one. Linear functions have the value of the coarse pixel's centre; means stay."""
        x = (np.arange(480) + 0.5) / 480
        image = np.add.outer(2 * x, 3 * x)
        coarse = (np.arange(128) + 0.5) / 128
        found = images.average_down(image, (128, 128))
        np.testing.assert_allclose(found.mean(), image.mean(), rtol=1e-12)
        # Cut pixels are taken at their own value: the line is met to a fraction of a fine pixel.
        np.testing.assert_allclose(found, np.add.outer(2 * coarse, 3 * coarse), atol=5 / 480 / 8)

    def test_pfm_both_ways_round(self):
        image = np.random.default_rng(2).uniform(size=(3, 5, 3)).astype("<f4")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "image.pfm"
            for kind, scale in (("<f4", -1), (">f4", 1)):
                # A first byte that looks like white space must not be eaten with the header's end.
                image[-1, 0, 0] = np.frombuffer(b"\x20\x0a\x0d\x3e", kind)[0]
                file.write_bytes(f"PF\n5 3\n{scale}\n".encode() + image[::-1].astype(kind).tobytes())
                np.testing.assert_array_equal(images.read_pfm(file), image)
            file.write_bytes(b"PF\n5 3\n-1\n" + image.tobytes()[:-1])
            with self.assertRaisesRegex(images.ImageError, "truncated"):
                images.read_pfm(file)

    def exr(self, planes, compression):
        """The bytes of an EXR file; each chunk compressed only where that helps, as the format asks."""
        height, width = next(iter(planes.values())).shape
        lines = {0: 1, 3: 16}[compression]

        def attribute(name, kind, value):
            return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

        channels = b"".join(name.encode() + struct.pack("<xiB3xii", 2, 0, 1, 1) for name in sorted(planes)) + b"\0"
        header = struct.pack("<ii", images.EXR_MAGIC, 2) + attribute(b"channels", b"chlist", channels) \
            + attribute(b"compression", b"compression", bytes([compression])) \
            + attribute(b"dataWindow", b"box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)) + b"\0"
        chunks = []
        for first in range(0, height, lines):
            raw = b"".join(planes[name][y].astype("<f4").tobytes()
                           for y in range(first, min(first + lines, height)) for name in sorted(planes))
            packed = raw
            if compression == 3:
                order = np.frombuffer(raw, np.uint8)
                order = np.concatenate([order[0::2], order[1::2]]).astype(np.int64)
                order[1:] = order[1:] - order[:-1] + 128
                packed = min(zlib.compress((order & 255).astype(np.uint8).tobytes()), raw, key=len)
            chunks.append(struct.pack("<ii", first, len(packed)) + packed)
        offsets = np.cumsum([len(header) + 8 * len(chunks)] + [len(chunk) for chunk in chunks[:-1]])
        return header + offsets.astype("<u8").tobytes() + b"".join(chunks)

    def test_exr(self):
        rng = np.random.default_rng(3)
        noise = {name: rng.uniform(size=(37, 7)).astype("<f4") for name in ("R", "G", "B", "stderr.R", "stderr.G", "stderr.B")}
        smooth = {name: np.full((37, 7), 0.5, "<f4") for name in noise}  # compresses; noise does not
        smooth["G"][20:] = 0.25
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "image.exr"
            for planes in (noise, smooth):
                for compression in (0, 3):
                    file.write_bytes(self.exr(planes, compression))
                    layers = images.read_exr(file)
                    np.testing.assert_array_equal(layers[""], np.stack([planes[c] for c in "RGB"], axis=-1))
                    np.testing.assert_array_equal(layers["stderr"], np.stack([planes[f"stderr.{c}"] for c in "RGB"], axis=-1))
            file.write_bytes(self.exr(noise, 3)[:-40])
            with self.assertRaisesRegex(images.ImageError, "damaged"):
                images.read_exr(file)
            file.write_bytes(b"not an image")
            with self.assertRaisesRegex(images.ImageError, "not an EXR"):
                images.read_exr(file)

    def test_tone_map(self):
        np.testing.assert_allclose(images.tone_map(np.array([0.0, 1.0, 2.0, 4.0]), 2.0), [0, 0.7353570, 1, 1], atol=1e-6)


if __name__ == "__main__":
    unittest.main()
