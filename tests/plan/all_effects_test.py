#!/usr/bin/python3
"""`--effects all` shows the same image: every integrator and primitive, plain and guided, in a few scenes each, by one thread. Bit for bit
where nothing is left out; to rounding where a plain integrator leaves out a medium; within errors where a guided one does. The renderer
is named by the environment's TUNGSTEN."""

import os
import tempfile
import unittest

import numpy as np

from plan_test import FAR_FOG, FRAMED, GLOSSY, LAMP, PATHS, PHOTONS, TUNGSTEN, foggy, render_all, room

MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
SLICES = ("planes", "volumes", "balls", "volumes_balls", "mis_volumes_balls", "hypervolumes")


def without(block, *words):
    return {name: value for name, value in block.items() if not any(word in name for word in words)}


def integrators():
    """By name: the block, and whether it guides."""
    listed = {}
    for kind in ("path_tracer", "transient_path_tracer"):
        for darts in ("off", "best"):
            listed[f"{kind}, {darts}"] = {**PATHS, "type": kind, "darts": darts}
    for kind in ("light_tracer", "transient_light_tracer"):
        listed[kind] = {**PATHS, "type": kind}
    for kind in ("photon_map", "progressive_photon_map"):
        listed[kind] = {**without(PHOTONS, "transient"), "type": kind}
    for kind in ("transient_photon_map", "progressive_transient_photon_map"):
        for darts in ("off", "best"):
            for primitive in ("points", "beams"):
                listed[f"{kind}, {primitive}, {darts}"] = {**PHOTONS, "type": kind, "volume_photon_type": primitive, "darts": darts}
    for primitive in SLICES:
        listed[primitive] = {**PHOTONS, "volume_photon_type": primitive}
    listed["delta gate, best"] = {**PHOTONS, "delta_time_gate": True, "darts": "best"}
    listed["frames, best"] = {**FRAMED, "darts": "best"}
    listed["paths in frames, best"] = {**without(FRAMED, "photon", "gather"), "type": "path_tracer", "darts": "best"}
    return listed


class AllEffects(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(dir=MEMORY)
        self.addCleanup(self.folder.cleanup)

    def both(self, scenes, *options):
        """Pairs of images of each of the scenes: with what can be left out left out, and with `--effects all`."""
        some, every = ([mean for mean, _ in render_all(TUNGSTEN, self.folder.name, scenes, "-t", "1", "-s", "3", *more, *options)]
                       for more in ([], ["--effects", "all"]))
        return zip(some, every)

    def test_bits_are_the_same_where_nothing_is_left_out(self):
        scenes = {}
        for name, integrator in integrators().items():
            scenes |= {(name, "surfaces alone"): room(integrator), (name, "fog"): foggy(integrator, surface=LAMP),
                       (name, "glass"): foggy(integrator, surface={"bsdf": "glass"}), (name, "glossy"): foggy(integrator, surface=GLOSSY),
                       (name, "boundary"): foggy(integrator, surface={"bsdf": {"type": "forward"}})}
        lit = 0
        for (name, where), (some, every) in zip(scenes, self.both(list(scenes.values()))):
            with self.subTest(integrator=name, scene=where):
                np.testing.assert_array_equal(some, every)
                lit += some.max() > 0
        self.assertEqual(lit, len(integrators()) * 5, "nothing is compared where the image is black")

    def test_what_is_left_out_was_not_seen(self):
        """Fog that is too far away. Where it is left out nothing scatters, and light paths are plain: 1.4 % of noise in 32 passes."""
        scenes = {name: room(integrator, surface=FAR_FOG) for name, integrator in integrators().items()}
        guided = [name for name in scenes if "best" in name]
        plain = [name for name in scenes if "best" not in name]
        more = ("--spp", "256", "--set", "renderer.spp_step=8")
        for name, (some, every) in zip(guided, self.both([scenes[name] for name in guided], *more)):
            with self.subTest(integrator=name):
                np.testing.assert_allclose(some.mean(), every.mean(), rtol=0.075)
        for name, (some, every) in zip(plain, self.both([scenes[name] for name in plain])):
            with self.subTest(integrator=name):
                np.testing.assert_allclose(some, every, rtol=0, atol=1e-6 * some.max())


if __name__ == "__main__":
    unittest.main()
