"""A curve of two folders of results laid over each other."""

import pandas as pd

from facegear.plots.colours import BLACK, BLUE, RED, grey
from facegear.plots.description import Axis, Curve, Figure, Line, Panel


def curves_compared(
    old: pd.DataFrame, new: pd.DataFrame, x: str, y: str, labels: tuple[str, str], title: str
) -> Figure:
    """Above both curves `y` over `x`, below what the new one has more; both tables are of one series.

    `labels`: `x` and `y` in words, with their units in brackets.
    """
    joined_curves = old[[x, y]].merge(new[[x, y]], on=x, suffixes=("_old", "_new"))
    (across, across_unit), (up, unit) = (split_label(label) for label in labels)
    top = [
        Curve(old[x], old[y], "old", BLUE, width=2.2, opacity=0.6),
        Curve(new[x], new[y], "new", BLACK, "dash", width=1.1),
    ]
    bottom: list[Curve | Line] = [
        Line(0.0, "y", colour=grey(0.6)),
        Curve(joined_curves[x], joined_curves[f"{y}_new"] - joined_curves[f"{y}_old"], colour=RED, width=1.2),
    ]
    axis = Axis(across, across_unit)
    return Figure(
        [
            Panel(axis, Axis(up, unit), top, height=2.0, own_legend=True),
            Panel(axis, Axis("New - old", unit), bottom, height=1.0),
        ],
        title=title,
    )


def split_label(label: str) -> tuple[str, str]:
    """Part a label into quantity and unit.

    Parameters
    ----------
    label : str
        The quantity with its unit in brackets, as tables of the report name it.

    Returns
    -------
    name, unit : str
        The unit is empty where there is none.
    """
    name, bracket, unit = label.rpartition(" (")
    return (name, unit.removesuffix(")")) if bracket and label.endswith(")") else (label, "")
