"""Campbell diagram and waterfall."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from facegear.plots.style import styled

ORDER_LINES = (0.5, 1.0, 1.5, 2.0, 3.0)
CLASS_COLOURS = {"pinion": "tab:blue", "face gear": "tab:orange", "pinion coupled face gear": "tab:green"}


def campbell(
    frequencies: pd.DataFrame, resonances: pd.DataFrame, jumps: pd.DataFrame, teeth: int, last_rpm: float
) -> Figure:
    """Natural frequencies, multiples of the mesh frequency, and what the sweep found: peaks and jumps."""
    elastic = frequencies[frequencies["class"] != "rigid body"]
    top = 1.1 * elastic["frequency_hz"].max()
    with styled():
        figure, axis = plt.subplots(figsize=(9, 6))
        for name, modes in elastic.groupby("class", sort=False):
            values = modes["frequency_hz"].drop_duplicates()
            axis.hlines(values, 0, last_rpm, color=CLASS_COLOURS[name], lw=0.8, label=f"{name} modes")
        speeds = np.array([0.0, last_rpm])
        for order in ORDER_LINES:
            line = order * teeth * speeds / 60.0
            axis.plot(speeds, line, color="0.5", lw=0.8)
            end = min(last_rpm, 60.0 * top / (order * teeth))
            axis.annotate(f"{order:g}x", (end, min(order * teeth * end / 60.0, top)), fontsize=7, color="0.3")
        _mark(axis, resonances, "speed_rpm", teeth, "o", "peaks of the sweep")
        _mark(axis, jumps, "speed_after_rpm", teeth, "x", "jumps")
        axis.set_xlim(0, last_rpm)
        axis.set_ylim(0, top)
        axis.set_xlabel("input rotation speed (rpm)")
        axis.set_ylabel("frequency (Hz)")
        axis.legend(fontsize=7, loc="upper left")
        axis.set_title("Campbell diagram; marks at the frequency of the mode that moves most")
    return figure


def _mark(axis: plt.Axes, rows: pd.DataFrame, speed: str, teeth: int, symbol: str, label: str) -> None:
    """Marks where the strongest mode's response frequency lies at the speed of each row."""
    if rows.empty:
        return
    unique = rows.drop_duplicates([speed, "resonance"])
    frequency = unique["order"] * teeth * unique[speed] / 60.0
    axis.plot(unique[speed], frequency, symbol, color="black", ms=4, label=label)


def waterfall(spectra: Mapping[str, NDArray[np.float64]], mesh: int, mesh_name: str, teeth: int) -> Figure:
    """Spectra of one mesh deflection over speed, one panel for each direction; logarithmic colour."""
    directions = [name for name in ("up", "down") if f"{name}_speed_rpm" in spectra]
    orders = spectra["orders"]
    with styled():
        figure, axes = plt.subplots(1, len(directions), figsize=(5.5 * len(directions), 5), squeeze=False)
        for axis, name in zip(axes[0], directions, strict=True):
            speeds = spectra[f"{name}_speed_rpm"]
            rank = np.argsort(speeds)
            values = 1e6 * spectra[f"{name}_amplitude_m"][rank, mesh, 1:]
            image = axis.pcolormesh(
                orders[1:],
                speeds[rank],
                np.log10(np.maximum(values, 1e-3 * values.max())),
                cmap="viridis",
                shading="nearest",
                rasterized=True,
            )
            axis.set_xlabel("multiple of the mesh frequency")
            axis.set_title(f"sweep {name}")
        axes[0, 0].set_ylabel("input rotation speed (rpm)")
        figure.colorbar(image, ax=axes, label="log10 of the amplitude in µm")
        figure.suptitle(f"Spectrum of the deflection, {mesh_name} (mesh frequency {teeth} per pinion turn)")
    return figure
