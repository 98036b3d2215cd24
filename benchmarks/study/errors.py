"""Errors of renders against a reference, whose own noise is taken off, relative to its mean; curves over time and seeds."""

from dataclasses import dataclass

import numpy as np

from measures import grey, picture_difference


@dataclass(frozen=True)
class Truth:
    """What renders are compared with: mean and standard error, (frames, height, width, 3)."""

    image: np.ndarray
    error: np.ndarray | None = None  # None: exact

    @property
    def grey(self):
        return grey(self.image)

    @property
    def variance(self):
        """Mean over pixels. Errors of the channels go together, as those of paths do."""
        return 0.0 if self.error is None else float(np.mean(grey(self.error) ** 2))

    @property
    def scale(self):
        """Mean squared value of the mean image: what squared errors are relative to."""
        return float(self.image.mean()) ** 2


def mse(image, truth):
    """Mean squared error of the grey image over (reference mean)^2; unbiased, so that noise can make it negative."""
    return (float(np.mean((grey(image) - truth.grey) ** 2)) - truth.variance) / truth.scale


def relmse99(image, truth):
    """Mean squared error after both images are divided by the 0.99 quantile of the reference's pixels."""
    return mse(image, truth) * truth.scale / float(np.quantile(truth.grey, 0.99)) ** 2


@dataclass(frozen=True)
class Parts:
    """Of the same render by several seeds: MSE, what of it is variance, and what bias, squared. Relative."""

    mse: float
    relmse99: float
    variance: float
    bias: float
    doubt: float  # about that bias: two standard errors
    median: float  # of the seeds' relative root mean squared errors
    flip: float  # mean over pixels, frames and seeds
    cpu: float
    passes: float

    @property
    def cost(self):
        """MSE x CPU seconds: 1 / efficiency."""
        return self.mse * self.cpu

    @property
    def certain_cost(self):
        """The same of the variance, and of the bias where it is beyond doubt: the noise of a reference does not enter it."""
        return (self.variance + (self.bias if self.bias > self.doubt else 0.0)) * self.cpu


def parts(renders, truth, at=-1):
    images = [render.image(at) for render in renders]
    greys = np.array([grey(image) for image in images])
    variance = float(np.var(greys, axis=0, ddof=1).mean()) / truth.scale if len(images) > 1 else np.nan
    means = np.mean(images, axis=0)
    squares = [mse(image, truth) for image in images]
    # Neighbours vary together: 16 pixels count as one.
    doubt = 2 * np.std((grey(means) - truth.grey) ** 2) / np.sqrt(means[..., 0].size / 16) / truth.scale
    looks = [picture_difference(image[frame], truth.image[frame]) for image in images for frame in range(len(image))]
    return Parts(float(np.mean(squares)), float(np.mean([relmse99(image, truth) for image in images])), variance,
                 mse(means, truth) - variance / len(images), float(doubt), float(np.median(np.sqrt(np.maximum(squares, 0.0)))),
                 float(np.mean(looks)), float(np.mean([render.cpu[at] for render in renders])), float(np.mean([render.passes[at] for render in renders])))


def curve(render, truth):
    """CPU seconds and relative root mean squared errors along a render's trace."""
    errors = [mse(render.image(i), truth) for i in range(len(render.entries))]
    return render.cpu, np.sqrt(np.maximum(errors, 1e-12))


def band(curves, points=9):
    """CPU seconds that all curves cover, and the median, least and largest error there, between logarithms."""
    low, high = max(cpu[0] for cpu, _ in curves), min(cpu[-1] for cpu, _ in curves)
    grid = np.geomspace(low, high, points)
    errors = np.array([np.exp(np.interp(np.log(grid), np.log(cpu), np.log(error))) for cpu, error in curves])
    return grid, np.median(errors, axis=0), errors.min(axis=0), errors.max(axis=0)


def slope(x, y):
    """Exponent of a power law through points, and its standard error (of the fit's residuals)."""
    x, y = np.log(x), np.log(y)
    fit, covariance = np.polyfit(x, y, 1, cov="unscaled")
    residuals = y - np.polyval(fit, x)
    spread = np.sqrt(covariance[0, 0] * np.sum(residuals**2) / max(len(x) - 2, 1))
    return float(fit[0]), float(spread)


def seconds_to(error, cost, bias=0.0):
    """CPU seconds to a relative error of an estimator whose MSE falls as cost / seconds above a squared bias that stays;
    None where the bias alone is larger."""
    left = error**2 - max(bias, 0.0)
    return cost / left if left > 0 else None
