"""Renders small scenes unlike the shipped ones by plain and guided points, beams and paths, and copies of them in other units
or turned and moved as a whole: all must agree.

--slices: planes, volumes, balls and hypervolumes, in scenes for them, against paths and beams. Writes FOLDER/SWEEP.md (SLICES.md)
with its figures beside it, SWEEP-scenes.csv and SWEEP-methods.csv; exits with 1 if anything disagrees. Renders are kept in FOLDER: an
interrupted sweep goes on with the same command, and only what changed is rendered again. Seeds are fixed.
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agreement.sweep_scenes import FAST, all_scenes
from agreement.sweep_slices import SLICE_FAST, slice_scenes
from darts_bench.measures import Samples, compare, compare_pairs, means, without_kernel
from darts_bench.run import BenchError, add_renderer, build_of, checked, content_key, read_film, require_renderer, workers
from darts_bench.scene_words import write_assets
from darts_bench.sweep_copies import moved, scaled
from darts_bench.sweep_report import INTRODUCTION, SLICES_INTRODUCTION, report, scene_row, tables

SEEDS = 8
LIMIT_SECONDS = 300    # for one render
COARSE, FINE = 1.0, 0.5  # parts of the scene's kernel radius


# ---- What scenes are rendered with

@dataclass(frozen=True)
class Method:
    name: str
    settings: dict
    samples: int     # per pixel of a path tracer, passes of a photon map
    photons: int = 0  # light paths per pass; 0: not a photon map

    @property
    def guided(self):
        return self.settings["darts"] != "off"

    @property
    def primitive(self):
        return self.settings.get("volume_photon_type")

    @property
    def sliced(self):
        return self.primitive not in (None, "points", "beams")

    def blurs(self, scene):
        """Whether a kernel's radius counts."""
        return self.photons > 0 and (not scene.blurred or self.primitive in scene.blurred)

    @property
    def steady(self):
        """Whether it can do without a gate, where there is nothing to guide light paths to."""
        return not self.guided and (not self.sliced or self.primitive in ("planes", "volumes"))


def photon_method(name, primitive, darts, passes, photons):
    settings = {"type": "photons", "volume_photon_type": primitive, "darts": darts, "alpha": 1.0, "volume_alpha": 1.0,
                "fixed_volume_radius": True, "gather_photon_count": 1000000, "volume_photon_count": 100000000}
    return Method(name, settings, passes, photons)


METHODS = [
    Method("plain paths", {"type": "path_tracer", "darts": "off"}, 512),
    Method("best paths", {"type": "path_tracer", "darts": "best"}, 96),
    photon_method("plain points", "points", "off", 4, 50000),
    photon_method("best points", "points", "best", 4, 6000),
    photon_method("plain beams", "beams", "off", 4, 12000),
    photon_method("best beams", "beams", "best", 4, 3000),
]

# Sliced primitives, and what they are held against: camera paths and beams. volumes_balls are what volumes are at a gate.
SLICE_METHODS = [
    Method("plain paths", {"type": "path_tracer", "darts": "off"}, 192),
    Method("best paths", {"type": "path_tracer", "darts": "best"}, 32),
    photon_method("best beams", "beams", "best", 4, 2500),
    *[photon_method(f"{prefix} {kind}", kind, darts, 4, count) for kind in
      ("planes", "volumes", "balls", "mis_volumes_balls", "hypervolumes")
      for prefix, darts, count in (("plain", "off", 1500), ("best", "best", 400))],
]

# Copies, and the seeds that they begin after. Scaled copies use the original's random numbers, with which they can be compared
# closely; moved ones, whose directions differ in any case, their own.
COPIES = {"original": (lambda scene: scene, 0), "scaled": (lambda scene: scaled(scene, 7.0, 3.0), 0), "moved": (moved, 100)}


@dataclass(frozen=True)
class Sweep:
    """What is rendered how, and the name of its page."""
    name: str
    introduction: str
    scenes: list
    fast: tuple
    methods: list
    copies: tuple = tuple(COPIES)


def sweep_of(options):
    if options.slices:
        return Sweep("SLICES", SLICES_INTRODUCTION, slice_scenes(), SLICE_FAST, SLICE_METHODS, ("original",))
    return Sweep("SWEEP", INTRODUCTION, all_scenes(), FAST, METHODS)


def methods_of(scene, methods):
    return [m for m in methods if m.name not in scene.without and (m.steady or not scene.steady)]


def photon_map(scene):
    return "progressive_photon_map" if scene.steady else "progressive_transient_photon_map"


def scene_json(scene, method, radius, effort=1.0):
    """The scene file's content; `effort` multiplies the samples or light paths."""
    effort *= scene.effort.get(method.name, 1.0)
    integrator = {**scene.integrator, **method.settings}
    samples = method.samples
    if method.photons:
        integrator.update({"type": scene.integrator.get("photon_map", photon_map(scene)), "gather_radius": radius,
                           "volume_gather_radius": radius, "photon_count": int(method.photons * effort)})
    else:
        samples = max(1, int(samples * effort))
    integrator.pop("photon_map", None)
    if not method.sliced:
        integrator.pop("delta_time_gate", None)
    if method.photons:
        integrator.pop("enable_rr", None)
    if integrator.pop("single_frames", False) and method.guided:
        integrator["darts"] = {"preset": integrator["darts"], "single_frames": True}
    return {"media": scene.media, "primitives": scene.primitives, "camera": scene.camera, "integrator": integrator,
            "renderer": {"spp": samples, "spp_step": 1 if method.photons else samples, **scene.renderer}}


class Renderer:
    """Renders scene files once and remembers their means, for one build of the renderer."""

    def __init__(self, tungsten, folder):
        self.tungsten, self.folder, self.build, self.messages = tungsten, folder, build_of(tungsten), set()

    def store(self, name, content):
        """Keeps a scene file under a name."""
        text = json.dumps(content, indent=1, default=lambda value: value.ravel().tolist())
        self._scene(name).write_text(text)

    def means(self, names, seed):
        """Of each of some stored scenes, rendered with one seed: means, frames, and the processor's seconds. What is not kept yet is
        rendered by one process, since starting takes longer than a small render. Throws BenchError with the renderer's message."""
        keys = {name: self._key(name, seed) for name in names}
        missing = [name for name in names if not self._kept(keys[name]).exists()]
        if missing:
            self._render([(name, keys[name]) for name in missing], seed)
        found = []
        for name in names:
            with np.load(self._kept(keys[name])) as stored:
                self.messages.update((name, str(message)) for message in stored["messages"])
                found.append((stored["means"], int(stored["frames"]), float(stored["seconds"])))
        return found

    def _scene(self, name):
        return self.folder / "scenes" / f"{name}.json"

    def _key(self, name, seed):
        return content_key([self.build, seed], self._scene(name))

    def _kept(self, key):
        return self.folder / "renders" / f"{key}.npz"

    def _render(self, due, seed):
        folder, files = self.folder / "renders", []
        for name, key in due:
            content = json.loads(self._scene(name).read_text())
            content["renderer"] |= {"output_file": f"{key}.png", "hdr_output_file": f"{key}.film.npz"}
            files.append(folder / f"{key}.scene.json")
            files[-1].write_text(json.dumps(content))
        said = checked([self.tungsten, "--quiet", "--allow-outside", "-t", "1", "-s", seed, "-d", folder, *files], limit=LIMIT_SECONDS * len(due))
        lines, before = [line for line in said.splitlines() if line.strip()], 0.0
        for i, (name, key) in enumerate(due):
            film = read_film(folder / f"{key}.film.npz")
            until = film.statistics["process CPU seconds"]
            # What names no scene is the first one's.
            messages = [line for line in lines if key in line or i == 0 and not any(other in line for _, other in due)]
            messages = [line.replace(f"{key}.scene.json", f"{name}.json") for line in messages]
            np.savez(folder / f"{key}.part.npz", means=means(film.mean), frames=len(film.mean), seconds=until - before,
                     messages=np.array(messages, str))
            (folder / f"{key}.part.npz").replace(self._kept(key))
            before = until
            for ending in ("film.npz", "png", "scene.json"):
                (folder / f"{key}.{ending}").unlink()


def render_scene(scene, sweep, effort, renderer, pool):
    """Samples of every method: all copies together, and copies by name; with the seconds that each method took."""
    wanted = {}  # by seed: what is rendered with it
    for copy in sweep.copies:
        change, first = COPIES[copy]
        changed = change(scene)
        for method in methods_of(scene, sweep.methods):
            for part in (COARSE, FINE) if method.blurs(scene) else (FINE,):
                name = f"{scene.name}-{copy}-{method.name.replace(' ', '-')}{'-coarse' if part == COARSE else ''}"
                renderer.store(name, scene_json(changed, method, part * changed.radius, effort))
                for seed in range(first + 1, first + SEEDS + 1):
                    wanted.setdefault(seed, {})[copy, method.name, part, seed - first] = name
    jobs = {seed: pool.submit(renderer.means, list(names.values()), seed) for seed, names in wanted.items()}
    results = {key: result for seed, names in wanted.items() for key, result in zip(names, jobs[seed].result())}
    return {method.name: gathered(method, scene, {key: result for key, result in results.items() if key[1] == method.name})
            for method in methods_of(scene, sweep.methods)}


def gathered(method, scene, results):
    """One method's samples by copy, those of all copies with random numbers of their own, and the processor's seconds."""
    copies = {copy: samples_of(copy, method, scene, results) for copy in dict.fromkeys(key[0] for key in results)}
    apart = [samples for copy, samples in copies.items() if copy != "scaled"]
    together = Samples([group for samples in apart for group in samples.groups], sum(samples.blur for samples in apart) / len(apart),
                       apart[0].frames)
    return copies, together, sum(seconds for _, _, seconds in results.values())


def samples_of(copy, method, scene, results):
    def renders(part):
        return np.array([results[copy, method.name, part, seed][0] for seed in range(1, SEEDS + 1)])

    frames = results[copy, method.name, FINE, 1][1]
    if not method.blurs(scene):
        return Samples([renders(FINE)], np.zeros_like(renders(FINE)[0]), frames)
    return Samples(*without_kernel(renders(FINE), renders(COARSE)), frames)


def compare_scene(rendered, references):
    """All comparisons: of methods with references, and of copies with the originals."""
    names = list(rendered)
    methods = {(a, b): compare(rendered[a][1], rendered[b][1])
               for i, a in enumerate(names) if a in references for b in names[i + 1:]}
    copies = {}
    for name, (by_copy, _, _) in rendered.items():
        if "scaled" in by_copy:
            copies[name, "scaled"] = compare_pairs(by_copy["original"], by_copy["scaled"])
        if "moved" in by_copy:
            copies[name, "moved"] = compare(by_copy["original"], by_copy["moved"])
    return methods, copies


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="bench.py sweep", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    add_renderer(parser)
    parser.add_argument("--slices", action="store_true", help="sliced primitives against paths and beams")
    parser.add_argument("--fast", action="store_true", help="a handful of scenes, for the tests")
    parser.add_argument("--scenes", nargs="+", default=[], metavar="NAME", help="those whose names hold one of these")
    parser.add_argument("--effort", type=float, help="factor on all samples and light paths (1; fast: 0.07)")
    parser.add_argument("--jobs", type=int, default=2, help="renders at a time, one thread each (2)")
    options = parser.parse_args(arguments)
    require_renderer(options.tungsten)
    options.effort = options.effort or (0.07 if options.fast else 1.0)
    return options


def chosen(sweep, options):
    scenes = [scene for scene in sweep.scenes if scene.name in sweep.fast] if options.fast else sweep.scenes
    return [s for s in scenes if not options.scenes or any(part in s.name for part in options.scenes)]


def main(arguments):
    options = parse_arguments(arguments)
    sweep = sweep_of(options)
    for name in ("scenes", "renders"):
        (options.folder / name).mkdir(parents=True, exist_ok=True)
    write_assets(options.folder / "assets")
    renderer = Renderer(options.tungsten, options.folder.resolve())
    references = [method.name for method in sweep.methods if not method.sliced]
    results, failures = {}, {}

    def write():
        text, agree = report(sweep.name, sweep.introduction, results, failures, renderer.messages)
        for name, content in {f"{sweep.name}.md": text, **tables(sweep.name, results)}.items():
            (options.folder / name).write_text(content)
        return agree

    with workers(options.jobs) as pool:
        for scene in chosen(sweep, options):
            try:
                rendered = render_scene(scene, sweep, options.effort, renderer, pool)
            except BenchError as error:
                failures[scene.name] = str(error)
                print(f"{scene.name}: {error}", flush=True)
                continue
            results[scene.name] = (scene, rendered, *compare_scene(rendered, references))
            write()
            print(*scene_row(*results[scene.name]), sep=", ", flush=True)
    return 0 if write() else 1
