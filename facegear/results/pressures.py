"""Pressures along the contact lines as one labelled dataset."""

from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import AnyArray, Arrays
from facegear.contact.columns import EDGES

if TYPE_CHECKING:
    import xarray as xr


def pressure_dataset(arrays: Arrays) -> "xr.Dataset":
    """Return pressures over torque_n_m, position, pair and plane.

    `pressure_mpa`, `pressure_error_mpa` and `half_width_mm`: nan unless inside; `line_load_n_per_mm`: zero
    where unloaded; `where`: one of EDGES, empty where unloaded. Coordinates `pinion_radius_mm` (position,
    pair, plane) and `axial_mm` (plane) place the contact lines on the pinion's flank.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    xr.Dataset
        The arrays with their coordinates.
    """
    import xarray as xr  # a third of a second, and few answers are asked for as a dataset

    axes = {name: np.unique(arrays[f"contact_{name}"]) for name in ("position", "tooth")}
    axes = {"torque_n_m": np.unique(arrays["line_torque_n_m"]), **axes}
    points = 1e3 * arrays["contact_point_m"]
    shape = (*(axis.size for axis in axes.values()), points.shape[1])
    rows = [np.searchsorted(axis, arrays[f"line_{name}"]) for name, axis in axes.items()]
    cells = (*rows, arrays["line_plane"])
    inside = arrays["line_where"] == EDGES.index("inside")

    def spread(values: AnyArray, rest: float | str) -> tuple[tuple[str, ...], AnyArray]:
        array = np.full(shape, rest, dtype=object if isinstance(rest, str) else float)
        array[cells] = values
        return ("torque_n_m", "position", "pair", "plane"), array.astype(str) if rest == "" else array

    def variable(name: str, scale: float) -> tuple[tuple[str, ...], AnyArray]:
        return spread(np.where(inside, scale * arrays[name], np.nan), np.nan)

    lines = np.hypot(points[..., 0], points[..., 2]).reshape(*shape[1:])
    return xr.Dataset(
        {
            "pressure_mpa": variable("line_pressure_pa", 1e-6),
            "pressure_error_mpa": variable("line_error_pa", 1e-6),
            "half_width_mm": variable("line_half_width_m", 1e3),
            "line_load_n_per_mm": spread(1e-3 * arrays["line_load_n_per_m"], 0.0),
            "where": spread(np.array(EDGES, dtype=object)[arrays["line_where"]], ""),
        },
        coords={
            "torque_n_m": axes["torque_n_m"],
            "position": axes["position"],
            "pair": axes["tooth"],
            "axial_mm": ("plane", points[0, :, 1]),
            "pinion_radius_mm": (("position", "pair", "plane"), lines),
        },
    )
