"""Contribution of single teeth to the transmission error over a turn of either gear."""

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.plots.colours import BLACK, BLUE
from facegear.plots.description import Axis, Bars, Curve, Figure, Panel


def tooth_error_figure(curves: Arrays, orders: pd.DataFrame) -> Figure:
    """Two panels a gear whose teeth differ: the drive flank over a turn, and the orders of its turns."""
    panels = []
    for body in orders["body"].unique():
        name, curve = body.replace("_", " "), 1e6 * curves[f"{body}_drive_m"]
        turns = np.arange(curve.size) / curve.size
        early = Curve(turns, curve, "drive flank, under load", BLUE, width=0.9)
        body_orders = orders[orders["body"] == body]
        at = body_orders["order"].to_numpy(float)
        bars = [
            Bars(at - 0.2, body_orders["unloaded_um"].to_numpy(float), "no load", BLACK, width=0.4),
            Bars(at + 0.2, body_orders["loaded_um"].to_numpy(float), "under load", BLUE, width=0.4),
        ]
        panels += [
            Panel(
                Axis(f"Turns of the {name}", ""), Axis("Early by", "µm"), [early], height=1.5, own_legend=True
            ),
            Panel(
                Axis(f"Order of its turns ({name})", "", integer=True),
                Axis("Amplitude", "µm", low=0.0),
                bars,
                height=1.5,
                own_legend=True,
            ),
        ]
    return Figure(panels, shared_x=False)


def figures(curves: Arrays, orders: pd.DataFrame) -> tuple[Figure, ...]:
    """The figure."""
    return (tooth_error_figure(curves, orders),)
