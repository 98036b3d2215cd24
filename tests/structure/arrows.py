#!/usr/bin/python3
"""Includes point one way: which folders may include which. Exits with 1 and names every include that does not."""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]

# A folder of the host may include itself and these.
MODELS = {"geometry", "texture", "bsdf", "medium", "emitter", "camera"}
SCENE = {"core", "reader", "image", "film", "scene", *MODELS}
HOST = {
    "core": set(),
    "reader": {"core"},
    "image": {"core"},
    "film": {"core", "image"},
    "geometry": {"core", "reader"},
    "texture": {"core", "reader", "image"},
    "bsdf": {"core", "reader", "texture"},
    "medium": {"core", "reader"},
    "camera": {"core", "reader"},
    "emitter": {"core", "reader", "geometry", "texture"},
    "scene": SCENE - {"scene"},
    "integrator": SCENE,
    "io": SCENE,
    "session": SCENE | {"integrator", "io"},
    "app": SCENE | {"integrator", "io", "session"},
    "python": SCENE | {"integrator", "io", "session"},
    "mpi": {"core", "session"},
}
# What per-ray code sees of the host: neither sessions nor files.
INTEGRATOR = {"tungsten/" + folder for folder in SCENE | {"integrator"}}
# A folder may include itself, and these.
FOLDERS = {
    **{"tungsten/" + folder: {"tungsten/" + other for other in others} for folder, others in HOST.items()},
    "src/darts": set(),
    "src/transport": {"src/darts"} | INTEGRATOR,
    "src/photon": {"src/darts", "src/transport"} | INTEGRATOR,
    "src/path": {"src/darts", "src/transport"} | INTEGRATOR,
}
# Inside the photon plugin: each folder may include the ones before it.
PHOTON = ["view", "raster", "store", "primitives", "surface", "light"]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def folder_of(include):
    for folder in FOLDERS:
        if include.startswith(folder.removeprefix("src/") + "/"):
            return folder
    return None


def circles():
    """Folders that reach themselves through what they may include."""
    for folder in FOLDERS:
        reached, found = set(), set(FOLDERS[folder])
        while found - reached:
            reached |= found
            found = set().union(*(FOLDERS[other] for other in reached))
        if folder in reached:
            yield f"{folder} may include what includes it"


def violations():
    for top in ("tungsten", "src"):
        for folder in sorted(path for path in (PROJECT / top).iterdir() if path.is_dir()):
            name = f"{top}/{folder.name}"
            sources = sorted(file for file in folder.rglob("*") if file.suffix in {".h", ".cpp"})
            if sources and name not in FOLDERS:
                yield f"{name}: no row says what it may include"
            for file in sources if name in FOLDERS else []:
                yield from file_violations(file, name)


def file_violations(file, folder):
    name = file.relative_to(PROJECT)
    for include in INCLUDE.findall(file.read_text()):
        target = folder_of(include)
        if include.startswith("tungsten/") and not target:
            yield f"{name}: no row is of {include}"
        if target and target != folder and target not in FOLDERS[folder]:
            yield f"{name}: {folder} must not include {include}"
        if folder == target == "src/photon":
            yield from photon_violations(name, include)


def photon_violations(name, include):
    """Settings and plan, at the root, are known everywhere."""
    if include.count("/") < 2 or len(name.parts) < 4:
        return
    rank = {folder: i for i, folder in enumerate(PHOTON)}
    if rank[include.split("/")[1]] > rank[name.parts[2]]:
        yield f"{name}: photon/{name.parts[2]} must not include {include}"


found = [*circles(), *violations()]
print("\n".join(found))
sys.exit(bool(found))
