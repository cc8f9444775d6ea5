"""Mesh forces at the orders of the gears' turns, at one speed and over speed."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from facegear.plots.colours import BLUE, RED
from facegear.plots.description import Axis, Curve, Figure, LineStyle, Panel, stems

GEARS = {"pinion": BLUE, "face_gear": RED}
LINES: tuple[LineStyle, ...] = ("solid", "dash", "dot", "dashdot")
ORDERS_SHOWN = 3
"""Orders of each gear that are drawn over speed."""


def figures(orders: pd.DataFrame, over_speed: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the figure of the orders.

    Parameters
    ----------
    orders : pd.DataFrame
        Table `orders` of stage shaft_orders.
    over_speed : pd.DataFrame
        Table `over_speed` of stage shaft_orders.

    Returns
    -------
    tuple[Figure, ...]
        The figure.
    """
    return (shaft_order_figure(orders, over_speed),)


def shaft_order_figure(orders: pd.DataFrame, over_speed: pd.DataFrame) -> Figure:
    """Draw above the largest force of all meshes at each order, below the largest orders over speed.

    Parameters
    ----------
    orders : pd.DataFrame
        Table `orders` of stage shaft_orders.
    over_speed : pd.DataFrame
        Table `over_speed` of stage shaft_orders.

    Returns
    -------
    Figure
        The figure.
    """
    above: list[Curve] = []
    below: list[Curve] = []
    for gear, colour in GEARS.items():
        rows = orders[orders["turning"] == gear]
        largest = rows.groupby("of_mesh")["force_n"].max()
        name = gear.replace("_", " ")
        if len(largest):
            above.append(Curve(*stems(largest.index, largest), f"turns of the {name}", colour))
        below += _over_speed(over_speed[over_speed["turning"] == gear], colour, name)
    frequency = Axis("Frequency over the mesh frequency", "")
    return Figure(
        [
            Panel(
                frequency,
                Axis("Force at the\nnominal speed", "N", low=0.0),
                above,
                height=2.0,
                own_legend=True,
            ),
            Panel(
                Axis("Speed of the pinions", "rpm"),
                Axis("Largest force\nof all meshes", "N", low=0.0),
                below,
                height=2.0,
            ),
        ],
        shared_x=False,
    )


def _over_speed(rows: pd.DataFrame, colour: str, name: str) -> Iterator[Curve]:
    """The orders whose forces become largest."""
    peaks = rows.groupby("order")["force_n"].max().nlargest(ORDERS_SHOWN)
    for line, order in zip(LINES, np.sort(peaks.index), strict=False):
        order_rows = rows[rows["order"] == order]
        yield Curve(order_rows["speed_rpm"], order_rows["force_n"], f"{name}, order {order}", colour, line)
