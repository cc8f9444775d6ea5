"""Load-sharing results as tidy tables."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.layout import Layout
from facegear.motion.plan import Motion
from facegear.sharing.even_shares import GroupSharing
from facegear.sharing.groups import load_groups
from facegear.sharing.run import Sharing

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
    """Tabulate the load-sharing coefficient of each group over the first mesh cycle, with its range over
    all cycles.

    Parameters
    ----------
    sharing : Sharing
        All groups of a machine.

    Returns
    -------
    pd.DataFrame
        One row a group and instant, columns CURVE_COLUMNS; empty cells where undefined. `lost_fraction`
        is the fraction of cycles with a path out of contact at that instant. No rows where no meshes
        share a load.
    """
    curves = [_curve(group, sharing.period) for group in sharing.groups]
    return pd.concat(curves, ignore_index=True) if curves else pd.DataFrame(columns=list(CURVE_COLUMNS))


def _curve(group: GroupSharing, period: float) -> pd.DataFrame:
    """Return the rows of `curve_table` of one group, columns CURVE_COLUMNS; `period` is the mesh period,
    s.
    """
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
    """Tabulate mean, confidence half-width, extremes and range over the starts of each group's coefficient.

    Parameters
    ----------
    sharing : Sharing
        All groups of a machine.

    Returns
    -------
    pd.DataFrame
        One row a group, columns SUMMARY_COLUMNS: the fields of `Average`, and of the starting states the
        range of means and the classes of motion.
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


def force_table(layout: Layout, mean: Array, largest: Array, motion: str) -> pd.DataFrame:
    """Tabulate mean and largest force of each mesh, and its part of its group's load.

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.
    mean : (M,) array
        Mean magnitude over time of each mesh force, N, in the order of `layout.meshes`.
    largest : (M,) array
        Largest magnitude of each mesh force, N.
    motion : str
        Class of the motion in words, repeated in each row.

    Returns
    -------
    pd.DataFrame
        One row a mesh: columns mesh, group, fraction, mean_n, largest_n, motion. fraction is the mean over
        the sum of its group's, empty with the group where the mesh shares its load with none.
    """
    group, total = np.full(mean.size, "", dtype=object), np.full(mean.size, np.nan)
    for load_group in load_groups(layout):
        meshes = list(load_group.meshes)
        group[meshes], total[meshes] = load_group.name, mean[meshes].sum()
    return pd.DataFrame(
        {
            "mesh": layout.mesh_names,
            "group": group,
            "fraction": np.where(total > 0.0, mean / np.where(total > 0.0, total, 1.0), np.nan),
            "mean_n": mean,
            "largest_n": largest,
            "motion": motion,
        }
    )


NOMINAL = "nominal"
"""Name of the study without changes."""


def collect_tables(
    frames: Mapping[tuple[str, str], pd.DataFrame], labels: Mapping[tuple[str, str], str] | None = None
) -> pd.DataFrame:
    """Put tables of several cases under each other, with the columns study, point and label in front.

    Parameters
    ----------
    frames : mapping of (study, point) to DataFrame
        Tables; point is the case's folder.
    labels : mapping of (study, point) to str, or None
        Name of each case in the config; the folder if None.

    Returns
    -------
    pd.DataFrame
        All rows.
    """
    parts = []
    for (study, point), frame in frames.items():
        table = frame.copy()
        table.insert(0, "study", study)
        table.insert(1, "point", point)
        table.insert(2, "label", (labels or {}).get((study, point), point))
        parts.append(table)
    return pd.concat(parts, ignore_index=True)
