"""e(t) of the pair itself: its transmission error without load, with assembly errors and reliefs."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.harmonics.fit import fit_harmonics
from facegear.harmonics.series import Harmonics

ROUNDING_UM = 1e-4
"""Peak-to-peak up to which an error counts as constant: the closest points of flanks are known no better."""


def unloaded_series(ltca: pd.DataFrame, order: int) -> tuple[Harmonics, float]:
    """Fourier series (m) of the contact table's unloaded_ste_um up to `order`, and what the cut misses (m).

    Positive where the drive flank comes late. The mean is taken off: it turns the pinions, and what it does
    to the backlash stands in that of the pair as assembled. An error that is constant is exactly zero.
    """
    samples = unloaded_samples(ltca)
    if np.ptp(samples) <= ROUNDING_UM:
        return Harmonics(np.zeros(order + 1), np.zeros(order + 1)), 0.0
    fit = fit_harmonics(1e-6 * (samples - samples.mean()))
    series = fit.series.truncate(order)
    cosine = series.cosine.copy()
    cosine[0] = 0.0
    return Harmonics(series.sine, cosine), float(fit.truncation[order])


def unloaded_samples(ltca: pd.DataFrame) -> Array:
    """Unloaded transmission error (p,) um of a contact table at its positions, rising."""
    torque, position, error = (
        ltca[name].to_numpy(float) for name in ("torque_n_m", "position", "unloaded_ste_um")
    )
    rows = np.flatnonzero(torque == torque.min())
    return np.asarray(error[rows[np.argsort(position[rows])]])


def peak_to_peak(series: Harmonics) -> float:
    """Of a series over a period, m."""
    points = np.linspace(0.0, 1.0, 64 * (series.order + 1), endpoint=False)
    return float(np.ptp(series(points)))
