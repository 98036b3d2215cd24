"""Figures: what all have in common, and the plots and pictures of a study's report."""

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter  # noqa: E402

from darts_bench import measures  # noqa: E402
from darts_bench.images import read_exr, tone_map  # noqa: E402
from darts_bench.tables import baseline_of, bias_text, number  # noqa: E402

COLOURS = {"points": "tab:blue", "beams": "tab:orange", "paths": "tab:green", "planes": "tab:red", "volumes": "tab:purple",
           "balls": "tab:brown", "volumes_balls": "tab:pink", "mis_volumes_balls": "tab:cyan", "hypervolumes": "tab:olive"}
LINES = {"plain": (":", "o"), "published": ("--", "s"), "best": ("-", "^")}  # and markers
COLUMNS = 4  # of pictures beside the reference
WHITE_PERCENTILE = 99.0  # of the reference: what is brighter is white
DIFFERENCE_RANGE = 0.5  # of the reference's mean, at the ends of the colour scale


# ---- What all figures have in common

def look(name):
    """Of a method such as "best beams": colour by primitive, line by preset."""
    preset, primitive = name.split(" ")
    return {"color": COLOURS[primitive], "linestyle": LINES[preset][0]}


def styles(names):
    """The same with a marker by preset; a colour and marker each for methods of other names."""
    chosen, spare = {}, 0
    for name in names:
        preset, _, primitive = name.partition(" ")
        if primitive in COLOURS and preset in LINES:
            chosen[name] = {**look(name), "marker": LINES[preset][1]}
        else:
            chosen[name] = {"color": f"C{spare % 10}", "linestyle": "-", "marker": "osD^vP*Xhd"[spare // 10 % 10]}
            spare += 1
    return chosen


def panels(count=1, width=4.2, height=3.4):
    """A figure and its axes, side by side."""
    figure, axes = plt.subplots(1, count, figsize=(width * count, height), constrained_layout=True, squeeze=False)
    for one in axes[0]:
        one.grid(which="both", color="0.92")
        one.tick_params(labelsize=8)
    return figure, list(axes[0])


def plain_log(axis, decades=1.5):
    """A logarithmic axis with few labels that can be read: powers of ten, or below so many decades 1, 2 and 5."""
    low, high = axis.get_view_interval()
    if high / low < 10**decades:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low > 3 else (1, 1.5, 2, 3, 5, 7)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def in_rows(panel, names, label):
    """A row for each name, from the top, along a logarithmic axis on which 1 is marked."""
    panel.set_xscale("log")
    panel.axvline(1, color="0.3", linewidth=0.8)
    panel.set_yticks(range(len(names)), names)
    panel.invert_yaxis()
    panel.set_xlabel(label, fontsize=9)


def ranges(panel, found, label, colours=COLOURS):
    """Rows of {name: {series: (value, least, largest)}}: a dot in each row and a bar beside it, by series."""
    for place, of_name in enumerate(found.values()):
        for i, (series, (value, low, high)) in enumerate(of_name.items()):
            at, colour = place + 0.22 * (i - (len(of_name) - 1) / 2), colours.get(series, "tab:blue")
            panel.plot([low, high], [at, at], color=colour, linewidth=3, alpha=0.35)
            panel.plot(value, at, marker="o", markersize=4, color=colour, label=series if place == 0 else None)
    in_rows(panel, list(found), label)


def frames_of(rows, columns, width, height):
    """A figure for pictures, each so wide, and its cells by row and column."""
    figure, axes = plt.subplots(rows, columns, figsize=(width * columns, height), squeeze=False, layout="constrained")
    for cell in axes.flat:
        cell.axis("off")
    return figure, axes


def show(axes, image, white, title):
    """A picture of an image (height, width, 3)."""
    axes.imshow(tone_map(image, white), interpolation="nearest")
    axes.set_title(title, fontsize=9)


def show_difference(axes, difference, title):
    """Of a grey image, over the reference's mean. Returns what a colour bar is of."""
    axes.set_title(title, fontsize=8)
    return axes.imshow(difference, cmap="RdBu_r", vmin=-DIFFERENCE_RANGE, vmax=DIFFERENCE_RANGE, interpolation="nearest")


def save(figure, file, dpi=100):
    """An SVG keeps its words as words, which is a few kB, and has no date: the same figures make the same file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": file.stem, "font.family": "sans-serif"}):
        figure.savefig(file, dpi=dpi, metadata={"Date": None} if file.suffix == ".svg" else None)
    plt.close(figure)


# ---- A study's report

def _saved(figure, folder, name):
    save(figure, folder / name)
    return name


def _errors_against(parameter, series, title):
    """A figure of {method: [(value of the parameter, summary)]}, its axes to be added to."""
    figure, (axes,) = panels(1, 9.5, 5.3)
    for method, style in styles(series).items():
        values, points = zip(*sorted(series[method], key=lambda point: point[0]))
        axes.loglog(values, [s.mse for s in points], label=method, **style)
        biases = [s.bias.squared if s.bias and s.bias.is_significant else np.nan for s in points]
        for part, line in (([s.noise**2 for s in points], ":"), (biases, "--")):
            axes.loglog(values, part, line, color=style["color"], linewidth=0.8, alpha=0.6)
    axes.set(xlabel=parameter, ylabel="relative to (reference mean)²", title=f"{title}: MSE (thin: variance dotted, bias² dashed where significant)")
    return figure, axes


def _saved_errors(figure, axes, folder, name):
    plain_log(axes.xaxis)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return _saved(figure, folder, name)


def _mse_against_time(scene, by_seconds, folder):
    series = {}
    for summaries in by_seconds.values():
        for name, s in summaries.items():
            if s.seeds and s.mse:
                series.setdefault(name, []).append((s.wall, s))
    if not series or max(map(len, series.values())) < 2:
        return []
    figure, axes = _errors_against("wall time of the passes, s", series, scene.name)
    (low, high), top = axes.get_xlim(), axes.get_ylim()[1]
    axes.loglog([low, high], [top, top * low / high], color="0.8", zorder=0, label="1 / time")
    return [("MSE against time", _saved_errors(figure, axes, folder, f"{scene.name}-mse-time.png"))]


def _gains(study, scene, seconds, summaries, folder):
    baseline = baseline_of(study, summaries)
    names = [name for name, s in summaries.items() if s.seeds and s.gain_over(baseline) is not None]
    if len(names) < 2:
        return []
    figure, (axes,) = panels(1, 8.5, 1.2 + 0.5 * len(names))
    colours = styles(names)
    for row, name in enumerate(names):
        both = (summaries[name].gain_over(baseline), summaries[name].gain_over(baseline, at_equal_cpu=True))
        for shift, gain, alpha in ((-0.19, both[0], 1.0), (0.19, both[1], 0.45)):
            axes.barh(row + shift, gain - 1, 0.36, left=1, color=colours[name]["color"], alpha=alpha)
            axes.annotate(f"{gain:.3g}×", (gain, row + shift), va="center", fontsize=8,
                          xytext=(3 if gain >= 1 else -3, 0), textcoords="offset points", ha="left" if gain >= 1 else "right")
    in_rows(axes, names, f"MSE of {baseline.method.name} / MSE (solid: at equal wall time, pale: at equal CPU time)")
    axes.margins(x=0.2)
    axes.set_axisbelow(True)
    plain_log(axes.xaxis, decades=2.5)
    axes.set_title(f"{scene.name}: gain, {seconds:g} s")
    return [(f"Gain in {seconds:g} seconds", _saved(figure, folder, f"{scene.name}-gain-{seconds:g}s.png"))]


def _sweeps(scene, seconds, summaries, folder):
    sweeps, found = {}, []
    for s in summaries.values():
        if s.seeds and s.method.swept and s.mse:
            parameter, value, method = s.method.swept
            sweeps.setdefault(parameter, {}).setdefault(method, []).append((value, s))
    for parameter, series in sweeps.items():
        figure, axes = _errors_against(parameter, series, f"{scene.name}, {seconds:g} s")
        name = f"{scene.name}-{parameter.replace(' ', '-')}-{seconds:g}s.png"
        found.append((f"Sweep of the {parameter}, {seconds:g} seconds", _saved_errors(figure, axes, folder, name)))
    return found


def scene_plots(study, scene, by_seconds, folder):
    """Writes what there is to plot; (title, file name) of each."""
    found = _mse_against_time(scene, by_seconds, folder)
    seconds, summaries = list(by_seconds.items())[-1]
    return found + _gains(study, scene, seconds, summaries, folder) + _sweeps(scene, seconds, summaries, folder)


def _column(axes, summary, reference, white, block):
    """The first seed's image, and the differences of the seeds' mean."""
    show(axes[0], read_exr(summary.image)[""], white, f"{summary.method.name}\nstd {number(summary.noise)}, bias {bias_text(summary.bias)}")
    average = measures.grey(summary.average)
    show_difference(axes[1], (average - reference.grey) / reference.mean, f"mean of {summary.seeds} − reference")
    blocks = measures.block_means(average, block) - measures.block_means(reference.grey, block)
    return show_difference(axes[2], blocks / reference.mean, f"the same, {block}×{block} blocks")


def _reference_column(axes, reference, white, block):
    show(axes[0], reference.image, white, "reference\n")
    noise = np.sqrt(reference.block_variance) / reference.mean
    for place, text in ((2, f"reference's own noise:\n{noise:.3f} per block"), (1, f"{noise * block:.2f} per pixel\nif independent")):
        axes[place].text(0.5, 0.5, text, ha="center", va="center", fontsize=8, transform=axes[place].transAxes)


def scene_pictures(study, scene, by_seconds, reference, folder):
    """Writes pictures of the longest renders, a few methods each beside the reference; (title, file name) of each."""
    seconds, summaries = list(by_seconds.items())[-1]
    done = [s for s in summaries.values() if s.seeds]
    white = float(np.percentile(reference.image, WHITE_PERCENTILE)) or 1.0
    found = []
    for first in range(0, len(done), COLUMNS):
        group = done[first:first + COLUMNS]
        figure, axes = frames_of(3, len(group) + 1, 2.7, 8.4)
        _reference_column(axes[:, 0], reference, white, study.block)
        for column, summary in enumerate(group, 1):
            scale = _column(axes[:, column], summary, reference, white, study.block)
        figure.colorbar(scale, ax=axes[1:, :], shrink=0.6, label="difference / reference's mean")
        name = f"{scene.name}-pictures-{first // COLUMNS + 1}.png"
        shown = ", ".join(s.method.name for s in group)
        found.append((f"Pictures after {seconds:g} seconds: {shown}", _saved(figure, folder, name)))
    return found
