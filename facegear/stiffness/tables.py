"""Mesh stiffness results as tables."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.harmonics.fit import LEVELS, Fit, fit_harmonics
from facegear.harmonics.series import Harmonics
from facegear.stiffness.curve import LoadTable
from facegear.stiffness.unloaded import peak_to_peak

HARMONICS_COLUMNS = ("order", "sin_n_per_m", "cos_n_per_m", "amplitude_n_per_m")


def harmonics_table(series: Harmonics, fit: Fit | None, scale: float = 1.0) -> pd.DataFrame:
    """Orders of a series with the errors of the fit it comes from, times `scale`; zero errors if it was
    given.
    """
    orders = np.arange(series.order + 1)
    zeros = np.zeros(orders.size)
    truncation = zeros if fit is None else scale * fit.truncation[orders]
    sampling = zeros if fit is None else scale * fit.sampling[orders]
    return pd.DataFrame(
        {
            "order": orders,
            "sin_n_per_m": series.sine,
            "cos_n_per_m": series.cosine,
            "amplitude_n_per_m": series.amplitudes,
            "truncation_error_n_per_m": truncation,
            "sampling_error_n_per_m": sampling,
        }
    )


def with_unloaded_error(table: pd.DataFrame, series: Harmonics, truncation: float) -> pd.DataFrame:
    """A harmonics table with the pair's unloaded transmission error (m) beside k, order by order."""
    orders = table["order"].to_numpy()
    return table.assign(
        e_sin_um=1e6 * series.sine[orders],
        e_cos_um=1e6 * series.cosine[orders],
        e_peak_to_peak_um=1e6 * peak_to_peak(series),
        e_truncation_error_um=1e6 * truncation,
    )


def unloaded_error(table: pd.DataFrame) -> Harmonics | None:
    """The unloaded transmission error (m) of a harmonics table; None where k was given without contact."""
    if "e_sin_um" not in table:
        return None
    renamed = table[["order", "e_sin_um", "e_cos_um"]].set_axis(
        ["order", "sin_n_per_m", "cos_n_per_m"], axis=1
    )
    return series_of(renamed).scale(1e-6)


def curve_table(positions: Array, samples: Array, series: Harmonics) -> pd.DataFrame:
    """The curve over a pitch and its cut series, N/m."""
    return pd.DataFrame({"position": positions, "k_n_per_m": samples, "k_series_n_per_m": series(positions)})


def load_dependence(table: LoadTable) -> pd.DataFrame:
    """Mean, extremes and first harmonics of both stiffnesses at each torque solved."""
    rows = []
    for definition in ("average", "local"):
        for torque in table.torques:
            samples = table.at(torque, definition)
            fit = fit_harmonics(samples)
            first, second = (*fit.series.amplitudes[1:3], np.nan)[:2]
            needed = [fit.orders_within(level) for level in LEVELS]
            rows.append(
                (definition, torque, samples.mean(), samples.min(), samples.max(), first, second, *needed)
            )
    names = [f"orders_for_{100 * level:g}_percent" for level in LEVELS]
    columns = ["definition", "torque_n_m", "mean_n_per_m", "min_n_per_m", "max_n_per_m"]
    frame = pd.DataFrame(rows, columns=[*columns, "amplitude_1_n_per_m", "amplitude_2_n_per_m", *names])
    return frame.astype(dict.fromkeys(names, "Int64"))


def series_of(table: pd.DataFrame) -> Harmonics:
    """The series of a table with the columns order, sin_n_per_m, cos_n_per_m; orders left out are zero.

    Raises ValueError for orders that are not whole numbers from zero, or stand twice.
    """
    orders = table["order"].to_numpy()
    if (orders != np.round(orders)).any() or (orders < 0).any() or np.unique(orders).size != orders.size:
        raise ValueError("orders must be whole numbers from 0, each once")
    sine, cosine = np.zeros(int(orders.max()) + 1), np.zeros(int(orders.max()) + 1)
    sine[orders.astype(int)] = table["sin_n_per_m"]
    cosine[orders.astype(int)] = table["cos_n_per_m"]
    return Harmonics(sine, cosine)
