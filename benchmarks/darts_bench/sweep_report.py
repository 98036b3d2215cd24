"""What a sweep found: a page in Markdown, and all figures as comma-separated values."""

import math

from darts_bench.measures import MOST_SIGMAS, RELATIVE_BIAS
from darts_bench.tables import comma_separated

JUDGED = f"""Compared are the means over the image,
every frame, and 16 blocks of it, each channel by itself. Errors are those of the seeds, as normal deviates of Student's t; allowed
besides are {100 * RELATIVE_BIAS:g} % of the image's mean and two thirds of what half the kernel's radius changes, the means of
photons being extrapolated to no radius. More than {MOST_SIGMAS:g} sigmas disagree. Where the largest error of a scene
is much above 1 %, it proves little about single blocks.
"""
INTRODUCTION = f"""# Sweep of small scenes

`benchmarks/bench.py sweep FOLDER`: plain and best points, beams and paths, and copies of each in other units (lengths
in sevenths, times in thirds) or turned and moved as a whole, 16 x 16 pixels, 8 seeds each. {JUDGED}"""
SLICES_INTRODUCTION = f"""# Sweep of sliced primitives

`benchmarks/bench.py sweep FOLDER --slices`: every sliced primitive, plain and best (at gates volumes_balls are volumes),
against camera paths, plain and best, and best beams; 16 x 16 pixels, 8 seeds. Delta gates are those of the slices:
paths and beams have a box of the width of the planes' temporal kernel about the same moment. {JUDGED}"""
SCENE_HEAD = ["scene", "shows", "worst_ratio_of_methods", "sigmas", "worst_ratio_of_copies", "sigmas_of_copies", "largest_error_percent",
              "cpu_seconds", "agrees"]
METHOD_HEAD = ["scene", "method", "mean_over_first", "standard_error", "worst_sigmas"]


def tables(name, results):
    """Comma-separated values by file name: a row for each scene, and for each method in it."""
    return {f"{name}-scenes.csv": comma_separated(SCENE_HEAD, [scene_row(*result) for result in results.values()]),
            f"{name}-methods.csv": comma_separated(METHOD_HEAD, [row for result in results.values() for row in _method_rows(*result)])}


def report(name, introduction, results, failures, messages):
    """The page, and whether everything agrees."""
    disagreements = [line for result in results.values() for line in _disagreements(*result)]
    parts = [introduction, _summary(results), f"By scene: [{name}-scenes.csv]({name}-scenes.csv), the largest error is the standard error of the "
             f"noisiest method's image mean.\nBy method: [{name}-methods.csv]({name}-methods.csv), means over the image relative to the first method's, "
             "and the worst deviation from any of the references before it.",
             "## Disagreements\n\n" + ("\n".join(disagreements) or "None.")]
    left_out = [f"- {scene.name}: {method}: {reason}" for scene, *_ in results.values()
                for method, reason in scene.without.items()]
    if left_out:
        parts.append("## Left out\n\n" + "\n".join(left_out))
    if failures:
        parts.append("## Not rendered\n\n" + "\n".join(f"- {name}:\n```\n{text}\n```" for name, text in failures.items()))
    if messages:
        parts.append("## Messages of the renderer\n\n" + "\n".join(f"- {name}: {text}" for name, text in sorted(messages)))
    return "\n\n".join(part.strip() for part in parts) + "\n", not disagreements and not failures


def _summary(results):
    """How many scenes agree, and what comes closest to a disagreement."""
    rows = [dict(zip(SCENE_HEAD, scene_row(*result))) for result in results.values()]
    if not rows:
        return ""

    def worst(column, unit=""):
        row = max(rows, key=lambda row: float(row[column]))
        return f"{row[column]}{unit} ({row['scene']})"

    text = (f"{sum(row['agrees'] for row in rows)} of {len(rows)} scenes agree, {sum(float(row['cpu_seconds']) for row in rows):.0f} CPU seconds. Most sigmas: "
            f"{worst('sigmas')} between methods")
    if any(copies for *_, copies in results.values()):
        text += f", {worst('sigmas_of_copies')} between copies"
    return text + f". Largest error: {worst('largest_error_percent', ' %')}."


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
    return [scene.name, scene.shows, f"{ratio:.3f}", f"{sigmas:.1f}", f"{copy_ratio:.3f}", f"{copy_sigmas:.1f}", f"{100 * error:.1f}",
            f"{seconds:.0f}", int(agree)]


def _method_rows(scene, rendered, methods, _):
    """Ratios of means with their standard errors, and the most sigmas from a reference."""
    reference = next(iter(rendered.values()))[1].whole
    for name, (_, together, _) in rendered.items():
        sigmas = [c.sigmas for (_, second), c in methods.items() if second == name]
        yield [scene.name, name, f"{together.whole / reference:.3f}", f"{together.whole_error / reference:.3f}", f"{max(sigmas):.1f}" if sigmas else ""]


def _disagreements(scene, _, methods, copies):
    for (first, second), c in methods.items():
        if not c.agrees:
            yield f"- {scene.name}: {second} against {first}: {c.sigmas:.1f} sigmas at {c.where}, ratio of images {c.ratio:.3f}"
    for (method, copy), c in copies.items():
        if not c.agrees:
            yield f"- {scene.name}: {method}, {copy}: {c.sigmas:.1f} sigmas at {c.where}, ratio of images {c.ratio:.3f}"
