"""Runs a study by its name: a file of studies/*.json compares methods at equal time (report.md and report.html under
build/study), a program of studies/*.py measures what is its own (README.md and plots under benchmarks/results)."""

import argparse
import dataclasses
import difflib
import importlib.util
import sys
from pathlib import Path

from darts_bench.new_study import write_study
from darts_bench.results import collect
from darts_bench.run import PROJECT, BenchError, add_renderer, require_renderer
from darts_bench.study_file import load_study, missing_references, require_references
from darts_bench.study_runs import SECONDS, SEEDS, check, plan, render_references, run_all
from darts_bench.submit import MOST_TASKS, part_of, submit

STUDIES = PROJECT / "benchmarks/study/studies"
ACTIONS = ["run", "report", "check", "list", "references", "submit"]
DONE, FAILED_RUNS = 0, 1  # exit codes; of bad input: bench.py


def _names(text):
    return [name.strip() for name in text.split(";")]


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="bench.py study", description=__doc__, epilog="An interrupted study goes on where it was: "
                                     "give the same command again. Exit codes: 0 done, 1 some runs failed, 2 bad input.")
    parser.add_argument("study", help="a name: " + ", ".join(sorted(file.stem for file in STUDIES.glob("*.*")))
                        + "; or a study file of your own; or new, with a scene: writes a study of it beside it")
    parser.add_argument("action", nargs="?", default="run", metavar="{run,report,check,list,references,submit} | SCENE",
                        help="run: render what is missing, then report (default); report: from the results so far; "
                        "check: whether there are references, and the renderer reads every scene with every method's settings; list: show the runs; "
                        f"references: render those of the study's own, {SEEDS} seeds of {SECONDS} s each unless told otherwise; "
                        "submit: hand the runs to Slurm as a job array, then the report")
    add_renderer(parser)
    parser.add_argument("--work", type=Path, help="folder of results (default: build/study/STUDY)")
    parser.add_argument("--root", type=Path, default=PROJECT, help="what paths in the study are relative to (default: the project)")
    parser.add_argument("--seconds", type=float, nargs="+", help="time budgets instead of the study's")
    parser.add_argument("--seeds", type=int, help="number of seeds instead of the study's")
    parser.add_argument("--threads", type=int, help="threads instead of the study's")
    parser.add_argument("--scenes", type=_names, help='only these, as "a; b"')
    parser.add_argument("--methods", type=_names, help='only these, as "a; b"')
    parser.add_argument("--workers", type=int, default=1, help="make so many runs at once on this machine; times are "
                        "comparable only where workers times threads are no more than its cores")
    parser.add_argument("--part", help="I/N: only every N-th run, from the I-th (from 0) on; no report")
    parser.add_argument("--tasks", type=int, default=MOST_TASKS, help="of submit: tasks of the array at most (default: %(default)s)")
    parser.add_argument("--sbatch", default="sbatch", help="of submit: Slurm's command (default: %(default)s)")
    parser.add_argument("--sbatch-option", action="append", default=[], metavar="OPTION",
                        help="of submit: for sbatch, as --sbatch-option=--partition=long (repeatable)")
    parser.add_argument("--write-only", action="store_true", help="of submit: write the scripts and submit nothing")
    parser.add_argument("--quick", action="store_true",
                        help="does it work? Small and short, its results under --work; of files: 2 seeds of 2 s")
    parser.add_argument("--retry-failed", action="store_true", help="run what failed once more")
    parser.add_argument("--accept-warnings", action="store_true",
                        help="do not refuse runs whose settings the renderer warns about")
    options = parser.parse_intermixed_args(arguments)
    if options.study == "new" and options.action == "run":
        parser.error("new: expected a scene")
    if options.study != "new" and options.action not in ACTIONS:
        parser.error(f"'{options.action}' is no action; there are: {', '.join(ACTIONS)}")
    if min(options.workers, options.tasks) < 1:
        parser.error("--workers, --tasks: at least 1 is needed")
    if (options.part or options.workers > 1) and options.action != "run":
        parser.error("--part, --workers: go with run alone")
    return options


def _keep(entries, names, kind):
    if names is None:
        return entries
    unknown = set(names) - {entry.name for entry in entries}
    if unknown:
        raise BenchError(f"no {kind} called '{', '.join(sorted(unknown))}'; there are: "
                         + "; ".join(entry.name for entry in entries))
    return [entry for entry in entries if entry.name in names]


def resolved(name):
    """The file of a study: as it is given, or that of its name."""
    found = [file for file in (Path(name), STUDIES / f"{name}.json", STUDIES / f"{name}.py") if file.is_file()]
    if not found:
        close = difflib.get_close_matches(name, [file.stem for file in STUDIES.glob("*.*")], 1)
        raise BenchError(f"there is no study '{name}'" + (f"; is it '{close[0]}'?" if close else "; --help lists them"))
    return found[0]


def perform_program(file, options):
    """A study that is a program; exits with what its renders say."""
    if options.action != "run" or options.part or options.workers > 1:
        raise BenchError(f"'{file.stem}' is a program: it knows 'run' alone")
    spec = importlib.util.spec_from_file_location(file.stem.replace("-", "_"), file)
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    base = PROJECT / "build/study"
    work = (options.work or base / file.stem).resolve()
    renders = work / "renders" if options.work else base / "renders"
    results = work if options.quick else PROJECT / "benchmarks/results" / file.stem
    from darts_bench.program import Bench  # with matplotlib, which takes long: most calls draw nothing

    program.run(Bench(file.stem, options.tungsten, work, renders, results, options.quick))
    return DONE


def narrowed(study, options):
    """The study with what the command line overrides or leaves out."""
    if options.quick:
        study = dataclasses.replace(study, seconds=[2.0], seeds=2)
    changes = {"scenes": _keep(study.scenes, options.scenes, "scene"), "methods": _keep(study.methods, options.methods, "method")}
    if options.seconds:
        if min(options.seconds) <= 0:
            raise BenchError("--seconds: positive numbers are needed")
        changes["seconds"] = sorted(options.seconds)
    for name in ("seeds", "threads"):
        if getattr(options, name) is not None:
            if getattr(options, name) < 1:
                raise BenchError(f"--{name}: at least 1 is needed")
            changes[name] = getattr(options, name)
    if study.baseline not in {method.name for method in changes["methods"]}:
        changes["baseline"] = changes["methods"][0].name
    return dataclasses.replace(study, **changes)


def _state(record):
    if record is None:
        return "to do"
    return "FAILED" if record["error"] else "skipped" if record.get("skipped") else "done"


def perform_new(options):
    require_renderer(options.tungsten)
    file = write_study(Path(options.action), options.tungsten)
    print(f"{file}\nnext:\n  {sys.argv[0]} study {file} references    # {SEEDS} x {SECONDS} s\n  {sys.argv[0]} study {file}")
    return DONE


def main(arguments):
    options = parse_arguments(arguments)
    if options.study == "new":
        return perform_new(options)
    file = resolved(options.study)
    if file.suffix == ".py":
        require_renderer(options.tungsten)
        return perform_program(file, options)
    study = narrowed(load_study(file, options.root), options)
    work = (options.work or PROJECT / "build/study" / study.name).resolve()
    runs = plan(study, work)
    if options.action == "list":
        for run in runs:
            print(f"{_state(run.record()):7}  {run.label}")
        return DONE
    if options.action in ("run", "check", "references", "submit"):
        require_renderer(options.tungsten)
    if options.action == "check":
        problems = missing_references(study) + check(runs, options.tungsten)
        print("".join(f"\n{problem}\n" for problem in problems), end="")
        return FAILED_RUNS if problems else DONE
    if options.action == "references":
        study = dataclasses.replace(study, seconds=[max(options.seconds or [SECONDS])], seeds=options.seeds or SEEDS)
        failed = render_references(study, work, options.tungsten, options.retry_failed, options.accept_warnings)
        return FAILED_RUNS if failed else DONE
    require_references(study)
    work.mkdir(parents=True, exist_ok=True)
    if options.action == "submit":
        submit(study, runs, work, options)
        return DONE
    if options.action == "run":
        part, parts = part_of(options.part or "0/1")
        run_all(study, runs[part::parts], options.tungsten, options.retry_failed, options.accept_warnings, options.workers)
        if options.part:
            return DONE
    failed = [run for run in runs if (record := run.record()) and record["error"]]
    from darts_bench.page import write_page  # with matplotlib
    from darts_bench.report import write_report

    summaries, references = collect(study, runs)
    print(f"{write_report(study, summaries, references, work)}\n{write_page(study, summaries, references, runs, work)}")
    if failed:
        print(f"{len(failed)} of {len(runs)} runs failed; the report has their messages", file=sys.stderr)
    return FAILED_RUNS if failed else DONE
