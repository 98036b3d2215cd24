"""Plots of a scene's figures: MSE against time, gains, and MSE along a swept parameter."""

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter  # noqa: E402

from tables import baseline_of  # noqa: E402

PRIMITIVE_COLOURS = {"points": "tab:blue", "beams": "tab:orange", "paths": "tab:green", "planes": "tab:red",
                     "volumes": "tab:purple", "balls": "tab:brown", "volumes_balls": "tab:pink", "mis_volumes_balls": "tab:cyan",
                     "hypervolumes": "tab:olive"}
VARIANT_STYLES = {"plain": (":", "o"), "published": ("--", "s"), "best": ("-", "^")}


def styles(names):
    """Colour by primitive and line by variant for names such as "best beams"; a colour and marker each for the others."""
    chosen, spare = {}, 0
    for name in names:
        variant, _, primitive = name.partition(" ")
        if primitive in PRIMITIVE_COLOURS and variant in VARIANT_STYLES:
            line, marker = VARIANT_STYLES[variant]
            chosen[name] = {"color": PRIMITIVE_COLOURS[primitive], "linestyle": line, "marker": marker}
        else:
            chosen[name] = {"color": f"C{spare % 10}", "linestyle": "-", "marker": "osD^vP*Xhd"[spare // 10 % 10]}
            spare += 1
    return chosen


def plain_ticks(axis):
    """1, 2, 5 and 10 rather than powers of ten where the range is short."""
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}" if f"{value:e}"[0] in "25" else ""))


def _save(figure, folder, name):
    figure.savefig(folder / name, dpi=110, bbox_inches="tight")
    plt.close(figure)
    return name


def _mse_against_time(scene, by_seconds, folder):
    series = {}
    for summaries in by_seconds.values():
        for name, s in summaries.items():
            if s.seeds and s.mse:
                series.setdefault(name, []).append((s.wall, s.mse, max(s.bias_squared, 0.0) if s.bias and
                                                    s.bias.is_significant else None))
    if not series or max(len(points) for points in series.values()) < 2:
        return []
    figure, axes = plt.subplots(figsize=(8.5, 5.5))
    style = styles(series)
    for name, points in series.items():
        points.sort()
        axes.loglog([p[0] for p in points], [p[1] for p in points], label=name, **style[name])
        biased = [(time, bias) for time, _, bias in points if bias is not None]
        if biased:
            axes.loglog(*zip(*biased), color=style[name]["color"], linewidth=0.8, alpha=0.5)
    low, high = axes.get_xlim()
    top = axes.get_ylim()[1]
    axes.loglog([low, high], [top, top * low / high], color="0.8", zorder=0, label="1 / time")
    axes.set(xlabel="wall time of the passes, s", ylabel="MSE relative to (reference mean)²",
             title=f"{scene.name}: MSE against time (thin: bias² where significant)")
    axes.grid(which="both", color="0.93")
    plain_ticks(axes.xaxis)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return [("MSE against time", _save(figure, folder, f"{scene.name}-mse-time.png"))]


def _gains(study, scene, seconds, summaries, folder):
    baseline = baseline_of(study, summaries)
    names = [name for name, s in summaries.items() if s.seeds and s.gain_over(baseline) is not None]
    if len(names) < 2:
        return []
    figure, axes = plt.subplots(figsize=(8.5, 1.2 + 0.5 * len(names)))
    colours = styles(names)
    for row, name in enumerate(names):
        both = (summaries[name].gain_over(baseline), summaries[name].gain_over(baseline, at_equal_cpu=True))
        for shift, gain, alpha in ((-0.19, both[0], 1.0), (0.19, both[1], 0.45)):
            axes.barh(row + shift, gain - 1, 0.36, left=1, color=colours[name]["color"], alpha=alpha)
            axes.annotate(f"{gain:.3g}×", (gain, row + shift), va="center", fontsize=8,
                          xytext=(3 if gain >= 1 else -3, 0), textcoords="offset points", ha="left" if gain >= 1 else "right")
    axes.set_xscale("log")
    axes.margins(x=0.2)
    axes.axvline(1, color="0.3", linewidth=0.8)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    plain_ticks(axes.xaxis)
    axes.set(xlabel=f"MSE of {baseline.method.name} / MSE (solid: at equal wall time, pale: at equal CPU time)",
             title=f"{scene.name}: gain, {seconds:g} s")
    return [(f"Gain in {seconds:g} seconds", _save(figure, folder, f"{scene.name}-gain-{seconds:g}s.png"))]


def _sweeps(scene, seconds, summaries, folder):
    sweeps = {}
    for s in summaries.values():
        if s.seeds and s.method.swept and s.mse:
            parameter, value, method = s.method.swept
            sweeps.setdefault(parameter, {}).setdefault(method, []).append((value, s))
    found = []
    for parameter, methods in sweeps.items():
        figure, axes = plt.subplots(figsize=(8.5, 5))
        style = styles(methods)
        for method, points in methods.items():
            points.sort(key=lambda point: point[0])
            values = [value for value, _ in points]
            look = {"color": style[method]["color"]}
            axes.loglog(values, [s.mse for _, s in points], marker="o", label=f"{method}: MSE", **look)
            axes.loglog(values, [s.noise**2 for _, s in points], linestyle=":", label=f"{method}: variance", **look)
            biased = [(value, s.bias.squared) for value, s in points if s.bias and s.bias.is_significant]
            if biased:
                axes.loglog(*zip(*biased), linestyle="--", marker=".", label=f"{method}: bias²", **look)
        axes.set(xlabel=parameter, ylabel="relative to (reference mean)²", title=f"{scene.name}, {seconds:g} s: {parameter}")
        axes.grid(which="both", color="0.93")
        plain_ticks(axes.xaxis)
        axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
        name = f"{scene.name}-{parameter.replace(' ', '-')}-{seconds:g}s.png"
        found.append((f"Sweep of the {parameter}, {seconds:g} seconds", _save(figure, folder, name)))
    return found


def scene_plots(study, scene, by_seconds, folder):
    """Writes what there is to plot; (title, file name) of each."""
    found = _mse_against_time(scene, by_seconds, folder)
    seconds, summaries = list(by_seconds.items())[-1]
    return found + _gains(study, scene, seconds, summaries, folder) + _sweeps(scene, seconds, summaries, folder)
