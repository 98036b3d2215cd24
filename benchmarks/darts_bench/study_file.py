"""Study files: which scenes, methods, times and seeds are compared. Read, completed and checked before anything runs."""

import json
from dataclasses import dataclass, field
from pathlib import Path

from darts_bench.run import BenchError


@dataclass(frozen=True)
class PublishedFigures:
    """Figures of another implementation, kept as data with their source."""

    source: str
    seconds: float
    threads: int
    rows: list  # of {"method", and any of "passes", "std", "bias", "bias_below", "mean_ratio", "memory_mb"}

    def row(self, method):
        return next((row for row in self.rows if row["method"] == method), None)


@dataclass(frozen=True)
class Scene:
    name: str
    path: Path
    resolution: tuple  # width, height
    reference: Path
    gate: tuple | None = None  # start and end of the time gate
    reference_block_variance: float | None = None  # None: from NAME.blockvar, or from an EXR's stderr layer
    files: dict = field(default_factory=dict)  # method name -> scene file, where it is not `path`
    overrides: dict = field(default_factory=dict)  # method name, or "*" for all -> list of --set values
    skip: dict = field(default_factory=dict)  # method name -> why it has no result here
    reference_by: "Method | None" = None  # renders the reference
    published: PublishedFigures | None = None


@dataclass(frozen=True)
class Method:
    name: str
    overrides: tuple = ()  # --set values, after those of the scene
    lineage: tuple = ()  # its own name and those of its bases, nearest first: they select a scene's files and overrides
    published: str | None = None  # row of the scene's published figures it is compared with
    scenes: tuple | None = None  # None: all
    swept: tuple | None = None  # parameter's name, value and the method swept
    may_refuse: tuple = ()  # fields: where the renderer refuses one of them the method is impossible, not failed


@dataclass(frozen=True)
class Study:
    name: str
    title: str
    scenes: list
    methods: list
    baseline: str
    seconds: list
    threads: int
    seeds: int
    block: int
    limit_seconds: float | None
    bias: bool = False  # renders estimate what their kernels leave, which takes time

    def methods_of(self, scene):
        return [method for method in self.methods
                if (method.scenes is None or scene.name in method.scenes) and reason_to_skip(scene, method) is None]

    def left_out(self):
        """(scene, method, reason) of what the study itself does not ask for."""
        return [(scene, method, reason) for scene in self.scenes for method in self.methods
                if (reason := reason_to_skip(scene, method)) is not None]


def reason_to_skip(scene, method):
    """Why the scene does not ask for the method, given for it or one of its bases; None if it does."""
    return next((scene.skip[name] for name in method.lineage if name in scene.skip), None)


STUDY_KEYS = {"title", "include", "scenes", "methods", "sweeps", "baseline", "seconds", "threads", "seeds", "block",
              "limit_seconds", "definitions", "bias"}
SCENE_KEYS = {"name", "base", "path", "resolution", "gate", "reference", "reference_block_variance", "files", "set",
              "published", "skip", "reference_by"}
METHOD_KEYS = {"name", "base", "set", "published", "scenes", "may_refuse"}
SWEEP_KEYS = {"parameter", "set", "methods", "values"}
FIGURE_KEYS = {"method", "passes", "std", "bias", "bias_below", "mean_ratio", "memory_mb"}


def _require(condition, where, message):
    if not condition:
        raise BenchError(f"{where}: {message}")


def _check_keys(block, known, where):
    _require(isinstance(block, dict), where, "expected an object {...}")
    unknown = sorted(set(block) - known)
    _require(not unknown, where, f"unknown field '{', '.join(unknown)}'; known: {', '.join(sorted(known))}")


def _load(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise BenchError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise BenchError(f"{path}: not text in UTF-8: {error.reason}") from error
    except json.JSONDecodeError as error:
        raise BenchError(f"{path}: not JSON: {error}") from error


def _definitions(study, path):
    """Scenes and methods by name: those of the included files, then the study's own."""
    found = {"scenes": {}, "methods": {}}
    blocks = [(_load(path.parent / name).get("definitions", {}), path.parent / name) for name in study.get("include", [])]
    blocks.append((study.get("definitions", {}), path))
    for block, source in blocks:
        _check_keys(block, {"scenes", "methods"}, f"{source}: definitions")
        for kind, keys in (("scenes", SCENE_KEYS), ("methods", METHOD_KEYS)):
            for entry in block.get(kind, []):
                _check_keys(entry, keys, f"{source}: {kind}")
                _require("name" in entry, source, f"an entry of {kind} has no name")
                found[kind][entry["name"]] = entry
    return found


def _chain(entry, known, where):
    """The entry and its bases, nearest first."""
    chain = [entry]
    while "base" in chain[-1]:
        base = chain[-1]["base"]
        _require(base in known and len(chain) <= len(known), where, f"'{base}' (base of '{chain[-1]['name']}') is not defined")
        chain.append(known[base])
    return chain


def _select(entries, known, keys, where):
    """Names are looked up, objects taken as they are."""
    chosen = []
    for entry in entries:
        if isinstance(entry, str):
            _require(entry in known, where, f"'{entry}' is not defined; defined: {', '.join(known) or 'nothing'}")
            entry = known[entry]
        _check_keys(entry, keys, where)
        _require("name" in entry, where, "an entry has no name")
        chosen.append(entry)
    names = [entry["name"] for entry in chosen]
    _require(len(set(names)) == len(names), where, "two entries have the same name")
    _require(names, where, "nothing to compare")
    return chosen


def _published(block, where):
    if block is None:
        return None
    _check_keys(block, {"source", "seconds", "threads", "rows"}, where)
    _require(block.keys() >= {"source", "seconds", "threads", "rows"}, where, "source, seconds, threads and rows are needed")
    for row in block["rows"]:
        _check_keys(row, FIGURE_KEYS, where)
        _require("method" in row, where, "a row names no method")
    return PublishedFigures(block["source"], float(block["seconds"]), int(block["threads"]), block["rows"])


def _scene(entry, known, methods, root, where):
    merged = {}
    for link in reversed(_chain(entry, known, where)):
        merged.update(link)
    where = f"{where}: scene '{merged['name']}'"
    for key in ("path", "resolution", "reference"):
        _require(key in merged, where, f"'{key}' is missing")
    gate = merged.get("gate")
    _require(gate is None or (len(gate) == 2 and gate[0] < gate[1]), where, "'gate' is [start, end]")
    path, files = root / merged["path"], {name: root / file for name, file in merged.get("files", {}).items()}
    reference = root / merged["reference"]
    for file in [path, *files.values()]:
        _require(file.is_file(), where, f"there is no file {file}")
    overrides = merged.get("set", {})
    _require(isinstance(overrides, dict), where, "'set' maps method names, or \"*\" for all, to lists of overrides")
    skip = merged.get("skip", {})
    _require(isinstance(skip, dict) and all(isinstance(reason, str) and reason for reason in skip.values()), where,
             "'skip' maps method names to reasons")
    by = merged.get("reference_by")
    _require(by is None or by in methods, where, f"'{by}' (reference_by) is not defined")
    return Scene(merged["name"], path, tuple(merged["resolution"]), reference, tuple(gate) if gate else None,
                 merged.get("reference_block_variance"), files, overrides, skip,
                 _method(methods[by], methods, where) if by else None, _published(merged.get("published"), where))


def _method(entry, known, where):
    chain = _chain(entry, known, where)
    overrides = [value for link in reversed(chain) for value in link.get("set", [])]
    lineage = tuple(link["name"] for link in chain)
    published = next((link["published"] for link in chain if "published" in link), lineage[-1])
    scenes = entry.get("scenes")
    fields = next((link["may_refuse"] for link in chain if "may_refuse" in link), [])
    _require(isinstance(fields, list), f"{where}: method '{entry['name']}'", "'may_refuse' is a list of fields")
    return Method(entry["name"], tuple(overrides), lineage, published, tuple(scenes) if scenes else None,
                  may_refuse=tuple(fields))


def _sweep(sweep, methods, where):
    """One method per scene and value of the parameter, named after the (first) value."""
    _require(sweep.keys() >= SWEEP_KEYS, where, f"a sweep needs {', '.join(sorted(SWEEP_KEYS))}")
    swept = []
    for method in methods:
        for scene, values in sweep["values"].items():
            for value in values:
                parts = value if isinstance(value, list) else [value]
                name = f"{method.name}, {sweep['parameter']} {parts[0]:g}"
                overrides = method.overrides + tuple(text.format(*parts) for text in sweep["set"])
                swept.append(Method(name, overrides, (name, *method.lineage), method.published, (scene,),
                                    (sweep["parameter"], float(parts[0]), method.name), method.may_refuse))
    return swept


def _whole(study, key, default, where):
    value = study.get(key, default)
    _require(isinstance(value, int) and value >= 1, where, f"'{key}' is a whole number of at least 1")
    return value


def _methods(study, known, scenes, where):
    """The methods named, then those of the sweeps."""
    def chosen(entries):
        return [_method(entry, known, where) for entry in _select(entries, known, METHOD_KEYS, where)]

    sweeps = study.get("sweeps", [])
    methods = chosen(study.get("methods", [])) if study.get("methods") or not sweeps else []
    for sweep in sweeps:
        _check_keys(sweep, SWEEP_KEYS, where)
        methods += _sweep(sweep, chosen(sweep.get("methods", [])), where)
    names = {scene.name for scene in scenes}
    for method in methods:
        _require(set(method.scenes or ()) <= names, where, f"method '{method.name}' names a scene that is not compared")
    known_names = {name for method in methods for name in method.lineage}
    for scene in scenes:
        unknown = sorted(set(scene.skip) - known_names)
        _require(not unknown, where, f"scene '{scene.name}' skips '{', '.join(unknown)}', which is not compared")
    return methods


def missing_references(study):
    """Messages about scenes whose reference is not there. Not needed to list a study."""
    return [f"scene '{scene.name}': there is no reference {scene.reference}" + ("; the action 'references' renders it" if scene.reference_by else "")
            for scene in study.scenes if not scene.reference.is_file()]


def require_references(study):
    """Before anything is rendered."""
    for message in missing_references(study):
        raise BenchError(message)


def load_study(path, root):
    """Reads a study; paths of scenes and references are relative to the folder `root`, included files to the study."""
    path, where = Path(path), str(path)
    study = _load(path)
    _check_keys(study, STUDY_KEYS, where)
    known = _definitions(study, path)
    scenes = [_scene(entry, known["scenes"], known["methods"], Path(root), where)
              for entry in _select(study.get("scenes", []), known["scenes"], SCENE_KEYS, where)]
    methods = _methods(study, known["methods"], scenes, where)
    baseline = study.get("baseline", methods[0].name)
    _require(baseline in {method.name for method in methods}, where, f"the baseline '{baseline}' is not among the methods")
    seconds = study.get("seconds", 30)
    seconds = sorted(seconds) if isinstance(seconds, list) else [seconds]
    _require(seconds and seconds[0] > 0, where, "'seconds' is a positive number, or a list of them")
    block = _whole(study, "block", 8, where)
    for scene in scenes:
        _require(all(side % block == 0 for side in scene.resolution), where, f"scene '{scene.name}': blocks of {block} pixels "
                 f"('block') do not divide {scene.resolution[0]} x {scene.resolution[1]}")
    _require(isinstance(study.get("bias", False), bool), where, "'bias' is true or false")
    return Study(path.stem, study.get("title", path.stem), scenes, methods, baseline, seconds, _whole(study, "threads", 2, where),
                 _whole(study, "seeds", 3, where), block, study.get("limit_seconds"), study.get("bias", False))
