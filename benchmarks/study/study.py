#!/usr/bin/python3
"""Runs a study by its name: a file of studies/*.json compares methods at equal time (report.md and report.html under
build/study), a program of studies/*.py measures what is its own (README.md and plots under benchmarks/results)."""

import argparse
import dataclasses
import difflib
import importlib.util
import sys
from pathlib import Path

from images import ImageError
from new_study import write_study
from results import collect
from references import SECONDS, SEEDS, render_references
from runs import check, plan, run_all
from study_file import StudyError, load_study, missing_references, require_references
from submit import MOST_TASKS, part_of, run_by_workers, submit

ROOT = Path(__file__).resolve().parents[2]
STUDIES = Path(__file__).resolve().parent / "studies"
ACTIONS = ["run", "report", "check", "list", "references", "submit"]
EXIT_DONE, EXIT_FAILED_RUNS, EXIT_BAD_INPUT, EXIT_INTERRUPTED = 0, 1, 2, 130


def _names(text):
    return [name.strip() for name in text.split(";")]


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="study.py", description=__doc__, epilog="An interrupted study goes on where it was: "
                                     "give the same command again. Exit codes: 0 done, 1 some runs failed, 2 bad input.")
    parser.add_argument("study", help="a name: " + ", ".join(sorted(file.stem for file in STUDIES.glob("*.*")))
                        + "; or a study file of your own; or new, with a scene: writes a study of it beside it")
    parser.add_argument("action", nargs="?", default="run", metavar="{run,report,check,list,references,submit} | SCENE",
                        help="run: render what is missing, then report (default); report: from the results so far; "
                        "check: whether there are references, and the renderer reads every scene with every method's settings; list: show the runs; "
                        f"references: render those of the study's own, {SEEDS} seeds of {SECONDS} s each unless told otherwise; "
                        "submit: hand the runs to Slurm as a job array, then the report")
    parser.add_argument("--tungsten", type=Path, default=ROOT / "build/bin/tungsten", help="the renderer (default: %(default)s)")
    parser.add_argument("--work", type=Path, help="folder of results (default: build/study/STUDY)")
    parser.add_argument("--root", type=Path, default=ROOT, help="what paths in the study are relative to (default: the project)")
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
        raise StudyError(f"no {kind} called '{', '.join(sorted(unknown))}'; there are: "
                         + "; ".join(entry.name for entry in entries))
    return [entry for entry in entries if entry.name in names]


def resolved(name):
    """The file of a study: as it is given, or that of its name."""
    found = [file for file in (Path(name), STUDIES / f"{name}.json", STUDIES / f"{name}.py") if file.is_file()]
    if not found:
        close = difflib.get_close_matches(name, [file.stem for file in STUDIES.glob("*.*")], 1)
        raise StudyError(f"there is no study '{name}'" + (f"; is it '{close[0]}'?" if close else "; --help lists them"))
    return found[0]


def perform_program(file, options):
    """A study that is a program; exits with what its renders say."""
    if options.action != "run" or options.part or options.workers > 1:
        raise StudyError(f"'{file.stem}' is a program: it knows 'run' alone")
    spec = importlib.util.spec_from_file_location(file.stem.replace("-", "_"), file)
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    base = ROOT / "build/study"
    work = (options.work or base / file.stem).resolve()
    renders = work / "renders" if options.work else base / "renders"
    results = work if options.quick else ROOT / "benchmarks/results" / file.stem
    from bench import Bench  # with matplotlib, which takes long: most calls draw nothing

    program.run(Bench(file.stem, options.tungsten.resolve(), work, renders, results, options.quick))
    return EXIT_DONE


def narrowed(study, options):
    """The study with what the command line overrides or leaves out."""
    if options.quick:
        study = dataclasses.replace(study, seconds=[2.0], seeds=2)
    changes = {"scenes": _keep(study.scenes, options.scenes, "scene"), "methods": _keep(study.methods, options.methods, "method")}
    if options.seconds:
        if min(options.seconds) <= 0:
            raise StudyError("--seconds: positive numbers are needed")
        changes["seconds"] = sorted(options.seconds)
    for name in ("seeds", "threads"):
        if getattr(options, name) is not None:
            if getattr(options, name) < 1:
                raise StudyError(f"--{name}: at least 1 is needed")
            changes[name] = getattr(options, name)
    if study.baseline not in {method.name for method in changes["methods"]}:
        changes["baseline"] = changes["methods"][0].name
    return dataclasses.replace(study, **changes)


def require_renderer(options):
    if not options.tungsten.is_file():
        raise StudyError(f"there is no renderer {options.tungsten}: build it (scripts/setup.sh) or name it with --tungsten")


def _state(record):
    if record is None:
        return "to do"
    return "FAILED" if record["error"] else "skipped" if record.get("skipped") else "done"


def perform_new(options):
    require_renderer(options)
    file = write_study(Path(options.action), options.tungsten.resolve())
    print(f"{file}\nnext:\n  {sys.argv[0]} {file} references    # {SEEDS} x {SECONDS} s\n  {sys.argv[0]} {file}")
    return EXIT_DONE


def perform(options):
    if options.study == "new":
        return perform_new(options)
    file = resolved(options.study)
    if file.suffix == ".py":
        require_renderer(options)
        return perform_program(file, options)
    study = narrowed(load_study(file, options.root), options)
    work = (options.work or ROOT / "build/study" / study.name).resolve()
    runs = plan(study, work)
    if options.action == "list":
        for run in runs:
            print(f"{_state(run.record()):7}  {run.label}")
        return EXIT_DONE
    if options.action in ("run", "check", "references", "submit"):
        require_renderer(options)
    if options.action == "check":
        problems = missing_references(study) + check(runs, options.tungsten)
        print("".join(f"\n{problem}\n" for problem in problems), end="")
        return EXIT_FAILED_RUNS if problems else EXIT_DONE
    if options.action == "references":
        study = dataclasses.replace(study, seconds=[max(options.seconds or [SECONDS])], seeds=options.seeds or SEEDS)
        failed = render_references(study, work, options.tungsten.resolve(), options.retry_failed, options.accept_warnings)
        return EXIT_FAILED_RUNS if failed else EXIT_DONE
    require_references(study)
    work.mkdir(parents=True, exist_ok=True)
    if options.action == "submit":
        submit(study, runs, work, options)
        return EXIT_DONE
    if options.action == "run" and options.workers > 1:
        run_by_workers(options)
    elif options.action == "run":
        part, parts = part_of(options.part or "0/1")
        run_all(study, runs[part::parts], options.tungsten.resolve(), options.retry_failed, options.accept_warnings)
        if options.part:
            return EXIT_DONE
    failed = [run for run in runs if (record := run.record()) and record["error"]]
    from page import write_page  # with matplotlib
    from report import write_report

    summaries, references = collect(study, runs)
    print(f"{write_report(study, summaries, references, work)}\n{write_page(study, summaries, references, runs, work)}")
    if failed:
        print(f"{len(failed)} of {len(runs)} runs failed; the report has their messages", file=sys.stderr)
    return EXIT_FAILED_RUNS if failed else EXIT_DONE


def main(arguments=None):
    try:
        return perform(parse_arguments(arguments))
    except (StudyError, ImageError) as error:
        print(f"error: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except KeyboardInterrupt:
        print("\ninterrupted: give the same command to go on", file=sys.stderr)
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
