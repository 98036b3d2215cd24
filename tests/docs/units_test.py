#!/usr/bin/python3
"""The listings of docs/units.md run as they stand there, and their numbers are right."""

import re
import subprocess
import sys
from pathlib import Path

from extract_snippets import SNIPPET

PROJECT = Path(__file__).resolve().parents[2]


def run(name, code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    print(done.stdout + done.stderr)
    if done.returncode or "warning" in done.stderr.lower():
        sys.exit(f"{name} of docs/units.md fails")
    return done.stdout


text = (PROJECT / "docs/units.md").read_text()
outputs = {name: run(name, code) for name, code in SNIPPET.findall(text)}
assert sorted(outputs) == ["region.py", "spad.py"], sorted(outputs)

total, by_hand = map(float, re.search(r"all: (\S+), by hand (\S+),", outputs["spad.py"]).groups())
assert abs(total / by_hand - 1) < 0.01, (total, by_hand)
bins = dict(map(lambda line: (float(line.split(" ns: ")[0]), float(line.split(" ns: ")[1].split()[0])),
                outputs["spad.py"].splitlines()[:-1]))
lit = [start for start, photons in bins.items() if photons > 0]
assert len(lit) == 1 and lit[0] < 10.007 < lit[0] + 0.1, bins  # 3 m of light's way

error, naive = map(float, re.search(r"\+- (\S+); .*\+- (\S+)", outputs["region.py"]).groups())
assert error > 1.5 * naive, (error, naive)

# The laser of energy 1: its disc times its emission.
radius, emission = map(float, re.search(r'"radius": (\S+), "emission": (\S+),', text).groups())
assert abs(3.14159265 * radius * radius * emission - 1) < 1e-5
