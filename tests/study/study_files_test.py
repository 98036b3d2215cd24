#!/usr/bin/python3
"""What the study tool makes of studies and results, without rendering."""

import dataclasses
import json
import sys
import tempfile
import unittest
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "benchmarks"))

from darts_bench.results import Summary  # noqa: E402
from darts_bench.run import BenchError, pass_size  # noqa: E402
from darts_bench.study_file import Method, PublishedFigures, Scene, Study, load_study, require_references  # noqa: E402
from darts_bench.study_runs import plan  # noqa: E402
from darts_bench.tables import baseline_of, left_out, overview  # noqa: E402


class Summaries(unittest.TestCase):
    def test_gain_is_at_equal_time(self):
        """A method that ran four times as long and has half the noise is as good as the other."""
        scene = Scene("s", Path(), (1, 1), Path(), published=PublishedFigures("invented", 5, 2, [{"method": "m", "std": 0.6}]))
        long = Summary(scene, Method("m", published="m"), 1, wall=8.0, cpu=10.0, std=0.5)
        short = Summary(scene, Method("n", published="n"), 1, wall=2.0, cpu=5.0, std=1.0)
        self.assertAlmostEqual(long.gain_over(short), 1)
        self.assertAlmostEqual(short.gain_over(long), 1)
        self.assertAlmostEqual(long.gain_over(short, at_equal_cpu=True), 2)
        self.assertAlmostEqual(long.gain_over_published(), 1.44)
        self.assertIsNone(short.gain_over_published())
        short.std, short.std_spread = None, 2.0  # one pass only: the seeds' spread stands in
        self.assertAlmostEqual(long.gain_over(short), 4)


    def test_overview_marks_the_least_cost(self):
        scenes = [Scene(name, Path(), (1, 1), Path()) for name in ("s", "t")]
        methods = [Method(name, lineage=(name,)) for name in ("m", "n", "o")]
        study = Study("x", "X", scenes, methods, "m", [1], 1, 3, 8, None)

        def row(scene, noises):
            return {1: {method.name: Summary(scene, method, 1, seeds=3 if noise else 0, cpu=2.0, wall=1.0, std=noise)
                        for method, noise in zip(methods, noises)}}

        text = overview(study, {"s": row(scenes[0], (1.0, 0.5, None)), "t": row(scenes[1], (None, 3.0, 2.0))}).markdown
        self.assertIn("| s | 2 | **0.5** | – |", text)
        self.assertIn("| t | – | 18 | **8** |", text)
        summaries = row(scenes[1], (None, 3.0, 2.0))[1]
        self.assertIs(baseline_of(study, summaries), summaries["n"])


class StudyFiles(unittest.TestCase):
    def load(self, study, encoding="utf-8"):
        with tempfile.TemporaryDirectory() as folder:
            for scene in study["scenes"]:
                scene.setdefault("reference", str(Path(folder) / "reference.pfm"))
            file = Path(folder) / "study.json"
            file.write_text(json.dumps(study), encoding=encoding)
            return load_study(file, PROJECT)

    def study(self, **changes):
        scenes = [{"name": name, "path": "data/scenes/cornell-fog/scene.json", "resolution": [8, 8]} for name in ("a", "b")]
        return {"scenes": scenes, "methods": [{"name": "m"}, {"name": "n"}, {"name": "o"}], **changes}

    def test_runs_are_interleaved(self):
        runs = plan(self.load(self.study()), Path("work"))
        self.assertEqual(len(runs), 2 * 3 * 3)
        order = [(run.seed, run.scene.name + run.method.name) for run in runs]
        self.assertEqual(order[:6], [(1, name) for name in ("am", "an", "ao", "bm", "bn", "bo")])
        self.assertEqual(order[6:12], [(2, name) for name in ("bo", "bn", "bm", "ao", "an", "am")])

    def test_bases_and_sweeps(self):
        definitions = {"methods": [{"name": "base", "set": ["x=1"], "published": "p"},
                                   {"name": "derived", "base": "base", "set": ["x=2"]}]}
        sweep = {"parameter": "size", "set": ["s={0}", "t={1}"], "methods": ["derived"], "values": {"a": [[1, 2], [3, 4]]}}
        study = self.load(self.study(definitions=definitions, methods=["base"], sweeps=[sweep]))
        self.assertEqual([m.name for m in study.methods], ["base", "derived, size 1", "derived, size 3"])
        swept = study.methods[2]
        self.assertEqual((swept.overrides, swept.published, swept.swept), (("x=1", "x=2", "s=3", "t=4"), "p", ("size", 3, "derived")))
        self.assertEqual([len(study.methods_of(scene)) for scene in study.scenes], [3, 1])

    def test_passes_of_paths_have_samples_to_share_out(self):
        paths, photons = "integrator.type=path_tracer", "integrator.type=progressive_transient_photon_map"
        sizes = [pass_size(settings) for settings in ([paths], [photons], [], [photons, paths, "integrator.darts=off"], [paths, photons])]
        self.assertEqual(sizes, [f"renderer.spp_step={size}" for size in (8, 1, 1, 8, 1)])

    def test_scenes_leave_methods_out(self):
        """By their name or a base's: no runs, and the reason is reported; a name that is not compared is a mistake."""
        methods = [{"name": "m"}, {"name": "n", "base": "m"}, {"name": "o"}]
        study = self.study(methods=methods, definitions={"methods": methods})
        study["scenes"][1]["skip"] = {"m": "nothing to see"}
        loaded = self.load(study)
        self.assertEqual([[method.name for method in loaded.methods_of(scene)] for scene in loaded.scenes],
                         [["m", "n", "o"], ["o"]])
        self.assertEqual([(scene.name, method.name, why) for scene, method, why in loaded.left_out()],
                         [("b", "m", "nothing to see"), ("b", "n", "nothing to see")])
        self.assertEqual(len(plan(loaded, Path("work"))), 3 * 4)
        self.assertIn("| m | b | nothing to see |", left_out(loaded, {}).markdown)
        study["scenes"][1]["skip"] = {"z": "nothing to see"}
        with self.assertRaisesRegex(BenchError, "skips 'z', which is not compared"):
            self.load(study)

    def test_mistakes_are_named(self):
        for change, message in (({"methods": ["nobody"]}, "'nobody' is not defined"), ({"sceens": []}, "unknown field 'sceens'"),
                                ({"seeds": 0}, "'seeds' is a whole number"), ({"baseline": "z"}, "baseline 'z'"),
                                ({"methods": [{"name": "m"}, {"name": "m"}]}, "same name"), ({"seconds": -1}, "positive"),
                                ({"methods": [{"name": "m", "scenes": ["c"]}]}, "not compared")):
            with self.assertRaisesRegex(BenchError, message):
                self.load(self.study(**change))

    def test_text_is_utf8_with_or_without_a_mark(self):
        self.assertEqual(len(self.load(self.study(), "utf-8-sig").methods), 3)
        with self.assertRaisesRegex(BenchError, "study.json: not text in UTF-8"):
            self.load(self.study(), "utf-16")

    def test_missing_references_are_named(self):
        study = self.load(self.study())

        def seen(reference):
            scenes = [dataclasses.replace(scene, reference=reference) for scene in study.scenes]
            return dataclasses.replace(study, scenes=scenes)

        require_references(seen(Path(__file__)))
        with self.assertRaisesRegex(BenchError, "scene .a.: there is no reference reference/none.exr"):
            require_references(seen(Path("reference/none.exr")))

    def test_studies_that_ship(self):
        """Those of scenes by others only where these are."""
        others = (PROJECT / "../shared/scenes").is_dir()
        for file in sorted((PROJECT / "benchmarks/study/studies").glob("*.json")):
            if not others and ("../shared" in (text := file.read_text()) or '"include"' in text):
                continue
            study = load_study(file, PROJECT)
            self.assertGreaterEqual(study.seeds, 3)
            plan(study, Path("work"))


if __name__ == "__main__":
    unittest.main()
