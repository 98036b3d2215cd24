#!/usr/bin/python3
"""Plants the faults of faults.py one at a time, builds what they are in and runs the tests that should notice: prints caught or missed.
Works in the tree that it is in, restores every file, and builds once more at the end. Takes about a minute a fault.

    tests/mutation/mutate.py [--build build] [--from N] [--count N] [--jobs N]
"""

import argparse
import os
import signal
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(__file__).resolve().parent))
from faults import FAULTS  # noqa: E402

LONGEST = 900  # seconds


def call(arguments):
    try:
        return subprocess.run([str(a) for a in arguments], cwd=PROJECT, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return None


def built(build, targets, jobs):
    done = call(["cmake", "--build", build, "--target", *targets, f"-j{jobs}"])
    return done is not None and done.returncode == 0


def noticed(build, target, tests):
    """By which test, or None."""
    if tests.endswith(".py"):
        done = call([sys.executable, PROJECT / tests])
        if done and done.returncode == 0:
            return None
        failed = [line.split()[1] for line in (done.stderr if done else "").splitlines() if line.startswith(("FAIL: ", "ERROR: "))]
        if done and not failed:
            sys.exit(f"{tests} does not run: {done.stderr.strip()[-300:]}")
        return f"{tests}, {failed[0]}" if failed else f"{tests} (time-out)"
    done = call([build / "bin" / target, f"--gtest_filter={tests}", "--gtest_brief=1", "--gtest_fail_fast"])
    if done and done.returncode == 0:
        return None
    failed = [line for line in (done.stdout if done else "").splitlines() if line.startswith("[  FAILED  ]")]
    return failed[0][13:].split(",")[0].split(" (")[0] if failed else f"{target} (crash or time-out)"


def plant(fault, build, jobs):
    file, good, bad, tests = fault
    path = PROJECT / file
    text = path.read_text()
    if text.count(good) != 1:
        return f"stale: '{good}' is there {text.count(good)} times"
    targets = sorted({target for target, _ in tests})
    if any(target == "tungsten-app" for target in targets):
        targets += ["tungsten-path", "tungsten-photon"]
    try:
        path.write_text(text.replace(good, bad))
        if not built(build, targets, jobs):
            return "does not compile"
        for target, which in tests:
            by = noticed(build, target, which)
            if by:
                return f"caught by {by}"
        return "MISSED"
    finally:
        path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=PROJECT / "build")
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--count", type=int, default=len(FAULTS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # files are restored then, too
    results = []
    for number, fault in list(enumerate(FAULTS))[arguments.first:arguments.first + arguments.count]:
        results.append(plant(fault, arguments.build.resolve(), arguments.jobs))
        print(f"{number:2} {fault[0]}: {fault[1]} -> {fault[2]}: {results[-1]}", flush=True)
    built(arguments.build.resolve(), ["tungsten-app", "tungsten-path", "tungsten-photon"], arguments.jobs)
    caught = sum(result.startswith("caught") for result in results)
    print(f"{caught} of {len(results)} caught")
    sys.exit(caught < len(results))


if __name__ == "__main__":
    main()
