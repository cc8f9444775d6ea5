"""Harmonics as a table (order, a_n_per_m, b_n_per_m) and back."""

import numpy as np
import pandas as pd

from facegear.harmonics.series import Harmonics

COLUMNS = ("order", "a_n_per_m", "b_n_per_m")


def from_table(frame: pd.DataFrame) -> Harmonics:
    """The series of a stored table; orders that are missing are zero."""
    orders = frame["order"].to_numpy(int)
    a, b = np.zeros(orders.max() + 1), np.zeros(orders.max() + 1)
    a[orders] = frame["a_n_per_m"]
    b[orders] = frame["b_n_per_m"]
    return Harmonics(a, b)


def to_table(series: Harmonics) -> pd.DataFrame:
    """Columns order, a_n_per_m, b_n_per_m, amplitude_n_per_m."""
    return pd.DataFrame(
        {
            "order": np.arange(series.order + 1),
            "a_n_per_m": series.a,
            "b_n_per_m": series.b,
            "amplitude_n_per_m": series.amplitudes,
        }
    )
