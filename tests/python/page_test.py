#!/usr/bin/python3
"""The listings of docs/python.md run as they stand there, but for their passes, two of eight, and print what they promise.

    page_test.py FOLDER     for what they write
"""

import os
import re
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
FOLDER = Path(sys.argv[1])
sys.path.insert(0, str(PROJECT / "tests/docs"))

from extract_snippets import SNIPPET  # noqa: E402


def run(name, code):
    # Names of scenes are relative to the project.
    link = FOLDER / "data"
    if not link.exists():
        link.symlink_to(PROJECT / "data")
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code], cwd=FOLDER, capture_output=True, text=True)
    print(done.stdout + done.stderr)
    if done.returncode:
        sys.exit(f"{name} of docs/python.md fails")
    return done.stdout


FOLDER.mkdir(parents=True, exist_ok=True)
listings = dict(SNIPPET.findall((PROJECT / "docs/python.md").read_text()))
outputs = {name: run(name, code.replace("passes=8", "passes=2")) for name, code in listings.items()}
assert sorted(outputs) == ["dict.py", "distances.py", "histogram.py", "instruments.py", "sweep.py"], sorted(outputs)

for file in ("histogram.png", "instruments.png", "sweep.png", "film.npz"):
    assert (FOLDER / file).stat().st_size > 1000, file
    os.remove(FOLDER / file)
swept = [[float(x) for x in line] for line in re.findall(r"sigma_s (\S+): (\S+) \+- (\S+)", outputs["sweep.py"])]
assert len(swept) == 5 and all(light > 4 * error > 0 for _, light, error in swept), swept
share = float(re.search(r"absorption leaves (\S+)", outputs["dict.py"])[1])
assert 0.05 < share < 0.5, share  # paths of 4 to 7: exp(-0.29 * 4) = 0.31 to exp(-0.29 * 7) = 0.13
assert "media[0].sigma_s - " in outputs["dict.py"] and "integrator.frame_num - " in outputs["dict.py"]
for preset in ("published", "best"):
    mean, error, exact = map(float, re.search(rf"{preset}: .* transmittance (\S+) \+- (\S+), exactly (\S+)",
                                              outputs["distances.py"]).groups())
    assert abs(mean - exact) < 4.5 * error + 1e-4, (preset, mean, error, exact)
whole, piled, undone = map(float, re.search(r"mean time (\S+), piled up (\S+), corrected (\S+)", outputs["instruments.py"]).groups())
assert piled < whole - 0.05 and abs(undone - whole) < 0.05, (whole, piled, undone)
