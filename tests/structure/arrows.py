#!/usr/bin/python3
"""Includes point one way: which rooms may include which. Exits with 1 and names every include that does not."""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]

# A room may include itself, and these.
ROOMS = {
    "tungsten": set(),
    "src/darts": set(),
    "src/transport": {"tungsten", "src/darts"},
    "src/photon": {"tungsten", "src/darts", "src/transport"},
    "src/path": {"tungsten", "src/darts", "src/transport"},
}
# Inside the photon plugin: each folder may include the ones before it.
PHOTON = ["view", "raster", "store", "primitives", "surface", "light"]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def room_of(include):
    for room in sorted(ROOMS, key=len, reverse=True):
        if include.startswith(room.removeprefix("src/") + "/"):
            return room
    return None


def violations():
    for room, allowed in ROOMS.items():
        for file in sorted((PROJECT / room).rglob("*")):
            if file.suffix not in {".h", ".cpp"}:
                continue
            name = file.relative_to(PROJECT)
            if room_of(str(name).removeprefix("src/")) != room:
                continue
            for include in INCLUDE.findall(file.read_text()):
                target = room_of(include)
                if target and target != room and target not in allowed:
                    yield f"{name}: {room} must not include {include}"
                if room == target == "src/photon":
                    yield from photon_violations(name, include)


def photon_violations(name, include):
    """Settings and plan, at the root, are known everywhere."""
    if include.count("/") < 2 or len(name.parts) < 4:
        return
    rank = {folder: i for i, folder in enumerate(PHOTON)}
    if rank[include.split("/")[1]] > rank[name.parts[2]]:
        yield f"{name}: photon/{name.parts[2]} must not include {include}"


found = list(violations())
print("\n".join(found))
sys.exit(bool(found))
