"""The study's command (benchmarks/bench.py study), mostly without a process of its own: loading numpy and matplotlib takes longer than
what most calls do."""

import contextlib
import io
import signal
import subprocess
import sys
from pathlib import Path

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
sys.path.insert(0, str(BENCHMARKS))

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


def started(*arguments):
    """A process that can be interrupted, even if a shell has started the test in the background, where interrupts are ignored."""
    return subprocess.Popen([sys.executable, BENCHMARKS / "bench.py", "study", *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                            text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
