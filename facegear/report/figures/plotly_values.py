"""Values, texts and colours of a figure as plotly.js takes them."""

from dataclasses import dataclass
from html import escape
from itertools import pairwise
from textwrap import wrap
from typing import Any

import numpy as np

from facegear.arrays import Array
from facegear.report.figures.colours import channels
from facegear.report.figures.description import Panel
from facegear.report.figures.marks import Map

Part = dict[str, Any]
"""A trace, a shape or an annotation, as plotly.js takes it."""
PIXELS = 96 / 72
"""Pixels of a page in a point of a paper."""
DIGITS, MAP_DIGITS = 6, 4
"""Significant digits of a value of a curve and of a map."""
ROWS = 160
"""Rows of a map whose own rows are not even, drawn again on even ones."""
LEGEND_LETTERS = 46
"""Letters of a line of a legend."""


VALUE_FORMAT, POSITION_FORMAT = ",.4~r", ",.5~r"
"""How a value, and the place that it stands at, are written beside the pointer."""


@dataclass(frozen=True)
class PlotlyAxes:
    """A panel with the names of its axes (`x2`, `y3`); `closest`: whether the pointer asks point by point."""

    panel: Panel
    x: str
    y: str
    closest: bool

    @property
    def axes(self) -> Part:
        """Attributes by which a trace names its axes, `xaxis` and `yaxis`."""
        return {"xaxis": self.x, "yaxis": self.y}

    def hover_template(self, value: str = "") -> str:
        """Write what stands beside the pointer: both values with names and units, or that of the curve alone.

        Parameters
        ----------
        value : str
            Template of a third value, such as the colour's; empty for none.

        Returns
        -------
        str
            Template of plotly.js with x, y and `value`, or with y alone unless `closest` or a `value`
            is given.
        """
        x, y = (
            f"{markup(axis.name)} %{{{letter}:{digits}}} {markup(axis.unit)}"
            for letter, axis, digits in (
                ("x", self.panel.x, POSITION_FORMAT),
                ("y", self.panel.y, VALUE_FORMAT),
            )
        )
        if self.closest or value:
            return "<br>".join(part for part in (x, y, value) if part) + "<extra></extra>" * bool(value)
        return f"%{{y:{VALUE_FORMAT}}} {markup(self.panel.y.unit)}"


def markup(text: str) -> str:
    """Write plain text as plotly.js takes it: HTML characters escaped, `<br>` for line ends.

    Parameters
    ----------
    text : str
        The text, with line ends.

    Returns
    -------
    str
        The text with marks of HTML.
    """
    return escape(text, quote=False).replace("\n", "<br>")


def legend_text(name: str) -> str:
    """Write a name as the legend of plotly.js takes it, in lines of at most LEGEND_LETTERS letters.

    Parameters
    ----------
    name : str
        The name.

    Returns
    -------
    str
        The name in lines that a telephone shows whole.
    """
    return markup("\n".join(wrap(name, LEGEND_LETTERS)))


def numbers(values: Any, digits: int = DIGITS) -> list[float | None]:
    """Round values to significant digits as a list for JSON; None stands for nan and infinite values.

    Parameters
    ----------
    values : array_like
        Numbers of any shape and unit.
    digits : int
        Significant digits kept, dimensionless.

    Returns
    -------
    list of float or None
        The numbers in one row, in the order of their rows.
    """
    flat_values = np.ravel(np.asarray(values, dtype=float))
    return [float(f"{value:.{digits}g}") + 0.0 if np.isfinite(value) else None for value in flat_values]


def css_colour(colour: str, opacity: float) -> str:
    """Write a colour with its opacity as CSS does.

    Parameters
    ----------
    colour : str
        The colour, as `#rrggbb`.
    opacity : float
        From 0 to 1, dimensionless.

    Returns
    -------
    str
        `#rrggbb` from an opacity of 1 on, else `rgba(red,green,blue,opacity)`.
    """
    if opacity >= 1.0:
        return colour
    red, green, blue = (round(255 * channel) for channel in channels(colour))
    return f"rgba({red},{green},{blue},{opacity:.3g})"


def straight(mark: Map) -> tuple[Array, Array, Array]:
    """Return a map with one x for each column and one y for each row; rows of other heights are
    interpolated.

    Parameters
    ----------
    mark : Map
        The map; all points of a column must have one x, or ValueError is raised.

    Returns
    -------
    x, y : array
        Columns and rows, shape (columns,) and (rows,), in units of the axes.
    values : array
        Values in the unit of the map, shape (rows, columns); between uneven rows straight from one to the
        next, as they are drawn.
    """
    x, y, values = (np.asarray(part, dtype=float) for part in (mark.x, mark.y, mark.values))
    if x.ndim == 1:
        return x, y, values
    if not np.allclose(x, x[0]):
        raise ValueError("a map whose columns do not stand straight")
    if np.allclose(y, y[:, :1]):
        return x[0], y[:, 0], values
    return x[0], *_even_rows(y, values)


def _even_rows(y: Array, values: Array) -> tuple[Array, Array]:
    """Interpolate a field, whose rows have other heights in each column, linearly along each column to
    ROWS even heights.

    y, values: (rows, columns), heights and values, nan where there is none. Returns heights (ROWS,) and
    values (ROWS, columns).
    """
    heights = np.linspace(y.min(), y.max(), ROWS)
    even = np.full((ROWS, y.shape[1]), np.nan)
    at = heights[:, None]
    for ends, row_values in zip(pairwise(y), pairwise(values), strict=True):
        order = np.argsort(ends, axis=0)
        (low, high), (below, above) = (
            np.take_along_axis(np.array(rows), order, 0) for rows in (ends, row_values)
        )
        slope = np.divide(above - below, high - low, out=np.zeros_like(low), where=high > low)
        inside = (at >= low) & (at <= high) & np.isfinite(row_values).all(axis=0)
        even = np.where(inside, np.where(at == high, above, slope * (at - low) + below), even)
    return heights, even
