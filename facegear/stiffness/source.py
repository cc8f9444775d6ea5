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
from facegear.stiffness.unloaded import peak_to_peak, unloaded_series

DRAWN = 256
"""Points a pitch of a curve that comes from given harmonics."""


@dataclass(frozen=True, eq=False)
class Stiffness:
    """`harmonics`: the orders kept; `spectrum`: all orders; `curve` over a pitch."""

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
    """Curve at the requested load and its series.

    Source fem_scaled multiplies the curve so that its mean is the requested one. Raises InvalidInput for a
    load outside those solved and for a variation with which k(t) is not positive throughout.
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
    series = whole.truncate(request.kept)
    if series.minimum <= 0.0:
        largest = _largest_variation(fit.series.truncate(request.kept))
        allowed = f"at most {largest:.4g}, so that k(t) stays positive"
        raise InvalidInput("variation of the mesh stiffness", request.variation, allowed)
    error, cut = unloaded_series(ltca, series.order)
    return ContactCurve(table, samples, fit, scale, whole, series, error, cut)


def stiffness_from_contact(ltca: pd.DataFrame, request: StiffnessRequest) -> Stiffness:
    """`curve_from_contact` as tables. Raises what that raises.

    Beside the harmonics stand the means of both definitions at that load, scaled alike.
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
        curve_table(table.positions, _varied(scale * curve.samples, request.variation), curve.series),
        harmonics,
        harmonics_table(curve.whole, fit, scale * request.variation),
        summary,
    )


def stiffness_given(request: StiffnessRequest) -> Stiffness:
    """Curve of the series that the config gives."""
    whole = request.given.scale_variation(request.variation)
    series = whole.truncate(request.kept)
    positions = np.arange(DRAWN) / DRAWN
    return Stiffness(
        curve_table(positions, whole(positions), series),
        harmonics_table(series, None),
        harmonics_table(whole, None),
        f"given harmonics, {series.order} kept, mean {format_number(1e-6 * series.mean)} N/um",
    )


def _varied(samples: Array, factor: float) -> Array:
    return samples + (factor - 1.0) * (samples - samples.mean())


def _largest_variation(series: Harmonics) -> float:
    """Factor on the variation at which the smallest value is zero."""
    return series.mean / (series.mean - series.minimum)
