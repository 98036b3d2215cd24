#!/usr/bin/python3
"""Runs of a study in parts: by workers of this machine, and by a job array, for which a stub stands in for Slurm. The renderer is
named by the environment's TUNGSTEN."""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PROJECT / "tests/support"), str(PROJECT / "benchmarks")]

from darts_bench import run  # noqa: E402
from study_command import started, study  # noqa: E402

TUNGSTEN = os.environ.get("TUNGSTEN", str(PROJECT / "build/bin/tungsten"))
SCENE = PROJECT / "data/scenes/cornell-fog/scene.json"
# As sbatch does it: reads the script's directives, starts each task of an array, prints the job's number. It waits for them.
STUB = r"""#!/usr/bin/python3
import os, re, subprocess, sys
from pathlib import Path
script = Path(sys.argv[-1])
log = Path(__file__).with_name("calls")
number = str(100 + len(log.read_text().splitlines()) if log.exists() else 100)
log.open("a").write(" ".join(sys.argv[1:]) + "\n")
if "--fail" in sys.argv:
    sys.exit("sbatch: error: Batch job submission failed: Invalid partition")
options = dict(re.findall(r"^#SBATCH --([a-z-]+)=(.*)$", script.read_text(), re.M))
first, last = map(int, options.get("array", "0-0").split("-"))
for task in range(first, last + 1):
    output = options["output"].replace("%a", str(task))
    with open(output, "w") as file:
        subprocess.run(["/bin/sh", str(script)], env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)}, stdout=file, stderr=file)
print(number + ";cluster")
"""


class Submit(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        subprocess.run([TUNGSTEN, "--quiet", "-t", "2", "--resolution", "16x16", "-d", self.folder, "-o", "reference.png", "-e",
                        "reference.exr", "--set", "integrator.type=path_tracer", "--spp", "64", SCENE], check=True)
        (self.folder / "tiny.json").write_text(json.dumps({
            "title": "Tiny", "baseline": "paths", "seconds": 0.6, "block": 4, "seeds": 3, "threads": 1,
            "scenes": [{"name": "fog", "path": str(SCENE), "resolution": [16, 16], "gate": [5.45, 5.75],
                        "reference": str(self.folder / "reference.exr")}],
            "methods": [{"name": "paths", "set": ["integrator.type=path_tracer"]},
                        {"name": "guided; no", "set": ["integrator.type=path_tracer", "integrator.darts=published"]}]}))
        self.stub = self.folder / "sbatch"
        self.stub.write_text(STUB)
        self.stub.chmod(0o755)
        self.work = self.folder / "work"

    def call(self, *options, code=0):
        arguments = [self.folder / "tiny.json", *options, "--work", self.work, "--tungsten", TUNGSTEN]
        result = study(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def runs(self):
        return sorted(str(file.parent.relative_to(self.work / "runs")) for file in self.work.glob("runs/*/*/*/run.json"))

    def test_an_array_makes_every_run_once_then_reports(self):
        out = self.call("submit", "--tasks", "4", "--sbatch", self.stub, "--sbatch-option=--partition=long").stdout
        self.assertIn("4 tasks of 6 runs, 1 threads each", out)
        self.assertIn("submitted as jobs 100 and, once all its tasks have ended, 101", out)
        array, report = (self.folder / "calls").read_text().splitlines()
        self.assertEqual(array, f"--parsable --partition=long {self.work}/slurm/array.sh")
        self.assertEqual(report, f"--parsable --partition=long --dependency=afterany:100 {self.work}/slurm/report.sh")
        script = (self.work / "slurm/array.sh").read_text()
        for line in ("--array=0-3", "--cpus-per-task=1", "--ntasks=1", f"--output={self.work}/slurm/%a.log"):
            self.assertIn(f"\n#SBATCH {line}\n", script)
        self.assertGreaterEqual(int(re.search(r"--time=(\d+)", script)[1]), 2 * 300 / 60)
        self.assertEqual(len(self.runs()), 6)
        logs = [(self.work / f"slurm/{task}.log").read_text() for task in range(4)]
        self.assertEqual([len(re.findall(r"^\[", log, re.M)) for log in logs], [2, 2, 1, 1])
        self.assertTrue((self.work / "report.md").exists())
        self.assertIn("6 of 6 runs are already there", self.call("run").stdout)

    def test_workers(self):
        out = self.call("run", "--workers", "2").stdout
        self.assertEqual(len(self.runs()), 6)
        self.assertEqual(len(re.findall(r"^\[\d/6\] fog, .* s$", out, re.M)), 6)
        self.assertTrue((self.work / "report.md").exists())

    def test_interrupted_workers_leave_no_result(self):
        process = started(self.folder / "tiny.json", "--seconds", "600", "--workers", "2", "--work", self.work, "--tungsten", TUNGSTEN)
        while len(list(self.work.glob("runs/*/*/*.partial"))) < 2 and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.communicate(timeout=60)[1])
        self.assertEqual((process.returncode, self.runs()), (130, []))

    def test_what_starts_while_others_are_ended_is_ended(self):
        """A process whose shell is started before the others are ended, and answers after."""
        started_late, popen = threading.Event(), subprocess.Popen

        def slow(*arguments, **options):
            started_late.set()
            time.sleep(0.5)
            return popen(*arguments, **options)

        with unittest.mock.patch.object(run.subprocess, "Popen", slow), self.assertRaises(KeyboardInterrupt), run.workers(1) as pool:
            late = pool.submit(run.call, ["sleep", "20"])
            self.assertTrue(started_late.wait(10))
            raise KeyboardInterrupt
        self.assertIsInstance(late.exception(), run.BenchError)
        self.assertEqual(run.call(["true"]), (0, ""))

    def test_what_goes_wrong_is_said(self):
        error = self.call("submit", "--sbatch", self.stub, "--sbatch-option=--fail", code=2).stderr
        self.assertIn("exit code 1: sbatch: error: Batch job submission failed: Invalid partition", error)
        error = self.call("submit", "--sbatch", "/no/such/sbatch", code=2).stderr
        self.assertIn("/no/such/sbatch: No such file or directory; --sbatch names Slurm's command", error)
        for part in ("3", "2/2", "-1/2", "a/b"):
            self.assertIn("expected I/N", self.call("run", "--part", part, code=2).stderr if not part.startswith("-") else
                          self.call("run", f"--part={part}", code=2).stderr)
        self.call("report", "--part", "0/2", code=2)
        self.call("run", "--workers", "0", code=2)
        self.call("submit", "--write-only", "--sbatch", "/no/such/sbatch")
        self.assertTrue((self.work / "slurm/report.sh").exists())
        self.assertEqual(self.runs(), [])


if __name__ == "__main__":
    unittest.main()
