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
    if hasattr(result, "mean"):
        mean, edges, about = result.mean, result.time_edges, result.metadata
    else:
        text = result["metadata.json" if "metadata.json" in result else "metadata"]
        text = text[()] if hasattr(text, "shape") else text
        mean, edges, about = np.asarray(result["mean"]), np.asarray(result["time_edges"]), json.loads(text)
    widths = np.diff(edges)
    if not np.all(np.isfinite(widths) & (widths > 0)):
        raise ValueError("expected a film of frames: in steady state, and at a single moment, there is no time to look at")
    channels = mean.shape[-1]
    if channel is not None and not 0 <= channel < channels:
        raise ValueError(f"channel: expected None, or a number from 0 to {channels - 1}, found {channel!r}")
    if channel is not None:
        image = mean[..., channel].astype(float)
    else:
        image = mean[..., 0].astype(float) if channels == 1 else mean @ LUMINANCE
    integrated = "integrated" in about["quantity"]
    return (image if integrated else image * widths[:, None, None]), edges


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
