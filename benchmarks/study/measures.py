"""What a set of renders is measured by.

All measures are of the grey image, the mean of R, G and B, and relative to the mean of the grey reference. Noise and
bias are kept apart: bias is what remains of the difference of block means once the noise of both sides is subtracted.
"""

from dataclasses import dataclass

import numpy as np

from flip import flip
from images import tone_map


def grey(image):
    """Mean of the channels."""
    return image.mean(axis=-1)


def relmse99(grey_image, grey_reference):
    """Mean squared difference once both are divided by the 0.99 quantile of the reference's pixels; noise of both included."""
    return float(np.mean((grey_image - grey_reference) ** 2) / np.quantile(grey_reference, 0.99) ** 2)


def median_error(grey_image, grey_reference):
    """Median over pixels of the absolute difference, relative to the reference's mean: bright outliers do not move it."""
    return float(np.median(np.abs(grey_image - grey_reference)) / np.mean(grey_reference))


def picture_difference(image, reference):
    """Mean FLIP of the pictures, tone-mapped alike: the 0.99 quantile of the reference is white."""
    white = float(np.quantile(reference, 0.99)) or 1.0
    return float(flip(tone_map(reference, white), tone_map(image, white)).mean())


def relative_std(standard_error, reference_mean):
    """rms over pixels of a render's own standard error (h, w, 3), relative.

    The channels of a path vary together, so the error of their mean is taken as the mean of their errors: exact for full
    correlation, otherwise an upper bound.
    """
    return float(np.sqrt(np.mean(grey(standard_error) ** 2)) / reference_mean)


def spread_std(greys, reference_mean):
    """rms over pixels of the standard deviation over independent renders (at least two), relative."""
    return float(np.sqrt(np.mean(np.var(greys, axis=0, ddof=1))) / reference_mean)


def block_means(image, block):
    """Means of block x block pixels; the block must divide both sides."""
    height, width = image.shape
    if height % block or width % block:
        raise ValueError(f"blocks of {block} pixels do not divide an image of {width}x{height}")
    return image.reshape(height // block, block, width // block, block).mean(axis=(1, 3))


def block_variance_of_independent_pixels(standard_error, block):
    """Mean variance of the block means of a render whose pixels are independent, from its stderr layer (h, w, 3)."""
    return float(np.mean(grey(standard_error) ** 2)) / block**2


@dataclass(frozen=True)
class Bias:
    """Mean squared bias of block means, relative, and its standard error over blocks. Unbiased, so it can be negative."""

    squared: float
    error: float

    @property
    def is_significant(self):
        return self.squared > 2 * self.error

    @property
    def bound(self):
        """rms bias that is exceeded with a probability of a few percent."""
        return float(np.sqrt(max(self.squared, 0.0) + 2 * self.error))


def block_bias(greys, reference, reference_block_variance, block):
    """Bias of independent renders (at least two; at the reference's resolution) against a grey reference.

    E[(M - R)^2] = bias^2 + var(M) + var(R) for the mean M of n renders' block means: var(M) is their variance over the
    renders divided by n, which holds for noise that is correlated between pixels too.
    """
    means = np.array([block_means(image, block) for image in greys])
    noise = means.var(axis=0, ddof=1) / len(means)
    squared = (means.mean(axis=0) - block_means(reference, block)) ** 2 - noise - reference_block_variance
    squared /= np.mean(reference) ** 2
    return Bias(float(squared.mean()), float(squared.std(ddof=1) / np.sqrt(squared.size)))


def mean_squared_error(std, bias_squared):
    """std^2 + bias^2; an estimate of the squared bias below zero counts as zero."""
    return std**2 + max(bias_squared, 0.0)


def gain(other_std, other_bias_squared, std, bias_squared, time_ratio=1.0):
    """MSE of another method over that of this one. `time_ratio` is the other's time over this one's: the other's variance
    is brought to this one's time by it, its bias stays."""
    other = mean_squared_error(other_std * np.sqrt(time_ratio), other_bias_squared)
    own = mean_squared_error(std, bias_squared)
    return float(other / own) if own > 0 else float("nan")
