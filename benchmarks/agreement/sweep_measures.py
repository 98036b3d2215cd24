"""Do renders agree? Means over the image and over blocks of it, with errors from independent seeds."""

from dataclasses import dataclass

import numpy as np

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
