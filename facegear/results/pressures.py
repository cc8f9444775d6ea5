"""The stored pressures of the loaded hats as one labelled array."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from numpy.typing import NDArray


def pressure_dataset(arrays: Mapping[str, NDArray]) -> xr.Dataset:
    """`pressure_mpa` over torque_n_m, position, pair, and the pinion flank's nodes (profile, width)."""
    axes = {name: np.unique(arrays[name]) for name in ("torque_n_m", "position", "tooth")}
    shape = tuple(int(n) for n in arrays["shape"])
    values = np.zeros((*(axis.size for axis in axes.values()), shape[0] * shape[1]))
    on = arrays["whole"].astype(bool)
    rows = [np.searchsorted(axis, arrays[name][on]) for name, axis in axes.items()]
    values[(*rows, arrays["node"][on])] = 1e-6 * arrays["pressure_pa"][on]
    points = 1e3 * arrays["point_m"].reshape(*shape, 3)
    nodes = ("profile", "width")
    return xr.Dataset(
        {
            "pressure_mpa": (
                ("torque_n_m", "position", "pair", *nodes),
                values.reshape(*values.shape[:3], *shape),
            )
        },
        coords={
            "torque_n_m": axes["torque_n_m"],
            "position": axes["position"],
            "pair": axes["tooth"],
            "pinion_radius_mm": (nodes, np.hypot(points[..., 0], points[..., 2])),
            "gear_radius_mm": (nodes, points[..., 1]),
        },
    )
