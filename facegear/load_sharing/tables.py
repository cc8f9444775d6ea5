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
    "lost_share",
)
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
    "lost_share",
    "undefined_share",
    "motion",
    "cycles",
    "starts_low",
    "starts_high",
    "motions_from_starts",
    "periodic",
)


def curve_table(sharing: Sharing) -> pd.DataFrame:
    """One mesh cycle of each group with the envelope over all cycles; empty cells where undefined.

    `lost_share` is the share of cycles with a path out of contact at that instant. No rows where no meshes
    share a load.
    """
    curves = [_curve(group, sharing.period) for group in sharing.groups]
    return pd.concat(curves, ignore_index=True) if curves else pd.DataFrame(columns=list(CURVE_COLUMNS))


def _curve(found: GroupSharing, period: float) -> pd.DataFrame:
    samples = found.coefficients.shape[1]
    fraction = np.arange(samples) / samples
    undefined = np.isnan(found.coefficients)
    low = np.where(undefined, np.inf, found.coefficients).min(axis=0)
    high = np.where(undefined, -np.inf, found.coefficients).max(axis=0)
    values = (
        found.group.name,
        found.group.kind.value,
        fraction,
        fraction * period,
        found.coefficients[0],
        np.where(np.isfinite(low), low, np.nan),
        np.where(np.isfinite(high), high, np.nan),
        found.lost.mean(axis=0),
    )
    return pd.DataFrame(dict(zip(CURVE_COLUMNS, values, strict=True)))


def summary_table(sharing: Sharing) -> pd.DataFrame:
    """One row a group."""
    motions = "; ".join(dict.fromkeys(sharing.motions))
    rows = []
    for found in sharing.groups:
        one = found.average
        values = (
            found.group.name,
            found.group.kind.value,
            one.mean,
            one.half_width,
            one.minimum,
            one.maximum,
            one.cycle_minimum,
            one.cycle_low,
            one.cycle_high,
            one.lost,
            one.undefined,
            sharing.response.label,
            one.cycles,
            found.starts_low,
            found.starts_high,
            motions,
            sharing.response.motion is Motion.PERIODIC,
        )
        rows.append(dict(zip(SUMMARY_COLUMNS, values, strict=True)))
    return pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS))
