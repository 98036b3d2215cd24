"""The sweep's tables, in Markdown."""

import math

from sweep_measures import MOST_SIGMAS, RELATIVE_BIAS

JUDGED = f"""Compared are the means over the image,
every frame, and 16 blocks of it, each channel by itself. Errors are those of the seeds, as normal deviates of Student's t; allowed
besides are {100 * RELATIVE_BIAS:g} % of the image's mean and two thirds of what half the kernel's radius changes, the means of
photons being extrapolated to no radius. More than {MOST_SIGMAS:g} sigmas disagree. The largest error is the standard error of the
noisiest method's image mean: what is much larger than 1 % proves little about single blocks.
"""
INTRODUCTION = f"""# Sweep of small scenes

`benchmarks/agreement/sweep.py FOLDER`: plain and best points, beams and paths, and copies of each in other units (lengths
in sevenths, times in thirds) or turned and moved as a whole, 16 x 16 pixels, 8 seeds each. {JUDGED}"""
SLICES_INTRODUCTION = f"""# Sweep of sliced primitives

`benchmarks/agreement/sweep.py FOLDER --slices`: every sliced primitive, plain and best (at gates volumes_balls are volumes),
against sensor paths, plain and best, and best beams; 16 x 16 pixels, 8 seeds. Delta gates are those of the slices:
paths and beams have a box of the width of the planes' temporal kernel about the same moment. {JUDGED}"""
SCENE_HEAD = """| scene | shows | worst ratio of methods | sigmas | of copies | sigmas | largest error, % | CPU s | |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |"""


def report(introduction, results, failures, messages):
    """The whole report, and whether everything agrees."""
    rows = [scene_row(*result) for result in results.values()]
    parts = [introduction, "\n".join([SCENE_HEAD, *rows])]
    disagreements = [line for result in results.values() for line in _disagreements(*result)]
    parts.append("## Disagreements\n\n" + ("\n".join(disagreements) or "None."))
    parts.append("## Means over the image, relative to the first method's\n\n" + _means_table(results))
    parts.append("## Worst deviation from any of the references before it, in sigmas\n\n" + _sigmas_table(results))
    left_out = [f"- {scene.name}: {method}: {reason}" for scene, *_ in results.values()
                for method, reason in scene.without.items()]
    if left_out:
        parts.append("## Left out\n\n" + "\n".join(left_out))
    if failures:
        parts.append("## Not rendered\n\n" + "\n".join(f"- {name}:\n```\n{text}\n```" for name, text in failures.items()))
    if messages:
        parts.append("## Messages of the renderer\n\n" + "\n".join(f"- {name}: {text}" for name, text in sorted(messages)))
    return "\n\n".join(part.strip() for part in parts) + "\n", not disagreements and not failures


def _worst(comparisons):
    """The most sigmas, and the ratio furthest from 1."""
    sigmas = max((c.sigmas for c in comparisons), default=0.0)
    return max((c.ratio for c in comparisons), key=lambda ratio: abs(math.log(max(ratio, 1e-9))), default=1.0), sigmas


def scene_row(scene, rendered, methods, copies):
    ratio, sigmas = _worst(methods.values())
    copy_ratio, copy_sigmas = _worst(copies.values())
    seconds = sum(seconds for *_, seconds in rendered.values())
    error = max(together.whole_error / together.whole for _, together, _ in rendered.values())
    agree = all(c.agrees for c in [*methods.values(), *copies.values()])
    return (f"| {scene.name} | {scene.shows} | {ratio:.3f} | {sigmas:.1f} | {copy_ratio:.3f} | {copy_sigmas:.1f} "
            f"| {100 * error:.1f} | {seconds:.0f} | {'' if agree else '**disagrees**'} |")


def _disagreements(scene, _, methods, copies):
    for (first, second), c in methods.items():
        if not c.agrees:
            yield f"- {scene.name}: {second} against {first}: {c.sigmas:.1f} sigmas at {c.where}, ratio of images {c.ratio:.3f}"
    for (method, copy), c in copies.items():
        if not c.agrees:
            yield f"- {scene.name}: {method}, {copy}: {c.sigmas:.1f} sigmas at {c.where}, ratio of images {c.ratio:.3f}"


def _table(results, cell):
    """cell(result, name) by scene and method."""
    names = list(dict.fromkeys(name for _, rendered, *_ in results.values() for name in rendered))
    lines = ["| scene | " + " | ".join(names) + " |", "| --- |" + " --- |" * len(names)]
    for result in results.values():
        lines.append(f"| {result[0].name} | " + " | ".join(cell(result, n) if n in result[1] else "" for n in names) + " |")
    return "\n".join(lines)


def _means_table(results):
    """Ratios with their standard errors."""
    def cell(result, name):
        reference, together = next(iter(result[1].values()))[1].whole, result[1][name][1]
        return f"{together.whole / reference:.3f} ± {together.whole_error / reference:.3f}"

    return _table(results, cell)


def _sigmas_table(results):
    def cell(result, name):
        sigmas = [c.sigmas for (_, second), c in result[2].items() if second == name]
        return f"{max(sigmas):.1f}" if sigmas else ""

    return _table(results, cell)
