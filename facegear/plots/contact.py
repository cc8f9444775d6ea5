"""Loaded contact: transmission error and load share over a pitch, and the pressure pattern on the flank."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from facegear.contact.columns import SHARES
from facegear.plots.style import NARROW, legend_above, styled

PAIR_NAMES = ("-2", "-1", "0", "1", "2")


def contact_curves(ltca: pd.DataFrame) -> Figure:
    """Static transmission error and both stiffnesses for each torque, load shares at the smallest and
    largest.
    """
    torques = np.sort(ltca["torque_n_m"].unique())
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, torques.size))
    with styled():
        figure, axes = plt.subplots(4, 1, figsize=(NARROW, 11), sharex=True)
        error, stiffness = axes[:2]
        for torque, colour in zip(torques, colours, strict=True):
            rows = closed(ltca[ltca["torque_n_m"] == torque])
            error.plot(rows["position"], rows["ste_um"], color=colour, label=f"{torque:g} N m")
            stiffness.plot(rows["position"], 1e-8 * rows["k_average_n_per_m"], color=colour)
            stiffness.plot(rows["position"], 1e-8 * rows["k_local_n_per_m"], "--", color=colour, lw=0.9)
        unloaded = closed(ltca[ltca["torque_n_m"] == torques[0]])
        error.plot(unloaded["position"], unloaded["unloaded_ste_um"], "k:", label="unloaded")
        error.set(ylabel="Static transmission error (µm)")
        legend_above(error, 3)
        stiffness.set(ylabel="Stiffness (10$^8$ N/m)\naverage solid, local dashed")
        for axis, torque in zip(axes[2:], torques[[0, -1]], strict=True):
            rows = closed(ltca[ltca["torque_n_m"] == torque])
            for column, name in zip(SHARES, PAIR_NAMES, strict=True):
                if (rows[column] > 0).any():
                    axis.plot(rows["position"], rows[column], label=f"pair {name}")
            axis.set(ylabel=f"Load share at {torque:g} N m", ylim=(-0.02, 1.05))
            legend_above(axis, 5)
        axes[-1].set(xlabel="Position (pitches)", xlim=(0, 1))
    return figure


def closed(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows of one torque with the end of the pitch: its beginning, each pair in the next one's place."""
    rows = rows.sort_values("position")
    last = rows.iloc[[0]].copy()
    last["position"] = rows["position"].iloc[0] + 1.0
    last[list(SHARES)] = np.append(last[list(SHARES)].to_numpy()[0, 1:], 0.0)
    return pd.concat([rows, last], ignore_index=True)


def contact_pattern(arrays: Mapping[str, NDArray]) -> Figure:
    """Largest pressure over a pitch on the pinion's flank, one panel a torque, one scale."""
    return pattern_panels({f"{torque:g} N m": (arrays, torque) for torque in np.unique(arrays["torque_n_m"])})


def pattern_panels(panels: Mapping[str, tuple[Mapping[str, NDArray], float]]) -> Figure:
    """`contact_pattern` with panels by title: the arrays and the torque (N m) that each shows."""
    found = {title: _largest_pressure(arrays, torque) for title, (arrays, torque) in panels.items()}
    top = max(np.nanquantile(field, 0.995) for _, _, field in found.values())
    rows = len(found)
    with styled():
        figure, axes = plt.subplots(
            rows, 1, figsize=(NARROW, 0.9 + 1.7 * rows), sharex=True, sharey=True, squeeze=False
        )
        for axis, (title, (along, radius, field)) in zip(axes[:, 0], found.items(), strict=True):
            drawn = axis.pcolormesh(
                along, radius, field, vmin=0, vmax=top, cmap="inferno", shading="gouraud", rasterized=True
            )
            axis.set_title(title)
            axis.grid(visible=False)
            axis.set_ylabel("Pinion radius (mm)")
        axes[-1, 0].set_xlabel("Gear radius (mm)")
        figure.colorbar(
            drawn, ax=axes, location="top", aspect=40, label="Largest pressure over a pitch (MPa)"
        )
    return figure


def _largest_pressure(arrays: Mapping[str, NDArray], torque: float) -> tuple[NDArray, NDArray, NDArray]:
    """Gear radius and pinion radius (mm) of the flank's nodes, and the largest pressure (MPa) each sees."""
    shape = tuple(int(n) for n in arrays["shape"])
    points = 1e3 * arrays["point_m"].reshape(*shape, 3)
    on = (arrays["torque_n_m"] == torque) & arrays["whole"]
    field: NDArray[np.float64] = np.zeros(shape[0] * shape[1])
    np.maximum.at(field, arrays["node"][on], 1e-6 * arrays["pressure_pa"][on])
    return points[..., 1], np.hypot(points[..., 0], points[..., 2]), field.reshape(shape)
