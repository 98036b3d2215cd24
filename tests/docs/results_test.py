#!/usr/bin/python3
"""Results as docs/results.md says: the page's own reader on a film, and every format against the others.

    results_test.py READER.py        (the listing of the page); the environment's TUNGSTEN names the renderer
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
TUNGSTEN = os.environ["TUNGSTEN"]
READER = sys.argv.pop(1) if len(sys.argv) > 1 else None
SCENE = PROJECT / "data/scenes/two-pulses/scene.json"
PICOSECONDS = 1e12 / 299792458  # that light takes for a metre


def render(folder, name, *options):
    command = [TUNGSTEN, "--quiet", "-t", "1", "--resolution", "7x5", "--spp", "6", "-s", "3", "-d", folder, "-o", "film.png",
               "-e", name, "--set", "integrator.type=path_tracer", "--set", "integrator.darts=off", "--set", "renderer.spp_step=2",
               "--set", "integrator.frame_num=4", *options, SCENE]
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        for extension in ("npz", "h5", "npy"):
            render(cls.folder, f"film.{extension}", "--set", "length_unit=cm")
        cls.npz = np.load(cls.folder / "film.npz")
        cls.about = json.loads(cls.npz["metadata.json"])

    def test_the_film_is_that_of_the_other_formats(self):
        film = self.npz["mean"]
        self.assertEqual((film.shape, film.dtype), ((4, 5, 7, 3), np.float32))
        np.testing.assert_array_equal(film, np.load(self.folder / "film.npy"))
        self.assertGreater(film.max(), 0)
        self.assertEqual(self.npz["standard_error"].shape, film.shape)
        self.assertTrue((self.npz["standard_error"][film > 0] > 0).all())

    def test_hdf5_holds_the_same(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("python3-h5py is not installed")
        with h5py.File(self.folder / "film.h5") as file:
            self.assertEqual((file.attrs["format"], file.attrs["format_version"]), (b"darts-tungsten result", 1))
            self.assertEqual(sorted(file), sorted(name.removesuffix(".json") for name in self.npz.files))
            for name in self.npz.files:
                if name != "metadata.json":
                    np.testing.assert_array_equal(file[name][()], self.npz[name])
            about = json.loads(file["metadata"][()])
        self.assertEqual(about["scene"], self.about["scene"])

    def test_edges_are_the_frames_of_the_scene(self):
        scene = self.about["scene"]["integrator"]
        edges = scene["start_time"] + scene["transient_time_width"] * np.arange(5)
        np.testing.assert_allclose(self.npz["time_edges"], edges, rtol=1e-14)
        np.testing.assert_allclose(self.about["time"]["edges"], edges, rtol=1e-14)
        speed = scene.get("vacuum_speed_of_light", scene.get("vaccum_speed_of_light", 1))
        np.testing.assert_allclose(self.npz["time_edges_ps"], edges * speed * 0.01 * PICOSECONDS, rtol=1e-12)

    def test_metadata_say_what_was_rendered(self):
        self.assertEqual(self.about["format version"], 1)
        self.assertEqual(self.about["quantity"], "radiance, mean over a frame")
        self.assertEqual(self.about["time"]["kind"], "frames")
        self.assertTrue(self.about["time"]["camera segments count"])
        statistics = self.about["statistics"]
        self.assertEqual([statistics[name] for name in ("seed", "passes", "samples per pixel", "threads")], [3, 3, 6, 1])
        self.assertGreater(statistics["process CPU seconds"], 0)
        scene = self.about["scene"]
        self.assertEqual((scene["integrator"]["type"], scene["camera"]["resolution"]), ("path_tracer", [7, 5]))
        self.assertEqual([thing["name"] for thing in scene["primitives"] if "name" in thing],
                         re.findall(r'"name": "([\w ]+)"', SCENE.read_text().split('"primitives"')[1]))

    def test_an_npy_has_them_beside_it(self):
        beside = json.loads((self.folder / "film.npy.json").read_text())
        for name in ("time", "scene", "quantity"):
            self.assertEqual(beside[name], self.about[name])

    def test_other_conventions_are_told(self):
        render(self.folder, "other.npz", "--set", "integrator.time_normalization=integral", "--set",
               "integrator.camera_unwarped=true")
        other = np.load(self.folder / "other.npz")
        about = json.loads(other["metadata.json"])
        self.assertEqual(about["quantity"], "radiance, integrated over a frame")
        self.assertFalse(about["time"]["camera segments count"])
        self.assertNotIn("time_edges_ps", other.files)
        self.assertNotIn("edges in picoseconds", about["time"])

    def test_members_are_stored_for_readers_of_all_kinds(self):
        with zipfile.ZipFile(self.folder / "film.npz") as members:
            self.assertIsNone(members.testzip())
            self.assertEqual({member.compress_type for member in members.infolist()}, {zipfile.ZIP_STORED})

    def test_the_reader_of_the_page(self):
        out = subprocess.run([sys.executable, READER, self.folder / "film.npz"], check=True, capture_output=True, text=True).stdout
        lines = out.splitlines()
        self.assertEqual(lines[0], "radiance, mean over a frame of 4 frames after 3 passes")
        mean, error = self.npz["mean"][2, 0, 0, 1], self.npz["standard_error"][2, 0, 0, 1]
        edges = self.npz["time_edges"]
        self.assertEqual(lines[3], f"green of the first pixel from {edges[2]:g} to {edges[3]:g}: {mean:g} +- {error:g}")


if __name__ == "__main__":
    unittest.main()
