"""report.html: a study's pictures, curves, tables and commands as one page that needs nothing else."""

import json
import re
import sys
from pathlib import Path
from statistics import median

import numpy as np

from darts_bench import measures
from darts_bench.film_code import encode
from darts_bench.images import average_down, read_exr
from darts_bench.report import conditions, legend
from darts_bench.run import COMMAND, PROJECT, as_typed, write_whole
from darts_bench.tables import left_out, overview, scene_tables

TEMPLATE = PROJECT / "tungsten/page/page.html"
PAYLOAD_BYTES = 20e6  # of all images, before base64


def template(file=TEMPLATE):
    """The page's parts before and after the data; a line "@include FILE" stands for the file."""
    page = re.sub(r"^@include (.*)$", lambda match: (file.parent / match[1]).read_text(), file.read_text(), flags=re.M)
    return page.split("\n@data\n")


def write_html(file, data, payloads):
    """The page of the data and of the images' payloads by identity; whole or not at all."""
    before, after = template()
    parts = [before, '\n<script type="application/json" id="page-data">', json.dumps(data).replace("<", "\\u003c"), "</script>"]
    parts += [f'\n<script type="text/plain" id="{identity}">{payload}</script>' for identity, payload in payloads.items()]
    write_whole(file, "".join([*parts, "\n", after]))


def _plain(table):
    """A table without Markdown."""
    rows = [[str(cell).replace("**", "").replace("`", "") for cell in row] for row in table.rows]
    return {"title": table.title, "header": table.header, "rows": rows, **({"seconds": table.seconds} if table.seconds else {})}


def _commands(runs):
    """By method: the command of every run made."""
    found = {}
    for run in runs:
        if record := run.record():
            load = f", load {record['load before']:.1f} before" if "load before" in record else ""
            found.setdefault(run.method.name, []).append(
                {"label": f"{run.label} (build {record['build']}{load})", "seconds": run.seconds,
                 "command": as_typed(record["command"])})
    return found


def _budget_points(summaries_by_seconds, name):
    """Error at each time budget; bars from the least and the most noisy seed."""
    points = []
    for summaries in summaries_by_seconds.values():
        s = summaries.get(name)
        if s is None or not s.seeds or not s.mse:
            continue
        low, high = (measures.mean_squared_error(std, s.bias_squared) ** 0.5 for std in s.std_range or (s.noise, s.noise))
        points.append({"cpu": s.cpu, "wall": s.wall, "error": s.mse**0.5, "low": low, "high": high})
    return points


def _trace(run, reference):
    """(CPU seconds, wall seconds, relative standard deviation) of a run's trace, where it has one (--trace)."""
    folder = run.folder / "trace"
    if not (folder / "trace.json").exists():
        return []
    entries = json.loads((folder / "trace.json").read_text())["entries"]
    return [(e["CPU seconds"], e["wall seconds"], measures.relative_std(np.load(folder / e["standard error"])[0], reference.mean))
            for e in entries if e["passes"] >= 2]


def trace_points(runs, reference):
    """Medians over the seeds of each moment's noise; bars from the smallest and largest."""
    traces = [trace for run in runs if (trace := _trace(run, reference))]
    points = []
    for moment in zip(*traces):
        cpu, wall, errors = zip(*moment)
        points.append({"cpu": median(cpu), "wall": median(wall), "error": median(errors), "low": min(errors), "high": max(errors)})
    return points


def _curves(scene, by_seconds, runs, reference):
    curves = []
    for name in list(by_seconds.values())[-1]:
        mine = [run for run in runs if run.method.name == name and run.seconds == list(by_seconds)[-1]]
        for label, points in ((name, _budget_points(by_seconds, name)), (f"{name}, noise on the way", trace_points(mine, reference))):
            if points:
                curves.append({"name": label, "points": points})
    return {"label": "rms error / mean of the reference", "curves": curves}


def _pictures(study, scene, summaries, reference):
    """(name, image, standard error) of the reference and of every method's first seed, at the reference's resolution."""
    shape = reference.image.shape[:2]
    found = [("reference", reference.image, None)]
    for name, summary in summaries.items():
        if summary.seeds:
            layers = read_exr(summary.image)
            error = layers.get("stderr")
            known = error is not None and np.isfinite(error).all()
            found.append((name, average_down(layers[""], shape), average_down(error, shape) if known else None))
    return found


def _facts(study, everything):
    machines = sorted({machine for s in everything for machine in s.machines})
    builds = sorted({build for s in everything for build in s.builds})
    facts = [("command", as_typed([COMMAND, *sys.argv[1:]])), ("machine", "; ".join(machines) or "not recorded"), ("renderer's build", ", ".join(builds) or "none")]
    failures = [(f"failed: {label}", message) for s in everything for label, message in s.failures]
    return [{"name": name, "value": value} for name, value in facts + failures]


def _page_data(study, summaries, references, runs):
    """The page's data, and the payloads by identity."""
    pictures = {scene.name: _pictures(study, scene, list(summaries[scene.name].values())[-1], references[scene.name])
                for scene in study.scenes}
    samples = sum(image.shape[0] * image.shape[1] for group in pictures.values() for _, image, _ in group)
    scenes, payloads = [], {}
    for scene in study.scenes:
        films, by_seconds, reference = [], summaries[scene.name], references[scene.name]
        mine = [run for run in runs if run.scene.name == scene.name]
        for name, image, error in pictures[scene.name]:
            budget = PAYLOAD_BYTES * image.shape[0] * image.shape[1] / samples
            film, payload = encode(name, f"film-{len(payloads)}", image, error, budget)
            payloads[film["data"]] = payload
            films.append(film)
        scenes.append({"name": scene.name, "toneMap": "pbrt", "quantity": "radiance", "reference": 0, "unit": reference.mean,
                       "films": films, "curves": _curves(scene, by_seconds, mine, reference),
                       "tables": [_plain(table) for table in scene_tables(study, scene, by_seconds)], "commands": _commands(mine)})
    return scenes, payloads


def write_page(study, summaries, references, runs, work: Path):
    """Writes report.html into the work folder; returns its path."""
    everything = [s for by_seconds in summaries.values() for group in by_seconds.values() for s in group.values()]
    scenes, payloads = _page_data(study, summaries, references, runs)
    tables = [overview(study, summaries), left_out(study, summaries)]
    data = {"title": study.title, "subtitle": f"Pictures: the first seed of {study.seconds[-1]:g} s. " + conditions(study, everything)
            .replace("**", "").replace("\n", " "), "scenes": scenes, "tables": [_plain(table) for table in tables if table.rows], "facts": _facts(study, everything),
            "notes": legend(study)}
    write_html(work / "report.html", data, payloads)
    return work / "report.html"
