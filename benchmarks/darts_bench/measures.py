"""What sets of renders are measured by: errors against a reference, noise and bias of studies, agreement of sweeps.

Measures of errors are of the grey image, the mean of R, G and B, and relative to the mean of the grey reference.
"""

from dataclasses import dataclass

import numpy as np

from darts_bench.flip import flip
from darts_bench.images import tone_map


def grey(image):
    """Mean of the channels."""
    return image.mean(axis=-1)


def standard_error(values):
    """Of the mean of independent values; NaN of a single one."""
    return float(np.std(values, ddof=1) / np.sqrt(len(values))) if len(values) > 1 else np.nan


# ---- Errors against a reference

@dataclass(frozen=True)
class Truth:
    """What renders are compared with: mean and standard error, (frames, height, width, 3), or a single image."""

    image: np.ndarray
    error: np.ndarray | None = None  # None: taken as exact
    block_variance: float = 0.0  # of the means of a study's blocks

    @property
    def grey(self):
        return grey(self.image)

    @property
    def mean(self):
        return float(self.image.mean())

    @property
    def variance(self):
        """Mean over pixels. Errors of the channels go together, as those of paths do."""
        return 0.0 if self.error is None else float(np.mean(grey(self.error) ** 2))

    @property
    def scale(self):
        """Mean squared value of the mean image: what squared errors are relative to."""
        return self.mean**2


def mse(image, truth):
    """Mean squared error of the grey image over (reference mean)^2, the reference's own noise taken off; unbiased, so that noise can make it
    negative."""
    return (float(np.mean((grey(image) - truth.grey) ** 2)) - truth.variance) / truth.scale


def relmse99(image, truth):
    """The same after both images are divided by the 0.99 quantile of the reference's pixels."""
    return mse(image, truth) * truth.scale / float(np.quantile(truth.grey, 0.99)) ** 2


def median_error(grey_image, grey_reference):
    """Median over pixels of the absolute difference, relative to the reference's mean: bright outliers do not move it."""
    return float(np.median(np.abs(grey_image - grey_reference)) / np.mean(grey_reference))


def picture_difference(image, reference):
    """Mean FLIP of the pictures, tone-mapped alike: the 0.99 quantile of the reference is white."""
    white = float(np.quantile(reference, 0.99)) or 1.0
    return float(flip(tone_map(reference, white), tone_map(image, white)).mean())


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
    mean: float  # of the images over that of the reference
    mean_error: float
    cpu: float
    passes: float
    told: float  # standard error by the renders' own account: rms of those that know theirs
    costs: list  # by seed: MSE x CPU seconds, above zero

    @property
    def cost(self):
        """MSE x CPU seconds: 1 / efficiency."""
        return self.mse * self.cpu

    @property
    def certain_cost(self):
        """The same of the variance, and of the bias where it is beyond doubt: the noise of a reference does not enter it."""
        return (self.variance + (self.bias if self.bias > self.doubt else 0.0)) * self.cpu


def own_error(renders, at=-1):
    """Relative standard error by the renders' own account, rms over those that know theirs."""
    known = [error for render in renders if np.isfinite(error := render.standard_errors[at])]
    return float(np.sqrt(np.mean(np.square(known)))) if known else np.nan


def parts(renders, truth, at=-1):
    images = [render.image(at) for render in renders]
    greys = np.array([grey(image) for image in images])
    variance = float(np.var(greys, axis=0, ddof=1).mean()) / truth.scale if len(images) > 1 else np.nan
    means = np.mean(images, axis=0)
    squares = [mse(image, truth) for image in images]
    # Neighbours vary together: 16 pixels count as one.
    doubt = 2 * np.std((grey(means) - truth.grey) ** 2) / np.sqrt(means[..., 0].size / 16) / truth.scale
    looks = [picture_difference(image[frame], truth.image[frame]) for image in images for frame in range(len(image))]
    ratios, cpu = [image.mean() / truth.mean for image in images], [float(render.cpu[at]) for render in renders]
    return Parts(mse=float(np.mean(squares)), relmse99=float(np.mean([relmse99(image, truth) for image in images])), variance=variance,
                 bias=mse(means, truth) - variance / len(images), doubt=float(doubt), median=float(np.median(np.sqrt(np.maximum(squares, 0.0)))),
                 flip=float(np.mean(looks)), mean=float(np.mean(ratios)), mean_error=standard_error(ratios), cpu=float(np.mean(cpu)),
                 passes=float(np.mean([render.passes[at] for render in renders])),
                 told=own_error(renders, at), costs=[max(square, 1e-12) * seconds for square, seconds in zip(squares, cpu)])


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


# ---- Noise and bias of the seeds of a study
#
# Both are kept apart: bias is what remains of the difference of block means once the noise of both sides is subtracted.

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


# ---- Do renders agree? Means over the image and over blocks of it, with errors from independent seeds

BLOCKS = 4            # along each side of the image
MOST_SIGMAS = 5.0     # that two means may differ by
RELATIVE_BIAS = 0.01  # of the image's mean, allowed besides: blocks too dark to know their own error


def means(images):
    """Of an array (frames, height, width, 3): every frame's mean, then those of blocks over all frames, by channel."""
    frames = images.mean(axis=(1, 2))
    whole = images.mean(axis=0)
    height, width = whole.shape[0] // BLOCKS, whole.shape[1] // BLOCKS
    blocks = whole[:height * BLOCKS, :width * BLOCKS].reshape(BLOCKS, height, BLOCKS, width, 3).mean(axis=(1, 3))
    return np.concatenate([frames.ravel(), blocks.ravel()])


def without_kernel(fine, coarse):
    """Means at half the radius and at the whole one, from the same photons: extrapolated to no radius at all, the bias's
    leading term being of the radius squared, as a group of samples; and the change (coarse - fine), the mean over seeds."""
    return [fine - (coarse - fine) / 3.0], (coarse - fine).mean(axis=0)


@dataclass(frozen=True)
class Samples:
    """Means of one method: `groups` of seeds render the same image, each in its own way. `blur` is what the kernel's radius
    still changes."""
    groups: list
    blur: np.ndarray
    frames: int

    @property
    def mean(self):
        return np.concatenate(self.groups).mean(axis=0)

    @property
    def error(self):
        """Standard error of the mean, the spread taken within groups."""
        count = sum(len(group) for group in self.groups)
        squares = sum(((group - group.mean(axis=0))**2).sum(axis=0) for group in self.groups)
        return np.sqrt(squares / self.freedom / count)

    def error_at(self, level):
        """The same, relative to `level` nowhere below the median: means that no rare bright path has reached yet do not know
        their error."""
        lit = self.mean > 0.0
        usual = np.median(self.error[lit] / self.mean[lit]) if lit.any() else 0.0
        return np.maximum(self.error, usual * level)

    @property
    def freedom(self):
        return sum(len(group) - 1 for group in self.groups)

    @property
    def whole(self):
        """Mean over the image, its frames and channels."""
        return self.mean[:3 * self.frames].mean()

    @property
    def whole_error(self):
        values = [group[:, :3 * self.frames].mean(axis=1) for group in self.groups]
        squares = sum(((group - group.mean())**2).sum() for group in values)
        return np.sqrt(squares / self.freedom / sum(map(len, values)))


@dataclass(frozen=True)
class Comparison:
    ratio: float   # of the means over the image
    sigmas: float  # the worst deviation beyond the allowed bias
    where: str

    @property
    def agrees(self):
        return self.sigmas <= MOST_SIGMAS


def normal_sigmas(t, freedom):
    """The normal deviate as unlikely as Student's t (Wallace 1959): few seeds know their own error badly."""
    t, freedom = np.abs(t), np.asarray(freedom, float)
    return (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t**2 / freedom))


def compare(first: Samples, second: Samples):
    """Two sets of renders of the same image by different random numbers."""
    level = np.maximum(np.abs(first.mean), np.abs(second.mean))
    variances = np.array([first.error_at(level)**2, second.error_at(level)**2])
    total = variances.sum(axis=0)
    # Welch and Satterthwaite
    freedom = total**2 / np.maximum((variances**2 / [[first.freedom], [second.freedom]]).sum(axis=0), 1e-300)
    blur = 2.0 / 3.0 * (np.abs(first.blur) + np.abs(second.blur))
    return _judge(second.mean - first.mean, np.sqrt(total), np.maximum(freedom, 1.0), blur, first, second.whole / first.whole)


def compare_pairs(first: Samples, second: Samples):
    """The same, where the first groups of both used the same random numbers."""
    pairs = second.groups[0] - first.groups[0]
    count = len(pairs)
    error = pairs.std(axis=0, ddof=1) / np.sqrt(count)
    ratio = second.groups[0][:, :3 * first.frames].mean() / first.groups[0][:, :3 * first.frames].mean()
    return _judge(pairs.mean(axis=0), error, count - 1, 0.0, first, ratio)


def _judge(difference, error, freedom, blur, reference, ratio):
    beyond = np.abs(difference) - blur - RELATIVE_BIAS * reference.whole
    t = np.where(beyond > 0.0, beyond / np.maximum(error, 1e-30), 0.0)
    sigmas = normal_sigmas(t, freedom)
    worst = int(np.nanargmax(np.where(np.isfinite(sigmas), sigmas, 1e9)))
    return Comparison(float(ratio), float(sigmas[worst]), place(worst, reference.frames))


def place(index, frames):
    """What a mean is of."""
    channel = "RGB"[index % 3]
    index //= 3
    if index < frames:
        return f"image {channel}" if frames == 1 else f"frame {index} {channel}"
    row, column = divmod(index - frames, BLOCKS)
    return f"block {row},{column} {channel}"
