#!/usr/bin/python3
"""`--effects all` shows the same image: every integrator and primitive, plain and guided, in a few scenes each, by one thread. Bit for bit
where nothing is left out; to rounding where a plain integrator leaves out a medium; within errors where a guided one does. The renderer
is named by the environment's TUNGSTEN."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

from plan_test import FAR_FOG, FRAMED, GLOSSY, LAMP, PATHS, PHOTONS, TUNGSTEN, foggy, room

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

    def image(self, scene, *options):
        file = Path(self.folder.name) / "scene.json"
        file.write_text(json.dumps(scene))
        done = subprocess.run([TUNGSTEN, "--quiet", "-t", "1", "-s", "3", "-d", self.folder.name, "-e", "film.npz", *options, str(file)],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return np.load(Path(self.folder.name) / "film.npz")["mean"].astype(float)

    def both(self, scene, *options):
        return self.image(scene, *options), self.image(scene, "--effects", "all", *options)

    def test_bits_are_the_same_where_nothing_is_left_out(self):
        lit = 0
        for name, integrator in integrators().items():
            scenes = {"surfaces alone": room(integrator), "fog": foggy(integrator, surface=LAMP),
                      "glass": foggy(integrator, surface={"bsdf": "glass"}), "glossy": foggy(integrator, surface=GLOSSY),
                      "boundary": foggy(integrator, surface={"bsdf": {"type": "forward"}})}
            for where, scene in scenes.items():
                with self.subTest(integrator=name, scene=where):
                    some, every = self.both(scene)
                    np.testing.assert_array_equal(some, every)
                    lit += some.max() > 0
        self.assertEqual(lit, len(integrators()) * 5, "nothing is compared where the image is black")

    def test_what_is_left_out_was_not_seen(self):
        """Fog that is too far away. Where it is left out nothing scatters, and light paths are plain: 1.4 % of noise."""
        for name, integrator in integrators().items():
            guided = "best" in name
            scene = room(integrator, surface=FAR_FOG)
            with self.subTest(integrator=name):
                some, every = self.both(scene, *(("--spp", "1024", "--set", "renderer.spp_step=32") if guided else ()))
                if guided:
                    np.testing.assert_allclose(some.mean(), every.mean(), rtol=0.075)
                else:
                    np.testing.assert_allclose(some, every, rtol=0, atol=1e-6 * some.max())


if __name__ == "__main__":
    unittest.main()
