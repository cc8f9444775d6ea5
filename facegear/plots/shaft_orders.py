"""Mesh forces at the orders of the gears' turns, at one speed and over speed."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import legend_above, styled

COLOURS = {"pinion": "C0", "face_gear": "C1"}
LINES = ("-", "--", ":", "-.")
SHOWN = 3
"""Orders of each gear that are drawn over speed."""


def figures(orders: pd.DataFrame, over_speed: pd.DataFrame, speed_rpm: float) -> tuple[Figure, ...]:
    """The figure."""
    return (shaft_order_figure(orders, over_speed, speed_rpm),)


def shaft_order_figure(orders: pd.DataFrame, over_speed: pd.DataFrame, speed_rpm: float) -> Figure:
    """Above the largest force of all meshes at each order, below the largest orders over speed."""
    with styled():
        figure, (above, below) = plt.subplots(2, 1, figsize=(7.2, 6.4))
        for gear, colour in COLOURS.items():
            rows = orders[orders["turning"] == gear]
            largest = rows.groupby("of_mesh")["force_n"].max()
            name = gear.replace("_", " ")
            above.vlines(largest.index, 0.0, largest, color=colour, lw=1.2, label=f"turns of the {name}")
            _over_speed(below, over_speed[over_speed["turning"] == gear], colour, name)
        above.set_ylim(bottom=0.0)
        above.set_xlabel("Frequency over the mesh frequency")
        above.set_ylabel(f"Force at {speed_rpm:g} rpm (N)")
        legend_above(above, 2)
        below.set_xlabel("Speed of the pinions (rpm)")
        below.set_ylabel("Largest force of all meshes (N)")
        below.set_ylim(bottom=0.0)
        figure.legend(*below.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _over_speed(axis: plt.Axes, rows: pd.DataFrame, colour: str, name: str) -> None:
    """The orders whose forces become largest."""
    peaks = rows.groupby("order")["force_n"].max().nlargest(SHOWN)
    for style, order in zip(LINES, np.sort(peaks.index), strict=False):
        line = rows[rows["order"] == order]
        label = f"{name}, order {order}"
        axis.plot(line["speed_rpm"], line["force_n"], color=colour, linestyle=style, lw=1.2, label=label)
