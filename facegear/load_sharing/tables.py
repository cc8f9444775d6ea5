"""Load-sharing results as tidy tables."""

import numpy as np
import pandas as pd

from facegear.dynamics.motion import Motion
from facegear.load_sharing.run import GroupSharing, Sharing

CURVE_COLUMNS = (
    "group",
    "kind",
    "cycle_fraction",
    "time_s",
    "coefficient",
    "envelope_low",
    "envelope_high",
    "lost_fraction",
)
"""Columns of curve_table()."""
SUMMARY_COLUMNS = (
    "group",
    "kind",
    "mean",
    "half_width",
    "minimum",
    "maximum",
    "cycle_minimum",
    "cycle_low",
    "cycle_high",
    "lost_fraction",
    "undefined_fraction",
    "motion",
    "cycles",
    "starts_low",
    "starts_high",
    "motions_from_starts",
    "periodic",
)
"""Columns of summary_table()."""


def curve_table(sharing: Sharing) -> pd.DataFrame:
    """Return one mesh cycle of each group with the envelope over all cycles.

    `lost_fraction` is the fraction of cycles with a path out of contact at that instant.

    Parameters
    ----------
    sharing : Sharing
        All groups of a machine.

    Returns
    -------
    pd.DataFrame
        Columns CURVE_COLUMNS; empty cells where undefined. No rows where no meshes share a load.
    """
    curves = [_curve(group, sharing.period) for group in sharing.groups]
    return pd.concat(curves, ignore_index=True) if curves else pd.DataFrame(columns=list(CURVE_COLUMNS))


def _curve(group: GroupSharing, period: float) -> pd.DataFrame:
    samples = group.coefficients.shape[1]
    fraction = np.arange(samples) / samples
    is_undefined = np.isnan(group.coefficients)
    low = np.where(is_undefined, np.inf, group.coefficients).min(axis=0)
    high = np.where(is_undefined, -np.inf, group.coefficients).max(axis=0)
    values = (
        group.group.name,
        group.group.kind.value,
        fraction,
        fraction * period,
        group.coefficients[0],
        np.where(np.isfinite(low), low, np.nan),
        np.where(np.isfinite(high), high, np.nan),
        group.lost_contact.mean(axis=0),
    )
    return pd.DataFrame(dict(zip(CURVE_COLUMNS, values, strict=True)))


def summary_table(sharing: Sharing) -> pd.DataFrame:
    """Return the averages of each group.

    Parameters
    ----------
    sharing : Sharing
        All groups of a machine.

    Returns
    -------
    pd.DataFrame
        One row a group, columns SUMMARY_COLUMNS.
    """
    motions = "; ".join(dict.fromkeys(sharing.motions))
    rows = []
    for group in sharing.groups:
        average = group.average
        values = (
            group.group.name,
            group.group.kind.value,
            average.mean,
            average.half_width,
            average.minimum,
            average.maximum,
            average.cycle_minimum,
            average.cycle_low,
            average.cycle_high,
            average.lost_fraction,
            average.undefined_fraction,
            sharing.response.label,
            average.cycles,
            group.starts_low,
            group.starts_high,
            motions,
            sharing.response.motion is Motion.PERIODIC,
        )
        rows.append(dict(zip(SUMMARY_COLUMNS, values, strict=True)))
    return pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS))
