"""Cameras whose light or sensitivity is modulated: what they measure is the Fourier transform of the arrival of light."""

import numpy as np

from .film import checked


def phasor(light, edges, frequency):
    """The integral of light(t) exp(i omega t) dt, omega = 2 pi frequency, for light that is even over each frame.

    `light` is the integral over each frame. Complex, of the shape of one frame; with `frequency` an array, one for each of them along
    a new axis 0. A flash at time t has the phasor exp(i omega t), times sinc(frequency x width) for the frame's width.
    """
    light, edges = checked(light, edges)
    frequency = np.asarray(frequency, dtype=float)
    if not np.all(np.isfinite(frequency)):
        raise ValueError("frequency: expected finite numbers")
    centres, widths = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    turns = np.multiply.outer(frequency, centres)
    kernel = np.exp(2j * np.pi * turns) * np.sinc(np.multiply.outer(frequency, widths))
    return np.tensordot(kernel, light, axes=([-1], [0]))


def correlation(light, edges, frequency, phase, contrast=1.0):
    """What a pixel holds whose sensitivity is (1 + contrast cos(omega t - phase)) / 2, or whose light is modulated so.

    With `phase` an array, one image for each along a new axis 0. Four phases of 0, pi/2, pi, 3 pi/2 give back the phasor:
    (c0 - c2) + i (c1 - c3) = contrast x phasor.
    """
    light, edges = checked(light, edges)
    if not 0 <= contrast <= 1:
        raise ValueError(f"contrast: expected a number from 0 to 1, found {contrast!r}")
    z = phasor(light, edges, frequency)
    turned = np.multiply.outer(np.exp(-1j * np.asarray(phase, dtype=float)), z)
    return (light.sum(axis=0) + contrast * turned.real) / 2


def phase_distance(z, frequency, speed=1.0):
    """The distance of a reflector whose light comes back with phasor `z`: half the way of light, from 0 to speed / (2 frequency), beyond
    which it starts anew."""
    if not (np.isfinite(frequency) and frequency > 0):
        raise ValueError(f"frequency: expected a number above 0, found {frequency!r}")
    return speed * (np.angle(z) % (2 * np.pi)) / (4 * np.pi * frequency)
