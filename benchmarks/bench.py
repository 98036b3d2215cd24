#!/usr/bin/python3
"""Every measurement that is Python, by name; `bench.py NAME --help` says more."""

import importlib
import sys

from darts_bench.run import BenchError

MEASUREMENTS = {
    "study": "whole renders at equal time: studies by name, files or programs; references, reports, job arrays",
    "sweep": "do all methods show the same image? Small generated scenes",
    "kernels": "what kernels of photons lose at surfaces, and what it costs that they end there",
    "costs": "what operations of paths and light paths cost: the tables that pilots use",
    "unused": "what the code of effects that a scene does not use costs it, in instructions",
    "two-builds": "what a change costs or saves, in instructions",
    "infinite-medium": "the picture of the figures that build/bin/infinite_medium writes",
}
BAD_INPUT, INTERRUPTED = 2, 130  # exit codes


def main(arguments=None):
    """Exit code: 0 done, 2 bad input, 130 interrupted; the others are the measurement's."""
    name, *rest = (sys.argv[1:] if arguments is None else arguments) or ["--help"]
    if name in ("-h", "--help"):
        print(__doc__ + "\n", *(f"  {name:16}  {what}" for name, what in MEASUREMENTS.items()), sep="\n")
        return 0
    try:
        if name not in MEASUREMENTS:
            raise BenchError(f"there is no measurement '{name}'; there are: {', '.join(MEASUREMENTS)}")
        return importlib.import_module("darts_bench." + name.replace("-", "_")).main(rest)
    except BenchError as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("\ninterrupted: give the same command to go on", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
