#!/usr/bin/python3
"""Plants the faults of faults.py and says which tests notice: prints caught or missed for each, with the first test that fails.

All faults are compiled into one build of a copy of the tree, each behind a switch (switches.py), so that the whole takes one build and
one short run of tests a fault. Nothing in the work tree is touched.

    tests/mutation/mutate.py [--build build-mutation] [--only N,N...] [--folder NAME] [--jobs N] [--all-tests] [--table]
"""

import argparse
import concurrent.futures
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(__file__).resolve().parent))
import switches  # noqa: E402
from faults import FAULTS  # noqa: E402

LONGEST = 600  # seconds of one test program
PYTHON = "/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable  # numpy is Debian's package of that one


def write_if_changed(path, content):
    """Files that stay the same keep their time, so that the next build is short."""
    if path.exists() and path.read_bytes() == content:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def copy_tree(source):
    """The tree as it is, every fault in it behind its switch."""
    by_file = defaultdict(list)
    for number, (file, good, bad, _) in enumerate(FAULTS):
        by_file[file].append((number, good, bad))
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=PROJECT, capture_output=True, text=True, check=True)
    header = source / "planted.h"
    for name in listed.stdout.splitlines():
        path = PROJECT / name
        if not path.is_file():
            continue
        content = path.read_bytes()
        if name in by_file:
            text = switches.switched(content.decode(), by_file.pop(name))
            content = f'#include "{header}"\n#line 1\n{text}'.encode()
        write_if_changed(source / name, content)
        shutil.copymode(path, source / name)
    write_if_changed(header, switches.HEADER.encode())
    assert not by_file, f"not in the tree: {list(by_file)}"


def build(source, build_folder, jobs):
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    options = [f"-DTUNGSTEN_{name}=ON" for name in ("TESTS", "PYTHON")]
    subprocess.run(["cmake", "-S", source, "-B", build_folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *options, *launcher],
                   stdout=subprocess.DEVNULL, check=True)
    subprocess.run(["cmake", "--build", build_folder, f"-j{jobs}"], check=True)


def run(command, number, build_folder):
    environment = dict(os.environ, PLANTED_FAULT=str(number), TUNGSTEN=str(build_folder / "bin/tungsten"), PYTHONDONTWRITEBYTECODE="1",
                       PYTHONPATH=str(build_folder / "python"))
    try:
        return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=LONGEST, env=environment,
                              cwd=build_folder, errors="replace")
    except subprocess.TimeoutExpired:
        return None


def noticed(source, build_folder, number, target, tests):
    """The test that fails, or None."""
    if target == "ctest":
        done = run(["ctest", "--stop-on-failure", "-R", tests], number, build_folder)
        failed = [line.split("***")[0].split()[-1] for line in (done.stdout if done else "").splitlines() if "***" in line]
        if done and done.returncode and not failed:
            sys.exit(f"ctest -R {tests} does not run: {done.stdout[-300:]}{done.stderr[-300:]}")
    elif target.endswith(".py"):
        done = run([PYTHON, source / target, *tests.split()], number, build_folder)
        failed = [line.split()[1] for line in (done.stderr if done else "").splitlines() if line.startswith(("FAIL: ", "ERROR: "))]
        if done and done.returncode and not failed:
            sys.exit(f"{target} does not run: {done.stderr.strip()[-300:]}")
    else:
        done = run([build_folder / "bin" / target, f"--gtest_filter={tests}", "--gtest_brief=1", "--gtest_fail_fast"], number, build_folder)
        failed = [line[13:].split(",")[0].split(" (")[0] for line in (done.stdout if done else "").splitlines()
                  if line.startswith("[  FAILED  ]")]
        if done and " 0 tests from 0 " in done.stdout:
            sys.exit(f"{target} has no test {tests}")
    if done and done.returncode == 0:
        return None
    return failed[0] if failed else f"{target} ({'crash' if done else 'time-out'})"


def judge(source, build_folder, number, whole):
    begin = time.monotonic()
    tests = list(FAULTS[number][3])
    if whole:
        tests += [("ctest", ".")]
    for target, which in tests:
        by = noticed(source, build_folder, number, target, which)
        if by:
            return by, time.monotonic() - begin
    return None, time.monotonic() - begin


def unharmed(source, build_folder, numbers):
    """Tests that fail without a fault would catch everything."""
    for target, which in sorted({test for number in numbers for test in FAULTS[number][3]}):
        by = noticed(source, build_folder, -1, target, which)
        if by:
            sys.exit(f"{by} fails without a fault")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=PROJECT / "build-mutation")
    parser.add_argument("--only", type=lambda text: [int(number) for number in text.split(",")], help="numbers of faults")
    parser.add_argument("--folder", default="", help="faults of files below it")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--all-tests", action="store_true", help="what is missed by its tests is shown to all others, too")
    parser.add_argument("--table", action="store_true", help="print rows of a Markdown table")
    parser.add_argument("--no-build", action="store_true", help="the build is there, with the faults as they are")
    arguments = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # else ignored by what tests interrupt, where this runs in the background
    source, build_folder = arguments.build.resolve() / "source", arguments.build.resolve() / "build"
    numbers = [number for number in arguments.only or range(len(FAULTS)) if FAULTS[number][0].startswith(arguments.folder)]
    if not arguments.no_build:
        copy_tree(source)
        build(source, build_folder, arguments.jobs)
        unharmed(source, build_folder, numbers)
    caught = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        verdicts = pool.map(lambda number: judge(source, build_folder, number, arguments.all_tests), numbers)
        for number, (by, seconds) in zip(numbers, verdicts):
            caught += by is not None
            file, good, bad, _ = FAULTS[number]
            if arguments.table:
                print(f"| {number} | {file.removeprefix('src/')} | `{good}` → `{bad}` | {by or '**missed**'} | {seconds:.1f} |", flush=True)
            else:
                print(f"{number:3} {file}: {good} -> {bad}: {'caught by ' + by if by else 'MISSED'} ({seconds:.1f} s)", flush=True)
    print(f"{caught} of {len(numbers)} caught")
    sys.exit(caught < len(numbers))


if __name__ == "__main__":
    main()
