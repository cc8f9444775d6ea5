"""Forms of the transmission error e(t) that the stored sets of inputs choose between."""

from collections.abc import Mapping
from enum import StrEnum

import numpy as np


class Waveform(StrEnum):
    """Form of e(t): a cosine, a triangle, or parabolic arcs as between equal teeth."""

    SINE = "sine"
    TRIANGLE = "triangle"
    ARCS = "arcs"


def _unit_range(*weights: tuple[int, float]) -> tuple[tuple[int, float], ...]:
    """Cosine terms (order, weight) scaled to a half range of one."""
    cycles = np.linspace(0.0, 1.0, 3601)
    half_range = 0.5 * np.ptp(sum(weight * np.cos(2.0 * np.pi * order * cycles) for order, weight in weights))
    return tuple((order, float(weight / half_range)) for order, weight in weights)


WAVEFORM_TERMS: Mapping[Waveform, tuple[tuple[int, float], ...]] = {
    Waveform.SINE: ((1, 1.0),),
    Waveform.TRIANGLE: _unit_range(*((j, j**-2.0) for j in (1, 3, 5, 7))),
    Waveform.ARCS: _unit_range(*((j, -((-1.0) ** j) * j**-2.0) for j in (1, 2, 3, 4, 5, 6))),
}
"""Cosine series (order, weight) of half range one; triangle and arcs are cut below 3 % of the first term."""
