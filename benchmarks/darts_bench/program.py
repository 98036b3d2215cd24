"""What the studies that are programs (study/studies/*.py) stand on: renders by processor time, kept and interleaved; results with
the conditions they were made under.

Renders here have one thread and end when their process has used its share of CPU seconds.
"""

import json
import os
import resource
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from darts_bench import plots, run
from darts_bench.run import MOST_SAMPLES, PROJECT, SHARED, appearing, build_of, checked, pass_size, set_options
from darts_bench.tables import comma_separated

MAP = "integrator.type=progressive_transient_photon_map"
PATHS = ["integrator.type=path_tracer"]
PRIMITIVES = {"points": [MAP, "integrator.volume_photon_type=points"],
              "beams": [MAP, "integrator.volume_photon_type=beams"], "paths": PATHS}
# The paper's preset leaves directions to the phase function where that is not the fork's `ida`.
PRESETS = {"plain": "off", "published": '{"preset":"published","direction":"eda"}', "best": "best"}


def method(name):
    """What a method such as "best points" sets."""
    preset, primitive = name.split(" ")
    return [*PRIMITIVES[primitive], f"integrator.darts={PRESETS[preset]}"]


@dataclass(frozen=True)
class Scene:
    name: str
    file: Path
    resolution: tuple
    settings: tuple = ()

    @staticmethod
    def own(name, side, *settings):
        """Of data/scenes, or of benchmarks/study/scenes."""
        file = PROJECT / "data/scenes" / name / "scene.json"
        file = file if file.exists() else PROJECT / "benchmarks/study/scenes" / f"{name}.json"
        return Scene(name, file, (side, side), settings)

    @staticmethod
    def others(name, side):
        """cbox, dragon and staircase, by others, which do not ship; None where they are not beside the project."""
        file, *gate = {"cbox": ("transient.json",),
                       "dragon": ("scene-points-darts-short.json", "integrator.transient_time_center=4.125",
                                  "integrator.transient_time_width=0.05"),
                       "staircase": ("scene-points-darts-short.json",)}[name]
        file = SHARED / name / file
        return Scene(name, file, (side, side), tuple(gate)) if file.exists() else None

    def words(self):
        """For a title: name and resolution."""
        return f"{self.name}, {self.resolution[0]} x {self.resolution[1]}"


@dataclass
class Render:
    """A finished render: its trace's moments, its statistics."""

    folder: Path
    entries: list
    stats: dict

    def image(self, i=-1, name="mean"):
        """(frames, height, width, 3)."""
        return np.load(self.folder / "trace" / self.entries[i][name]).astype(np.float64)

    @property
    def cpu(self):
        """Processor seconds of the passes at each moment."""
        return np.array([entry["CPU seconds"] for entry in self.entries])

    @property
    def passes(self):
        return np.array([entry["passes"] for entry in self.entries])

    @property
    def standard_errors(self):
        """Relative, by the render's own account; NaN after a single pass."""
        return np.array([entry["relative standard error"] or np.nan for entry in self.entries])


@dataclass
class Bench:
    """Renders of one study, kept under `renders` by their command and the renderer's build: studies share references."""

    name: str
    tungsten: Path
    work: Path
    renders: Path
    results: Path
    quick: bool = False
    spent: float = 0.0  # CPU seconds of all renders, kept ones included
    sample: list = field(default_factory=list)  # the first command, for the record

    def __post_init__(self):
        self.work.mkdir(parents=True, exist_ok=True)
        self.build = build_of(self.tungsten)

    def short(self, full, quick):
        """A figure of the study, or that of its quick form."""
        return quick if self.quick else full

    def command(self, scene, settings, options, threads=1, size="renderer.spp_step=1"):
        """Of any run of the scene at its resolution, but for its outputs and its file."""
        return [str(self.tungsten), "-t", str(threads), "--resolution", f"{scene.resolution[0]}x{scene.resolution[1]}", *options,
                *set_options([size, "renderer.enable_resume_render=false", *scene.settings, *settings])]

    def kept(self, scene, what, make):
        """The folder of what a command left, made by `make` in a folder if it is not there; `what` is the command and its limits."""
        folder = self.renders / run.content_key([*what, self.build], scene.file)
        if not folder.exists():
            with appearing(folder) as partial:
                make(partial)
        self.sample = self.sample or [*what[0], str(scene.file)]
        return folder

    def render(self, scene, settings=(), seed=1, cpu=None, passes=None, options=(), threads=1, again=1):
        """Until `passes` of one sample a pixel, or the process has used `cpu` seconds in passes of that size (pass_size), unless
        `settings` say else. `again`: the same another time, where times matter."""
        size = {} if passes else {"size": pass_size([*scene.settings, *settings])}
        limits = ["-s", str(seed), "--quiet", "--spp", str(passes or MOST_SAMPLES), "--timeout", "10h"]
        command = self.command(scene, settings, [*limits, *options], threads, **size)

        def make(folder):
            outputs = ["-d", folder, "-o", "image.png", "-e", "image.exr", "--stats", "stats.json", "--trace", "trace", scene.file]
            checked([*command, *outputs], cpu=cpu, first=folder / "trace/trace.json")

        folder = self.kept(scene, [command, cpu, *([again] if again > 1 else [])], make)
        render = Render(folder, json.loads((folder / "trace/trace.json").read_text())["entries"], json.loads((folder / "stats.json").read_text()))
        self.spent += render.stats["process CPU seconds"]
        return render

    def plan_cost(self, scene, seconds):
        """What --plan-cost says, as data, from a pilot of so many seconds for each method: more on a machine whose load
        takes wall time from it."""
        command = self.command(scene, (), ["--plan-cost"])

        def make(folder):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            wall = 4 * seconds * max(1.0, os.getloadavg()[0] / os.cpu_count())
            checked([*command, "--timeout", f"{wall:.2f}s", "--stats", folder / "plan.json", scene.file])
            (folder / "cpu").write_text(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before))

        folder = self.kept(scene, [command, seconds], make)
        self.spent += float((folder / "cpu").read_text())
        return json.loads((folder / "plan.json").read_text())

    def plain(self, scene, passes):
        """The folder of a render of some passes of the scene as it is, but for the names of its images."""
        command = [str(self.tungsten), "-t", "1", "-s", "1", "--quiet", "--spp", str(passes), "--timeout", "10h", "-o", "image.png", "-e", "image.exr"]
        return self.kept(scene, [command], lambda folder: checked([*command, "-d", folder, scene.file]))

    def interleaved(self, cells, seeds, first=1, **how):
        """{key: [render by seed]} of {key: (scene, settings)}: every cell once, then in the opposite order with the next
        seed, so that a machine that slows down favours none. Seeds from `first` on."""
        found = {key: [] for key in cells}
        for seed in range(first, first + seeds):
            for key in list(cells)[::1 if seed % 2 else -1]:
                scene, settings = cells[key]
                found[key].append(self.render(scene, settings, seed, **how))
                last = found[key][-1]
                print(f"{key}, seed {seed}: {last.passes[-1]} passes, {last.cpu[-1]:.2f} CPU s, relative standard error "
                      f"{last.standard_errors[-1]:.3g}", flush=True)
        return found

    def reference(self, scene, cpu, settings=(*PATHS, "integrator.darts=best"), seed=1001):
        """Of best paths, which nothing blurs: image and standard errors."""
        render = self.render(scene, settings, seed, cpu)
        print(f"reference of {scene.name}: relative standard error {render.standard_errors[-1]:.3g}", flush=True)
        return render.image(), render.image(name="standard error")

    def plot(self, figure, name):
        """An SVG beside the page."""
        plots.save(figure, self.results / f"{name}.svg")

    def keep(self, name, head, rows):
        """Writes a table as NAME.csv beside the page, empty where there is no figure. Returns what the page says of it."""
        rows = list(rows)
        self.results.mkdir(parents=True, exist_ok=True)
        (self.results / f"{name}.csv").write_text(comma_separated(head, rows))
        return f"[{name}.csv]({name}.csv) ({len(rows)} rows)"

    def write(self, title, *parts):
        """README.md of the results: what the study says, then the conditions. Long tables (`keep`) and the first command are files beside it."""
        end = ["## Conditions", f"`benchmarks/bench.py study {self.name}{' --quick' if self.quick else ''}`, renderer built at "
               f"`{run.commit()}`, {time.strftime('%Y-%m-%d')}, {run.machine()}, load {os.getloadavg()[1]:.1f} in the last 5 minutes; "
               f"{self.spent / 60:.1f} CPU minutes of renders; the first: [command.sh](command.sh)."]
        self.results.mkdir(parents=True, exist_ok=True)
        (self.results / "command.sh").write_text(f"{run.as_typed(self.sample)}\n")
        file = self.results / "README.md"
        file.write_text("\n\n".join([f"# {title}", *parts, *end]) + "\n")
        print(file)
