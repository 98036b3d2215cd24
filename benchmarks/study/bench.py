"""What the studies that are programs (studies/*.py) stand on: renders by processor time, kept and interleaved; results with
the conditions they were made under.

A busy machine takes wall time from a render, hardly processor time: renders here have one thread and end when their
process has used its share of CPU seconds.
"""

import csv
import hashlib
import json
import os
import resource
import signal
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter  # noqa: E402

from runs import build_of, machine  # noqa: E402
from study_file import StudyError  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared/scenes"  # by others, not part of the project
MAP = "integrator.type=progressive_transient_photon_map"
PATHS = ["integrator.type=path_tracer"]
PRIMITIVES = {"points": [MAP, "integrator.volume_photon_type=points"],
              "beams": [MAP, "integrator.volume_photon_type=beams"], "paths": PATHS}
# The paper's preset leaves directions to the phase function where that is not the fork's `ida`.
PRESETS = {"plain": "off", "published": '{"preset":"published","direction":"eda"}', "best": "best"}
COLOURS = {"points": "tab:blue", "beams": "tab:orange", "paths": "tab:green"}
LINES = {"plain": ":", "published": "--", "best": "-"}


def method(name):
    """What a method such as "best points" sets."""
    preset, primitive = name.split(" ")
    return [*PRIMITIVES[primitive], f"integrator.darts={PRESETS[preset]}"]


def look(name):
    """Colour by primitive, line by preset."""
    preset, primitive = name.split(" ")
    return {"color": COLOURS[primitive], "linestyle": LINES[preset]}


@dataclass(frozen=True)
class Scene:
    name: str
    file: Path
    resolution: tuple
    settings: tuple = ()

    @staticmethod
    def own(name, side, *settings):
        """Of data/scenes, or of benchmarks/study/scenes."""
        file = ROOT / "data/scenes" / name / "scene.json"
        file = file if file.exists() else ROOT / "benchmarks/study/scenes" / f"{name}.json"
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

    def command(self, scene, settings, options, threads=1):
        """Of any run of the scene at its resolution, but for its outputs and its file."""
        command = [str(self.tungsten), "-t", str(threads), "--resolution", f"{scene.resolution[0]}x{scene.resolution[1]}", *options]
        for value in ["renderer.spp_step=1", "renderer.enable_resume_render=false", *scene.settings, *settings]:
            command += ["--set", value]
        return command

    def folder_of(self, scene, *what):
        """Where the results of a command are kept."""
        key = json.dumps([*what, self.build]).encode() + scene.file.read_bytes()
        return self.renders / hashlib.sha256(key).hexdigest()[:16]

    def render(self, scene, settings=(), seed=1, cpu=None, passes=None, options=(), threads=1, again=1):
        """Until `passes`, or the process has used `cpu` seconds; passes of one sample a pixel unless `settings` say else.
        `again`: the same another time, where times matter."""
        command = self.command(scene, settings, ["-s", str(seed), "--quiet", "--spp", str(passes or 10**9), "--timeout", "10h",
                                                 *options], threads)
        folder = self.folder_of(scene, command, cpu, *([again] if again > 1 else []))
        outputs = ["-d", str(folder), "-o", "image.png", "-e", "image.exr", "--stats", "stats.json",
                   "--trace", "trace", str(scene.file)]
        if not (folder / "done").exists():
            run_for(command + outputs, cpu, folder / "trace/trace.json")
            (folder / "done").touch()
        self.sample = self.sample or command + [str(scene.file)]
        render = Render(folder, json.loads((folder / "trace/trace.json").read_text())["entries"],
                        json.loads((folder / "stats.json").read_text()))
        self.spent += render.stats["process CPU seconds"]
        return render

    def plan_cost(self, scene, seconds):
        """What --plan-cost says, as data, from a pilot of so many seconds for each method: more on a machine whose load
        takes wall time from it."""
        command = self.command(scene, (), ["--plan-cost"])
        folder = self.folder_of(scene, command, seconds)
        file = folder / "plan.json"
        if not file.exists():
            folder.mkdir(parents=True, exist_ok=True)
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            wall = 4 * seconds * max(1.0, os.getloadavg()[0] / os.cpu_count())
            run_for([*command, "--timeout", f"{wall:.2f}s", "--stats", str(file), str(scene.file)])
            (folder / "cpu").write_text(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before))
        self.sample = self.sample or command + [str(scene.file)]
        self.spent += float((folder / "cpu").read_text())
        return json.loads(file.read_text())

    def plain(self, scene, passes):
        """The folder of a render of some passes of the scene as it is, but for the names of its images."""
        folder = self.renders / f"{scene.name}-{passes}"
        if not (folder / "done").exists():
            run_for([str(self.tungsten), "-t", "1", "-s", "1", "--quiet", "--spp", str(passes), "--timeout", "10h", "-d", str(folder),
                     "-o", "image.png", "-e", "image.exr", str(scene.file)])
            (folder / "done").touch()
        return folder

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
        """An SVG, its words kept as words, which is a few kB."""
        self.results.mkdir(parents=True, exist_ok=True)
        with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": name, "font.family": "sans-serif"}):
            figure.savefig(self.results / f"{name}.svg", metadata={"Date": None})
        plt.close(figure)

    def keep(self, name, head, rows):
        """Writes a table as NAME.csv beside the page, empty where there is no figure. Returns what the page says of it."""
        rows = [["" if cell in ("–", None) else str(cell) for cell in row] for row in rows]
        self.results.mkdir(parents=True, exist_ok=True)
        with (self.results / f"{name}.csv").open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([head, *rows])
        return f"[{name}.csv]({name}.csv) ({len(rows)} rows)"

    def write(self, title, *parts):
        """README.md of the results: what the study says, then the conditions. Long tables (`keep`) and the first command are files beside it."""
        commit = commit_of(ROOT)
        command = " ".join(self.sample).replace(f"{ROOT.parent}/", "../").replace(f"../{ROOT.name}/", "")
        end = ["## Conditions", f"`benchmarks/study/study.py {self.name}{' --quick' if self.quick else ''}`, renderer built at "
               f"`{commit}`, {time.strftime('%Y-%m-%d')}, {machine()}, load {os.getloadavg()[1]:.1f} in the last 5 minutes; "
               f"{self.spent / 60:.1f} CPU minutes of renders, one thread each unless a table says else; the first of them: [command.sh](command.sh)."]
        self.results.mkdir(parents=True, exist_ok=True)
        (self.results / "command.sh").write_text(f"{quoted(command)}\n")
        file = self.results / "README.md"
        file.write_text("\n\n".join([f"# {title}", *parts, *end]) + "\n")
        print(file)


def commit_of(root):
    """The commit, and whether the renderer's sources differ from it: results are written before they are committed."""
    def git(*words):
        return subprocess.run(["git", "-C", root, *words], capture_output=True, text=True).stdout.strip()

    return git("rev-parse", "--short", "HEAD") + ("-dirty" if git("status", "--porcelain", "--", "src", "tungsten") else "")


def quoted(command):
    return " ".join(f"'{word}'" if set(word) & set('{}"[') else word for word in command.split(" "))


def cpu_used(pid):
    """Seconds of processor time, user and system, of a running process."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run_for(command, cpu=None, first=None):
    """Runs the renderer; asks it to write what it has once it has used `cpu` seconds of processor time and its first pass
    has left the file `first`."""
    # The shell forks: a child that Python starts itself would report Python's own peak memory as the least of its own.
    shell = subprocess.Popen(["/bin/sh", "-c", '"$@" >/dev/null & echo $!; wait $!', "sh", *command], stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True)
    pid, asked = int(shell.stdout.readline()), cpu is None
    try:
        while shell.poll() is None:
            if not asked and cpu_used(pid) >= cpu and first.exists():
                os.kill(pid, signal.SIGTERM)
                asked = True
            time.sleep(0.02)
    except BaseException:
        os.kill(pid, signal.SIGKILL)
        raise
    messages = shell.stderr.read()
    if shell.returncode != 0:
        raise StudyError(f"{' '.join(command)}: exit code {shell.returncode}: {messages.strip()}")


def table(head, rows):
    """Markdown."""
    return "\n".join("| " + " | ".join(str(cell) for cell in row) + " |" for row in [head, ["---"] * len(head), *rows])


def plain_log(axis, decades=1.5):
    """A logarithmic axis with few labels that can be read: powers of ten, or below so many decades 1, 2 and 5."""
    low, high = axis.get_view_interval()
    if high / low < 10**decades:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low > 3 else (1, 1.5, 2, 3, 5, 7)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def panels(count=1, width=4.2, height=3.4):
    """A figure and its axes, side by side."""
    figure, axes = plt.subplots(1, count, figsize=(width * count, height), constrained_layout=True, squeeze=False)
    for one in axes[0]:
        one.grid(which="both", color="0.92")
        one.tick_params(labelsize=8)
    return figure, list(axes[0])
