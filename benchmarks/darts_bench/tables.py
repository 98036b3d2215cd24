"""Figures as text: Markdown tables, comma-separated values, and the tables of a study's report."""

import csv
import io

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


def accuracy_table(study, summaries):
    done = [s for s in summaries.values() if s.seeds]
    baseline = baseline_of(study, summaries)
    averaged = any(s.std_averaged is not None for s in done)
    published = any(s.gain_over_published() is not None for s in done)
    header = ["method", "seeds", "passes", "wall s", "CPU s", "rel. std (range)", "std over seeds"]
    header += ["std, averaged down"] if averaged else []
    told = any(s.told_bias is not None for s in done)
    header += ["block bias"] + (["own bias"] if told else []) + ["mean ratio", "MSE", "relMSE 0.99", "median error", "FLIP",
                                                                 "MSE × CPU s", "gain", "gain per CPU s"]
    header += ["over published"] if published else []
    rows = []
    for s in done:
        row = [s.method.name, s.seeds, number(s.passes), number(s.wall), number(s.cpu), _range(s), number(s.std_spread)]
        row += [number(s.std_averaged)] if averaged else []
        row += [bias_text(s.bias)] + ([_told(s.told_bias)] if told else [])
        row += [_ratio(s), number(s.mse), number(s.relmse99), number(s.median_error), number(s.flip), number(s.cost),
                _times(s.gain_over(baseline)), _times(s.gain_over(baseline, at_equal_cpu=True))]
        row += [_times(s.gain_over_published())] if published else []
        rows.append(row)
    return table(header, rows)


def overview_table(study, summaries):
    """MSE × CPU seconds of every method in every scene, at the longest time; the least of a scene is bold."""
    rows = []
    for scene in study.scenes:
        costs = {name: s.cost for name, s in list(summaries[scene.name].values())[-1].items() if s.seeds}
        least = min((cost for cost in costs.values() if cost is not None), default=None)
        cells = [costs.get(method.name) for method in study.methods]
        rows.append([scene.name] + [f"**{number(cost)}**" if cost is not None and cost == least else number(cost)
                                    for cost in cells])
    return table(["scene", *(method.name for method in study.methods)], rows)


def left_out_table(study, summaries):
    """What has no result, and why: left out by the study, or impossible to the renderer. Empty if there is nothing."""
    found = {}
    for scene, method, reason in study.left_out():
        found.setdefault((method.name, reason), []).append(scene.name)
    for by_seconds in summaries.values():
        for s in list(by_seconds.values())[-1].values():
            if s.skipped:
                found.setdefault((s.method.name, s.skipped), []).append(s.scene.name)
    if not found:
        return ""
    order = [method.name for method in study.methods]
    lines = sorted(found.items(), key=lambda entry: order.index(entry[0][0]))
    return table(["method", "scenes", "why"], [[method, ", ".join(scenes), reason] for (method, reason), scenes in lines], words=3)


def cost_table(summaries):
    done = [s for s in summaries.values() if s.seeds]
    stages = [stage for stage in STAGES if any(stage in s.stages for s in done)]
    once = {"load", "prepare"}
    header = ["method", "peak memory, MB", "processor share"]
    header += [f"{stage}, {'s' if stage in once else 'ms per pass'}" for stage in stages] + ["non-finite samples"]
    rows = []
    for s in done:
        row = [s.method.name, number(s.memory / 1e6), f"{100 * s.share:.0f} %"]
        for stage in stages:
            seconds = s.stages.get(stage)
            row.append(number(seconds if stage in once or seconds is None else 1000 * seconds / s.passes))
        rows.append([*row, s.non_finite])
    return table(header, rows)


def published_table(published):
    rows = []
    for row in published.rows:
        bias = f"< {row['bias_below']}" if "bias_below" in row else number(row.get("bias"))
        rows.append([row["method"], number(row.get("passes")), number(row.get("std")), bias, number(row.get("mean_ratio")),
                     number(row.get("memory_mb"))])
    return (f"Published implementation, {published.seconds:g} s on {published.threads} threads ({published.source}):\n\n"
            + table(["method", "passes", "rel. std", "block bias", "mean ratio", "memory, MB"], rows))
