"""Rendering what a study asks for: interleaved, resumable, one folder of results per run."""

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from study_file import Method, Scene, Study, StudyError

MOST_SAMPLES = 10**12  # the time-out ends a render, never the number of samples
BAD_INPUT = 1  # exit code


@dataclass(frozen=True)
class Run:
    scene: Scene
    method: Method
    seconds: float
    seed: int
    threads: int
    folder: Path
    bias: bool = False

    @property
    def label(self):
        return f"{self.scene.name}, {self.method.name}, {self.seconds:g} s, seed {self.seed}"

    @property
    def scene_file(self):
        names = [name for name in self.method.lineage if name in self.scene.files]
        return self.scene.files[names[0]] if names else self.scene.path

    @property
    def overrides(self):
        """All --set values; later ones win: the scene's for every method and for this one, then the method's own."""
        values = list(self.scene.overrides.get("*", []))
        if self.scene.gate:
            start, end = self.scene.gate
            values += [f"integrator.transient_time_center={(start + end) / 2!r}",
                       f"integrator.transient_time_width={round(end - start, 12)!r}"]
        for name in reversed(self.method.lineage):
            values += self.scene.overrides.get(name, [])
        return [*values, *self.method.overrides, "renderer.enable_resume_render=false", "renderer.spp_step=1"]

    def arguments(self):
        """The renderer's, without those that say where results go."""
        width, height = self.scene.resolution
        arguments = ["-t", str(self.threads), "-s", str(self.seed), "--timeout", f"{self.seconds:g}s", "--quiet",
                     "--spp", str(MOST_SAMPLES), "--resolution", f"{width}x{height}"]
        arguments += ["--bias"] if self.bias else []
        for value in self.overrides:
            arguments += ["--set", value]
        return [*arguments, str(self.scene_file)]

    def fingerprint(self):
        """Changes with anything that shapes the result, the renderer itself excepted."""
        content = json.dumps(self.arguments()[:-1]).encode() + self.scene_file.read_bytes()
        return hashlib.sha256(content).hexdigest()[:16]

    def record(self):
        """The stored result, or None if there is none or it was made with other settings."""
        try:
            record = json.loads((self.folder / "run.json").read_text())
        except (OSError, json.JSONDecodeError):
            return None
        return record if record.get("fingerprint") == self.fingerprint() else None


def _slug(text):
    return re.sub(r"[^A-Za-z0-9.]+", "-", text).strip("-")


def plan(study: Study, work: Path):
    """All runs, in the order in which they are made: every method once, then again with the next seed in the opposite
    order, so that a machine that slows down over time favours none."""
    runs = []
    for seed in range(1, study.seeds + 1):
        once = []
        for seconds in study.seconds:
            for scene in study.scenes:
                for method in study.methods_of(scene):
                    folder = work / "runs" / _slug(scene.name) / _slug(method.name) / f"{seconds:g}s-seed{seed}"
                    once.append(Run(scene, method, seconds, seed, study.threads, folder, study.bias))
        runs += once if seed % 2 else reversed(once)
    folders = {run.folder for run in runs}
    if len(folders) != len(runs):
        raise StudyError("two methods or scenes have names that differ only in punctuation")
    return runs


def machine():
    """Processor, threads and system of this machine."""
    models = re.findall(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), flags=re.M)
    system = os.uname()
    return f"{models[0] if models else 'unknown processor'}, {os.cpu_count()} threads, {system.sysname} {system.machine}"


def build_of(tungsten: Path):
    """Identity of a build: the command and the plugins beside it."""
    content = hashlib.sha256(tungsten.read_bytes())
    for plugin in sorted(tungsten.parent.glob("libtungsten-*.so")):
        content.update(plugin.read_bytes())
    return content.hexdigest()[:12]


def refused_warning(messages, overrides):
    """A warning about a field that an override sets: the render would not be what its method's name says."""
    fields = {value.partition("=")[0] for value in overrides}
    for line in messages.splitlines():
        if line.startswith("warning:") and any(f" {name}:" in line or f" {name}." in line for name in fields):
            return line
    return None


def impossible(code, messages, method):
    """Why the renderer cannot do what the method asks for, where that is no mistake: all that it refuses are fields that
    the method says may be refused. None otherwise."""
    errors = [line for line in messages.splitlines() if line.startswith("error:")]
    reasons = []
    for line in errors if code == BAD_INPUT else []:
        field = next((name for name in method.may_refuse if f": {name}: " in line), None)
        if field is None:
            return None
        reasons.append(f"`{field}`: {line.partition(f': {field}: ')[2]}")
    return "; ".join(reasons) or None


def call(command, limit):
    """Exit code (None: stopped after `limit` seconds) and messages. The renderer ends when this program is interrupted."""
    # The shell forks: a child that Python starts itself would report Python's own peak memory as the least of its own.
    # A session of its own keeps Ctrl-C from the renderer, which would write a render cut short.
    process = subprocess.Popen(["/bin/sh", "-c", '"$@"; exit $?', "sh", *command], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True)
    try:
        messages = process.communicate(timeout=limit)[0]
        return process.returncode, messages
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return None, process.communicate()[0] + f"\nstopped: not finished after {limit:g} seconds"
    except BaseException:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        raise


def execute(run: Run, tungsten: Path, build: str, limit: float, accept_warnings: bool):
    """Renders into a folder that appears under its name only when complete, and returns its record."""
    partial = run.folder.with_name(run.folder.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    command = [str(tungsten), "-d", str(partial), "-o", "image.png", "-e", "image.exr", "--stats", "stats.json",
               *run.arguments()]
    start, load = time.time(), os.getloadavg()[0]
    code, messages = call(command, limit)
    record = {"fingerprint": run.fingerprint(), "build": build, "machine": machine(), "label": run.label, "command": command,
              "messages": messages.strip(), "error": None, "skipped": impossible(code, messages, run.method),
              "wall seconds": time.time() - start, "load before": load}
    refused = None if accept_warnings else refused_warning(messages, run.overrides)
    if record["skipped"]:
        pass
    elif code != 0:
        record["error"] = f"exit code {code}: {messages.strip()}"
    elif refused:
        record["error"] = f"refused, the renderer does not do what the method sets: {refused}"
    elif not (partial / "stats.json").exists():
        record["error"] = "the renderer wrote no statistics"
    (partial / "run.json").write_text(json.dumps(record, indent=2) + "\n")
    shutil.rmtree(run.folder, ignore_errors=True)
    partial.rename(run.folder)
    return record


def _state(run, build, retry_failed):
    """Why a run is to be made, or None if its result stands."""
    record = run.record()
    if record is None:
        return "settings changed" if run.folder.exists() else "new"
    if record["build"] != build:
        return "renderer rebuilt"
    return "failed before" if record["error"] and retry_failed else None


def run_all(study: Study, runs, tungsten: Path, retry_failed=False, accept_warnings=False, say=print):
    """Makes the missing runs. Failures are recorded and reported, and not tried again unless `retry_failed`."""
    build = build_of(tungsten)
    due = [(run, state) for run in runs if (state := _state(run, build, retry_failed))]
    if len(due) < len(runs):
        say(f"{len(runs) - len(due)} of {len(runs)} runs are already there")
    if due:
        say(f"{len(due)} runs, {sum(run.seconds for run, _ in due) / 60:.1f} minutes of passes and the time for loading")
    for number, (run, state) in enumerate(due, 1):
        limit = study.limit_seconds or 10 * run.seconds + 600
        say(f"[{number}/{len(due)}] {run.label}{'' if state == 'new' else f' ({state})'} ...", end=" ", flush=True)
        record = execute(run, tungsten, build, limit, accept_warnings)
        say(f"FAILED: {record['error']}" if record["error"] else f"skipped: {record['skipped']}" if record["skipped"]
            else f"{record['wall seconds']:.1f} s", flush=True)


def check(runs, tungsten: Path, say=print):
    """Reads every scene with every method's settings, renders nothing. Returns what the renderer objects to."""
    problems = []
    for run in (run for run in runs if run.seed == 1):
        code, messages = call([str(tungsten), "--explain", *run.arguments()], 600)
        if skipped := impossible(code, messages, run.method):
            say(f"skipped  {run.scene.name}, {run.method.name}: {skipped}")
            continue
        refused = refused_warning(messages, run.overrides)
        problem = messages.strip() if code != 0 else refused
        say(f"{'refused' if problem else 'good   '}  {run.scene.name}, {run.method.name}")
        if problem:
            problems.append(f"{run.scene.name}, {run.method.name}: {problem}")
    return problems
