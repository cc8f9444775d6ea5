"""Mesh forces at the orders of the gears' turns, at one speed and over speed."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import COLOURS, NARROW, legend_above, styled

GEARS = {"pinion": COLOURS[1], "face_gear": COLOURS[2]}
LINES = ("-", "--", ":", "-.")
SHOWN = 3
"""Orders of each gear that are drawn over speed."""


def figures(orders: pd.DataFrame, over_speed: pd.DataFrame, speed_rpm: float) -> tuple[Figure, ...]:
    """The figure."""
    return (shaft_order_figure(orders, over_speed, speed_rpm),)


def shaft_order_figure(orders: pd.DataFrame, over_speed: pd.DataFrame, speed_rpm: float) -> Figure:
    """Above the largest force of all meshes at each order, below the largest orders over speed."""
    with styled():
        figure, (above, below) = plt.subplots(2, 1, figsize=(NARROW, 6.0))
        for gear, colour in GEARS.items():
            rows = orders[orders["turning"] == gear]
            largest = rows.groupby("of_mesh")["force_n"].max()
            name = gear.replace("_", " ")
            above.vlines(largest.index, 0.0, largest, color=colour, lw=1.2, label=f"turns of the {name}")
            _over_speed(below, over_speed[over_speed["turning"] == gear], colour, name)
        above.set_xlabel("Frequency over the mesh frequency")
        above.set_ylabel(f"Force at {speed_rpm:g} rpm (N)")
        legend_above(above, 2)
        below.set_xlabel("Speed of the pinions (rpm)")
        below.set_ylabel("Largest force of all meshes (N)")
        for axis in (above, below):
            axis.set_ylim(0.0, 1.05 * axis.get_ylim()[1])
        figure.legend(*below.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _over_speed(axis: plt.Axes, rows: pd.DataFrame, colour: str, name: str) -> None:
    """The orders whose forces become largest."""
    peaks = rows.groupby("order")["force_n"].max().nlargest(SHOWN)
    for style, order in zip(LINES, np.sort(peaks.index), strict=False):
        line = rows[rows["order"] == order]
        label = f"{name}, order {order}"
        axis.plot(line["speed_rpm"], line["force_n"], color=colour, linestyle=style, lw=1.2, label=label)
