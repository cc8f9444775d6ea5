"""Mesh stiffness k(t) from the contact analysis or from given harmonics, with its tables."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.harmonics import LEVELS, Fit, Harmonics, fit_harmonics
from facegear.meshing.stiffness_curve import LoadTable, load_table, peak_to_peak, unloaded_series
from facegear.meshing.stiffness_request import StiffnessRequest
from facegear.number_format import format_number

GEARS = ("lower", "upper")
"""Face gears of which a harmonics table may have the flanks."""
FlankSeries = dict[str, tuple[Harmonics, Harmonics]]
"""Stiffness series of drive and back flank by gear, N/m."""
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
        One row an order from 0: HARMONICS_COLUMNS, truncation_error_n_per_m if the series is cut after
        that order, and sampling_error_n_per_m; both errors are zero without a fit.
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
        One row a definition and torque: definition, torque_n_m, mean_n_per_m, min_n_per_m, max_n_per_m,
        amplitude_1_n_per_m, amplitude_2_n_per_m, and orders_for_L_percent: orders needed for each error L
        of LEVELS, missing where no order is enough.
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


CURVE_POINTS = 256
"""Number of points in a pitch of a curve that comes from given harmonics."""


@dataclass(frozen=True, eq=False)
class Stiffness:
    """Tables of a mesh stiffness.

    Attributes
    ----------
    curve : DataFrame
        Stiffness over a pitch, see `curve_table`.
    harmonics : DataFrame
        Orders that are kept, see `harmonics_table`, with columns of `with_unloaded_error` and the means
        of both definitions if it comes from contact.
    spectrum : DataFrame
        All orders, see `harmonics_table`.
    summary : str
        One line for the log.
    """

    curve: pd.DataFrame
    harmonics: pd.DataFrame
    spectrum: pd.DataFrame
    summary: str


@dataclass(frozen=True, eq=False)
class ContactCurve:
    """Mesh stiffness k(t) at one load of the contact analysis, N/m.

    Attributes
    ----------
    table
        Stiffness over positions and torques that it was taken from.
    samples, fit
        Stiffness at the positions solved (p,), and its Fourier fit, both before `scale`.
    scale
        Factor on both that the request asks for: 1, or requested mean over the fit's mean for fem_scaled.
    whole, series
        Series times `scale`, its variation times the request's factor: with all orders, and with those
        kept.
    error, error_cut
        Unloaded transmission error of the same orders (m), and what the cut misses of it (m).
    """

    table: LoadTable
    samples: Array
    fit: Fit
    scale: float
    whole: Harmonics
    series: Harmonics
    error: Harmonics
    error_cut: float


def curve_from_contact(ltca: pd.DataFrame, request: StiffnessRequest) -> ContactCurve:
    """Compute the stiffness curve at the requested load and its series.

    Source fem_scaled multiplies the curve so that its mean is the requested one.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis.
    request : StiffnessRequest
        Source, load and orders.

    Returns
    -------
    ContactCurve
        N/m and m.

    Raises
    ------
    InvalidInput
        For a load outside those solved, and for a variation with which k(t) is not positive throughout.
    """
    assert request.torque is not None
    table = load_table(ltca)
    samples = table.at(request.torque, request.definition)
    fit = fit_harmonics(samples)
    scale = 1.0
    if request.source == "fem_scaled":
        assert request.mean is not None
        scale = request.mean / fit.series.mean
    whole, series = _vary_fit(fit, scale, request)
    error, cut = unloaded_series(ltca, series.order)
    return ContactCurve(table, samples, fit, scale, whole, series, error, cut)


def _vary_fit(fit: Fit, scale: float, request: StiffnessRequest) -> tuple[Harmonics, Harmonics]:
    """Return a fit's series times a factor and with the request's variation, whole and cut, N/m."""
    whole = fit.series.scale(scale).scale_variation(request.variation)
    series = whole.truncate(request.order)
    if series.minimum <= 0.0:
        largest = _largest_variation(fit.series.truncate(request.order))
        requirement = f"at most {largest:.4g}, so that k(t) stays positive"
        raise InvalidInput("variation of the mesh stiffness", request.variation, requirement)
    return whole, series


def _series_of_flank(rows: pd.DataFrame, scale: float, request: StiffnessRequest) -> Harmonics:
    """Return the cut stiffness series of a flank from its rows of the contact table, times a factor, N/m."""
    assert request.torque is not None
    samples = load_table(rows).at(request.torque, request.definition)
    return _vary_fit(fit_harmonics(samples), scale, request)[1]


def with_flanks(table: pd.DataFrame, series_by_flank: Mapping[tuple[str, str], Harmonics]) -> pd.DataFrame:
    """Add the series of single flanks to a harmonics table, order by order.

    Parameters
    ----------
    table : pd.DataFrame
        Table of harmonics_table().
    series_by_flank : Mapping
        Stiffness by gear and flank, N/m; of a back flank over the cycle of the mirrored pair.

    Returns
    -------
    pd.DataFrame
        The table with columns `<gear>_<flank>_sin_n_per_m` and `<gear>_<flank>_cos_n_per_m` for each.
    """
    last = max([int(table["order"].max()), *(series.order for series in series_by_flank.values())])
    if last > table["order"].max():
        further_rows = pd.DataFrame({"order": np.arange(int(table["order"].max()) + 1, last + 1)})
        table = pd.concat([table, further_rows], ignore_index=True).fillna(0.0)
    columns = {}
    for (gear, flank), series in series_by_flank.items():
        parts = np.zeros((2, last + 1))
        parts[:, : series.order + 1] = series.sine, series.cosine
        for part, values in zip(("sin", "cos"), parts, strict=True):
            columns[f"{gear}_{flank}_{part}_n_per_m"] = values[table["order"].to_numpy(int)]
    return table.assign(**columns)


def flank_series(table: pd.DataFrame) -> FlankSeries | None:
    """Return the stiffness series of the flanks of both gears from a harmonics table.

    Parameters
    ----------
    table : pd.DataFrame
        Table with columns of with_flanks(), if any.

    Returns
    -------
    dict of str to pair of Harmonics, or None
        Drive and back flank of each of GEARS, N/m; None where all flanks are alike.
    """
    flank_columns = [column for column in table if column.endswith("_cos_n_per_m")]
    if not flank_columns:
        return None

    def series(gear: str, flank: str) -> Harmonics:
        names = [f"{gear}_{flank}_{part}_n_per_m" for part in ("sin", "cos")]
        if names[1] not in flank_columns:
            return series_of(table)
        return series_of(table[["order", *names]].set_axis(["order", *HARMONICS_COLUMNS[1:3]], axis=1))

    return {gear: (series(gear, "drive"), series(gear, "back")) for gear in GEARS}


def stiffness_from_contact(
    ltca: pd.DataFrame, request: StiffnessRequest, flanks: pd.DataFrame | None = None
) -> Stiffness:
    """Return `curve_from_contact` as tables.

    The table of harmonics also has the means of both definitions at that load, times the same scale, and the
    series of all flanks that differ.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis.
    flanks : pd.DataFrame or None
        The same columns of the other flanks that differ, with columns gear and flank; None without any.
    request : StiffnessRequest
        Source, load and orders.

    Returns
    -------
    Stiffness
        N/m and um.

    Raises
    ------
    InvalidInput
        As `curve_from_contact`.
    """
    curve = curve_from_contact(ltca, request)
    assert request.torque is not None
    table, fit, scale, torque = curve.table, curve.fit, curve.scale, request.torque
    scale_text = "" if scale == 1.0 else f", scaled by {scale:.4f}"
    summary = (
        f"{request.definition} stiffness at {torque:g} N m: mean {format_number(1e-6 * fit.series.mean)} N/um"
        f"{scale_text}; transmission error without load {1e6 * peak_to_peak(curve.error):.3g} um peak to peak"
    )
    harmonics = with_unloaded_error(
        harmonics_table(curve.series, fit, scale * request.variation), curve.error, curve.error_cut
    ).assign(
        mean_average_n_per_m=scale * table.at(torque, "average").mean(),
        mean_local_n_per_m=scale * table.at(torque, "local").mean(),
    )
    if flanks is not None and len(flanks):
        by_flank = {
            (str(gear), str(flank)): _series_of_flank(rows, scale, request)
            for (gear, flank), rows in flanks.groupby(["gear", "flank"])
        }
        harmonics = with_flanks(harmonics, by_flank)
    return Stiffness(
        curve_table(table.positions, _vary_samples(scale * curve.samples, request.variation), curve.series),
        harmonics,
        harmonics_table(curve.whole, fit, scale * request.variation),
        summary,
    )


def stiffness_given(request: StiffnessRequest) -> Stiffness:
    """Return the tables of the stiffness series that the config gives, without contact analysis.

    The curve has CURVE_POINTS points and the varied series with all orders.

    Parameters
    ----------
    request : StiffnessRequest
        The series, the factor on its variation and the orders kept.

    Returns
    -------
    Stiffness
        N/m.
    """
    whole = request.given_series.scale_variation(request.variation)
    series = whole.truncate(request.order)
    positions = np.arange(CURVE_POINTS) / CURVE_POINTS
    harmonics = harmonics_table(series, None)
    if request.coast_series is not None:
        coast = request.coast_series.scale_variation(request.variation).truncate(request.order)
        harmonics = with_flanks(harmonics, {(gear, "back"): coast for gear in GEARS})
    return Stiffness(
        curve_table(positions, whole(positions), series),
        harmonics,
        harmonics_table(whole, None),
        f"given harmonics, {series.order} kept, mean {format_number(1e-6 * series.mean)} N/um",
    )


def _vary_samples(samples: Array, factor: float) -> Array:
    """Return samples with their deviation from their mean times a factor, of the same shape and unit."""
    return samples + (factor - 1.0) * (samples - samples.mean())


def _largest_variation(series: Harmonics) -> float:
    """Return the factor on the variation about the mean at which the smallest value of the series becomes
    zero.
    """
    return series.mean / (series.mean - series.minimum)
