"""Single-photon detectors: what they count of the photons that arrive.

`rate` is the number of photons that would be detected during each frame of one laser period (photons x efficiency), plus dark counts:
axis 0 is time. A detection makes the detector dead for a while; jitter moves detections in time.
"""

import numpy as np

from .film import along_time, checked


def detect(light, edges, efficiency=1.0, dark_rate=0.0):
    """The rate of a detector: efficiency x photons + dark counts (per unit of time), by frame and period."""
    light, edges = checked(light, edges)
    if not 0 <= efficiency <= 1:
        raise ValueError(f"efficiency: expected a number from 0 to 1, found {efficiency!r}")
    if not 0 <= dark_rate < np.inf:
        raise ValueError(f"dark_rate: expected a number of at least 0, found {dark_rate!r}")
    if (light < 0).any():
        raise ValueError("light: expected no negative number of photons; clip what noise of the render has left below 0")
    return efficiency * light + dark_rate * along_time(np.diff(edges), light)


def jitter(light, edges, sigma):
    """Light or counts whose times are spread by a gaussian of standard deviation `sigma`; what leaves the film is lost.

    Exact for light that is even over each frame: its variance in time grows by sigma^2.
    """
    light, edges = checked(light, edges)
    if not 0 <= sigma < np.inf:
        raise ValueError(f"sigma: expected a number of at least 0, found {sigma!r}")
    if sigma == 0:
        return light
    distance = np.subtract.outer(edges, edges) / sigma                    # edge of a frame after, edge of a frame before
    ramp = sigma * (distance * _normal_distribution(distance) + np.exp(-distance ** 2 / 2) / np.sqrt(2 * np.pi))
    before = ramp[:, :-1] - ramp[:, 1:]                                   # integral over each frame before, up to edges after
    moved = np.diff(before, axis=0) / np.diff(edges)
    return np.tensordot(moved, light, axes=([1], [0]))


def dead_time_rate(rate, dead_time, paralysable=False):
    """Detections per time under an even `rate` of photons per time: rate / (1 + rate dead_time), where photons during the dead time
    are lost; rate exp(-rate dead_time), where they start it anew (paralysable)."""
    rate = np.asarray(rate, dtype=float)
    return rate * np.exp(-rate * dead_time) if paralysable else rate / (1 + rate * dead_time)


def expected_counts(rate, pulses):
    """The histogram that a detector with at most one detection per period has after `pulses` periods, in expectation: pile-up, by
    which early photons hide later ones."""
    rate = _rates(rate)
    before = np.cumsum(rate, axis=0) - rate
    return pulses * np.exp(-before) * -np.expm1(-rate)


def coates(histogram, pulses):
    """The rate from a histogram with at most one detection per period: undoes expected_counts (Coates 1968). Infinite in a frame after
    which no period is left without a detection."""
    histogram = np.asarray(histogram, dtype=float)
    left = pulses - (np.cumsum(histogram, axis=0) - histogram)
    if (histogram < 0).any() or (histogram > left + 1e-9 * pulses).any():
        raise ValueError("histogram: expected counts of at least 0, and no more than there are pulses")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(histogram > 0, -np.log1p(-np.minimum(histogram / left, 1.0)), 0.0)


def counts(rate, pulses, random, dead_time=None, edges=None, period=None, paralysable=False):
    """A histogram as a detector leaves it after `pulses` periods: whole numbers of the shape of `rate`.

    `random` is a numpy.random.Generator. Without a dead time: Poisson. With dead_time="period" the detector is dead until the next
    period (at most one detection each: pile-up). With a number, in the unit of `edges`, photon by photon: `period` is the time
    between pulses, by default the film's length, and the detector may still be dead in the next period. Photons arrive evenly over
    each frame; there are none outside the film.
    """
    rate = _rates(rate)
    if pulses < 1 or pulses != int(pulses):
        raise ValueError(f"pulses: expected a whole number above 0, found {pulses!r}")
    if dead_time is None:
        return random.poisson(rate * pulses)
    if isinstance(dead_time, str):
        if dead_time != "period":
            raise ValueError(f"dead_time: expected None, 'period' or a time, found {dead_time!r}")
        return _first_photons(rate, int(pulses), random)
    if edges is None:
        raise ValueError("edges: needed for a dead time")
    rate, edges = checked(rate, edges)
    period = edges[-1] - edges[0] if period is None else float(period)
    if not 0 <= dead_time < np.inf:
        raise ValueError(f"dead_time: expected a time of at least 0, found {dead_time!r}")
    if not edges[-1] - edges[0] <= period < np.inf:
        raise ValueError(f"period: expected a time of at least the film's {edges[-1] - edges[0]:g}, found {period!r}")
    pixels = rate.reshape(len(rate), -1)
    found = [_detections(pixel, edges, int(pulses), period, dead_time, paralysable, random) for pixel in pixels.T]
    return np.stack(found, axis=1).reshape(rate.shape)


def _rates(rate):
    rate = np.asarray(rate, dtype=float)
    if rate.ndim < 1 or not np.all(np.isfinite(rate)) or (rate < 0).any():
        raise ValueError("rate: expected finite numbers of at least 0 with time along axis 0")
    return rate


def _first_photons(rate, pulses, random):
    """Of each period: the frame of its first photon, or none."""
    shares = expected_counts(rate, 1).reshape(len(rate), -1).T
    none = np.maximum(1 - shares.sum(axis=1), 0.0)
    shares = np.concatenate([shares, none[:, None]], axis=1)
    drawn = random.multinomial(pulses, shares / shares.sum(axis=1, keepdims=True))
    return drawn[:, :-1].T.reshape(rate.shape)


def _detections(rate, edges, pulses, period, dead_time, paralysable, random):
    """One pixel's histogram."""
    photons = random.poisson(rate * pulses)
    frames = np.repeat(np.arange(len(rate)), photons)
    times = edges[frames] - edges[0] + random.random(len(frames)) * np.diff(edges)[frames]
    times = times + period * random.integers(pulses, size=len(frames))
    order = np.argsort(times, kind="stable")
    times, frames = times[order], frames[order]
    seen = np.ones(len(times), dtype=bool)
    seen[1:] = np.diff(times) >= dead_time                                # whatever came before, it is over
    if not paralysable:
        _resume(times, dead_time, seen)
    return np.bincount(frames[seen], minlength=len(rate))


def _resume(times, dead_time, seen):
    """Marks in `seen` the photons that find the detector live again: from every one known to be seen, the first after its dead time,
    for all in step until each comes to one already seen."""
    following = np.searchsorted(times, times + dead_time)
    at = np.flatnonzero(seen)
    while len(at):
        at = following[at]
        at = at[at < len(times)]
        at = at[~seen[at]]
        seen[at] = True


def _normal_distribution(x):
    """Of the standard normal."""
    from math import erfc
    return 0.5 * np.vectorize(erfc)(-x / np.sqrt(2.0))
