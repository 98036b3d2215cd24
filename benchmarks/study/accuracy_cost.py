#!/usr/bin/python3
"""Does --plan-cost tell what an error costs? Its prices against renders with --trace and --bias: CPU seconds until noise
and bias together are at an error, and whether the method that it calls cheapest is. Writes a table.

    benchmarks/study/accuracy_cost.py FOLDER [--seconds 15] [--resolution 48x48] [--scenes NAME ...]
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
RENDERER = PROJECT / "build/bin/tungsten"
# Folder of the scene, and what its renders set.
SCENES = {
    "cornell-fog": ("data/scenes", []),
    "two-pulses": ("data/scenes", ["integrator.frame_num=4"]),
    "mirror-fog": ("data/scenes", []),
    "glass-tank": ("data/scenes", []),
    "fogged-box": ("data/scenes", []),
    "laser-in-fog": ("data/scenes", []),
    "lamp-in-fog": ("benchmarks/study/scenes", []),
    "several-lights": ("benchmarks/study/scenes", []),
    "milk-behind-glass": ("benchmarks/study/scenes", []),
    "cloud-in-haze": ("benchmarks/study/scenes", []),
}
# Small passes: every method has many of them in little time.
COMMON = ["renderer.spp_step=1", "integrator.photon_count=20000", "integrator.volume_photon_count=10000"]
LEVELS = [1.0, 0.3, 0.1, 0.03]


def command(scene, arguments, settings):
    folder, own = SCENES[scene]
    file = PROJECT / folder / scene / "scene.json"
    if not file.exists():
        file = PROJECT / folder / f"{scene}.json"
    line = [RENDERER, "-t", "1", "--resolution", arguments.resolution, "-d", arguments.folder]
    for value in [*COMMON, *own, *settings]:
        line += ["--set", value]
    return [*line, file]


def run(line):
    done = subprocess.run(line, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)


def plan(scene, arguments):
    """The methods that --plan-cost measured, as its JSON has them."""
    file = arguments.folder / "plan.json"
    run([*command(scene, arguments, []), "--plan-cost", "--stats", file])
    return [method for method in json.loads(file.read_text())["methods"] if "prices" in method]


def total(law, passes):
    return law["first"] * np.cumsum(np.arange(1.0, passes + 1) ** law["exponent"])


def predicted(method):
    """Errors and CPU seconds after 1, 2, ... passes."""
    passes = np.arange(1.0, MOST + 1)
    noise = total(method["relative variance of a pass"], MOST) / passes**2
    bias = total(method["relative bias of a pass"], MOST) / passes
    return np.sqrt(noise + bias**2), total(method["CPU seconds of a pass"], MOST)


MOST = 1 << 18  # passes that are looked at


def measured(scene, method, arguments):
    """Errors and CPU seconds of a render at its trace's moments."""
    settings = [value for value in method["settings"].split(" ") if value]
    run([*command(scene, arguments, settings), "--quiet", "--bias", "--seed", "99", "--spp", "1000000000", "--timeout",
         f"{arguments.seconds}s", "--trace", arguments.folder / "trace"])
    entries = json.loads((arguments.folder / "trace/trace.json").read_text())["entries"]
    rows = [(entry["relative standard error"], entry.get("relative bias", 0.0), entry["CPU seconds"])
            for entry in entries if entry["passes"] >= 8 and entry["relative standard error"] is not None]
    noise, bias, seconds = map(np.array, zip(*rows)) if rows else (np.array([]),) * 3
    return np.hypot(noise, bias), seconds


def seconds_at(curve, error):
    """CPU seconds at an error between a curve's first and last, between logarithms; None outside."""
    errors, seconds = curve
    below = np.flatnonzero(errors <= error)
    if len(below) == 0 or below[0] == 0:
        return None
    i = below[0]
    share = np.log(errors[i - 1] / error) / np.log(errors[i - 1] / errors[i])
    return float(np.exp((1 - share) * np.log(seconds[i - 1]) + share * np.log(seconds[i])))


def levels_of(curves):
    """Errors that are looked at: round ones, and the last of every method."""
    return sorted({*LEVELS, *(round(float(errors[-1]) * 1.05, 4) for errors, _ in curves.values() if len(errors))},
                  reverse=True)


def study(scene, arguments):
    """Rows of prices, and of choices where two methods or more get to an error."""
    methods = {method["name"]: method for method in plan(scene, arguments)}
    prices = {name: predicted(method) for name, method in methods.items()}
    curves = {name: measured(scene, method, arguments) for name, method in methods.items()}
    told, chosen = [], []
    for error in levels_of(curves):
        real = {name: seconds_at(curve, error) for name, curve in curves.items()}
        real = {name: seconds for name, seconds in real.items() if seconds}
        price = {name: seconds_at(prices[name], error) for name in real}
        price = {name: seconds for name, seconds in price.items() if seconds}
        told += [(scene, name, error, price.get(name), seconds) for name, seconds in real.items()]
        if len(real) > 1 and price:
            choice, best = min(price, key=price.get), min(real, key=real.get)
            chosen.append((scene, error, choice, best, real[choice] / real[best]))
    return told, chosen


def table(told, chosen):
    lines = ["| scene | method | error | predicted, CPU s | measured, CPU s | ratio |", "| --- | --- | --- | --- | --- | --- |"]
    for scene, name, error, price, seconds in told:
        ratio = f"{price / seconds:.2f}" if price else ""
        lines.append(f"| {scene} | {name} | {error:.1%} | {f'{price:.3g}' if price else 'never'} | {seconds:.3g} | {ratio} |")
    lines += ["", "| scene | error | its choice | cheapest | price of the choice over the cheapest |",
              "| --- | --- | --- | --- | --- |"]
    lines += [f"| {scene} | {error:.1%} | {choice} | {best} | {ratio:.2f} |" for scene, error, choice, best, ratio in chosen]
    ratios = np.array([price / seconds for *_, price, seconds in told if price])
    off = np.array([ratio for *_, ratio in chosen])
    summary = [f"Predictions within a factor of two: {np.mean((ratios > 0.5) & (ratios < 2)):.0%} of {len(ratios)}, median "
               f"ratio {np.median(ratios):.2f}; not foreseen at all: {sum(price is None for *_, price, _ in told)}. Choices "
               f"that are the cheapest or within 1.5 times of it: {np.mean(off <= 1.5):.0%} of {len(off)}.", ""]
    return summary + lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=int, default=15)
    parser.add_argument("--resolution", default="48x48")
    parser.add_argument("--scenes", nargs="*", default=list(SCENES))
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    told, chosen = [], []
    for scene in arguments.scenes:
        prices, choices = study(scene, arguments)
        told += prices
        chosen += choices
        print("\n".join(table(prices, choices)) if choices else f"{scene}: nothing to compare", flush=True)
    (arguments.folder / "ACCURACY-COST.md").write_text("\n".join(table(told, chosen)) + "\n")


if __name__ == "__main__":
    main()
