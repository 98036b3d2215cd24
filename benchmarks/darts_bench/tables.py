"""Figures as text: Markdown tables, comma-separated values, and the tables of a study's report."""

import csv
import io
from typing import NamedTuple

STAGES = ["load", "prepare", "photon pass", "build", "camera pass"]


def number(value, digits=3):
    """Three significant digits without an exponent where that is readable; a dash for what is not known."""
    if value is None:
        return "–"
    if value != 0 and (abs(value) < 1e-3 or abs(value) >= 1e5):
        return f"{value:.{digits - 1}e}"
    if abs(value) >= 100:
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def table(header, rows, words=1):
    """A Markdown table; the first columns, so many, are words, the others figures."""
    lines = [header, ["---"] * words + ["---:"] * (len(header) - words), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def comma_separated(header, rows):
    """Empty where there is no figure."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([header, *(["" if cell in ("–", None) else cell for cell in row] for row in rows)])
    return text.getvalue()


class Table(NamedTuple):
    """One of a study's."""

    title: str
    header: list
    rows: list
    words: int = 1
    seconds: float | None = None  # of the renders that it is about

    @property
    def markdown(self):
        return table(self.header, self.rows, self.words)


def bias_text(bias):
    """rms bias where it stands out of the noise, else its bound."""
    if bias is None:
        return "–"
    return number(bias.squared**0.5) if bias.is_significant else f"< {number(bias.bound, 2)}"


def _told(bias):
    """The renders' own estimate, and in brackets what it may be."""
    return "–" if bias is None else f"{number(bias[0], 2)} (< {number(bias[1], 2)})"


def _times(value):
    return "–" if value is None else f"{number(value)}×"


def _range(summary):
    if summary.std is None:
        return "–"
    low, high = summary.std_range
    return number(summary.std) if summary.seeds < 2 else f"{number(summary.std)} ({number(low)}–{number(high)})"


def _ratio(summary):
    error = summary.mean_ratio_error
    return f"{summary.mean_ratio:.3f}" + (f" ± {error:.3f}" if error is not None else "")


def baseline_of(study, summaries):
    """The study's baseline, or the first method with a result where a scene lacks it."""
    baseline = summaries.get(study.baseline)
    if baseline is None or not baseline.seeds:
        baseline = next((s for s in summaries.values() if s.seeds), next(iter(summaries.values())))
    return baseline


def accuracy(study, seconds, summaries):
    """What only some studies have is left out where no method has it."""
    done, baseline = [s for s in summaries.values() if s.seeds], baseline_of(study, summaries)
    columns = {
        "method": [s.method.name for s in done],
        "seeds": [s.seeds for s in done],
        "passes": [number(s.passes) for s in done],
        "wall s": [number(s.wall) for s in done],
        "CPU s": [number(s.cpu) for s in done],
        "rel. std (range)": [_range(s) for s in done],
        "std over seeds": [number(s.std_spread) for s in done],
        "std, averaged down": [number(s.std_averaged) for s in done],
        "block bias": [bias_text(s.bias) for s in done],
        "own bias": [_told(s.told_bias) for s in done],
        "mean ratio": [_ratio(s) for s in done],
        "MSE": [number(s.mse) for s in done],
        "relMSE 0.99": [number(s.relmse99) for s in done],
        "median error": [number(s.median_error) for s in done],
        "FLIP": [number(s.flip) for s in done],
        "MSE × CPU s": [number(s.cost) for s in done],
        "gain": [_times(s.gain_over(baseline)) for s in done],
        "gain per CPU s": [_times(s.gain_over(baseline, at_equal_cpu=True)) for s in done],
        "over published": [_times(s.gain_over_published()) for s in done]}
    for name in ("std, averaged down", "own bias", "over published"):
        if set(columns[name]) == {"–"}:
            del columns[name]
    return Table(f"Accuracy, {seconds:g} s", list(columns), list(zip(*columns.values())), seconds=seconds)


def cost(seconds, summaries):
    done, once = [s for s in summaries.values() if s.seeds], ("load", "prepare")
    columns = {"method": [s.method.name for s in done], "peak memory, MB": [number(s.memory / 1e6) for s in done],
               "processor share": [f"{100 * s.share:.0f} %" for s in done]}
    for stage in STAGES:
        if any(stage in s.stages for s in done):
            spent = [(s.stages.get(stage), 1 if stage in once else s.passes / 1000) for s in done]
            columns[f"{stage}, {'s' if stage in once else 'ms per pass'}"] = [number(None if time is None else time / unit) for time, unit in spent]
    columns["non-finite samples"] = [s.non_finite for s in done]
    return Table(f"Cost, {seconds:g} s", list(columns), list(zip(*columns.values())), seconds=seconds)


def published(figures):
    rows = [[row["method"], number(row.get("passes")), number(row.get("std")), f"< {row['bias_below']}" if "bias_below" in row else number(row.get("bias")),
             number(row.get("mean_ratio")), number(row.get("memory_mb"))] for row in figures.rows]
    return Table(f"Published implementation, {figures.seconds:g} s on {figures.threads} threads ({figures.source})",
                 ["method", "passes", "rel. std", "block bias", "mean ratio", "memory, MB"], rows)


def scene_tables(study, scene, by_seconds):
    found = []
    for seconds, summaries in by_seconds.items():
        if any(s.seeds for s in summaries.values()):
            found += [accuracy(study, seconds, summaries), cost(seconds, summaries)]
    return found + ([published(scene.published)] if scene.published else [])


def overview(study, summaries):
    """MSE × CPU seconds of every method in every scene, at the longest time; the least of a scene is bold."""
    rows = []
    for scene in study.scenes:
        costs = {name: s.cost for name, s in list(summaries[scene.name].values())[-1].items() if s.seeds}
        least = min((cost for cost in costs.values() if cost is not None), default=None)
        cells = [costs.get(method.name) for method in study.methods]
        rows.append([scene.name] + [f"**{number(cost)}**" if cost is not None and cost == least else number(cost) for cost in cells])
    return Table(f"MSE × CPU seconds, {study.seconds[-1]:g} s", ["scene", *(method.name for method in study.methods)], rows)


def left_out(study, summaries):
    """What has no result, and why: left out by the study, or impossible to the renderer."""
    found = {}
    for scene, method, reason in study.left_out():
        found.setdefault((method.name, reason), []).append(scene.name)
    for by_seconds in summaries.values():
        for s in list(by_seconds.values())[-1].values():
            if s.skipped:
                found.setdefault((s.method.name, s.skipped), []).append(s.scene.name)
    order = [method.name for method in study.methods]
    lines = sorted(found.items(), key=lambda entry: order.index(entry[0][0]))
    return Table("Not compared", ["method", "scenes", "why"], [[method, ", ".join(scenes), reason] for (method, reason), scenes in lines], words=3)
