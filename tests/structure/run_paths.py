#!/usr/bin/python3
"""run_paths.py FOLDER...: where the loader looks for the libraries of every binary there. Exits with 1 and names each whose RPATH or RUNPATH
has an entry that depends on the current folder (an empty one is that folder), or if there is no binary in a folder."""

import re
import subprocess
import sys
from pathlib import Path


def binaries(folder):
    for file in sorted(folder.rglob("*")):
        if file.is_file() and not file.is_symlink() and file.suffix != ".o" and "CMakeFiles" not in file.parts:
            with file.open("rb") as content:
                if content.read(4) == b"\x7fELF":
                    yield file


def of_current_folder(entries):
    return [entry for entry in entries if not re.match(r"/|\$ORIGIN(/|$)", entry)]


def entries_of(file):
    dynamic = subprocess.run(["readelf", "--dynamic", "--wide", file], capture_output=True, text=True, check=True).stdout
    return [entry for paths in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", dynamic) if paths for entry in paths.split(":")]


assert of_current_folder("$ORIGIN/../lib:$ORIGIN:/opt/lib::lib:.:$ORIGINAL:".split(":")) == ["", "lib", ".", "$ORIGINAL", ""]
wrong, seen = [], 0
for folder in map(Path, sys.argv[1:]):
    files = list(binaries(folder))
    if not files:
        wrong.append(f"{folder}: no binaries")
    for file in files:
        paths = entries_of(file)
        seen += bool(paths)
        if of_current_folder(paths):
            wrong.append(f"{file}: libraries of the current folder are loaded: {':'.join(paths)}")
if not seen:
    wrong.append("no binary has a RUNPATH: is readelf understood?")
sys.exit("\n".join(wrong) or 0)
