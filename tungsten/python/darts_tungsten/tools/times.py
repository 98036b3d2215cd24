"""Maps of times of flight."""

import numpy as np

from .film import along_time, checked


def peak_time(light, edges, threshold=0.0):
    """When most light arrives, by pixel: the vertex of the parabola through the logarithms of the brightest frame and its
    neighbours, exact for a gaussian in frames of one width; the frame's centre at the ends and where a neighbour is dark.

    NaN where no frame's light exceeds `threshold`.
    """
    light, edges = checked(light, edges)
    density = light / along_time(np.diff(edges), light)
    top = np.argmax(density, axis=0)
    centres = (edges[1:] + edges[:-1]) / 2
    last = len(light) - 1

    def at(frames):
        return np.take_along_axis(density, np.clip(frames, 0, last)[None], axis=0)[0]

    before, here, after = at(top - 1), at(top), at(top + 1)
    widths = np.diff(edges)
    low, high = np.maximum(top - 1, 0), np.minimum(top + 1, last)
    even = np.isclose(widths[low], widths[top]) & np.isclose(widths[high], widths[top])
    inside = (top > 0) & (top < last) & (before > 0) & (after > 0) & even
    left, middle, right = (np.log(np.where(inside, value, 1.0)) for value in (before, here, after))
    bend = left - 2 * middle + right
    offset = np.where(bend < 0, 0.5 * (left - right) / np.where(bend < 0, bend, 1.0), 0.0)
    times = centres[top] + np.where(inside, offset, 0.0) * widths[top]
    brightest = np.take_along_axis(light, top[None], axis=0)[0]
    return np.where(brightest > threshold, times, np.nan)[()]


def mean_time(light, edges):
    """The centre of the light's arrival, by pixel; NaN where there is none."""
    light, edges = checked(light, edges)
    total = light.sum(axis=0)
    moment = (light * along_time((edges[1:] + edges[:-1]) / 2, light)).sum(axis=0)
    return np.where(total > 0, moment / np.where(total > 0, total, 1.0), np.nan)[()]


def spread(light, edges):
    """The standard deviation of the light's arrival, by pixel, as light that is even over each frame has it; NaN where there is
    none."""
    light, edges = checked(light, edges)
    total = light.sum(axis=0)
    away = along_time((edges[1:] + edges[:-1]) / 2, light) - mean_time(light, edges)
    squares = away ** 2 + along_time(np.diff(edges) ** 2 / 12, light)
    variance = (light * squares).sum(axis=0) / np.where(total > 0, total, 1.0)
    return np.where(total > 0, np.sqrt(np.maximum(variance, 0.0)), np.nan)[()]
