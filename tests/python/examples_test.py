#!/usr/bin/python3
"""The programs of data/examples run, draw, and print what they promise.

    examples_test.py FOLDER     for what they write
"""

import re
import subprocess
import sys
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "data/examples"
FOLDER = Path(sys.argv[1])
FOLDER.mkdir(parents=True, exist_ok=True)

said = {}
for program in sorted(EXAMPLES.glob("*.py")):
    picture = FOLDER / f"{program.stem}.png"
    picture.unlink(missing_ok=True)
    done = subprocess.run([sys.executable, "-W", "ignore", program, picture], capture_output=True, text=True)
    print(done.stdout + done.stderr)
    assert done.returncode == 0, program
    assert picture.stat().st_size > 5000, picture
    said[program.stem] = done.stdout

exact = float(re.search(r"exactly: (\S+)", said["directions"])[1])
for mean, error in re.findall(r"once (\S+) \+- (\S+)", said["directions"]):
    assert abs(float(mean) - exact) < 4.5 * float(error), (mean, error, exact)
times = float(re.search(r"(\S+) times what independent", said["regions"])[1])
assert 1.5 < times < 30, times
