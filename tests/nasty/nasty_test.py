#!/usr/bin/python3
"""Hard scenes (nasty_cases.py): finite, without crash or hang, and agreeing where a comparison makes sense. `--long` adds what takes
minutes, `--table` prints the rows of docs/accuracy-hard-scenes.csv. The renderer is named by the environment's TUNGSTEN."""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from nasty_cases import ALL, PATHS, Case, by, cases, moved, needle, room, scaled  # noqa: E402

TUNGSTEN = os.environ.get("TUNGSTEN", str(Path(__file__).resolve().parents[2] / "build/bin/tungsten"))
SIGMAS = 5.0
LONGEST = 300  # seconds for one case
MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # ten thousand images are brought to the disk one by one


class Failed(Exception):
    pass


def render(folder, scenes, spp, step, *options, files=None, paths=1, warns=""):
    """Scenes by name, in one process: {name: (mean, standard error)} of all values. `paths`: factor on the samples of paths, which
    are cheaper."""
    for name, text in (files or {}).items():
        (folder / name).write_text(text)
    names = []
    for name, scene in scenes.items():
        more = paths if scene["integrator"]["type"] == "path_tracer" else 1
        scene = {**scene, "renderer": {"spp": spp * more, "spp_step": step * more, "output_file": f"{name}.png",
                                       "hdr_output_file": f"{name}.npz"}}
        (folder / f"{name}.json").write_text(json.dumps(scene))
        names.append(str(folder / f"{name}.json"))
    done = subprocess.run([TUNGSTEN, "--quiet", "-d", str(folder), *options, *names], capture_output=True, text=True, timeout=LONGEST)
    if done.returncode != 0:
        raise Failed(f"exit code {done.returncode}: {done.stderr.strip()[-300:]}")
    if warns not in done.stderr:
        raise Failed(f"no warning of '{warns}': {done.stderr}")
    films = {}
    for name in scenes:
        film = np.load(folder / f"{name}.npz")
        films[name] = (film["mean"].astype(float), film["standard_error"].astype(float))
        lost = json.loads(str(film["metadata"]))["statistics"]["non-finite samples"] if "metadata" in film else 0
        if not np.isfinite(films[name][0]).all() or lost:
            raise Failed(f"{name}: {lost} samples are not finite")
        if (films[name][0] < 0).any():
            raise Failed(f"{name}: negative")
    return films


def difference(a, b, kernel):
    """How far two images are apart, in standard errors, beyond what the kernel may change."""
    (x, ex), (y, ey) = a, b
    apart = np.maximum(np.abs(x - y) - kernel * np.maximum(x, y), 0)
    error = np.hypot(ex, ey)
    return float(np.max(np.where(apart > 0, apart / np.maximum(error, 1e-30), 0)))


def check(case, folder):
    """What was measured, in words. Raises Failed."""
    scenes = {method.replace(", ", "-"): by(method, {**case.scene, **case.set}) for method in case.methods}
    films = render(folder, scenes, case.spp, case.step, files=case.files, paths=case.paths, warns=case.warns)
    means = {name: float(film[0].mean()) for name, film in films.items()}
    if case.black:
        if any(means.values()):
            raise Failed(f"not black: {means}")
        return "black"
    if case.expected == -1:
        wide = render(folder, {name: by(method, needle(1e-3)) for name, method in zip(scenes, case.methods)}, case.spp, case.step,
                      paths=case.paths)
        worst = max(difference(films[name], wide[name], 0.0) for name in scenes)
        if worst > SIGMAS or not all(means.values()):
            raise Failed(f"{worst:.1f} standard errors from the wide gate: {means}")
        return f"{worst:.1f} standard errors from the wide gate"
    if case.expected is not None:
        worst = max(difference(film, (np.full_like(film[0], case.expected), np.zeros_like(film[1])), case.within) for film in films.values())
        error = max(float((film[1] / case.expected).max()) for film in films.values())
        if worst > SIGMAS:
            raise Failed(f"{worst:.1f} standard errors from {case.expected}: {means}")
        return f"{worst:.1f} standard errors of {100 * error:.1f} %"
    if not case.agree:
        return "finite"
    films = {name: film for name, film in films.items() if name.replace("-", ", ", 1) in case.agree}
    reference = "paths-plain"
    expected = films[reference]
    if case.like:
        reference = "the plain scene"
        expected = render(folder, {"like": by("paths, plain", case.like)}, case.spp, case.step, paths=case.paths)["like"]
    worst, where = max((difference(film, expected, case.kernel), name) for name, film in films.items())
    if worst > SIGMAS:
        errors = {name: float(film[1].mean()) for name, film in films.items()}
        raise Failed(f"{where}: {worst:.1f} standard errors from {reference}: means {means}, errors {errors}")
    return f"{worst:.1f} standard errors ({where})"


def scales(folder):
    """Images of scenes in other units: powers of two bit for bit (plain paths) or to rounding, others within bounds."""
    base = {method.replace(", ", "-"): by(method, scaled(room(), 1.0)) for method in ALL}
    expected = render(folder, base, 8, 4, "-t", "1")
    rows = []
    for label, k, bound in (("2^20", 2.0 ** 20, 0.0), ("2^-20", 2.0 ** -20, 0.0), ("1e6", 1e6, None), ("1e-6", 1e-6, None)):
        found = render(folder, {name: scaled(scene, k) for name, scene in base.items()}, 8, 4, "-t", "1")
        worst = 0.0
        for name in base:
            apart = np.abs(found[name][0] / expected[name][0] - 1).max()
            worst = max(worst, float(apart))
            if bound is not None and apart > (0 if name == "paths-plain" else 1e-6):
                rows.append((f"lengths times {label}", f"{name}: {apart:.2g} apart", False))
        if bound is None:
            sigmas = max(difference(found[name], expected[name], 0.0) for name in base)
            rows.append((f"lengths times {label}", f"{sigmas:.1f} standard errors, {worst:.1g} apart", sigmas <= SIGMAS))
        else:
            rows.append((f"lengths times {label}", f"{worst:.1g} apart", True))
    return rows


def far(folder):
    """The room 1e4 of its sizes from the origin."""
    scenes = {method.replace(", ", "-"): by(method, room()) for method in ALL}
    here, there = (render(folder, {name: moved(scene, d) for name, scene in scenes.items()}, 48, 3, paths=64) for d in ((0, 0, 0), (2e4, -2e4, 2e4)))
    worst, where = max((difference(here[name], there[name], 0.02), name) for name in scenes)
    return [("the room 1e4 sizes from the origin", f"{worst:.1f} standard errors ({where})", worst <= SIGMAS)]


def frames(folder, count=10000):
    """A sequence of 10 000 frames: their mean is the gate's."""
    one = {method.replace(", ", "-"): by(method, room()) for method in PATHS + ["points, plain"]}
    many = {}
    for name, scene in one.items():
        settings = {key: value for key, value in scene["integrator"].items() if key != "transient_time_center"}
        many[name] = {**scene, "integrator": {**settings, "start_time": 2.0, "frame_num": count, "transient_time_width": 2.0 / count}}
    gate, film = render(folder, one, 48, 3), render(folder, many, 48, 3)
    rows = []
    for name in one:
        mean, error = film[name][0].mean(axis=0), gate[name][1][0]
        sigmas = float(np.max(np.abs(mean - gate[name][0][0]) / (1.5 * error)))
        rows.append((f"{count} frames, {name}", f"{sigmas:.1f} standard errors from one gate", sigmas <= SIGMAS))
    return rows


def attempt(name, work):
    try:
        return [(name, work(), True)]
    except Failed as failed:
        return [(name, str(failed), False)]
    except subprocess.TimeoutExpired:
        return [(name, f"takes more than {LONGEST} s", False)]


def rows(arguments):
    for part in (scales, far, frames):
        if arguments.only in part.__name__:
            with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
                try:
                    for row in part(Path(folder)):
                        yield (*row, "invariant" if part is scales else "within 5 standard errors")
                except Failed as failed:
                    yield part.__name__, str(failed), False, ""
    for case in cases():
        if arguments.only not in case.name or (case.long and not arguments.long):
            continue
        with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
            for row in attempt(case.name, lambda: check(case, Path(folder))):
                yield (*row, case.promise)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--only", default="", help="cases whose name holds this")
    arguments = parser.parse_args()
    bad = 0
    for name, measured, good, promise in rows(arguments):
        bad += not good
        if arguments.table:
            csv.writer(sys.stdout, lineterminator="\n").writerow([name, promise, measured])
            sys.stdout.flush()
        else:
            print(f"{'ok    ' if good else 'FAILED'} {name}: {measured}", flush=True)
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
