"""Loaded contact: transmission error and load share over a pitch, and the pressure pattern on the flank."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from facegear.contact.columns import SHARES
from facegear.plots.style import styled

PAIR_NAMES = ("-2", "-1", "0", "1", "2")


def contact_curves(ltca: pd.DataFrame) -> Figure:
    """Static transmission error and both stiffnesses for each torque, load shares at the smallest and
    largest.
    """
    torques = np.sort(ltca["torque_n_m"].unique())
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, torques.size))
    with styled():
        figure, axes = plt.subplots(2, 2, figsize=(9.5, 6.2), sharex=True)
        for torque, colour in zip(torques, colours, strict=True):
            rows = ltca[ltca["torque_n_m"] == torque]
            axes[0, 0].plot(rows["position"], rows["ste_um"], color=colour, label=f"{torque:g} N m")
            axes[0, 1].plot(rows["position"], 1e-8 * rows["k_average_n_per_m"], color=colour)
            axes[0, 1].plot(rows["position"], 1e-8 * rows["k_local_n_per_m"], "--", color=colour, lw=0.9)
        unloaded = ltca[ltca["torque_n_m"] == torques[0]]
        axes[0, 0].plot(unloaded["position"], unloaded["unloaded_ste_um"], "k:", label="unloaded")
        axes[0, 0].set(ylabel="Static transmission error (µm)")
        axes[0, 1].set(ylabel="Stiffness (10$^8$ N/m)\naverage solid, local dashed")
        for axis, torque in zip(axes[1], torques[[0, -1]], strict=True):
            rows = ltca[ltca["torque_n_m"] == torque]
            for column, name in zip(SHARES, PAIR_NAMES, strict=True):
                if (rows[column] > 0).any():
                    axis.plot(rows["position"], rows[column], label=f"pair {name}")
            axis.set(xlabel="Position (pitches)", ylabel=f"Load share at {torque:g} N m", ylim=(-0.02, 1.05))
            axis.legend()
        axes[0, 0].legend()
        axes[0, 0].set_xlim(0, 1)
    return figure


def contact_pattern(arrays: Mapping[str, NDArray]) -> Figure:
    """Largest pressure over a pitch on the pinion's flank, one panel a torque, one scale."""
    shape = tuple(int(n) for n in arrays["shape"])
    points = arrays["point_m"].reshape(*shape, 3)
    radius = 1e3 * np.hypot(points[..., 0], points[..., 2])
    width = 1e3 * points[..., 1]
    torques = np.unique(arrays["torque_n_m"])
    fields = []
    for torque in torques:
        on = (arrays["torque_n_m"] == torque) & arrays["whole"]
        field: NDArray[np.float64] = np.zeros(shape[0] * shape[1])
        np.maximum.at(field, arrays["node"][on], 1e-6 * arrays["pressure_pa"][on])
        fields.append(field.reshape(shape))
    top = np.nanquantile(fields[-1], 0.995)
    with styled():
        columns = min(torques.size, 2)
        rows = -(-torques.size // columns)
        figure, axes = plt.subplots(
            rows, columns, figsize=(4.9 * columns, 2.6 * rows), sharex=True, sharey=True, squeeze=False
        )
        for axis, torque, field in zip(axes.flat, torques, fields, strict=False):
            drawn = axis.pcolormesh(width, radius, field, vmin=0, vmax=top, cmap="inferno", shading="gouraud")
            axis.set_title(f"{torque:g} N m")
            axis.grid(visible=False)
        for axis in axes.flat[torques.size :]:
            axis.set_axis_off()
        for axis in axes[-1]:
            axis.set_xlabel("Gear radius (mm)")
        for axis in axes[:, 0]:
            axis.set_ylabel("Pinion radius (mm)")
        figure.colorbar(drawn, ax=axes, label="Largest pressure over a pitch (MPa)")
    return figure
