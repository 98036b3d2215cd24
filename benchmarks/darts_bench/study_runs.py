"""Rendering what a study asks for, and its references: interleaved, resumable, one folder of results per run."""

import dataclasses
import json
import os
import re
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from darts_bench import measures
from darts_bench.images import read_exr, write_pfm
from darts_bench.run import MOST_SAMPLES, BenchError, appearing, build_of, call, content_key, machine, pass_size, set_options, workers
from darts_bench.study_file import Method, Scene, Study

BAD_INPUT = 1  # exit code
SECONDS, SEEDS = 60, 4  # of one reference, if nothing else is asked for


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
        values += self.method.overrides
        return [*values, "renderer.enable_resume_render=false", pass_size(values)]

    def arguments(self):
        """The renderer's, without those that say where results go."""
        width, height = self.scene.resolution
        arguments = ["-t", str(self.threads), "-s", str(self.seed), "--timeout", f"{self.seconds:g}s", "--quiet",
                     "--spp", str(MOST_SAMPLES), "--resolution", f"{width}x{height}"]
        return [*arguments, *(["--bias"] if self.bias else []), *set_options(self.overrides), str(self.scene_file)]

    def fingerprint(self):
        """Changes with anything that shapes the result, the renderer itself excepted."""
        return content_key(self.arguments()[:-1], self.scene_file)

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
        raise BenchError("two methods or scenes have names that differ only in punctuation")
    return runs


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


def execute(run: Run, tungsten: Path, build: str, limit: float, accept_warnings: bool):
    """Renders into a folder that appears under its name only when complete, and returns its record."""
    with appearing(run.folder) as folder:
        command = [str(tungsten), "-d", str(folder), "-o", "image.png", "-e", "image.exr", "--stats", "stats.json", *run.arguments()]
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
        elif not (folder / "stats.json").exists():
            record["error"] = "the renderer wrote no statistics"
        (folder / "run.json").write_text(json.dumps(record, indent=2) + "\n")
    return record


def _state(run, build, retry_failed):
    """Why a run is to be made, or None if its result stands."""
    record = run.record()
    if record is None:
        return "settings changed" if run.folder.exists() else "new"
    if record["build"] != build:
        return "renderer rebuilt"
    return "failed before" if record["error"] and retry_failed else None


def run_all(study: Study, runs, tungsten: Path, retry_failed=False, accept_warnings=False, at_once=1):
    """Makes the missing runs. Failures are recorded and reported, and not tried again unless `retry_failed`."""
    build = build_of(tungsten)
    due = [(run, state) for run in runs if (state := _state(run, build, retry_failed))]
    if len(due) < len(runs):
        print(f"{len(runs) - len(due)} of {len(runs)} runs are already there")
    if due:
        print(f"{len(due)} runs, {sum(run.seconds for run, _ in due) / 60:.1f} minutes of passes and the time for loading")

    def make(number, run, state):
        title = f"[{number}/{len(due)}] {run.label}{'' if state == 'new' else f' ({state})'} ... "
        if at_once == 1:  # else lines would mix
            print(title, end="", flush=True)
        record = execute(run, tungsten, build, study.limit_seconds or 10 * run.seconds + 600, accept_warnings)
        told = f"FAILED: {record['error']}" if record["error"] else f"skipped: {record['skipped']}" if record["skipped"] \
            else f"{record['wall seconds']:.1f} s"
        print(told if at_once == 1 else title + told, flush=True)

    with workers(at_once) as pool:
        for job in [pool.submit(make, number, *one) for number, one in enumerate(due, 1)]:
            job.result()


def check(runs, tungsten: Path):
    """Reads every scene with every method's settings, renders nothing. Returns what the renderer objects to."""
    problems = []
    for run in (run for run in runs if run.seed == 1):
        code, messages = call([str(tungsten), "--explain", *run.arguments()], 600)
        if skipped := impossible(code, messages, run.method):
            print(f"skipped  {run.scene.name}, {run.method.name}: {skipped}")
            continue
        refused = refused_warning(messages, run.overrides)
        problem = messages.strip() if code != 0 else refused
        print(f"{'refused' if problem else 'good   '}  {run.scene.name}, {run.method.name}")
        if problem:
            problems.append(f"{run.scene.name}, {run.method.name}: {problem}")
    return problems


# ---- References of a study's own: the mean of long renders by the method that a scene names (reference_by)

def _runs_of(study, scene, work):
    """Long renders of one scene, in a folder of their own beside the study's."""
    alone = dataclasses.replace(study, scenes=[dataclasses.replace(scene, skip={})], methods=[scene.reference_by])
    return alone, plan(alone, work / "references")


def average(images, block):
    """Mean of independent renders (at least two), and the mean variance of its block means over the image."""
    blocks = np.array([measures.block_means(measures.grey(image), block) for image in images])
    return np.mean(images, axis=0), float(np.mean(blocks.var(axis=0, ddof=1)) / len(images))


def render_references(study, work, tungsten, retry_failed, accept_warnings):
    """Renders what is missing and writes each reference as a PFM with NAME.blockvar beside it. The study's times and seeds
    are those of the references. Returns the scenes that have none because their renders failed."""
    failed = []
    for scene in study.scenes:
        if scene.reference_by is None:
            raise BenchError(f"scene '{scene.name}' does not say how its reference is rendered (reference_by)")
        if scene.reference.suffix != ".pfm" or study.seeds < 2:
            raise BenchError(f"scene '{scene.name}': references are rendered as .pfm, from at least 2 seeds")
        alone, runs = _runs_of(study, scene, work)
        run_all(alone, runs, tungsten, retry_failed, accept_warnings)
        if any((record := run.record())["error"] or record["skipped"] for run in runs):
            failed.append(scene.name)
            continue
        image, variance = average([read_exr(run.folder / "image.exr")[""] for run in runs], study.block)
        scene.reference.parent.mkdir(parents=True, exist_ok=True)
        write_pfm(scene.reference, image)
        scene.reference.with_suffix(".blockvar").write_text(f"{variance!r}\n")
        print(f"{scene.reference}: noise of a block {np.sqrt(variance) / image.mean():.2%} of the mean")
    return failed
