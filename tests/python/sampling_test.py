#!/usr/bin/python3
"""The sampling library in Python, against closed forms."""

import math
import unittest

import numpy as np

from darts_tungsten import sampling


class Sampling(unittest.TestCase):
    """A density's integral is 1; samples spread as their density says; weights average to the transmittance."""

    def test_directions(self):
        h = (np.arange(200000) + 0.5) / 100000
        u = (np.arange(100000) + 0.5) / 100000
        table = sampling.EdaTable(0.9, 0.3)
        for name, pdf, sample in (
                ("path", lambda h: sampling.path_lobe_pdf(h, 2.0, 0.5), lambda u: sampling.path_lobe_sample(u, 2.0, 0.5)),
                ("photon", lambda h: sampling.photon_lobe_pdf(h, 2.0, 0.5), lambda u: sampling.photon_lobe_sample(u, 2.0, 0.5)),
                ("eda", lambda h: table.pdf(2.0, 0.5, 1.0, h), lambda u: table.sample(2.0, 0.5, 1.0, u))):
            density = 2 * np.pi * pdf(h)
            self.assertAlmostEqual(density.mean() * 2, 1, delta=1e-4, msg=name)
            # Quantiles are where the density's integral says.
            below = np.interp(sample(u[::5000]), h, np.cumsum(density) / 100000)
            np.testing.assert_allclose(below, u[::5000], atol=1e-3, err_msg=name)

    def test_connection_lengths(self):
        offset = (np.arange(100000) + 0.5) / 50000
        density = sampling.connection_length_pdf(offset, 0.1, 2.0, 1.5)
        np.testing.assert_allclose(density, 1.5 * np.exp(-1.5 * offset) / -np.expm1(-3), rtol=1e-6)
        u = np.linspace(0, 0.99, 12)
        np.testing.assert_allclose(sampling.connection_length_sample(u, 0.1, 2.0, 1.5), -np.log1p(u * np.expm1(-3)) / 1.5, rtol=1e-6,
                                   atol=1e-12)

    def test_connections_have_their_length(self):
        h = np.linspace(0, 2, 9)
        first, second = sampling.first_leg(2.0, 0.5, h), sampling.second_leg(2.0, 0.5, h)
        np.testing.assert_allclose(first + second, 2.5)
        np.testing.assert_allclose(second, np.sqrt((first - 2) ** 2 + 4 * first * h), rtol=1e-12)

    def test_guides_sum_to_light_scattered_once(self):
        """Connections of one scattering from an isotropic vertex, against the integral over their lengths."""
        C, low, high, sigma_s = 1.0, 1.5, 1.6, 0.8
        S = np.linspace(low, high, 20001)
        light = np.exp(-S) * np.log((S + C) / (S - C)) / (C * S)
        exact = sigma_s * ((light[1:] + light[:-1]) / 2).mean() * (high - low)
        for preset in ("published", "best"):
            for mode in ("path", "photon"):
                guide = sampling.Guide(preset, mode, 0.2, sigma_s)
                drawn = guide.sample(C, low, high, 200000, seed=5)
                self.assertTrue(((drawn["length"] >= low - 1e-5) & (drawn["length"] <= high + 1e-5)).all())
                good = drawn["vertex_inverse_pdf"] > 0
                np.testing.assert_allclose(drawn["vertex"][good] + drawn["to_target"][good], drawn["length"][good], rtol=1e-5)
                value = np.zeros(len(good))
                value[good] = (sigma_s * np.exp(-drawn["length"]) * drawn["vertex_inverse_pdf"] * drawn["direction_inverse_pdf"]
                               * drawn["phase"] / np.square(drawn["to_target"]))[good]
                self.assertAlmostEqual(value.mean(), exact, delta=4.5 * value.std() / len(value) ** 0.5, msg=(preset, mode))
                pdf = guide.vertex_pdf(C, low, high, drawn["h"][good][:1000], drawn["vertex"][good][:1000])
                np.testing.assert_allclose(pdf, 1 / drawn["vertex_inverse_pdf"][good][:1000], rtol=2e-3)
                flight = -np.expm1(-sampling.first_leg(C, high - C, drawn["h"]))
                weight = drawn["transmittance_over_pdf"]
                self.assertAlmostEqual((weight - flight).mean(), 0, delta=4.5 * (weight - flight).std() / len(weight) ** 0.5)
        with self.assertRaisesRegex(ValueError, "high > low"):
            guide.sample(1.0, 2.0, 1.5, 10)
        with self.assertRaisesRegex(ValueError, "preset"):
            sampling.Guide("worst", "path", 0.2, 0.8)

    def test_first_passage_is_the_integrated_flux(self):
        sigma_a, reduced, gate = 0.02, 10.0, 0.3
        D = 1 / (3 * (sigma_a + reduced))
        depth, longest = np.array([[0.05], [0.3], [1.0]]), np.array([2.0, 5.0, 12.0])
        z, s = depth[..., None], np.linspace(longest - gate, longest, 4001).T[None]
        p, w = z / np.sqrt(4 * D * s), np.sqrt(D * s) / (2 * D)
        scaled_erfc = np.vectorize(lambda x: math.erfc(x) * math.exp(x * x))
        flux = np.exp(-p ** 2) / 2 * (1 / np.sqrt(np.pi * D * s) - scaled_erfc(p + w) / (2 * D))
        expected = np.log(((flux[..., 1:] + flux[..., :-1]) / 2).mean(axis=-1) * gate) - sigma_a * longest
        found = sampling.first_passage_log(depth, longest, gate, sigma_a, reduced, allowance=0)
        np.testing.assert_allclose(found, expected, atol=5e-3)
        self.assertLess(sampling.first_passage_log(0.3, 5.0, gate, sigma_a, reduced, thickness=0.5),
                        sampling.first_passage_log(0.3, 5.0, gate, sigma_a, reduced))
        self.assertEqual(sampling.first_passage_log(1.0, 0.5, gate, sigma_a, reduced), -np.inf)

    def test_greens_functions(self):
        rho, s = np.array([[1.0], [2.0]]), np.array([2.5, 4.0, 8.0])
        D = 1 / (3 * (0.1 + 0.9 * 0.5))
        expected = -1.5 * np.log(4 * np.pi * D * s) - rho ** 2 / (4 * D * s) - 0.1 * s
        np.testing.assert_allclose(sampling.diffusion_log(rho, s, 0.1, 0.9, 0.5), expected)
        q = 1 - (rho / s) ** 2
        x = 0.9 * s * q ** 0.75
        paasschens = (np.log(q) / 8 - 1.5 * np.log(4 * np.pi * s / (3 * 0.9)) - s + x + np.log1p(2.026 / x) / 2)
        np.testing.assert_allclose(sampling.causal_log(rho, s, 0.1, 0.9), paasschens, rtol=1e-5)
        self.assertEqual(sampling.causal_log(2.0, 1.0, 0.1, 0.9), -np.inf)

    def test_weights_of_distances_average_to_the_transmittance(self):
        random = np.random.default_rng(7).random((200000, 4), dtype=np.float32)
        for preset in ("published", "best"):
            for mode in ("path", "photon"):
                distance, weight = sampling.DistanceSampler(preset, mode, 0.1, 0.9).sample(2.0, 4.8, 5.0, 0.7, random)
                reach = sampling.first_leg(2.0, 3.0, 0.7)
                self.assertLessEqual(distance[weight > 0].max(), reach * 1.0001)
                error = weight.std() / len(weight) ** 0.5
                self.assertAlmostEqual(weight.mean(), -np.expm1(-reach), delta=4.5 * error, msg=f"{preset}, {mode}")
                self.assertLess(error, 0.01)

    def test_responses(self):
        response = sampling.TemporalResponse.gaussian(3.0, 0.5)
        time = np.linspace(1, 5, 4001)
        self.assertAlmostEqual(response.pdf(time).sum() * 0.001, 1, delta=1e-3)
        np.testing.assert_allclose(response.distribution(response.quantile([0.1, 0.5, 0.9])), [0.1, 0.5, 0.9])

    def test_bad_input(self):
        random = np.zeros((2, 4), np.float32)
        for bad in (lambda: sampling.DistanceSampler("beste", "path", 0, 1), lambda: sampling.DistanceSampler("best", "light", 0, 1),
                    lambda: sampling.DistanceSampler("best", "path", -1, 1), lambda: sampling.EdaTable(2.0, 0.0),
                    lambda: sampling.DistanceSampler("best", "path", 0, 1).sample(1, 2, 3, 5, random),
                    lambda: sampling.DistanceSampler("best", "path", 0, 1).sample(1, 2, 3, 1, random[:, :3])):
            with self.assertRaises(ValueError):
                bad()

    def test_arguments_out_of_range(self):
        """Each argument of everything: NaN is a ValueError that names it; so is what is out of range, or it is a number's limit. What
        indexes a table with them ends the process instead."""
        inf = np.inf
        response, table = sampling.TemporalResponse.box(0, 1), sampling.EdaTable(0.9, 0.3)
        calls = {  # good arguments, and those of them that may be infinite
            "diffusion_log": (sampling.diffusion_log, {"rho": 1, "s": 2, "sigma_a": 0.1, "sigma_s": 0.9, "g": 0.5}, ""),
            "causal_log": (sampling.causal_log, {"rho": 1, "s": 2, "sigma_a": 0.1, "sigma_s": 0.9}, ""),
            "first_leg": (sampling.first_leg, {"C": 2, "delta": 0.5, "h": 1}, ""),
            "second_leg": (sampling.second_leg, {"C": 2, "delta": 0.5, "h": 1}, ""),
            "connection_length_sample": (sampling.connection_length_sample,
                                         {"u": 0.5, "low": 1, "width": 1, "sigma_t": 1, "needle": 0}, "width"),
            "connection_length_pdf": (sampling.connection_length_pdf,
                                      {"offset": 0.5, "low": 1, "width": 1, "sigma_t": 1, "needle": 0}, "width"),
            "control_vertex_pdf": (sampling.control_vertex_pdf, {"C": 2, "delta": 0.5, "h": 1, "length_pdf": 1}, ""),
            "path_lobe_sample": (sampling.path_lobe_sample, {"u": 0.5, "C": 2, "delta": 0.5}, ""),
            "path_lobe_pdf": (sampling.path_lobe_pdf, {"h": 0.5, "C": 2, "delta": 0.5}, ""),
            "photon_lobe_sample": (sampling.photon_lobe_sample, {"u": 0.5, "C": 2, "delta": 0.5}, ""),
            "photon_lobe_pdf": (sampling.photon_lobe_pdf, {"h": 0.5, "C": 2, "delta": 0.5}, ""),
            "eda_log_density": (sampling.eda_log_density, {"albedo": 0.9, "g": 0.3, "C": 2, "delta": 0.5, "h": 1}, ""),
            "EdaTable": (sampling.EdaTable, {"albedo": 0.9, "g": 0.3}, ""),
            "EdaTable.sample": (table.sample, {"C": 2, "delta": 0.5, "sigma_t": 1, "u": 0.5}, ""),
            "EdaTable.pdf": (table.pdf, {"C": 2, "delta": 0.5, "sigma_t": 1, "h": 0.5}, ""),
            "box": (sampling.TemporalResponse.box, {"begin": 0, "end": 1}, ""),
            "gaussian": (sampling.TemporalResponse.gaussian, {"center": 0, "sigma": 1}, ""),
            "pdf": (response.pdf, {"time": 0.5}, "time"),
            "distribution": (response.distribution, {"time": 0.5}, "time"),
            "quantile": (response.quantile, {"u": 0.5}, ""),
            "first_passage_log": (sampling.first_passage_log,
                                  {"depth": 1, "longest": 5, "gate": 0.5, "sigma_a": 0.1, "reduced_sigma_s": 1, "thickness": 2,
                                   "relative_index": 1.3, "allowance": 1}, "thickness")}
        random = np.full((3, 4), 0.5, np.float32)
        for preset in ("best", "published"):
            for mode in ("path", "photon"):
                medium = {"preset": preset, "mode": mode, "sigma_a": 0.1, "sigma_s": 0.9, "g": 0.3}
                distances, guide = sampling.DistanceSampler(**medium), sampling.Guide(**medium)
                calls.update({
                    f"DistanceSampler {preset} {mode}": (sampling.DistanceSampler, medium, ""),
                    f"Guide {preset} {mode}": (sampling.Guide, medium, ""),
                    f"DistanceSampler.sample {preset} {mode}": (distances.sample, {
                        "C": 2, "low": 5, "high": 5.1, "h": 1, "random": random, "surface": 3}, "surface"),
                    f"Guide.sample {preset} {mode}": (guide.sample, {
                        "C": 2, "low": 5, "high": 5.1, "count": 9, "before": 1, "surface": 3}, "surface"),
                    f"vertex_pdf {preset} {mode}": (guide.vertex_pdf, {"C": 2, "low": 5, "high": 5.1, "h": 1, "distance": 1}, ""),
                    f"log_usefulness {preset} {mode}": (guide.log_usefulness, {"C": 2, "low": 5, "high": 5.1, "throughput": 1}, "")})
                for wrong in (np.nan, inf, -inf, 1e30, -1, 1, 1.5):
                    for at in ((0, 0), (1, 1), (2, 2), (2, 3)):
                        numbers = random.copy()
                        numbers[at] = wrong
                        with self.assertRaisesRegex(ValueError, "random: expected random numbers from 0 to below 1"):
                            distances.sample(2, 5, 5.1, 1, numbers)
        for name, (call, good, infinite) in calls.items():
            call(**good)
            for argument, value in good.items():
                if not isinstance(value, (int, float)) or argument == "count":
                    continue
                with self.assertRaisesRegex(ValueError, argument, msg=f"{name}: {argument}"):
                    call(**{**good, argument: np.nan})
                # Tables, which constructors make, take half a second each.
                for wrong in (inf, -inf, 1e30, -1e30, -2) + (() if name[0] in "DEG" and "." not in name else (-1, 0, 1e15, 1e-30, 1e-300)):
                    try:
                        call(**{**good, argument: wrong})
                    except ValueError:
                        continue
                    self.assertTrue(argument in infinite or abs(wrong) <= 1e15, f"{name}: {argument} = {wrong} is taken")
        for name in ("C", "low", "high", "h", "random", "surface"):
            with self.assertRaises(TypeError):
                sampling.DistanceSampler("best", "path", 0.1, 0.9).sample(**{**{"C": 2, "low": 5, "high": 5.1, "h": 1, "random": random,
                                                                               "surface": 3}, name: "much"})
        for times, values in (([0, np.nan], [1, 1]), ([0, 1], [1, np.inf]), ([0], [1]), ([1, 0], [1, 1]), ([], [])):
            with self.assertRaises(ValueError):
                sampling.TemporalResponse.tabulated(times, values)

    def test_random_numbers_out_of_range_of_vectors(self):
        table = sampling.EdaTable(0.9, 0.3)
        for call in (lambda u: sampling.path_lobe_sample(u, 2.0, 0.5), lambda u: sampling.photon_lobe_sample(u, 2.0, 0.5),
                     lambda u: sampling.connection_length_sample(u, 1, 1, 1), lambda u: table.sample(2.0, 0.5, 1.0, u)):
            self.assertEqual(call(np.array([0.0, 0.5])).shape, (2,))
            for wrong in (np.nan, np.inf, 1e30, -0.1, 1.0):
                with self.assertRaisesRegex(ValueError, "u: expected random numbers"):
                    call(np.array([0.5, wrong, 0.5]))

    def test_nothing_is_made_without_its_constructor(self):
        for kind in (sampling.DistanceSampler, sampling.Guide, sampling.EdaTable, sampling.TemporalResponse):
            with self.assertRaises(TypeError):
                kind.__new__(kind)
        self.assertEqual(sampling.EdaTable.__new__(sampling.EdaTable, 0.9, 0.3).sample(2, 0.5, 1, 0.5),
                         sampling.EdaTable(0.9, 0.3).sample(2, 0.5, 1, 0.5))


if __name__ == "__main__":
    unittest.main()
