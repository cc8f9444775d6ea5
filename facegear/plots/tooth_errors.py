"""What single teeth add to the transmission error over a turn of either gear."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.arrays import Arrays
from facegear.plots.style import COLOURS, NARROW, legend_above, styled


def tooth_error_figure(curves: Arrays, orders: pd.DataFrame) -> Figure:
    """Two panels a gear whose teeth differ: the drive flank over a turn, and the orders of its turns."""
    with styled():
        bodies = list(orders["body"].unique())
        figure, axes = plt.subplots(2 * len(bodies), 1, figsize=(NARROW, 0.3 + 4.2 * len(bodies)))
        for row, body in zip(axes.reshape(-1, 2), bodies, strict=True):
            name, curve = body.replace("_", " "), 1e6 * curves[f"{body}_drive_m"]
            row[0].plot(
                np.arange(curve.size) / curve.size,
                curve,
                color=COLOURS[1],
                lw=0.9,
                label="drive flank, under load",
            )
            row[0].set_xlabel(f"Turns of the {name}")
            row[0].set_ylabel("Early by (µm)")
            own = orders[orders["body"] == body]
            for column, label, at, colour in (
                ("unloaded_um", "no load", -0.2, COLOURS[0]),
                ("loaded_um", "under load", 0.2, COLOURS[1]),
            ):
                row[1].bar(own["order"] + at, own[column], 0.4, color=colour, label=label)
            row[1].set_xlabel(f"Order of its turns ({name})")
            row[1].set_ylabel("Amplitude (µm)")
            legend_above(row[0], 1)
            legend_above(row[1], 2)
    return figure


def figures(curves: Arrays, orders: pd.DataFrame) -> tuple[Figure, ...]:
    """The figure."""
    return (tooth_error_figure(curves, orders),)
