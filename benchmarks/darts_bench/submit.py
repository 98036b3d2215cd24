"""Runs of a study handed to Slurm as a job array. A part is every N-th run, whoever makes it."""

import math
import shlex
import subprocess
import sys
from pathlib import Path

from darts_bench.run import COMMAND, BenchError

PROGRAM = [sys.executable, str(COMMAND), "study"]
MOST_TASKS = 1000  # Slurm's own limit (MaxArraySize) is 1001 unless a site raises it
LOADING = 300  # seconds of a run besides its passes, at most


def part_of(text):
    """"I/N" as (I, N)."""
    try:
        part, parts = (int(number) for number in text.split("/"))
    except ValueError:
        part, parts = 0, 0
    if not 0 <= part < parts:
        raise BenchError(f"--part {text}: expected I/N, with I from 0 to N - 1")
    return part, parts


def same_study(options, action):
    """The command line of this study with another action."""
    arguments = [options.study, action]
    for name, of_option in (("tungsten", str), ("root", Path.resolve), ("work", Path.resolve), ("seeds", str), ("threads", str),
                            ("scenes", "; ".join), ("methods", "; ".join)):
        if (value := getattr(options, name)) is not None:
            arguments += [f"--{name}", str(of_option(value))]
    arguments += ["--seconds", *map(str, options.seconds)] if options.seconds else []
    return arguments + [f"--{name.replace('_', '-')}" for name in ("quick", "retry_failed", "accept_warnings") if getattr(options, name)]


def _longest(runs, tasks):
    """Minutes that the longest task takes, and half as much again."""
    seconds = max(sum(run.seconds + LOADING for run in runs[task::tasks]) for task in range(tasks))
    return math.ceil(1.5 * seconds / 60)


def _script(name, lines, command):
    return "\n".join(["#!/bin/sh", f"#SBATCH --job-name={name}", *(f"#SBATCH {line}" for line in lines), "",
                      "exec " + command, ""])


def _sbatch(options, arguments):
    try:
        result = subprocess.run([options.sbatch, "--parsable", *options.sbatch_option, *arguments], capture_output=True, text=True)
    except OSError as error:
        raise BenchError(f"{options.sbatch}: {error.strerror}; --sbatch names Slurm's command, --write-only only writes the "
                         "scripts") from error
    if result.returncode != 0:
        raise BenchError(f"{options.sbatch}: exit code {result.returncode}: {result.stderr.strip()}")
    return result.stdout.strip().partition(";")[0]


def submit(study, runs, work, options):
    """Writes an array of tasks, each with a part of the runs, and a job that reports when all have ended; submits both."""
    tasks = min(len(runs), options.tasks)
    folder = work / "slurm"
    folder.mkdir(parents=True, exist_ok=True)
    run, report_all = (shlex.join([*PROGRAM, *same_study(options, action)]) for action in ("run", "report"))
    array = folder / "array.sh"
    array.write_text(_script(study.name, [
        f"--array=0-{tasks - 1}", "--ntasks=1", f"--cpus-per-task={study.threads}", f"--time={_longest(runs, tasks)}",
        f"--output={folder}/%a.log"], f'{run} --part "$SLURM_ARRAY_TASK_ID/{tasks}"'))
    report = folder / "report.sh"
    report.write_text(_script(f"{study.name}-report", ["--ntasks=1", "--time=60", f"--output={folder}/report.log"],
                              report_all))
    print(f"{array}: {tasks} tasks of {len(runs)} runs, {study.threads} threads each\n{report}")
    if options.write_only:
        return
    job = _sbatch(options, [str(array)])
    after = _sbatch(options, [f"--dependency=afterany:{job}", str(report)])
    print(f"submitted as jobs {job} and, once all its tasks have ended, {after}")
