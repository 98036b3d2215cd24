#!/usr/bin/python3
"""Renders by mpirun with two and three ranks against one process. TUNGSTEN names the renderer, MPIRUN the launcher; without either
its module or the launcher all is skipped."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scenes import lamp_over_floor  # noqa: E402

TUNGSTEN = os.environ.get("TUNGSTEN", str(Path(__file__).resolve().parents[2] / "build/bin/tungsten"))
MPIRUN = os.environ.get("MPIRUN") or shutil.which("mpirun")
if not MPIRUN or not Path(TUNGSTEN).with_name("tungsten-mpi.so").exists():
    print("skipped: no mpirun, or the renderer is built without MPI (libopenmpi-dev, openmpi-bin)")
    sys.exit(77)

FRAMES = {"type": "path_tracer", "max_bounces": 6, "start_time": 3, "transient_time_width": 0.5, "frame_num": 4}
PHOTONS = {"type": "progressive_transient_photon_map", "max_bounces": 6, "photon_count": 4000, "volume_photon_count": 4000,
           "volume_gather_radius": 0.1, "fixed_volume_radius": True, "gather_radius": 0.1,
           "transient_time_center": 4.5, "transient_time_width": 2}
SCENE = lamp_over_floor((24, 17), FRAMES, {"spp": 15, "spp_step": 2, "output_file": "box.png"})


def launcher(ranks):
    arguments = [MPIRUN, "--oversubscribe", "-n", str(ranks)]
    return arguments[:1] + (["--allow-run-as-root"] if os.geteuid() == 0 else []) + arguments[1:]


class Mpi(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def scene(self, integrator=None, **renderer):
        scene = {**SCENE, "integrator": integrator or FRAMES, "renderer": {**SCENE["renderer"], **renderer}}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        return str(self.folder / "scene.json")

    def command(self, ranks, scene, *more):
        return (launcher(ranks) if ranks > 1 else []) + [TUNGSTEN, "-t", "1", "-d", str(self.folder), *more, scene]

    def run_with(self, ranks, scene, *more, code=0):
        result = subprocess.run(self.command(ranks, scene, *more), capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def agree(self, integrator, *more, **renderer):
        """Images, errors and state of one process and of several; the statistics of the latter."""
        scene = self.scene(integrator, **renderer)
        for ranks in (1, 2, 3):
            self.run_with(ranks, scene, "-e", f"film{ranks}.npy", "--quiet", "--stats", str(self.folder / f"{ranks}.json"),
                          "-o", f"film{ranks}.png", "-c", "1h", "-r", *more)
        for ranks in (2, 3):
            self.assertEqual(self.bytes_of("film1.npy"), self.bytes_of(f"film{ranks}.npy"), ranks)
            self.assertEqual(self.bytes_of("film1State.dat"), self.bytes_of(f"film{ranks}State.dat"), ranks)
        return [json.loads(self.bytes_of(f"{ranks}.json")) for ranks in (1, 2, 3)]

    def test_paths_are_those_of_one_process_bit_for_bit(self):
        one, two, three = self.agree(FRAMES)
        self.assertNotIn("ranks", one)
        self.assertEqual((two["ranks"], three["ranks"]), (2, 3))
        for other in (two, three):
            self.assertGreater(other["counters"].pop("bytes of passes to other ranks"), 0)
            for name in ("passes", "samples per pixel", "relative standard error", "relative error bound", "counters"):
                self.assertEqual(one[name], other[name], name)
            self.assertGreater(other["process CPU seconds"], 0)

    def test_the_gate_and_films_without_moments(self):
        self.agree({**FRAMES, "frame_num": 1})
        self.agree(FRAMES, "--set", "film.moments=false", "--set", "film.channels=luminance")

    def test_batches_and_what_rank_0_alone_writes(self):
        self.agree(FRAMES, "--set", "film.batches=3", "--set", "film.batch_block=5")
        self.run_with(2, self.scene(spp=64), "-e", "film.npz", "--trace", str(self.folder / "trace"), "--html",
                      str(self.folder / "film.html"), "--sheet", "sheet.png", "--quiet")
        entries = json.loads(self.bytes_of("trace/trace.json"))["entries"]
        self.assertEqual(entries[-1]["passes"], 32)
        self.run_with(1, self.scene(spp=64), "--set", "renderer.output_file=one.png", "-e", "one.npz", "--quiet", "--trace",
                      str(self.folder / "alone"))
        self.assertEqual(self.bytes_of("trace/mean-000032.npy"), self.bytes_of("alone/mean-000032.npy"))
        self.assertIn(b"</html>", self.bytes_of("film.html"))

    def test_more_ranks_than_rows_and_a_black_image(self):
        fibres = [{"position": [0, 1.2, 3.5], "direction": [0, -0.2, -1], "radius": 0.1}] * 3
        camera = json.dumps({"type": "detectors", "medium": "fog", "detectors": fibres})
        self.agree(FRAMES, "--set", f"camera={camera}")
        self.agree({**FRAMES, "start_time": 0, "transient_time_width": 0.1})

    def test_a_target_error_is_that_of_all_passes(self):
        one, two, three = self.agree({**FRAMES, "frame_num": 0, "start_time": 0, "transient_time_center": 5, "transient_time_width": 4,
                                      "darts": "best"}, "--target-error", "0.2", spp=4096, spp_step=1)
        self.assertEqual(one["stopped because"], "target error reached")
        self.assertEqual((two["passes"], three["passes"]), (one["passes"], one["passes"]))

    def test_photon_maps_and_their_bias_agree_to_rounding(self):
        import numpy as np
        scene = self.scene(PHOTONS, spp=20)
        films = []
        for ranks in (1, 2):
            self.run_with(ranks, scene, "-e", f"film{ranks}.npz", "--quiet", "--bias")
            films.append(np.load(self.folder / f"film{ranks}.npz"))
        for name in ("mean", "bias"):
            one, two = (film[name].astype(float) for film in films)
            self.assertGreater(abs(one).sum(), 0)
            self.assertLess(abs(one - two).sum(), 1e-5 * abs(one).sum(), name)

    def test_resumes_what_one_process_began_and_the_other_way_round(self):
        scene = self.scene()
        self.run_with(1, scene, "-e", "whole.npy", "-o", "whole.png", "--quiet")
        self.run_with(1, scene, "-e", "film.npy", "-c", "1h", "--quiet", "--spp", "6")
        self.run_with(2, scene, "-e", "film.npy", "-c", "1h", "--quiet", "--spp", "10")
        self.run_with(1, scene, "-e", "film.npy", "-c", "1h", "--quiet")
        self.assertEqual(self.bytes_of("whole.npy"), self.bytes_of("film.npy"))

    def test_time_outs_end_all(self):
        scene = self.scene(spp=10_000_000, spp_step=200)  # passes that take a while: the last ones are broken off
        start = time.monotonic()
        result = self.run_with(2, scene, "--timeout", "2s", "-e", "film.npy")
        self.assertLess(time.monotonic() - start, 30)
        self.assertIn("time-out", result.stdout)
        self.assertEqual(result.stdout.count("passes, "), 1, "one rank speaks")
        passes = int(re.search(r"(\d+) passes, ", result.stdout)[1])
        self.run_with(1, scene, "--spp", str(200 * passes), "-e", "one.npy", "-o", "one.png")
        self.assertEqual(self.bytes_of("film.npy"), self.bytes_of("one.npy"))
        # One pass as long as the time-out and more: it is cut, in both.
        result = self.run_with(2, self.scene(spp=10_000_000, spp_step=1_000_000), "--timeout", "1s", "-e", "film.npy")
        self.assertEqual(result.stderr.count("passes are cut to"), 1, result.stderr)

    def test_one_bar(self):
        result = self.run_with(2, self.scene(), "-e", "film.npy")
        self.assertIn("pass 8/8", result.stderr)
        self.assertEqual(result.stderr.count("pass 8/8"), 1)

    def test_bad_input_is_told_once(self):
        result = self.run_with(2, self.scene({**FRAMES, "max_bounces": -3}), code=1)
        self.assertEqual(result.stderr.count("error: "), 1, result.stderr)
        result = self.run_with(2, str(self.folder / "none.json"), code=1)
        self.assertEqual(result.stderr.count("none.json: "), 1, result.stderr)
        scene = self.scene()
        (self.folder / "boxState.dat").write_text("no state")
        result = self.run_with(2, scene, "-c", "1h", code=1)
        self.assertEqual(result.stderr.count("not a resume state"), 1, result.stderr)
        self.assertIn("--passes", self.run_with(2, scene, "--passes", "0:2", code=2).stderr)
        self.assertEqual(self.run_with(2, scene, "--no-such-option", code=2).stderr.count("error: "), 1)

    def test_what_renders_nothing_is_said_once(self):
        self.assertEqual(self.run_with(2, self.scene(), "--explain").stdout.count("(path_tracer)"), 1)

    def run_bare(self, ranks, *arguments):
        """As if there was no scene; without what mpirun says of exit codes."""
        result = subprocess.run((launcher(ranks) if ranks > 1 else []) + [TUNGSTEN, *arguments], capture_output=True, text=True,
                                timeout=120, cwd=self.folder)
        errors = [line for line in result.stderr.splitlines() if line.startswith(("error: ", "warning: "))]
        return result.returncode, result.stdout, errors

    def test_answers_and_bad_usage_are_those_of_one_process(self):
        for arguments in (["--help"], ["--version"], ["--list"], ["--describe", "mirror"], ["--manual"], ["--completion"],
                          ["merge", "--help"], [], ["--timeout", "soon", "none.json"], ["--describe", "mirrror"], ["merge"],
                          ["merge", "none.state", "-e", "none.exr"]):
            with self.subTest(arguments=arguments):
                one = self.run_bare(1, *arguments)
                self.assertTrue(one[1] or one[2])
                self.assertEqual(self.run_bare(3, *arguments), one)

    def start(self, *more):
        process = subprocess.Popen(self.command(2, self.scene(spp=10_000_000), "-e", "film.npy", "--quiet", *more),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def ranks_of(self, process):
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        return [int(child) for child in children if "tungsten" in Path(f"/proc/{child}/cmdline").read_text()]

    def wait_for(self, file, process):
        for _ in range(600):
            if file.exists() and file.stat().st_size > 0:
                return
            self.assertIsNone(process.poll(), "ended before its checkpoint")
            time.sleep(0.1)
        self.fail("no checkpoint")

    def test_an_interrupt_writes_what_there_is(self):
        for sent in (signal.SIGINT, signal.SIGUSR1):
            process = self.start("-c", "0.5s")
            self.wait_for(self.folder / "film_checkpoint.npy", process)
            (self.folder / "film.npy").unlink(missing_ok=True)
            process.send_signal(sent)
            process.communicate(timeout=60)
            self.assertTrue((self.folder / "film.npy").exists(), sent)
            self.run_with(1, self.scene(spp=10_000_000), "--timeout", "1s", "-c", "1h", "--quiet", "-e", "film.npy")
            for file in self.folder.glob("*State.dat"):
                file.unlink()
            (self.folder / "film_checkpoint.npy").unlink()

    def test_a_killed_rank_is_an_error_and_the_checkpoint_whole(self):
        process = self.start("-c", "0.3s")
        state = self.folder / "boxState.dat"
        self.wait_for(state, process)
        ranks = self.ranks_of(process)
        self.assertEqual(len(ranks), 2)
        os.kill(ranks[1], signal.SIGKILL)
        out, err = process.communicate(timeout=60)
        self.assertNotEqual(process.returncode, 0)
        self.assertIn("signal 9", err)
        self.assertTrue(state.exists())
        resumed = self.run_with(1, self.scene(spp=10_000_000), "--timeout", "1s", "-c", "1h", "-e", "film.npy")
        self.assertIn("resuming after", resumed.stderr)

    def test_without_its_module_the_command_says_so(self):
        """As one of several processes, from a folder without the module."""
        alone = self.folder / "bin"
        alone.mkdir()
        for file in Path(TUNGSTEN).parent.glob("libtungsten*.so"):
            (alone / file.name).symlink_to(file)
        shutil.copy(TUNGSTEN, alone / "tungsten")
        shutil.copy(Path(TUNGSTEN).with_name("libtungsten.so"), self.folder / "libtungsten.so")
        (alone / "libtungsten.so").unlink()
        (self.folder / "libtungsten.so").rename(alone / "libtungsten.so")
        environment = {**os.environ, "OMPI_COMM_WORLD_SIZE": "2", "LD_LIBRARY_PATH": str(alone)}
        result = subprocess.run([str(alone / "tungsten"), "--list"], capture_output=True, text=True, env=environment)
        self.assertEqual(result.returncode, 2)
        self.assertIn("this build has no MPI", result.stderr)


if __name__ == "__main__":
    unittest.main()
