#!/usr/bin/python3
"""The study's command from outside: renders a tiny scene with the built renderer, named by the environment's TUNGSTEN."""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
BENCH = PROJECT / "benchmarks/bench.py"
TUNGSTEN = os.environ.get("TUNGSTEN", str(PROJECT / "build/bin/tungsten"))
sys.path[:0] = [str(BENCH.parent), str(PROJECT / "tests/support")]

from darts_bench import measures  # noqa: E402
from darts_bench.images import read_exr, read_pfm  # noqa: E402
from darts_bench.run import call  # noqa: E402
from darts_bench.study_file import load_study  # noqa: E402
from study_command import started, study as study_command  # noqa: E402

SCENE = PROJECT / "data/scenes/cornell-fog/scene.json"
SIZE = 32


def render(folder, name, *options):
    subprocess.run([TUNGSTEN, "--quiet", "-t", "2", "--resolution", f"{SIZE}x{SIZE}", "-d", folder, "-o", "reference.png", "-e",
                    name, "--set", "integrator.type=path_tracer", *options, SCENE], check=True)


class TinyStudy(unittest.TestCase):
    """One scratch folder with a reference, a study and its results for all tests, which only look at them."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.scratch.name)
        render(cls.folder, "reference.exr", "--spp", "2000", "-s", "1000")
        points = ["integrator.photon_count=30000", "integrator.volume_photon_count=15000"]
        cls.study = {
            "title": "Tiny", "baseline": "paths", "seconds": 0.2, "block": 4, "bias": True,
            "scenes": [{"name": "fog", "path": str(SCENE), "resolution": [SIZE, SIZE], "reference": str(cls.folder / "reference.exr"),
                        "gate": [5.45, 5.75], "set": {"points": points},
                        "published": {"source": "invented", "seconds": 1, "threads": 1, "rows": [{"method": "paths", "std": 2.0}]}}],
            "methods": [{"name": "points", "set": []}, {"name": "paths", "set": ["integrator.type=path_tracer"]},
                        {"name": "wrong", "set": ["integrator.photon_count=-1"]},
                        {"name": "unknown", "set": ["integrator.no_such_field=1"]},
                        {"name": "moment", "base": "delta"},
                        {"name": "two mistakes", "base": "delta", "set": ["integrator.max_bounces=-1"]}],
            "definitions": {"methods": [{"name": "delta", "may_refuse": ["integrator.delta_time_gate"],
                                         "set": ["integrator.type=path_tracer", "integrator.delta_time_gate=true"]}]}}
        cls.write()
        cls.first = subprocess.run([sys.executable, BENCH, "study", *cls.arguments()], capture_output=True, text=True)
        cls.report, cls.page = ((cls.folder / f"work/report.{kind}").read_text() for kind in ("md", "html"))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def write(cls):
        (cls.folder / "tiny.json").write_text(json.dumps(cls.study))

    @classmethod
    def arguments(cls):
        return [cls.folder / "tiny.json", "--work", cls.folder / "work", "--tungsten", TUNGSTEN]

    @classmethod
    def call(cls, *options):
        return study_command(*cls.arguments(), *options)

    def folder_of(self, method, seed=1):
        return self.folder / "work/runs/fog" / method / f"0.2s-seed{seed}"

    def test_report(self):
        self.assertEqual(self.first.returncode, 1, self.first.stderr)  # three methods fail
        report = self.report
        self.assertIn("## Failed runs (9)", report)
        self.assertIn("integrator.photon_count", report)  # the renderer's own message
        self.assertIn("no_such_field", report)
        for method in ("points", "paths"):
            self.assertIn(f"| {method} | 3 |", report)
        self.assertNotIn("| wrong |", report)
        self.assertIn("| moment | fog | `integrator.delta_time_gate`: plain paths meet a delta gate", report)
        self.assertIn("fog, moment, 0.2 s, seed 1 ... skipped: `integrator.delta_time_gate`", self.first.stdout)
        self.assertNotIn("nan", report.replace("non-finite", ""))
        for image in ("fog-pictures-1.png", "fog-gain-0.2s.png"):
            self.assertIn(f"({image})", report)
            self.assertEqual((self.folder / "work" / image).read_bytes()[:4], b"\x89PNG")

    def test_figures(self):
        """The noise as read here against the renderer's own statistics; the unbiased method against its reference."""
        for method in ("points", "paths"):
            stats = json.loads((self.folder_of(method) / "stats.json").read_text())
            layers = read_exr(self.folder_of(method) / "image.exr")
            error = np.sqrt(np.mean(layers["stderr"] ** 2)) / layers[""].mean()
            self.assertGreater(error, 0)
            self.assertAlmostEqual(error / stats["relative standard error"], 1, delta=1e-4)
        reference = read_exr(self.folder / "reference.exr")
        mean, seeds = measures.grey(reference[""]).mean(), range(1, 4)
        header, *rows = [line.strip("| ").split(" | ") for line in self.report.splitlines() if line.startswith(("| method | seeds", "| points |", "| paths |"))]
        for row in rows[:2]:
            cell = dict(zip(header, row))
            self.assertTrue(0 < float(cell["FLIP"]) < 1 and float(cell["median error"]) > 0 and float(cell["relMSE 0.99"]) > 0, cell)
            self.assertEqual("<" in cell["own bias"], row[0] == "points", "paths have no kernels")
        renders = [read_exr(self.folder_of("paths", seed) / "image.exr") for seed in seeds]
        difference = np.mean([layers[""].mean() for layers in renders]) / mean - 1
        variance = measures.relative_std(reference["stderr"], mean) ** 2 \
            + sum(measures.relative_std(layers["stderr"], mean) ** 2 for layers in renders) / len(seeds) ** 2
        self.assertLess(abs(difference), 5 * np.sqrt(variance / SIZE**2))

    def test_page(self):
        data = json.loads(re.search(r'id="page-data">(.*?)</script>', self.page, re.S)[1])
        scene = data["scenes"][0]
        self.assertEqual([film["name"] for film in scene["films"]], ["reference", "points", "paths"])
        self.assertEqual([curve["name"] for curve in scene["curves"]["curves"]], ["points", "paths"])
        self.assertEqual([row[0] for row in scene["tables"][0]["rows"]], ["points", "paths"])
        for row in scene["tables"][0]["rows"]:
            self.assertIn("| " + " | ".join(row) + " |", self.report)
            self.assertEqual([command["command"].split(" -s ")[1][0] for command in scene["commands"][row[0]]], ["1", "2", "3"])
        self.assertEqual(len([fact for fact in data["facts"] if fact["name"].startswith("failed")]), 9)

    def test_goes_on_and_repeats_nothing(self):
        files = [self.folder_of(method, seed) / "run.json" for method in ("points", "wrong") for seed in (1, 2, 3)]
        before = [file.stat().st_mtime_ns for file in files]
        again = self.call("--seeds", "4", "--methods", "points; wrong")
        self.assertIn("6 of 8 runs are already there", again.stdout)
        self.assertIn("[2/2]", again.stdout)
        self.assertEqual(before, [file.stat().st_mtime_ns for file in files])
        self.assertTrue((self.folder_of("points", 4) / "image.exr").exists())
        self.assertEqual(self.call("report").returncode, 1)
        self.assertEqual(self.call("report", "--methods", "points; paths").returncode, 0)

    def test_references(self):
        """Rendered by the method that the scene names: their mean, with the variance of its block means from their spread."""
        scene, paths = {**self.study["scenes"][0], "reference": str(self.folder / "own/fog.pfm")}, self.study["methods"][1]
        study = {**self.study, "scenes": [scene], "methods": [paths], "baseline": "paths", "definitions": {"methods": [paths]}}
        file, work = self.folder / "own.json", self.folder / "own-work"

        def call(action, *options):
            file.write_text(json.dumps(study))
            return study_command(file, action, "--work", work, "--tungsten", TUNGSTEN, *options)

        self.assertIn("(reference_by)", call("references").stderr)
        scene["reference_by"] = "paths"
        self.assertIn("the action 'references' renders it", call("report").stderr)
        rendered = call("references", "--seconds", "0.2", "--seeds", "3")
        self.assertEqual(rendered.returncode, 0, rendered.stderr)
        images = [read_exr(image)[""] for image in sorted(work.glob("references/runs/fog/paths/*/image.exr"))]
        self.assertEqual(len(images), 3)
        np.testing.assert_allclose(read_pfm(self.folder / "own/fog.pfm"), np.mean(images, axis=0), rtol=1e-6)
        self.assertGreater(float((self.folder / "own/fog.blockvar").read_text()), 0)
        self.assertIn("3 of 3 runs are already there", call("references", "--seconds", "0.2", "--seeds", "3").stdout)

    def test_check_looks_for_references_and_blocks(self):
        file = self.folder / "odd.json"

        def call(action, **scene):
            file.write_text(json.dumps({**self.study, "scenes": [{**self.study["scenes"][0], **scene}]}))
            return study_command(file, action, "--tungsten", TUNGSTEN, "--methods", "paths")

        missing = call("check", reference=str(self.folder / "nowhere.exr"))
        self.assertEqual(missing.returncode, 1)
        self.assertIn("scene 'fog': there is no reference", missing.stdout)
        odd = call("check", resolution=[SIZE, SIZE + 2])
        self.assertEqual(odd.returncode, 2)
        self.assertIn("blocks of 4 pixels ('block') do not divide 32 x 34", odd.stderr)
        self.assertEqual(call("check").returncode, 0)
        self.assertIn("'chekc' is no action", call("chekc").stderr)

    def test_new_studies_run(self):
        """Of a scene with frames: references, check, a run."""
        scene = self.folder / "room.json"
        scene.write_text((PROJECT / "data/scenes/cornell-fog/scene.json").read_text())
        film = self.folder / "film.json"
        film.write_text((PROJECT / "data/scenes/two-pulses/scene.json").read_text())

        def call(*arguments):
            done = study_command(*arguments, "--tungsten", TUNGSTEN)
            return done.returncode, done.stdout + done.stderr

        self.assertEqual(call("new", film)[0], 0)
        study = load_study(self.folder / "film-study.json", PROJECT)
        self.assertEqual((study.scenes[0].gate, study.scenes[0].resolution), ((4.7, 9.7), (160, 120)))
        self.assertIn("integrator.frame_num=0", study.scenes[0].overrides["*"])
        code, text = call("new", scene)
        self.assertEqual(code, 0, text)
        self.assertIn("references", text)
        file, options = self.folder / "room-study.json", ["--work", self.folder / "room-work", "--seconds", "1.5"]
        self.assertEqual(call(file, "check")[0], 1)
        self.assertEqual(call(file, "references", *options, "--seeds", "2")[0], 0)
        self.assertEqual(call(file, "check")[0], 0)
        code, text = call(file, "run", *options, "--seeds", "1", "--methods", "plain paths; best paths")
        self.assertEqual(code, 0, text)
        self.assertTrue((self.folder / "room-work/report.md").is_file())
        self.assertEqual(call("new", scene)[0], 2)
        self.assertIn("there is no scene", call("new", self.folder / "none.json")[1])

    def test_interrupted_runs_leave_no_result(self):
        work = self.folder / "interrupted"
        process = started(self.folder / "tiny.json", "--seconds", "600", "--methods", "points", "--work", work, "--tungsten", TUNGSTEN)
        while not list(work.glob("runs/fog/points/*.partial")) and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 130)
        self.assertEqual(list(work.glob("runs/*/*/*/run.json")), [])

    def test_peak_memory_is_the_renderers_own(self):
        """A child of a large process may not inherit its peak: compared with what Python alone reports of itself."""
        ask = "import resource; print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
        ballast = np.ones(20_000_000)  # 160 MB
        peak = int(call([sys.executable, "-c", ask], 60)[1])
        self.assertLess(1024 * peak, ballast.nbytes / 2)

    def test_check_names_what_the_renderer_refuses(self):
        checked = self.call("check")
        self.assertEqual(checked.returncode, 1)
        self.assertIn("good     fog, points", checked.stdout)
        self.assertIn("refused  fog, wrong", checked.stdout)
        self.assertIn("refused  fog, unknown", checked.stdout)
        self.assertIn("skipped  fog, moment: `integrator.delta_time_gate`", checked.stdout)
        self.assertIn("refused  fog, two mistakes", checked.stdout)
        listed = self.call("list").stdout
        self.assertIn("skipped  fog, moment", listed)
        self.assertIn("FAILED   fog, two mistakes", listed)

    def test_exr_holds_what_pfm_does(self):
        render(self.folder, "two.exr", "--spp", "2")
        render(self.folder, "two.pfm", "--spp", "2")
        np.testing.assert_array_equal(read_exr(self.folder / "two.exr")[""], read_pfm(self.folder / "two.pfm"))


if __name__ == "__main__":
    unittest.main()
