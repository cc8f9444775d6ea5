"""Transmission error e(t) of the pair itself without load, with assembly errors and reliefs."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.harmonics.fit import fit_harmonics
from facegear.harmonics.series import Harmonics

ROUNDING_UM = 1e-4
"""Peak-to-peak up to which an error counts as constant: the closest points of flanks are known no better."""


def unloaded_series(ltca: pd.DataFrame, order: int) -> tuple[Harmonics, float]:
    """Return the Fourier series of the contact table's unloaded_ste_um, and its cut error.

    Positive where the drive flank comes late. The mean is taken off: it turns the pinions, and what it does
    to the backlash stands in that of the pair as assembled. An error that is constant is exactly zero.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis.
    order : int
        Last order of the series.

    Returns
    -------
    tuple of Harmonics and float
        Series in m, and the largest error of the cut, m.
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
    """Return the unloaded transmission error of a contact table at its positions, rising.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis.

    Returns
    -------
    (p,) array
        um.
    """
    torque, position, error = (
        ltca[name].to_numpy(float) for name in ("torque_n_m", "position", "unloaded_ste_um")
    )
    rows = np.flatnonzero(torque == torque.min())
    return np.asarray(error[rows[np.argsort(position[rows])]])


def peak_to_peak(series: Harmonics) -> float:
    """Return the peak-to-peak value of a series over a period.

    Parameters
    ----------
    series : Harmonics
        The series, m.

    Returns
    -------
    float
        m.
    """
    points = np.linspace(0.0, 1.0, 64 * (series.order + 1), endpoint=False)
    return float(np.ptp(series(points)))
