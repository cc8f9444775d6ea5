"""k(t) from the contact analysis or from given harmonics, with its tables."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.harmonics.fit import Fit, fit_harmonics
from facegear.harmonics.series import Harmonics
from facegear.number_format import format_number
from facegear.stiffness.curve import LoadTable, load_table
from facegear.stiffness.request import StiffnessRequest
from facegear.stiffness.tables import curve_table, harmonics_table, with_unloaded_error
from facegear.stiffness.unloaded_error import peak_to_peak, unloaded_series

CURVE_POINTS = 256
"""Number of points in a pitch of a curve that comes from given harmonics."""


@dataclass(frozen=True, eq=False)
class Stiffness:
    """Tables of a mesh stiffness.

    Attributes
    ----------
    curve : DataFrame
        Stiffness over a pitch.
    harmonics : DataFrame
        Orders that are kept.
    spectrum : DataFrame
        All orders.
    summary : str
        One line for the log.
    """

    curve: pd.DataFrame
    harmonics: pd.DataFrame
    spectrum: pd.DataFrame
    summary: str


@dataclass(frozen=True, eq=False)
class ContactCurve:
    """k(t) at a load of the contact analysis, N/m.

    Attributes
    ----------
    table
        Stiffness over positions and torques that it was taken from.
    samples, fit
        At the positions solved, and their series, before both are scaled.
    scale
        Factor on both that the request asks for.
    whole, series
        Scaled and varied, with all orders and with those kept.
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
    whole = fit.series.scale(scale).scale_variation(request.variation)
    series = whole.truncate(request.order)
    if series.minimum <= 0.0:
        largest = _largest_variation(fit.series.truncate(request.order))
        requirement = f"at most {largest:.4g}, so that k(t) stays positive"
        raise InvalidInput("variation of the mesh stiffness", request.variation, requirement)
    error, cut = unloaded_series(ltca, series.order)
    return ContactCurve(table, samples, fit, scale, whole, series, error, cut)


def stiffness_from_contact(ltca: pd.DataFrame, request: StiffnessRequest) -> Stiffness:
    """Return `curve_from_contact` as tables.

    Beside the harmonics stand the means of both definitions at that load, scaled alike.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table of the contact analysis.
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
    return Stiffness(
        curve_table(table.positions, _vary_samples(scale * curve.samples, request.variation), curve.series),
        harmonics,
        harmonics_table(curve.whole, fit, scale * request.variation),
        summary,
    )


def stiffness_given(request: StiffnessRequest) -> Stiffness:
    """Return the curve of the series that the config gives.

    Parameters
    ----------
    request : StiffnessRequest
        The series and the orders kept.

    Returns
    -------
    Stiffness
        N/m.
    """
    whole = request.given_series.scale_variation(request.variation)
    series = whole.truncate(request.order)
    positions = np.arange(CURVE_POINTS) / CURVE_POINTS
    return Stiffness(
        curve_table(positions, whole(positions), series),
        harmonics_table(series, None),
        harmonics_table(whole, None),
        f"given harmonics, {series.order} kept, mean {format_number(1e-6 * series.mean)} N/um",
    )


def _vary_samples(samples: Array, factor: float) -> Array:
    return samples + (factor - 1.0) * (samples - samples.mean())


def _largest_variation(series: Harmonics) -> float:
    """Return the factor on the variation at which the smallest value is zero."""
    return series.mean / (series.mean - series.minimum)
