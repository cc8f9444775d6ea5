"""The tidy table of a sweep as a labelled dataset."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

if TYPE_CHECKING:
    import xarray as xr

KEYS = ["direction", "speed_rpm"]
NO_ITEM = "machine"
"""Name in place of body or mesh, in rows that belong to the whole machine."""


def sweep_dataset(table: pd.DataFrame) -> "xr.Dataset":
    """Return quantities over direction, speed_rpm and mesh, body or nothing, in the order of the table.

    The names of meshes hold a stroke, `pinion/side`, those of bodies do not.

    Parameters
    ----------
    table : pd.DataFrame
        Table of a sweep.

    Returns
    -------
    xr.Dataset
        The quantities with their coordinates.
    """
    import xarray as xr  # a third of a second, and few answers are asked for as a dataset

    axes: dict[str, list] = {
        "direction": list(dict.fromkeys(table["direction"])),
        "speed_rpm": np.unique(table["speed_rpm"]).tolist(),
    }
    names = [str(name) for name in dict.fromkeys(table["body_or_mesh"]) if name != NO_ITEM]
    items = {
        "mesh": [name for name in names if "/" in name],
        "body": [name for name in names if "/" not in name],
    }
    speeds = table.drop_duplicates(KEYS)
    variables = {
        "class": _fill_array(speeds, "class", axes, ""),
        "periodic": _fill_array(speeds, "periodic", axes, ""),
        "after_irregular": _fill_array(speeds, "after_irregular", axes, ""),
        "symmetry_broken": _fill_array(speeds, "symmetry_broken", axes, ""),
    }
    for quantity, rows in table.groupby("quantity", sort=False):
        kind = _kind(rows["body_or_mesh"].iloc[0])
        variable_axes = {**axes, kind: items[kind]} if kind else axes
        variables[str(quantity)] = _fill_array(
            rows.rename(columns={"body_or_mesh": kind}), "value", variable_axes, np.nan
        )
    return xr.Dataset(variables)


def _kind(name: str) -> str:
    """Whether a name is that of a mesh, of a body, or of the machine (no text)."""
    return "" if name == NO_ITEM else "mesh" if "/" in name else "body"


def _fill_array(rows: pd.DataFrame, column: str, axes: dict[str, list], empty: object) -> "xr.DataArray":
    """One column over its axes; `empty` where the table has no row."""
    import xarray as xr  # as above

    values = np.full([len(axis) for axis in axes.values()], empty, dtype=object if empty == "" else float)
    item_indices = tuple(pd.Index(axis).get_indexer(rows[name]) for name, axis in axes.items())
    values[item_indices] = rows[column].to_numpy()
    return xr.DataArray(values, coords=axes, dims=list(axes))
