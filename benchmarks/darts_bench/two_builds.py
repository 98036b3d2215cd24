"""What a change costs or saves: instructions of small renders by the build before it and the one after it, by paths, points and beams,
plain and best, as the difference of two lengths, so that set-up is left out.

    cmake --preset portable && cmake --build build-portable --target tungsten-app tungsten-path tungsten-photon     # in both trees
    benchmarks/bench.py two-builds BEFORE AFTER

BEFORE and AFTER are tungsten commands or build folders, of the preset `portable`: valgrind knows no AVX-512. A cell is after/before - 1, so
+1 % is a slower build; the total is of the sums. Where both builds make the same paths the counts differ by what the code costs and by
nothing else. A change of random numbers makes other paths: counts of `best points` and `best beams` then scatter by 2 to 3 % a seed, those
of the others by less than 1 %, and --seeds N takes the mean over N seeds and gives its standard error.

Some six minutes on two cores. The scenes by others are looked for beside the project and left out where they are not. Staircase's set-up
alone takes more than a minute under valgrind: only its best paths are counted, all methods where --only names the scene."""

import argparse
import math
import os
import statistics
import sys
from pathlib import Path

from darts_bench.run import SHARED, BenchError, workers
from darts_bench.tables import table
from darts_bench.unused import METHODS, SCENE, of_samples

#   scene: its file, and settings by which one gate is open
SCENES = {
    "cornell-fog": (SCENE, ()),
    "cbox": (SHARED / "cbox/transient.json", ()),
    "dragon": (SHARED / "dragon/scene-points-darts-short.json",
               ("integrator.transient_time_center=4.125", "integrator.transient_time_width=0.05")),
    "staircase": (SHARED / "staircase/scene-points-darts-short.json", ()),
}
LONG_SET_UP = {"staircase": ("best paths",)}  # what is counted unless --only names the scene
PLAIN = ("integrator.darts=off", "media.*.type=homogeneous")  # the others' files turn guiding on


def command(name):
    """The tungsten command that a path or a build folder stands for."""
    for path in (Path(name), Path(name) / "bin/tungsten", Path(name) / "tungsten"):
        if path.is_file() and os.access(path, os.X_OK):
            return path.resolve()
    raise argparse.ArgumentTypeError(f"{name}: neither a tungsten command nor a build folder with bin/tungsten")


def chosen(only):
    """The scenes and methods to count."""
    for scene, (file, _) in SCENES.items():
        methods = [method for method in METHODS if only in f"{scene}, {method}"]
        if scene in LONG_SET_UP and scene not in only:
            methods = [method for method in methods if method in LONG_SET_UP[scene]]
        if methods and not file.exists():
            print(f"{scene} is left out: there is no {file}", file=sys.stderr)
        else:
            yield from ((scene, method) for method in methods)


def count(job):
    tungsten, scene, method, seed = job
    file, settings = SCENES[scene]
    settings = (*settings, *(PLAIN if method.startswith("plain") else ()))
    return of_samples(tungsten, method, scene=file, settings=settings, seed=seed)


def cell(before, after):
    """after/before - 1 of counts by seed, and its standard error where there are several seeds."""
    ratio = sum(after) / sum(before)
    if len(before) == 1:
        return f"{ratio - 1:+.2%}"
    error = statistics.stdev(a - ratio * b for a, b in zip(after, before)) / math.sqrt(len(before)) / statistics.mean(before)
    return f"{ratio - 1:+.2%} ± {error:.2%}"


def added(counts):
    """Sums by seed."""
    return [sum(of_seed) for of_seed in zip(*counts)]


def main(arguments):
    parser = argparse.ArgumentParser(prog="bench.py two-builds", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", metavar="BEFORE", type=command, help="a tungsten command, or a build folder")
    parser.add_argument("after", metavar="AFTER", type=command, help="the same")
    parser.add_argument("--only", default="", metavar="TEXT", help="count only where 'SCENE, METHOD' contains this")
    parser.add_argument("--seeds", type=int, default=1, metavar="N", help="take the mean over so many seeds")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="count in so many renders at a time")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="write the table to this file, too")
    options = parser.parse_args(arguments)
    rows = list(chosen(options.only))
    if not rows:
        raise BenchError(f"no scene and method to count: --only is '{options.only}'")
    if options.seeds < 1 or options.jobs < 1:
        parser.error("--seeds and --jobs are at least 1")
    jobs = [(build, scene, method, seed) for scene, method in rows for build in (options.before, options.after)
            for seed in range(1, options.seeds + 1)]
    try:
        with workers(options.jobs) as pool:
            counts = dict(zip(jobs, pool.map(count, jobs)))
    except BenchError as error:
        raise BenchError(f"{error}\n(valgrind must be installed, and the builds be of the preset `portable`)") from error

    def of(build, picked):
        return added([counts[build, scene, method, seed] for seed in range(1, options.seeds + 1)] for scene, method in picked)

    def ratio(picked):
        return cell(of(options.before, picked), of(options.after, picked)) if picked else ""

    methods = [m for m in METHODS if any(m == method for _, method in rows)]
    scenes = [s for s in SCENES if any(s == scene for scene, _ in rows)]
    found = [[scene, *(ratio([row for row in rows if row == (scene, m)]) for m in methods), ratio([row for row in rows if row[0] == scene])]
             for scene in scenes]
    found.append(["total", *(ratio([row for row in rows if row[1] == m]) for m in methods), ratio(rows)])
    text = table(["scene", *methods, "all"], found)
    print(text)
    if options.markdown:
        options.markdown.write_text(text + "\n")
