"""FLIP, how different two pictures look to someone who flips between them: Andersson et al., "FLIP: A Difference Evaluator for
Alternating Images", 2020. Of sRGB pictures in [0, 1], (height, width, 3)."""

import numpy as np

PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * np.pi / 180  # 0.7 m from a 4K screen of 0.7 m
# Contrast sensitivity of the eye (table 1): a1, b1, a2, b2 of luminance, red to green, blue to yellow; b in degrees².
SENSITIVITY = np.array([[1, 0.0047, 0, 1e-5], [1, 0.0053, 0, 1e-5], [34.1, 0.04, 13.5, 0.025]])
COLOUR_EXPONENT, COLOUR_CUT, COLOUR_TOP = 0.7, 0.4, 0.95  # q_c, p_c, p_t
FEATURE_EXPONENT, FEATURE_WIDTH = 0.5, 0.082  # q_f; w in degrees
TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
WHITE = TO_XYZ.sum(axis=1)


def linear(picture):
    return np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)


def opponent(rgb):
    """YyCxCz of linear sRGB, linear as well."""
    x, y, z = np.moveaxis(rgb @ TO_XYZ.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def from_opponent(yxz):
    y = (yxz[..., 0] + 16) / 116
    xyz = np.stack([y + yxz[..., 1] / 500, y, y - yxz[..., 2] / 200], axis=-1) * WHITE
    return xyz @ np.linalg.inv(TO_XYZ).T


def hunt_lab(rgb):
    """CIELAB of linear sRGB whose colours fade with their lightness (Hunt)."""
    ratio, delta = rgb @ TO_XYZ.T / WHITE, 6 / 29
    x, y, z = np.moveaxis(np.where(ratio > delta**3, np.cbrt(ratio), ratio / (3 * delta**2) + 4 / 29), -1, 0)
    lightness = 116 * y - 16
    return np.stack([lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)], axis=-1)


def hyab(one, other):
    d = one - other
    return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])


def convolved(image, kernel):
    """Of a single channel, its edges repeated; the kernel is a square of odd side."""
    radius = kernel.shape[0] // 2
    padded = np.pad(image, radius, mode="edge")
    height, width = image.shape
    return sum(kernel[i, j] * padded[i:i + height, j:j + width] for i, j in np.argwhere(kernel != 0))


def offsets(radius):
    x = np.arange(-radius, radius + 1.0)
    return x[None, :], x[:, None]


def sensitivity_kernel(a1, b1, a2, b2, ppd):
    """Equation 6, sum 1."""
    x, y = offsets(int(np.ceil(3 * np.sqrt(SENSITIVITY[:, 1].max() / (2 * np.pi**2)) * ppd)))
    squared = (x**2 + y**2) / ppd**2
    kernel = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi**2 * squared / b) for a, b in ((a1, b1), (a2, b2)))
    return kernel / kernel.sum()


def seen(picture, ppd):
    """What is left of colours at that distance, as Hunt-adjusted CIELAB."""
    channels = opponent(linear(picture))
    blurred = [convolved(channels[..., i], sensitivity_kernel(*SENSITIVITY[i], ppd)) for i in range(3)]
    return hunt_lab(np.clip(from_opponent(np.stack(blurred, axis=-1)), 0, 1))


def colour_difference(reference, test, ppd):
    """Of pixels, in [0, 1] (equations 9 to 11)."""
    green, blue = (hunt_lab(np.array(rgb, float)) for rgb in ([0, 1, 0], [0, 0, 1]))
    most = hyab(green, blue) ** COLOUR_EXPONENT
    difference, cut = hyab(seen(reference, ppd), seen(test, ppd)) ** COLOUR_EXPONENT, COLOUR_CUT * most
    return np.where(difference < cut, COLOUR_TOP / cut * difference, COLOUR_TOP + (difference - cut) / (most - cut) * (1 - COLOUR_TOP))


def balanced(kernel):
    """Positive weights of sum 1, negative ones of sum -1."""
    return np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())


def features(picture, ppd):
    """How much of an edge and of a point there is at every pixel."""
    luminance = (opponent(linear(picture))[..., 0] + 16) / 116
    deviation = 0.5 * FEATURE_WIDTH * ppd
    x, y = offsets(int(np.ceil(3 * deviation)))
    bell = np.exp(-(x**2 + y**2) / (2 * deviation**2))
    kernels = [balanced(-x * bell), balanced((x**2 / deviation**2 - 1) * bell)]
    return [np.hypot(convolved(luminance, kernel), convolved(luminance, kernel.T)) for kernel in kernels]


def flip(reference, test, pixels_per_degree=PIXELS_PER_DEGREE):
    """Difference of every pixel, from 0 to 1; the figure for two pictures is the mean."""
    colour = colour_difference(reference, test, pixels_per_degree)
    of_reference, of_test = features(reference, pixels_per_degree), features(test, pixels_per_degree)
    feature = np.maximum(*(np.abs(one - other) for one, other in zip(of_reference, of_test)))
    return colour ** (1 - np.minimum((feature / np.sqrt(2)) ** FEATURE_EXPONENT, 1))
