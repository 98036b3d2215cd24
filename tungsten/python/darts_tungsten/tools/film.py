"""From a result to light by frame."""

import json

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # Rec. 709


def per_frame(result, channel=None):
    """(light, edges) of a result: what arrives during each frame, frames x height x width, and the frames' edges.

    `result` is a Result, or what numpy.load and h5py.File make of a result file (.npz, .h5). Light is radiance integrated over each
    frame, whatever the scene's time_normalization; multiplied by photons per radiance and time of a pixel it is a number of photons.
    `channel` is 0, 1 or 2 for red, green or blue; None for luminance.
    """
    about = _metadata(result)
    if hasattr(result, "mean"):
        mean, edges = result.mean, result.time_edges
    else:
        mean, edges = np.asarray(result["mean"]), np.asarray(result["time_edges"])
    widths = np.diff(edges)
    if not np.all(np.isfinite(widths) & (widths > 0)):
        raise ValueError("expected a film of frames: in steady state, and at a single moment, there is no time to look at")
    image = _one_channel(mean, channel)
    integrated = "integrated" in about["quantity"]
    return (image if integrated else image * widths[:, None, None]), edges


def region(result, rows, columns, channel=None):
    """(mean, standard error) of a region of pixels by frame: the mean of what a pixel holds, and its error from the spread of the
    film's batches (`"film": {"batches": 16}` in the scene), which is right where pixels err together, as those of photon maps do.

    `result` as for per_frame. `rows` and `columns` are slices of pixels that begin and end where blocks do (`batch_block`, 4
    pixels), or at the image's edge. With N batches the error is itself uncertain by 1 / sqrt(2 (N - 1)) of it: 18 % with 16.
    """
    of = (lambda name: getattr(result, name)) if hasattr(result, "mean") else (lambda name: result[name] if name in result else None)
    batches = of("batch_means")
    if batches is None:
        raise ValueError('the film has no batches: give the scene "film": {"batches": 16}, or set={"film.batches": 16}')
    weights, about = np.asarray(of("batch_weights")), _metadata(result)
    height, width = of("mean").shape[1:3]
    vertical, horizontal = (_share(where, side, about["batch block"], name)
                            for where, side, name in ((rows, height, "rows"), (columns, width, "columns")))
    values = np.einsum("bfyxc,y,x->bfc", np.asarray(batches, dtype=float), vertical, horizontal)
    values = _one_channel(values, channel)
    values, weights = values[weights > 0], weights[weights > 0, None]
    mean = (weights * values).sum(axis=0) / weights.sum()
    if len(values) < 2:
        return mean, np.full(mean.shape, np.nan)
    return mean, np.sqrt((weights * np.square(values - mean)).sum(axis=0) / ((len(values) - 1) * weights.sum()))


def _share(where, side, block, name):
    """How much each block counts in the mean over these pixels."""
    first, end, step = where.indices(side)
    if step != 1 or end <= first or first % block or (end % block and end != side):
        raise ValueError(f"{name}: expected a slice from one multiple of {block} to another, or to the edge at {side}, found {where}")
    starts = np.arange(0, side, block)
    pixels = np.minimum(starts + block, side) - starts
    return np.where((starts >= first) & (starts < end), pixels, 0) / (end - first)


def _metadata(result):
    if hasattr(result, "mean"):
        return result.metadata
    text = result["metadata.json" if "metadata.json" in result else "metadata"]
    return json.loads(text[()] if hasattr(text, "shape") else text)


def _one_channel(values, channel):
    """Luminance, or the channel that is asked for; the last axis goes."""
    channels = values.shape[-1]
    if channel is not None and not 0 <= channel < channels:
        raise ValueError(f"channel: expected None, or a number from 0 to {channels - 1}, found {channel!r}")
    if channel is not None:
        return values[..., channel].astype(float)
    return values[..., 0].astype(float) if channels == 1 else values @ LUMINANCE


def checked(light, edges):
    """Both as arrays of doubles; ValueError if they do not belong together."""
    light, edges = np.asarray(light, dtype=float), np.asarray(edges, dtype=float)
    if edges.ndim != 1 or light.ndim < 1 or len(edges) != len(light) + 1:
        raise ValueError(f"expected one edge more than frames along axis 0, found {edges.shape} edges for light of {light.shape}")
    if not np.all(np.isfinite(edges)) or not np.all(np.diff(edges) > 0):
        raise ValueError("edges: expected finite, increasing times")
    if not np.all(np.isfinite(light)):
        raise ValueError("light: expected finite numbers")
    return light, edges


def along_time(values, light):
    """An array (frames,) shaped to multiply `light`."""
    return np.reshape(values, (-1,) + (1,) * (light.ndim - 1))
