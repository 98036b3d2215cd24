#!/usr/bin/python3
"""The package's copyright file names whatever is compiled into it: every Debian package that it is built from and every header of
others that the source includes. Exits with 1 and names what is missing."""

import re
import subprocess
import sys
from fnmatch import fnmatch
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]

# Tools, and C libraries that are linked when a program starts: nothing of them is in the package.
LINKED = {"g++", "cmake", "ninja-build", "zlib1g-dev", "libminizip-dev", "libhdf5-dev", "python3-dev", "python3-numpy"}
LINKED_HEADERS = ["zlib.h", "minizip/*", "hdf5.h", "hdf5_hl.h", "Python.h", "mpi.h"]
SYSTEM_HEADERS = ["*intrin.h", "sys/*", "ext/*", "dlfcn.h", "fcntl.h", "link.h", "malloc.h", "pthread.h", "sched.h", "signal.h", "spawn.h", "unistd.h"]


def paragraphs(text):
    """Of a Debian copyright file, each a dict of its fields."""
    for part in re.split(r"\n\s*\n", text.strip()):
        fields = re.findall(r"^([A-Z][A-Za-z-]*): *(.*(?:\n[ \t].*)*)", part, flags=re.M)
        yield dict(fields)


def packages():
    """What the scripts install to build the renderer and Python's modules."""
    lists = 'echo "${renderer_packages[@]}" "${python_packages[@]}"'
    return subprocess.run(["bash", "-c", f". scripts/packages.sh; {lists}"], cwd=PROJECT, check=True, capture_output=True, text=True).stdout.split()


def included_headers():
    """Of others, by system includes with a folder or an ending."""
    found = {}
    for folder in ("tungsten", "src"):
        for file in sorted((PROJECT / folder).rglob("*")):
            if file.suffix in (".h", ".cpp"):
                for header in re.findall(r"^#include <([^>]*[/.][^>]*)>", file.read_text(), flags=re.M):
                    found.setdefault(header, file.relative_to(PROJECT))
    return found


def missing(text, needed, headers, folders):
    """What the text of a copyright file lacks, a line each."""
    all_of = list(paragraphs(text))
    if not all_of or "copyright-format/1.0" not in all_of[0].get("Format", ""):
        return ["it does not begin with Debian's format"]
    files = [one for one in all_of if "Files" in one]
    texts = {one["License"].split("\n")[0].strip() for one in all_of if "Files" not in one and "\n" in one.get("License", "")}
    patterns = [pattern for one in files for pattern in one["Files"].split() if pattern != "*"]
    comments = set(re.findall(r"[a-z0-9+.-]+", " ".join(one.get("Comment", "") for one in files)))
    told = [f"'{one['Files']}' has no {field}" for one in files for field in ("Copyright", "License") if not one.get(field)]
    used = {name for one in files for name in re.split(r" and | or ", one.get("License", "").split("\n")[0]) if name}
    told += [f"the licence {name} has no text" for name in sorted(used - texts)]
    told += [f"no notice of {name}, which the package is built from" for name in needed if name not in LINKED and name not in comments]
    told += [f"no notice of <{header}>, which {where} includes" for header, where in headers.items()
             if not any(fnmatch(header, pattern) for pattern in patterns + LINKED_HEADERS + SYSTEM_HEADERS)]
    return told + [f"no notice of {folder}, which has a licence of its own" for folder in folders
                   if not any(pattern == f"{folder}/*" for pattern in patterns)]


def main():
    text = (PROJECT / "scripts/copyright").read_text()
    folders = [str(file.parent.relative_to(PROJECT)) for room in ("tungsten", "src") for file in (PROJECT / room).rglob("LICENSE*")]
    told = missing(text, packages(), included_headers(), folders)
    for line in told:
        print(f"scripts/copyright: {line}")
    # What is not named is found.
    assert missing(text, ["libeigen3-dev"], {}, []) == ["no notice of libeigen3-dev, which the package is built from"]
    assert missing(text, [], {"Eigen/Dense": "a.cpp"}, []) == ["no notice of <Eigen/Dense>, which a.cpp includes"]
    assert missing(text.replace("rapidjson-dev", ""), packages(), {}, []) == ["no notice of rapidjson-dev, which the package is built from"]
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
