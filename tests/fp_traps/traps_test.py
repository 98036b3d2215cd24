#!/usr/bin/python3
"""Every place that divides by zero or computes what is no number is known, with a reason (known.txt). Runs unit tests, the hard scenes,
those of the plan, and small renders of every integrator and primitive with a library loaded before that traps them in all threads:
traps_test.py LIBRARY BINARIES. `--list` prints all places."""

import argparse
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
UNIT_TESTS = ["medium_tests", "bsdf_tests", "emitter_tests", "camera_tests", "transport_tests"]


def run(arguments, traces):
    """Unit tests, then scenes by a command that stands for the renderer."""
    for test in UNIT_TESTS:
        binary = arguments.binaries / test
        if binary.exists():
            environment = {**os.environ, "FP_TRAPS": str(traces), "LD_PRELOAD": str(arguments.library)}
            done = subprocess.run([str(binary), "--gtest_brief=1"], env=environment, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{test} fails under traps:\n{done.stdout[-2000:]}")
    command = traces.with_name("tungsten")
    command.write_text(f'#!/bin/sh\nFP_TRAPS={traces} LD_PRELOAD={arguments.library} exec {arguments.binaries / "tungsten"} "$@"\n')
    command.chmod(0o755)
    for script in ("nasty/nasty_test.py", "plan/plan_test.py", "render/small_renders.py"):
        done = subprocess.run([sys.executable, str(HERE.parent / script)], env={**os.environ, "TUNGSTEN": str(command)},
                              capture_output=True, text=True)
        if done.returncode != 0:  # what has not run has not been looked at
            sys.exit(f"{script} fails under traps:\n{done.stdout[-1500:]}{done.stderr[-1500:]}")


def places(traces):
    """{(functions, kind): how often} in the project's modules; functions, with their files: the innermost that is inlined first."""
    modules = {}
    for line in traces.read_text().splitlines():
        module, offset, kind, count = line.split("\t")
        if "tungsten" in Path(module).name or module.endswith("_tests"):
            modules.setdefault(module, Counter())[offset, kind] += int(count)
    found = Counter()
    for module, counts in modules.items():
        for (offset, kind), count in counts.items():
            done = subprocess.run(["addr2line", "-C", "-f", "-i", "-e", module, offset], capture_output=True, text=True)
            lines = done.stdout.splitlines()
            inlined = [f"{function} in {Path(place.split(':')[0]).name}" for function, place in zip(lines[::2], lines[1::2])]
            found[" < ".join(inlined), kind] += count
    return found


def known():
    """(part of a function's name, kind, reason)."""
    lines = (HERE / "known.txt").read_text().splitlines()
    return [tuple(part.strip() for part in line.split("|")) for line in lines if line and not line.startswith("#")]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("library", type=Path)
    parser.add_argument("binaries", type=Path)
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        traces = Path(folder) / "traps"
        run(arguments, traces)
        found = places(traces)
    unknown = 0
    for (functions, kind), count in sorted(found.items()):
        reason = next((reason for part, of, reason in known() if part in functions and of == kind), None)
        unknown += not reason
        if arguments.list or not reason:
            inlined = functions.split(" < ")
            print(f"{inlined[-1][:200]}: {inlined[0][:100]} | {kind} | {reason or '?'}   ({count} times)")
    sys.exit(f"{unknown} places are not in known.txt" if unknown else 0)


if __name__ == "__main__":
    main()
