"""Mesh stiffness results as tables."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.harmonics.fit import LEVELS, Fit, fit_harmonics
from facegear.harmonics.series import Harmonics
from facegear.stiffness.curve import LoadTable
from facegear.stiffness.unloaded_error import peak_to_peak

HARMONICS_COLUMNS = ("order", "sin_n_per_m", "cos_n_per_m", "amplitude_n_per_m")
"""First columns of harmonics_table()."""


def harmonics_table(series: Harmonics, fit: Fit | None, scale: float = 1.0) -> pd.DataFrame:
    """Return the orders of a series with the errors of the fit it comes from.

    Parameters
    ----------
    series : Harmonics
        The series, N/m.
    fit : Fit or None
        Its fit, None if the series was given.
    scale : float
        Factor on the errors, dimensionless.

    Returns
    -------
    pd.DataFrame
        One row an order, N/m; zero errors without a fit.
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
    """Add the pair's unloaded transmission error to a harmonics table, order by order.

    Parameters
    ----------
    table : pd.DataFrame
        Table of harmonics_table().
    series : Harmonics
        Unloaded transmission error, m.
    truncation : float
        Error of its cut, m.

    Returns
    -------
    pd.DataFrame
        The table with columns e_sin_um, e_cos_um, e_peak_to_peak_um and e_truncation_error_um.
    """
    orders = table["order"].to_numpy()
    return table.assign(
        e_sin_um=1e6 * series.sine[orders],
        e_cos_um=1e6 * series.cosine[orders],
        e_peak_to_peak_um=1e6 * peak_to_peak(series),
        e_truncation_error_um=1e6 * truncation,
    )


def unloaded_error(table: pd.DataFrame) -> Harmonics | None:
    """Return the unloaded transmission error of a harmonics table.

    Parameters
    ----------
    table : pd.DataFrame
        Table with the columns of with_unloaded_error().

    Returns
    -------
    Harmonics or None
        m; None where k was given without contact.
    """
    if "e_sin_um" not in table:
        return None
    error_table = table[["order", "e_sin_um", "e_cos_um"]].set_axis(
        ["order", "sin_n_per_m", "cos_n_per_m"], axis=1
    )
    return series_of(error_table).scale(1e-6)


def curve_table(positions: Array, samples: Array, series: Harmonics) -> pd.DataFrame:
    """Return the curve over a pitch and its cut series.

    Parameters
    ----------
    positions : (p,) array
        Positions, periods.
    samples : (p,) array
        Stiffness at the positions, N/m.
    series : Harmonics
        The cut series, N/m.

    Returns
    -------
    pd.DataFrame
        Columns position, k_n_per_m, k_series_n_per_m.
    """
    return pd.DataFrame({"position": positions, "k_n_per_m": samples, "k_series_n_per_m": series(positions)})


def load_dependence(table: LoadTable) -> pd.DataFrame:
    """Return mean, extremes and first harmonics of both stiffnesses at each torque solved.

    Parameters
    ----------
    table : LoadTable
        Stiffness over position and torque.

    Returns
    -------
    pd.DataFrame
        One row a definition and torque, N/m.
    """
    rows = []
    for definition in ("average", "local"):
        for torque in table.torques:
            samples = table.at(torque, definition)
            fit = fit_harmonics(samples)
            first, second = (*fit.series.amplitudes[1:3], np.nan)[:2]
            needed_orders = [fit.orders_within(level) for level in LEVELS]
            rows.append(
                (
                    definition,
                    torque,
                    samples.mean(),
                    samples.min(),
                    samples.max(),
                    first,
                    second,
                    *needed_orders,
                )
            )
    names = [f"orders_for_{100 * level:g}_percent" for level in LEVELS]
    columns = ["definition", "torque_n_m", "mean_n_per_m", "min_n_per_m", "max_n_per_m"]
    frame = pd.DataFrame(rows, columns=[*columns, "amplitude_1_n_per_m", "amplitude_2_n_per_m", *names])
    return frame.astype(dict.fromkeys(names, "Int64"))


def series_of(table: pd.DataFrame) -> Harmonics:
    """Return the series of a table; orders left out are zero.

    Parameters
    ----------
    table : pd.DataFrame
        Columns order, sin_n_per_m, cos_n_per_m.

    Returns
    -------
    Harmonics
        N/m.

    Raises
    ------
    ValueError
        For orders that are not whole numbers from zero, or repeated.
    """
    orders = table["order"].to_numpy()
    if (orders != np.round(orders)).any() or (orders < 0).any() or np.unique(orders).size != orders.size:
        raise ValueError("orders must be whole numbers from 0, each once")
    sine, cosine = np.zeros(int(orders.max()) + 1), np.zeros(int(orders.max()) + 1)
    sine[orders.astype(int)] = table["sin_n_per_m"]
    cosine[orders.astype(int)] = table["cos_n_per_m"]
    return Harmonics(sine, cosine)
