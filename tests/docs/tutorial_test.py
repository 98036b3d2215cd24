#!/usr/bin/python3
"""The commands and listings of docs/tutorial.md run as they stand there, in their order, but for their seconds: half a second each, and one
for the tank, whose first pass alone takes nearly that.

    tutorial_test.py FOLDER     for what they write; the environment's TUNGSTEN is the renderer
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from extract_snippets import SNIPPET

PROJECT = Path(__file__).resolve().parents[2]
FOLDER = Path(sys.argv[1])
NAMES = {"tungsten": [os.environ["TUNGSTEN"]],
         "study": [sys.executable, str(PROJECT / "benchmarks/bench.py"), "study"]}


def run(words):
    if words[0] == "study":
        words = [*words, "--tungsten", os.environ["TUNGSTEN"]]
    done = subprocess.run([*NAMES.get(words[0], [words[0]]), *words[1:]], cwd=FOLDER, capture_output=True, text=True)
    said = done.stdout + done.stderr
    if done.returncode:
        sys.exit(f"docs/tutorial.md: {shlex.join(words)} fails:\n{said}")
    return said


FOLDER.mkdir(parents=True, exist_ok=True)
for old in ("room-study.json", "room-reference.pfm", "room-reference.blockvar"):
    (FOLDER / old).unlink(missing_ok=True)
text, said = (PROJECT / "docs/tutorial.md").read_text(), []
for block in re.finditer(r"(?:<!-- snippet: (\S+) -->\n)?```(\w+)\n(.*?)```", text, re.S):
    name, language, content = block.groups()
    if language == "sh":
        for line in content.splitlines():
            seconds = 1 if "tank.json" in line else 0.5
            said.append(run(shlex.split(re.sub(r"(--timeout|--seconds) \d+", rf"\1 {seconds}", line))))
    else:
        (FOLDER / name).write_text(content)
        if language == "python":
            said.append(run([sys.executable, name]))
assert SNIPPET.findall(text)
for file in ("room.png", "film.png", "film.npz", "histogram.png", "tank-film.png", "study/report.md", "study/report.html"):
    assert (FOLDER / "out" / file).stat().st_size > 1000, file

# The patch lies on the far wall, at z = -2.5: the lamp's light is there and back no sooner than the way over the wall allows.
first, last, mean, error = map(float, re.search(r"brightest from (\S+) to (\S+) ns: (\S+) \+- (\S+)", "".join(said)).groups())
assert 18 < first < last < 30 and 0 < error < 0.2 * mean, (first, last, mean, error)
assert "default radius" in "".join(said)
