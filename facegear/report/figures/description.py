"""A figure as data: panels with axes, units and marks, which `draw_plotly` and `draw_matplotlib` draw.

Texts are plain, with line ends where they are wanted. Numbers are in the unit that their axis names.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import log10
from typing import Any

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.report.figures.colours import BLACK
from facegear.report.figures.marks import (
    Area,
    Arrow,
    Band,
    Bars,
    ColourScale,
    Curve,
    Faces,
    Letter,
    Levels,
    Line,
    LineStyle,
    Map,
    Mark,
    Scatter,
    Solid,
    Span,
    Surface,
    Text,
    with_unit,
)

NARROW = 4.7
"""Width in inches of figures that a telephone shows whole: at 500 px their 9 pt text is 12 px high."""
MARGIN = 0.05
"""Room beside the data on an axis without limits, in its range."""
NO_RANGE = 1e-5
"""Range of values, over the largest, up to which they are drawn as equal: rounding alone moves them."""


@dataclass(frozen=True)
class Axis:
    """Quantity of an axis, with its unit, ends and ticks.

    - name, unit: an empty unit is that of a dimensionless number
    - note: second line of its label
    - low, high: limits; None where the data decide
    - ticks: positions with names
    """

    name: str
    unit: str
    note: str = ""
    low: float | None = None
    high: float | None = None
    logarithmic: bool = False
    integer: bool = False
    is_falling: bool = False
    ticks: Sequence[tuple[float, str]] = ()

    @property
    def label(self) -> str:
        """Text of the axis: name with the unit in brackets, and below it the note."""
        return "\n".join(part for part in (with_unit(self.name, self.unit), self.note) if part)


@dataclass(frozen=True)
class Key:
    """An entry of a legend that explains a look; `area`: a patch of colour instead of a line."""

    name: str
    colour: str = BLACK
    line: LineStyle = "solid"
    width: float = 1.2
    marker: str = ""
    hollow: bool = False
    area: bool = False
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Panel:
    """Axes with what is drawn in them; later marks lie above earlier ones.

    - height: of the axes, in inches
    - z: third axis of a drawing in space
    - equal: whether both axes have one scale
    - bare: whether it is a drawing without axes
    - own_legend: whether its legend stands above it, not below the figure
    - ground: colour behind the marks
    """

    x: Axis
    y: Axis
    marks: Sequence[Mark]
    title: str = ""
    height: float = 1.6
    z: Axis | None = None
    equal: bool = False
    bare: bool = False
    own_legend: bool = False
    ground: str = ""
    view: tuple[float, float] = (22.0, -62.0)

    def scales(self) -> list[ColourScale]:
        """Return the colour scales of its marks.

        Returns
        -------
        list of ColourScale
            Those of maps, levels and points that have one, each once, in the order of the marks.
        """
        values_found = [
            mark.scale for mark in self.marks if isinstance(mark, Map | Levels | Scatter) and mark.scale
        ]
        return list(dict.fromkeys(values_found))


@dataclass(frozen=True, eq=False)
class Figure:
    """Panels row by row.

    - title: above all; empty where axes and names say enough
    - width: in inches
    - shared_x, shared_y: whether panels of a column have one x axis, and those of a row one y axis
    - y_label: label of all y axes
    - keys: entries of the legend that no mark gives
    """

    panels: Sequence[Panel]
    title: str = ""
    columns: int = 1
    width: float = NARROW
    shared_x: bool = True
    shared_y: bool = False
    y_label: str = ""
    legend_title: str = ""
    keys: Sequence[Key] = ()

    @property
    def rows(self) -> int:
        """Number of rows of panels; the last one may have fewer panels."""
        return -(-len(self.panels) // self.columns)

    @property
    def is_drawing(self) -> bool:
        """Whether any panel is bare, in space or has arrows. The page shows such a figure as a fixed
        drawing, not with plotly.js.
        """
        return any(
            panel.bare or panel.z or any(isinstance(mark, Arrow) for mark in panel.marks)
            for panel in self.panels
        )

    @property
    def shared_scale(self) -> ColourScale | None:
        """Colour scale that all maps and points of two or more panels have in common, whose bar lies
        above them; None where scales differ or only one panel has one.
        """
        scales = [scale for panel in self.panels for scale in panel.scales()]
        return scales[0] if len(scales) > 1 and len(set(scales)) == 1 else None

    def shows_x(self, number: int) -> bool:
        """Return whether a panel has the label of its x axis below it.

        Parameters
        ----------
        number : int
            Number of the panel, from 0, dimensionless.

        Returns
        -------
        bool
            False where a panel below shares the axis.
        """
        return not self.shared_x or number + self.columns >= len(self.panels)

    def shows_y(self, number: int) -> bool:
        """Return whether a panel has the label of its y axis beside it.

        Parameters
        ----------
        number : int
            Number of the panel, from 0, dimensionless.

        Returns
        -------
        bool
            False where a panel at its left shares the axis.
        """
        return not self.shared_y or number % self.columns == 0

    def limits(self, number: int, letter: Letter) -> tuple[float, float]:
        """Return the ends of an axis of a panel: given limits, else the extremes of all marks with a
        margin.

        Panels that share the axis have the same ends: those of a column if `shared_x`, of a row if
        `shared_y`.

        Parameters
        ----------
        number : int
            Number of the panel, from 0, dimensionless.
        letter : str
            `x` or `y`.

        Returns
        -------
        low, high : float
            Ends in the unit of the axis.
        """
        panels_joined = [
            panel
            for index, panel in enumerate(self.panels)
            if index == number
            or (letter == "x" and self.shared_x and (index - number) % self.columns == 0)
            or (letter == "y" and self.shared_y and index // self.columns == number // self.columns)
        ]
        return _limits(panels_joined, letter)


def entries(panels: Sequence[Panel], keys: Sequence[Key] = ()) -> list[Key]:
    """List the legend's entries of panels: each name once, in the order of the marks, then `keys`.

    Of several marks with one name the first decides the look.

    Parameters
    ----------
    panels : sequence of Panel
        The panels.
    keys : sequence of Key
        Entries that no mark gives.

    Returns
    -------
    list of Key
        The entries.
    """
    values_found = {key.name: key for key in reversed([*_legend_keys(panels), *keys])}
    return [values_found[name] for name in dict.fromkeys(key.name for key in [*_legend_keys(panels), *keys])]


def _legend_keys(panels: Sequence[Panel]) -> Iterator[Key]:
    """Yield an entry of the legend for each mark that has a name and is not kept out of the legend,
    panel by panel; names may occur twice. Curves, points and lines give a line or marker, bars and
    areas a patch.
    """
    for mark in (mark for panel in panels for mark in panel.marks):
        if not getattr(mark, "name", "") or not getattr(mark, "in_legend", True):
            continue
        if isinstance(mark, Curve):
            yield Key(mark.name, mark.colour, mark.line, mark.width, mark.marker, mark.hollow)
        elif isinstance(mark, Scatter):
            yield Key(mark.name, mark.colour, "none", marker=mark.marker)
        elif isinstance(mark, Line):
            yield Key(mark.name, mark.colour, mark.line, mark.width)
        elif isinstance(mark, Bars | Band | Area | Span):
            yield Key(mark.name, mark.colour, area=True, opacity=getattr(mark, "opacity", 1.0))


def apart(x: AnyArray, y: AnyArray) -> tuple[Array, Array]:
    """Join separate lines to one curve.

    Parameters
    ----------
    x, y : array
        Points of each line, shape (lines, points), any unit.

    Returns
    -------
    x, y : array
        Points of the curve, with nan between two lines, shape (lines * (points + 1) - 1,).
    """
    x, y = np.broadcast_arrays(np.atleast_2d(x), np.atleast_2d(y))
    ends = np.full((len(x), 1), np.nan)
    return tuple(np.hstack([values, ends]).ravel()[:-1] for values in (x, y))  # type: ignore[return-value]


def stems(at: AnyArray, heights: AnyArray) -> tuple[Array, Array]:
    """Return upright lines from 0 to heights as one curve, with nan between them.

    Parameters
    ----------
    at, heights : array
        Place and height of each line, shape (lines,), any unit.

    Returns
    -------
    x, y : array
        Points of the curve, shape (3 * lines - 1,).
    """
    at, heights = np.asarray(at, dtype=float), np.asarray(heights, dtype=float)
    return apart(np.stack([at, at], axis=1), np.stack([0.0 * heights, heights], axis=1))


def extent(mark: Mark, letter: Letter) -> Array:
    """List the finite coordinates of a mark along an axis, from which the axis takes its ends.

    Parameters
    ----------
    mark : Mark
        The mark.
    letter : str
        `x` or `y`.

    Returns
    -------
    array
        Values in the unit of the axis, shape (n,); empty for texts, arrows and bodies in space.
    """
    values: Any
    if isinstance(mark, Line):
        values = [mark.at] if mark.of == letter else []
    elif isinstance(mark, Span):
        values = [mark.low, mark.high] if mark.of == letter else []
    elif isinstance(mark, Band) and letter == "y":
        values = [*mark.low, *mark.high]
    elif isinstance(mark, Bars):
        values = _extent_of_bars(mark, letter)
    elif isinstance(mark, Faces):
        values = mark.corners[..., "xy".index(letter)].ravel()
    elif isinstance(mark, Text | Arrow | Solid | Surface):
        values = []
    else:
        values = np.ravel(getattr(mark, letter))
    values_found = np.asarray(values, dtype=float)
    return np.asarray(values_found[np.isfinite(values_found)])


def _extent_of_bars(bars: Bars, letter: Letter) -> list[float]:
    """Return the coordinates of all bars' ends along an axis: their sides along the axis of positions;
    base, tip and ends of error bars along the other.
    """
    if (letter == "y") == bars.flat:
        half = 0.5 * bars.width
        return [*(bars.positions - half), *(bars.positions + half)]
    base = np.zeros_like(bars.lengths) if bars.base is None else bars.base
    ends = [values for values in (bars.low, bars.high) if values is not None]
    return [*base, *(base + bars.lengths), *np.ravel(ends)]


def _limits(panels: Sequence[Panel], letter: Letter) -> tuple[float, float]:
    """Return low and high end of axis `letter` for several panels: limits given by any panel (the
    lowest and the highest), else the extremes of all marks with a margin; logarithmic if the first
    panel's axis is.
    """
    axes: list[Axis] = [getattr(panel, letter) for panel in panels]
    values = np.concatenate(
        [np.zeros(0), *(extent(mark, letter) for panel in panels for mark in panel.marks)]
    )
    lows = [axis.low for axis in axes if axis.low is not None]
    highs = [axis.high for axis in axes if axis.high is not None]
    if axes[0].logarithmic:
        logarithms = np.log10(values[values > 0.0])
        ends = _with_margin(logarithms, [log10(low) for low in lows], [log10(high) for high in highs])
        return 10.0 ** ends[0], 10.0 ** ends[1]
    return _with_margin(values, lows, highs)


def _with_margin(values: Array, lows: Sequence[float], highs: Sequence[float]) -> tuple[float, float]:
    """Return the ends of an axis: the smallest of `lows` and largest of `highs` if any, else the
    extremes of `values` (n,) and MARGIN of their range. Values that are equal or missing get a range
    about their middle.
    """
    low = min(lows) if lows else float(values.min(initial=np.inf))
    high = max(highs) if highs else float(values.max(initial=-np.inf))
    if not np.isfinite([low, high]).all() or high - low <= NO_RANGE * max(abs(low), abs(high)):
        middle = next((end for end in (low, high) if np.isfinite(end)), 0.5)
        reach = max(MARGIN * abs(middle), MARGIN)
        return (middle if lows else middle - reach), middle + reach
    margin = MARGIN * (high - low)
    return (low if lows else low - margin), (high if highs else high + margin)
