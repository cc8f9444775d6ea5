"""Campbell diagram and waterfall."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.arrays import Array
from facegear.dynamics.sweeps.jump_kinds import JumpKind
from facegear.plots.style import NARROW, styled

ORDER_LINES = (1.0, 2.0, 3.0)
"""Multiples of the mesh frequency that are always drawn, beside those of the marks."""
CLASS_COLOURS = {"pinion": "tab:blue", "face gear": "tab:orange", "pinion coupled face gear": "tab:green"}


def campbell(
    frequencies: pd.DataFrame, resonances: pd.DataFrame, jumps: pd.DataFrame, teeth: int, last_rpm: float
) -> Figure:
    """Natural frequencies, multiples of the mesh frequency, and what the sweep found: peaks, jumps, and where
    irregular motion begins or ends.
    """
    elastic = frequencies[frequencies["class"] != "rigid body"]
    top = 1.1 * elastic["frequency_hz"].max()
    marked = pd.concat([resonances["order"], jumps["order"]]).astype(float)
    lines = sorted(set(ORDER_LINES) | set(marked[_on_line(marked)]))
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 5.4))
        for name, modes in elastic.groupby("class", sort=False):
            values = modes["frequency_hz"].drop_duplicates()
            axis.hlines(values, 0, last_rpm, color=CLASS_COLOURS[name], lw=0.8, label=name)
        speeds = np.array([0.0, last_rpm])
        for order in lines:
            axis.plot(speeds, order * teeth * speeds / 60.0, color="0.5", lw=0.8)
            end = min(last_rpm, 60.0 * top / (order * teeth))
            height = order * teeth * end / 60.0
            beyond = (2, 0) if height < 0.99 * top else (0, 2)
            axis.annotate(f"{order:g}x", (end, height), beyond, textcoords="offset points", color="0.3")
        _mark(axis, resonances, "speed_rpm", teeth, "o", "peaks")
        irregular = jumps["kind"] == JumpKind.IRREGULAR
        _mark(axis, jumps[~irregular], "speed_after_rpm", teeth, "x", "jumps")
        _mark(axis, jumps[irregular], "speed_after_rpm", teeth, "+", "irregular motion")
        axis.set_xlim(0, last_rpm)
        axis.set_ylim(0, top)
        axis.set_xlabel("input rotation speed (rpm)")
        axis.set_ylabel("frequency (Hz)")
        figure.legend(loc="outside lower center", ncols=2, title="modes by class, and what the sweep found")
        figure.suptitle("Campbell diagram; marks: frequency of the mode that moves most", fontsize=9)
    return figure


def _on_line(orders: pd.Series) -> pd.Series:
    """Which orders are multiples of half the mesh frequency; others belong to motion that is not locked."""
    return (2.0 * orders - (2.0 * orders).round()).abs() < 1e-9


def _mark(axis: Axes, rows: pd.DataFrame, speed: str, teeth: int, symbol: str, label: str) -> None:
    """Marks where the strongest mode's response frequency lies at each row's speed; grey off all lines."""
    unique = rows.drop_duplicates([speed, "resonance"])
    on = _on_line(unique["order"].astype(float))
    for chosen, colour, text in ((on, "black", label), (~on, "0.6", f"{label}, off lines")):
        if chosen.any():
            frequency = unique["order"][chosen] * teeth * unique[speed][chosen] / 60.0
            axis.plot(unique[speed][chosen], frequency, symbol, color=colour, ms=4, label=text)


def waterfall(spectra: Mapping[str, Array], mesh: int, mesh_name: str, teeth: int) -> Figure:
    """Spectra of one mesh deflection over speed, one panel for each direction; logarithmic colour."""
    directions = [name for name in ("up", "down") if f"{name}_speed_rpm" in spectra]
    orders = spectra["orders"]
    with styled():
        figure, axes = plt.subplots(
            len(directions), 1, figsize=(NARROW, 0.9 + 3.6 * len(directions)), sharex=True, squeeze=False
        )
        for axis, name in zip(axes[:, 0], directions, strict=True):
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
            axis.set_ylabel("input rotation speed (rpm)")
            axis.set_title(f"sweep {name}", fontsize=9, loc="left")
        axes[-1, 0].set_xlabel("multiple of the mesh frequency")
        figure.colorbar(image, ax=axes, label="log10 of the amplitude in µm")
        figure.suptitle(
            f"Spectrum of the deflection, {mesh_name}\n(mesh frequency {teeth} per pinion turn)", fontsize=9
        )
    return figure
