"""The study's command (benchmarks/bench.py study) without a process of its own: loading numpy and matplotlib takes longer than what
most calls do."""

import contextlib
import io
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

from bench import main  # noqa: E402


def study(*arguments):
    """Exit code and output of the command, as subprocess.run gives them."""
    arguments = [str(argument) for argument in arguments]
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        try:
            code = main(["study", *arguments])
        except SystemExit as stop:
            code = stop.code
    return subprocess.CompletedProcess(arguments, code, out.getvalue(), error.getvalue())
