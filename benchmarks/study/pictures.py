"""Side-by-side pictures of the methods, tone-mapped alike, with their differences from the reference."""

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import measures  # noqa: E402
from images import read_exr, tone_map  # noqa: E402
from tables import bias_text, number  # noqa: E402

COLUMNS = 4
WHITE_PERCENTILE = 99.0  # of the reference: what is brighter is white
DIFFERENCE_RANGE = 0.5  # of the reference's mean, at the ends of the colour scale


def _show_difference(axes, difference, title):
    shown = axes.imshow(difference, cmap="RdBu_r", vmin=-DIFFERENCE_RANGE, vmax=DIFFERENCE_RANGE, interpolation="nearest")
    axes.set_title(title, fontsize=8)
    return shown


def _column(axes, summary, reference, white, block):
    """The first seed's image, and the differences of the seeds' mean."""
    axes[0].imshow(tone_map(read_exr(summary.image)[""], white), interpolation="nearest")
    axes[0].set_title(f"{summary.method.name}\nstd {number(summary.noise)}, bias {bias_text(summary.bias)}", fontsize=9)
    average = measures.grey(summary.average)
    _show_difference(axes[1], (average - reference.grey) / reference.mean, f"mean of {summary.seeds} − reference")
    blocks = measures.block_means(average, block) - measures.block_means(reference.grey, block)
    return _show_difference(axes[2], blocks / reference.mean, f"the same, {block}×{block} blocks")


def _reference_column(axes, reference, white, block):
    axes[0].imshow(tone_map(reference.image, white), interpolation="nearest")
    axes[0].set_title("reference\n", fontsize=9)
    noise = np.sqrt(reference.block_variance) / reference.mean
    axes[2].text(0.5, 0.5, f"reference's own noise:\n{noise:.3f} per block", ha="center", va="center", fontsize=8,
                 transform=axes[2].transAxes)
    axes[1].text(0.5, 0.5, f"{noise * block:.2f} per pixel\nif independent", ha="center", va="center", fontsize=8,
                 transform=axes[1].transAxes)


def scene_pictures(study, scene, by_seconds, reference, folder):
    """Writes pictures of the longest renders, a few methods each beside the reference; (title, file name) of each."""
    seconds, summaries = list(by_seconds.items())[-1]
    done = [s for s in summaries.values() if s.seeds]
    white = float(np.percentile(reference.image, WHITE_PERCENTILE)) or 1.0
    found = []
    for first in range(0, len(done), COLUMNS):
        group = done[first:first + COLUMNS]
        figure, axes = plt.subplots(3, len(group) + 1, figsize=(2.7 * (len(group) + 1), 8.4), squeeze=False,
                                    layout="constrained")
        for cell in axes.flat:
            cell.axis("off")
        _reference_column(axes[:, 0], reference, white, study.block)
        for column, summary in enumerate(group, 1):
            scale = _column(axes[:, column], summary, reference, white, study.block)
        figure.colorbar(scale, ax=axes[1:, :], shrink=0.6, label="difference / reference's mean")
        name = f"{scene.name}-pictures-{first // COLUMNS + 1}.png"
        figure.savefig(folder / name, dpi=100)
        plt.close(figure)
        shown = ", ".join(s.method.name for s in group)
        found.append((f"Pictures after {seconds:g} seconds: {shown}", name))
    return found
