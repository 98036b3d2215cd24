"""The renderer as every measurement starts it: limits of time, processor time, results that are kept by their content, what a film says.

A busy machine takes wall time from a render, hardly processor time. What is to be compared is therefore measured by CPU seconds: the renderer's
own, of its passes (`Film.cpu`), or those of a process, after which it is asked to stop (`call`).
"""

import contextlib
import hashlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
COMMAND = PROJECT / "benchmarks/bench.py"
SHARED = PROJECT.parent / "shared/scenes"  # by others, not part of the project
LONGEST = 40000  # seconds of any render that has no other limit
MOST_SAMPLES = 10**9  # where a limit of time ends a render, never the number of samples
PATHS_STEP = 8  # samples of a pass of paths that a limit of time ends: from 4 on they are shared out over the image


class BenchError(Exception):
    """What a command cannot go on from; the message names the file or command and what was expected."""


def add_renderer(parser):
    """The option of all commands that names the renderer."""
    parser.add_argument("--tungsten", type=lambda name: Path(name).resolve(), default=os.environ.get("TUNGSTEN", str(PROJECT / "build/bin/tungsten")),
                        help="the renderer (default: the environment's TUNGSTEN, or build/bin/tungsten)")


def require_renderer(tungsten):
    if not tungsten.is_file():
        raise BenchError(f"there is no renderer {tungsten}: build it (scripts/setup.sh) or name it with --tungsten")


# ---- Starting it

_running = set()  # process groups; workers() ends them, and takes them out
_ending = threading.Event()  # workers() has begun to: what starts now ends itself


def _end_all():
    while _running:
        with contextlib.suppress(KeyError, ProcessLookupError):
            os.killpg(_running.pop(), signal.SIGKILL)


def call(command, limit=LONGEST, cpu=None, first=None):
    """Exit code (None: stopped after `limit` seconds) and messages. With `cpu`, the renderer is asked to write what it has once it has used so many
    seconds of processor time and its first pass has left the file `first`. It ends when this program is interrupted."""
    # The shell forks: a child that Python starts itself would report Python's own peak memory as the least of its own.
    # A session of its own keeps Ctrl-C from the renderer, which would write a render cut short.
    shell = subprocess.Popen(["/bin/sh", "-c", '"$@" >&2 & echo $!; wait $!', "sh", *map(str, command)], stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True)
    end, asked, messages = time.monotonic() + limit, cpu is None, None
    ended = BenchError(f"{command[0]} was ended: others failed, or it was asked for")
    try:
        _running.add(shell.pid)
        pid = shell.stdout.readline()
        if _ending.is_set():
            _end_all()
        if not pid or shell.pid not in _running:
            raise ended
        while messages is None:
            left = max(end - time.monotonic(), 0.0)
            try:
                messages = shell.communicate(timeout=left if asked else min(0.02, left))[1]
            except subprocess.TimeoutExpired:
                if time.monotonic() >= end:
                    os.killpg(shell.pid, signal.SIGKILL)
                    return None, shell.communicate()[1] + f"\nstopped: not finished after {limit:g} seconds"
                if not asked and cpu_used(int(pid)) >= cpu and first.exists():
                    os.kill(int(pid), signal.SIGTERM)
                    asked = True
        if shell.pid not in _running:
            raise ended
        return shell.returncode, messages
    finally:
        _running.discard(shell.pid)
        if messages is None and shell.poll() is None:
            os.killpg(shell.pid, signal.SIGKILL)
            shell.communicate()


def checked(command, **limits):
    """The messages of a command that has to succeed."""
    code, messages = call(command, **limits)
    if code != 0:
        raise BenchError(f"{' '.join(map(str, command))}: exit code {code}: {messages.strip()}")
    return messages


def cpu_used(pid):
    """Seconds of processor time, user and system, of a running process."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def as_typed(command):
    """A command as it is typed in the project's folder."""
    def from_project(word):
        name, is_setting, path = str(word).rpartition("=")
        path = os.path.relpath(path, PROJECT) if path.startswith(str(PROJECT.parent)) else path
        return f"{name}={path}" if is_setting else path

    return shlex.join(map(from_project, command))


def pass_size(settings):
    """The setting of a render that a limit of time ends: each pass of a photon map has photons of its own, one of paths
    some samples to share out."""
    types = [value for value in settings if value.startswith("integrator.type=")]
    return f"renderer.spp_step={PATHS_STEP if types[-1:] == ['integrator.type=path_tracer'] else 1}"


def set_options(settings):
    """`--set FIELD=VALUE` of each."""
    return [word for value in settings for word in ("--set", value)]


@contextlib.contextmanager
def workers(count):
    """A pool of threads, each of which waits for a process. Where something goes wrong, or on Ctrl-C, all of them are ended."""
    pool = ThreadPoolExecutor(count)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        _ending.set()
        _end_all()
        raise
    finally:
        pool.shutdown()
        _ending.clear()


# ---- What is kept

def content_key(what, *files):
    """Changes with anything in `what`, which JSON can hold, and with the files' content."""
    return hashlib.sha256(json.dumps(what).encode() + b"".join(file.read_bytes() for file in files)).hexdigest()[:16]


@contextlib.contextmanager
def appearing(folder):
    """A folder to write to, which appears under its name, in place of what was there, when all is written."""
    partial = folder.with_name(folder.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    yield partial
    shutil.rmtree(folder, ignore_errors=True)
    partial.rename(folder)


def write_whole(file, text):
    """All of the file, or nothing."""
    unfinished = file.with_name(file.name + ".partial")
    unfinished.write_text(text)
    unfinished.replace(file)


# ---- The conditions

def build_of(tungsten):
    """Identity of a build: the command, and the libraries and plugins beside it."""
    content = hashlib.sha256(tungsten.read_bytes())
    for library in sorted(tungsten.parent.glob("libtungsten*.so")):
        content.update(library.read_bytes())
    return content.hexdigest()[:12]


def machine():
    """Processor, threads and system of this machine."""
    models = re.findall(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), flags=re.M)
    system = os.uname()
    return f"{models[0] if models else 'unknown processor'}, {os.cpu_count()} threads, {system.sysname} {system.machine}"


def commit():
    """The commit, and whether the renderer's sources differ from it: results are written before they are committed."""
    def git(*words):
        return subprocess.run(["git", "-C", PROJECT, *words], capture_output=True, text=True).stdout.strip()

    return git("rev-parse", "--short", "HEAD") + ("-dirty" if git("status", "--porcelain", "--", "src", "tungsten") else "")


# ---- A film

@dataclass(frozen=True)
class Film:
    """A finished render: arrays (frames, height, width, 3), the standard error None after a single pass; and what the file says of itself."""

    mean: np.ndarray
    error: np.ndarray | None
    about: dict

    @property
    def statistics(self):
        return self.about["statistics"]

    @property
    def cpu(self):
        """Processor seconds of the passes."""
        return self.statistics["stages"]["passes"]["CPU seconds"]


def read_film(file):
    """What the renderer has written as NPZ."""
    with np.load(file) as stored:
        error = stored["standard_error"].astype(float) if "standard_error" in stored else None
        return Film(stored["mean"].astype(float), error, json.loads(bytes(stored["metadata.json"])))


def film(tungsten, scene, settings=(), passes=None, seconds=None, seed=1, threads=1, options=()):
    """A render of so many samples a pixel, or of so many seconds of the wall's clock; nothing of it stays but what is returned."""
    with tempfile.TemporaryDirectory() as folder:
        length = ["--spp", passes] if passes else ["--timeout", f"{seconds:g}s", "--spp", MOST_SAMPLES]
        checked([tungsten, "--quiet", "--no-frames", "--allow-outside", "-t", threads, "-s", seed, "-d", folder, "-e", "film.npz", *length, *options,
                 *set_options(settings), scene])
        return read_film(Path(folder) / "film.npz")
