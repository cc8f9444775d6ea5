"""Tables of forces made from formulas."""

import numpy as np

from facegear.meshing.force_table import ForceTable


def power_table(levels=400, depth=0.0, first=1e-5, last=4.0, size=1.0, exponent=1.5):
    """(1 + depth cos phase) size x^exponent at levels in geometric progression."""
    x = np.append(0.0, np.geomspace(first, last, levels))
    factor = np.array([[0.0, 0.0], [1.0, depth]])
    slopes = size * exponent * x ** (exponent - 1.0)
    return ForceTable(x, np.multiply.outer(size * x**exponent, factor), np.multiply.outer(slopes, factor))


def linear_table(intervals, last, size=1.0):
    """size x at even levels."""
    x = np.linspace(0.0, last, intervals + 1)
    mean = np.array([[0.0], [size]])
    return ForceTable(x, np.multiply.outer(x, mean), np.multiply.outer(np.ones(x.size), mean))


def two_pairs(levels, orders, exponent=1.0, last=2.2):
    """sum max(x - g, 0)^exponent of two pairs, g = (1 -+ cos(phase / 2)) / 2, at even levels.

    Slopes are at most three times those of both chords, with which a cubic between two levels never falls.
    """
    x, samples = np.linspace(0.0, last, levels), 8 * orders
    half = np.pi * np.arange(samples) / samples
    over = np.maximum(x[:, None] - 0.5 * (1.0 + np.multiply.outer([-1.0, 1.0], np.cos(half)))[:, None], 0.0)
    forces = (over**exponent).sum(0) * (x > 0.0)[:, None]
    slopes = (exponent * np.where(over > 0.0, over, 0.0) ** (exponent - 1.0) * (over > 0.0)).sum(0)
    chords = 3.0 * np.diff(forces, axis=0) / np.diff(x)[:, None]
    slopes[1:], slopes[:-1] = np.minimum(slopes[1:], chords), np.minimum(slopes[:-1], chords)
    return ForceTable(x, _series(forces, orders), _series(slopes, orders))


def _series(values, orders):
    found = np.fft.rfft(values, axis=1)[:, : orders + 1] / values.shape[1]
    found[:, 1:] *= 2.0
    return np.stack([-found.imag, found.real], axis=1)
