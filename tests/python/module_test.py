#!/usr/bin/python3
"""The Python module: renders against the command (the environment's TUNGSTEN), errors and
interruption."""

import gc
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np

import darts_tungsten

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scenes import lamp_over_floor  # noqa: E402

PROJECT = Path(__file__).resolve().parents[2]
TUNGSTEN = os.environ["TUNGSTEN"]
SCENE = lamp_over_floor((12, 8), {"type": "path_tracer", "max_bounces": 8, "start_time": 3, "transient_time_width": 0.5,
                                 "frame_num": 4}, {"spp": 8, "spp_step": 2})


class Render(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.file = self.folder / "scene.json"
        self.file.write_text(json.dumps(SCENE))

    def test_film_of_luminance(self):
        settings = {"seed": 3, "passes": 4}
        whole = darts_tungsten.render(SCENE, **settings)
        grey = darts_tungsten.render(SCENE, set={"film": {"channels": "luminance", "moments": False}}, **settings)
        self.assertEqual(grey.mean.shape, (4, 8, 12, 1))
        np.testing.assert_allclose(grey.mean[..., 0], whole.mean @ np.array([0.2126, 0.7152, 0.0722]), rtol=1e-4, atol=1e-7)
        self.assertTrue(np.isnan(grey.standard_error).all())
        self.assertAlmostEqual(grey.relative_error / whole.relative_error, 1.0, 3)  # the scene is grey
        self.assertEqual(grey.metadata["channels"], ["Y"])
        grey.write(self.folder / "grey.npz")
        with np.load(self.folder / "grey.npz") as result:
            self.assertEqual(result["mean"].shape, (4, 8, 12, 1))
            self.assertNotIn("standard_error", result)
        with self.assertRaisesRegex(ValueError, "film.channels.*luminance"):
            darts_tungsten.render(SCENE, set={"film": {"channels": "luminence"}}, passes=1)

    def test_numbers_of_numpy_and_paths_in_scenes(self):
        plain = darts_tungsten.render(SCENE, passes=1, threads=1)
        scene = json.loads(json.dumps(SCENE))
        scene["integrator"].update(max_bounces=np.int64(8), start_time=np.float32(3), transient_time_width=np.float64(0.5),
                                   frame_num=np.uint8(4), enable_rr=np.bool_(False))
        scene["camera"]["resolution"] = np.array([12, 8])
        scene["camera"]["fov"] = np.array(scene["camera"]["fov"])
        rendered = darts_tungsten.render(scene, passes=np.int32(1), threads=np.int64(1), seconds=np.float32(100))
        plainly = darts_tungsten.render(SCENE, set={"integrator.enable_rr": False}, passes=1, threads=1)
        np.testing.assert_array_equal(rendered.mean, plainly.mean)
        self.assertEqual(plain.mean.shape, rendered.mean.shape)
        moved = darts_tungsten.render(SCENE, set={"camera.resolution": np.array([6, 4]), "integrator.frame_num": np.int8(2)}, passes=1)
        self.assertEqual(moved.mean.shape, (2, 4, 6, 3))
        with self.assertRaisesRegex(ValueError, "max_bounces"):
            darts_tungsten.render(SCENE, set={"integrator.max_bounces": np.float32("nan")}, passes=1)
        with self.assertRaisesRegex(ValueError, "nowhere.obj"):
            darts_tungsten.plan({**SCENE, "primitives": [{"type": "mesh", "file": Path("nowhere.obj")}]}, folder=self.folder)

    def test_arguments_of_other_types(self):
        for arguments, expected in (((None,), "scene: expected a dict or the name of a file, found NoneType"),
                                    ((3,), "scene: expected a dict or the name of a file, found int"),
                                    (([SCENE],), "found list"), (({**SCENE, "media": {1, 2}},), "a value of type set"),
                                    (({**SCENE, "media": [3j]},), "a value of type complex")):
            for function in (darts_tungsten.render, darts_tungsten.plan):
                with self.assertRaisesRegex(TypeError, expected):
                    function(*arguments)
        for named, expected in (({"set": {3: 4}}, "set: expected names as keys, found int"), ({"progress": "yes"}, "progress: expected"),
                                ({"set": None}, ""), ({"seconds": "1"}, ""), ({"passes": 1.5}, ""), ({"folder": 3}, "")):
            with self.assertRaisesRegex(TypeError, expected):
                darts_tungsten.render(SCENE, **named)
        for named in ({"seconds": 0}, {"seconds": np.nan}, {"seconds": -1}, {"passes": 0}, {"passes": 1 << 62}, {"samples": 1 << 62},
                      {"samples": -1}, {"target_error": np.nan}, {"target_error": 0}, {"threads": 0}):
            with self.assertRaisesRegex(ValueError, next(iter(named))):
                darts_tungsten.render(SCENE, **named)

    def test_results_are_made_by_renders_alone(self):
        for make in (darts_tungsten.Result, lambda: darts_tungsten.Result.__new__(darts_tungsten.Result)):
            with self.assertRaises(TypeError):
                make()

    def command(self, *options):
        subprocess.run([TUNGSTEN, "--quiet", "-d", self.folder, "-e", "film.npz", *options, self.file], check=True)
        return np.load(self.folder / "film.npz")

    def test_two_renders_in_one_process_are_what_two_processes_give(self):
        first = darts_tungsten.render(SCENE, seed=5, threads=1)
        second = darts_tungsten.render(str(self.file), seed=6, set={"media.fog.sigma_a": 0.2})
        np.testing.assert_array_equal(first.mean, self.command("-s", "5")["mean"])
        film = self.command("-s", "6", "--set", "media.fog.sigma_a=0.2")
        np.testing.assert_array_equal(second.mean, film["mean"])
        np.testing.assert_array_equal(second.standard_error, film["standard_error"])
        np.testing.assert_array_equal(second.time_edges, film["time_edges"])

    def test_integrals_are_told_in_units_of_outputs(self):
        change = {"integrator.time_normalization": "integral"}
        mean, integral = darts_tungsten.render(SCENE).mean, darts_tungsten.render(SCENE, set=change).mean
        np.testing.assert_array_equal(integral, mean * np.float32(0.5))

    def test_arrays_are_views_that_keep_the_result(self):
        result = darts_tungsten.render(SCENE, passes=2)
        mean, again = result.mean, result.mean
        self.assertEqual((mean.shape, mean.dtype), ((4, 8, 12, 3), np.float32))
        self.assertTrue(np.shares_memory(mean, again))
        with self.assertRaises(ValueError):
            mean[0] = 1
        copy = mean.copy()
        del result, again
        gc.collect()
        np.testing.assert_array_equal(mean, copy)

    def test_limits(self):
        self.assertEqual(darts_tungsten.render(SCENE).samples, 8)
        self.assertEqual(darts_tungsten.render(SCENE, passes=3).passes, 3)
        self.assertEqual(darts_tungsten.render(SCENE, samples=5).samples, 5)
        timed = darts_tungsten.render(SCENE, passes=10 ** 6, seconds=0.3)
        self.assertEqual(timed.reason, "time-out")
        self.assertLess(timed.seconds, 5)
        steady = {"integrator.frame_num": 0, "integrator.transient_time_width": 0}
        reached = darts_tungsten.render(SCENE, passes=10 ** 6, target_error=0.5, set=steady)
        self.assertEqual(reached.reason, "target error reached")
        self.assertLessEqual(reached.error_bound, 0.5)
        for bad in ({"passes": 0}, {"samples": 0}, {"seconds": 0}, {"seconds": float("nan")}, {"target_error": -1}, {"target_error": 0},
                    {"threads": 0}, {"passes": 1, "samples": 1}):
            with self.assertRaises(darts_tungsten.UsageError, msg=bad) as raised:
                darts_tungsten.render(SCENE, **bad)
            self.assertIn(next(iter(bad)), str(raised.exception))

    def test_metadata_and_files(self):
        result = darts_tungsten.render(SCENE, set={"length_unit": "m"})
        self.assertEqual(result.metadata["scene"]["length_unit"], "m")
        self.assertEqual(result.metadata["statistics"]["passes"], 4)
        np.testing.assert_allclose(result.time_edges_ps, result.time_edges * 1e12 / 299792458, rtol=1e-12)
        self.assertIsNone(darts_tungsten.render(SCENE, passes=1).time_edges_ps)
        names = result.write(str(self.folder / "mine.npz"))
        self.assertEqual(names, [str(self.folder / "mine.npz")])
        np.testing.assert_array_equal(np.load(names[0])["mean"], result.mean)
        with self.assertRaisesRegex(darts_tungsten.InputError, "accepted: .exr"):
            result.write(str(self.folder / "mine.tiff"))

    def test_every_problem_is_listed(self):
        with self.assertRaises(darts_tungsten.InputError) as raised:
            darts_tungsten.render(SCENE, set={"media.fog.sigma_s": -1, "camera.fov": "wide"})
        self.assertEqual(sorted(path for _, path, _ in raised.exception.problems), ["camera.fov", "media[0].sigma_s"])
        self.assertIsInstance(raised.exception, ValueError)
        with self.assertRaisesRegex(darts_tungsten.InputError, "did you mean 'path_tracer'"):
            darts_tungsten.render(SCENE, set={"integrator.type": "path_trace"})
        with self.assertRaisesRegex(darts_tungsten.InputError, "no such file|cannot be read"):
            darts_tungsten.render("nowhere.json")
        with self.assertRaisesRegex(darts_tungsten.UsageError, "did you mean 'sigma_s'|nothing is called"):
            darts_tungsten.render(SCENE, set={"medium.fog.sigma_s": 1})

    def test_warnings_are_pythons(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            darts_tungsten.plan(SCENE, set={"integrator.max_bounce": 3})
        self.assertIn("max_bounce", str(caught[0].message))

    def test_progress_may_stop(self):
        seen = []

        def progress(state):
            seen.append(state["passes"])
            return len(seen) < 3

        result = darts_tungsten.render(SCENE, passes=100, progress=progress)
        self.assertEqual((seen, result.passes, result.reason), ([1, 2, 3], 3, "interrupted"))

        def fail(_):
            raise KeyError("mine")

        with self.assertRaises(KeyError):
            darts_tungsten.render(SCENE, passes=100, progress=fail)

    def test_ctrl_c_interrupts_and_other_threads_run(self):
        ticks = []

        def interrupt():
            for _ in range(20):
                ticks.append(time.monotonic())
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            darts_tungsten.render(SCENE, passes=10 ** 7, seconds=60)
        thread.join()
        self.assertEqual(len(ticks), 20)

    def test_ctrl_c_while_a_scene_is_loaded(self):
        side, mesh = 1400, self.folder / "big.obj"  # text that takes seconds to read
        row = "".join(f"v {i} {side + i % 7} 0\n" for i in range(side))
        faces = "".join(f"f {i} {i + 1} {i + side + 1}\n" for i in range(1000000, 1000000 + side))
        mesh.write_text(3 * side * row + 3 * side * faces)
        scene = self.folder / "big.json"
        scene.write_text(json.dumps({**SCENE, "primitives": SCENE["primitives"] + [{"type": "mesh", "file": mesh.name}]}))
        before = darts_tungsten.render(SCENE, passes=1, seed=4).mean
        for load in darts_tungsten.render, darts_tungsten.plan:
            # Its own process: threads of this one must not be needed. It tells when it has sent the signal.
            sender = subprocess.Popen(["sh", "-c", f"sleep 0.3; kill -INT {os.getpid()}; date +%s.%N"], stdout=subprocess.PIPE)
            with self.assertRaises(KeyboardInterrupt):
                load(scene)
            ended = time.time()
            sent = float(sender.communicate()[0])
            self.assertLess(ended - sent, 1, "the mesh takes some three seconds")
        np.testing.assert_array_equal(darts_tungsten.render(SCENE, passes=1, seed=4).mean, before)

    def test_files_are_beside_the_scene(self):
        (self.folder / "lone.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.file.write_text(json.dumps({**SCENE, "primitives": SCENE["primitives"] + [{"type": "mesh", "file": "lone.obj"}]}))
        self.assertEqual(darts_tungsten.plan(self.file)["integrator"], "path_tracer")
        self.assertEqual(darts_tungsten.render(self.file, passes=1).passes, 1)
        with self.assertRaisesRegex(darts_tungsten.InputError, "lone.obj: no such file"):
            darts_tungsten.plan(self.file, folder=PROJECT)

    def test_passes_are_broken_off(self):
        endless = {"renderer.spp_step": 10 ** 6, "renderer.spp": 10 ** 6, "camera.resolution": [256, 256]}
        interrupt = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        interrupt.start()
        with self.assertRaises(KeyboardInterrupt):
            darts_tungsten.render(SCENE, set=endless, seconds=600)
        interrupt.join()
        with self.assertRaisesRegex(TimeoutError, "not one pass ended within 0.001 s"):
            darts_tungsten.render(SCENE, set={**endless, "renderer.spp_step": 1, "camera.resolution": [2048, 2048]}, seconds=0.001)
        result = darts_tungsten.render(SCENE, set=endless, seconds=0.8)
        self.assertEqual(result.reason, "time-out")
        self.assertGreater(result.passes, 0)

    def test_plan_and_describe(self):
        plan = darts_tungsten.plan(SCENE)
        self.assertEqual(plan["integrator"], "path_tracer")
        self.assertTrue(all(effect["reason"] for effect in plan["effects"]))
        explained = subprocess.run([TUNGSTEN, "--explain=effects", self.file], check=True, capture_output=True, text=True).stdout
        for effect in plan["effects"]:
            self.assertIn(effect["reason"], explained)
        causes = {effect["name"]: effect["causes"] for effect in plan["effects"]}
        self.assertEqual(causes["medium scattering"], ["media[0]"])
        self.assertEqual(plan["lacks"], [])
        self.assertTrue(all(taken["field"] and taken["value"] and taken["meaning"] for taken in plan["defaults"]))
        fields = {field["name"]: field for field in darts_tungsten.describe("homogeneous")[0]["fields"]}
        self.assertEqual(fields["sigma_s"]["unit"], "1/length")
        with self.assertRaisesRegex(darts_tungsten.UsageError, "homogeneous"):
            darts_tungsten.describe("homogenous")


if __name__ == "__main__":
    unittest.main()
