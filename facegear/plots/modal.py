"""Figure 6: mode shapes, one panel for each kind of mode."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import styled

COLOURS = {"pinion": "tab:blue", "face gear": "tab:orange", "pinion coupled face gear": "tab:green"}


def typical_orders(frequencies: pd.DataFrame) -> list[int]:
    """The first mode of each kind, a kind being a class with the same symbols; rigid modes left out."""
    elastic = frequencies[frequencies["class"] != "rigid body"]
    return [int(rows["order"].iloc[0]) for _, rows in elastic.groupby(["class", "symbols"], sort=False)]


def mode_shapes(frequencies: pd.DataFrame, shapes: pd.DataFrame) -> Figure:
    """Bars over all DOF, relative to the largest in the mode (m and rad alike, as in the paper)."""
    orders = typical_orders(frequencies)
    rows = (len(orders) + 1) // 2
    by_order = frequencies.set_index("order")
    with styled():
        figure, axes = plt.subplots(rows, 2, figsize=(11, 1.9 * rows), sharex=True, squeeze=False)
        for axis, order in zip(axes.flat, orders, strict=False):
            shape = shapes[shapes["order"] == order].reset_index(drop=True)
            mode = by_order.loc[order]
            axis.bar(shape.index, shape["relative"], color=COLOURS[mode["class"]], width=0.8)
            axis.axhline(0.0, color="black", lw=0.6)
            axis.set_ylim(-1.1, 1.1)
            axis.set_title(f"Mode {order}, {mode['frequency_hz']:.1f} Hz: {mode['symbols']}", fontsize=8)
            bodies = shape["body"].drop_duplicates()
            axis.set_xticks(bodies.index + 1.5, bodies.str.replace(" ", "\n"), fontsize=6)
            for edge in bodies.index[1:]:
                axis.axvline(edge - 0.5, color="0.8", lw=0.6)
            axis.grid(axis="x", visible=False)
        for axis in axes.flat[len(orders) :]:
            axis.set_axis_off()
        figure.supylabel("Amplitude relative to the largest")
        figure.supxlabel("Degrees of freedom: x, y, z, θ of each body")
    return figure
