"""What single teeth add to the transmission error over a turn of either gear."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.arrays import Arrays
from facegear.plots.style import legend_above, styled


def tooth_error_figure(curves: Arrays, orders: pd.DataFrame) -> Figure:
    """One row a gear whose teeth differ: the drive flank over a turn, and the orders of its turns."""
    with styled():
        bodies = list(orders["body"].unique())
        figure, axes = plt.subplots(
            len(bodies), 2, figsize=(7.2, 2.6 * len(bodies)), width_ratios=(2, 1), squeeze=False
        )
        for row, body in zip(axes, bodies, strict=True):
            name, curve = body.replace("_", " "), 1e6 * curves[f"{body}_drive_m"]
            row[0].plot(np.arange(curve.size) / curve.size, curve, lw=0.9, label="drive flank, under load")
            row[0].set_xlabel(f"Turns of the {name}")
            row[0].set_ylabel("Early by (um)")
            own = orders[orders["body"] == body]
            for column, label, at in (("unloaded_um", "no load", -0.2), ("loaded_um", "under load", 0.2)):
                row[1].bar(own["order"] + at, own[column], 0.4, label=label)
            row[1].set_xlabel(f"Order of its turns ({name})")
            row[1].set_ylabel("Amplitude (um)")
            legend_above(row[0], 1)
            legend_above(row[1], 2)
    return figure


def figures(curves: Arrays, orders: pd.DataFrame) -> tuple[Figure, ...]:
    """The figure."""
    return (tooth_error_figure(curves, orders),)
