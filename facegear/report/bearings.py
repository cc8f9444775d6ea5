"""Tables of the report on rolling bearings, and the texts above them."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.report.table import Table

BEARING_LOADS = (
    "Rolling bearings under the mean torques (mean) and in every bin of the duty cycle: load of the shaft on "
    "the bearing, hardest element, angle of the circumference that is loaded, largest pressure at the inner "
    "ring, and factor by which loads may grow up to the pressure of ISO 76"
)
"""Caption of the table of loads of rolling bearings."""
BEARING_LOADS_SHOWN = (
    *("pinion", "bearing", "bin", "radial_n", "z_n", "hardest_element_n", "zone_deg"),
    *("inner_pressure_mpa", "static_safety"),
)
"""Columns of loads of rolling bearings that are not folded."""
BEARING_STIFFNESS = (
    "Stiffness of rolling bearings, N/m, N/rad and N m/rad; modes and motion take that under the mean load"
)
"""Caption of the table of stiffness of rolling bearings."""
BEARING_LIFE = (
    "Lives of rolling bearings over the duty cycle by Miner's rule, in hours: L10 by equivalent loads, L10r "
    "by the loads of all elements, and the modified life where its conditions are given. basis: standards, "
    "and which of them were not at hand"
)
"""Caption of the table of lives of rolling bearings."""
BEARING_LIFE_SHOWN = (
    *("pinion", "bearing", "l10_hours", "l10r_hours", "modified_hours", "required_hours", "is_enough"),
    "remark",
)
"""Columns of lives of rolling bearings that are not folded."""


def largest_change(stiffness: pd.DataFrame) -> float:
    """Return the largest change of a bearing's diagonal stiffness between the mean load and the ends of the
    duty cycle.

    Parameters
    ----------
    stiffness : pd.DataFrame
        Table `stiffness` of stage bearing_life.

    Returns
    -------
    float
        Relative to that under the mean load, not negative; 0 where nothing is known.
    """
    changes = stiffness["change"].to_numpy(float)
    known_changes = changes[np.isfinite(changes)]
    return float(np.abs(known_changes).max()) if known_changes.size else 0.0


def bearing_life_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the table on the lives of rolling bearings over the duty cycle.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name; `bearings_life` is read.

    Returns
    -------
    list of Table
        The rows of each bearing and of all together, then those of every bin; none without `bearings_life`.
    """
    if "bearings_life" not in tables:
        return []
    life = tables["bearings_life"].replace({"remark": {"": np.nan}})
    is_whole = life["bin"] == "all"
    whole, bins = (life[rows].dropna(axis="columns", how="all") for rows in (is_whole, ~is_whole))
    return [
        Table(BEARING_LIFE, whole, main=[name for name in BEARING_LIFE_SHOWN if name in whole]),
        Table("Lives of every bearing in every bin", bins, is_folded=True),
    ]


def bearing_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the tables of loads and stiffness of rolling bearings.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name; `bearings_loads` and `bearings_stiffness` are read, and `bearings_life`
        where no chapter on strength shows it.

    Returns
    -------
    list of Table
        The tables; none without rolling bearings.
    """
    if "bearings_loads" not in tables:
        return []
    loads, stiffness = tables["bearings_loads"], tables["bearings_stiffness"]
    change = largest_change(stiffness)
    words = f"{BEARING_STIFFNESS}. Between the mean load and the ends of the duty cycle it changes by up to "
    caption = f"{words}{100 * change:.3g} %" if change > 0.0 else BEARING_STIFFNESS
    return [
        Table(BEARING_LOADS, loads, main=BEARING_LOADS_SHOWN),
        *([] if "root_stress" in tables else bearing_life_tables(tables)),
        Table(caption, stiffness, is_folded=True),
    ]
