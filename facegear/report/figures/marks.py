"""Marks of a figure as data: curves, bars, maps, texts, bodies in space."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from facegear.arrays import Array
from facegear.report.figures.colours import BLACK, grey

LineStyle = Literal["solid", "dash", "dot", "dashdot", "none"]
Letter = Literal["x", "y"]
Look = dict[str, Any]
"""Keywords of a mark that say how it is drawn."""


@dataclass(frozen=True)
class ColourScale:
    """Quantity that colours of a map or of points show.

    - colours: name of the scale as matplotlib has it
    - levels: limits of areas of one colour; none for a colour that follows the value
    """

    name: str
    unit: str
    low: float
    high: float
    colours: str = "viridis"
    levels: tuple[float, ...] = ()

    @property
    def label(self) -> str:
        """Text beside the bar of colours: name with the unit in brackets."""
        return with_unit(self.name, self.unit)


@dataclass(frozen=True, eq=False)
class Curve:
    """A line, marks, or both; nan parts it.

    - x, y: shape (points,)
    - name: in the legend; empty for none
    - marker: `circle`, `square`, `diamond`, `triangle-up`, `triangle-down`, `x`, `cross`, `star`, `dot`, ...
    - width, size: of line and mark, in points of 1/72 inch
    - steps: a value holds up to the next one
    - in_legend: whether its name stands there, not beside the pointer alone
    """

    x: Array
    y: Array
    name: str = ""
    colour: str = BLACK
    line: LineStyle = "solid"
    width: float = 1.2
    marker: str = ""
    size: float = 4.5
    hollow: bool = False
    opacity: float = 1.0
    steps: bool = False
    in_legend: bool = True


@dataclass(frozen=True, eq=False)
class Scatter:
    """Points, coloured by a value where `values` and `scale` are given.

    - x, y, values, sizes: shape (points,); sizes in 1/72 inch
    """

    x: Array
    y: Array
    sizes: Array
    name: str = ""
    colour: str = BLACK
    marker: str = "circle"
    values: Array | None = None
    scale: ColourScale | None = None


@dataclass(frozen=True, eq=False)
class Bars:
    """Bars from `base` to `base + lengths` at positions on an axis, all of shape (bars,).

    - flat: whether they lie
    - width: in the unit of their positions
    - low, high: ends of an error bar of each
    - labels: text inside each
    """

    positions: Array
    lengths: Array
    name: str = ""
    colour: str = BLACK
    width: float = 0.8
    flat: bool = False
    base: Array | None = None
    low: Array | None = None
    high: Array | None = None
    labels: Sequence[str] = ()
    in_legend: bool = True


@dataclass(frozen=True, eq=False)
class Band:
    """An area between two curves, shape (points,) each."""

    x: Array
    low: Array
    high: Array
    name: str = ""
    colour: str = BLACK
    opacity: float = 0.2


@dataclass(frozen=True, eq=False)
class Area:
    """A filled area inside a ring of points, shape (points,) each."""

    x: Array
    y: Array
    name: str = ""
    colour: str = BLACK
    opacity: float = 1.0
    outline: str = ""


@dataclass(frozen=True)
class Line:
    """A line across a panel at a value of the axis `of`, over the first `part` of it."""

    at: float
    of: Letter = "x"
    name: str = ""
    colour: str = grey(0.5)
    line: LineStyle = "solid"
    width: float = 0.8
    part: float = 1.0
    in_legend: bool = True


@dataclass(frozen=True)
class Span:
    """A band across a panel between two values of the axis `of`."""

    low: float
    high: float
    of: Letter = "x"
    name: str = ""
    colour: str = grey(0.5)
    opacity: float = 0.15


@dataclass(frozen=True, eq=False)
class Map:
    """Values over a grid, nan where there is none.

    - x, y: shape (columns,) and (rows,), or (rows, columns) each where rows are not even
    - values: shape (rows, columns), at the points of the grid
    - smooth: whether colours run from point to point
    """

    x: Array
    y: Array
    values: Array
    scale: ColourScale
    smooth: bool = False


@dataclass(frozen=True, eq=False)
class Levels:
    """Areas between the levels of a scale.

    - x, y, values: shape (rows, columns); values are nan where there is none
    """

    x: Array
    y: Array
    values: Array
    scale: ColourScale


@dataclass(frozen=True, eq=False)
class Faces:
    """Polygons of shape (faces, corners, 2), each with a value that its colour shows."""

    corners: Array
    values: Array
    colours: str = "viridis"


@dataclass(frozen=True)
class Text:
    """A text at a point of the data, moved by `shift` (1/72 inch).

    - across, upright: which side of the text stands there
    - paper: whether it stands on a patch of paper
    """

    x: float
    y: float
    text: str
    shift: tuple[float, float] = (0.0, 0.0)
    across: Literal["left", "center", "right"] = "left"
    upright: Literal["bottom", "center", "top"] = "center"
    colour: str = BLACK
    paper: bool = False


@dataclass(frozen=True)
class Arrow:
    """An arrow of a drawing; `bend` is the height of its arc in its length, to the right for more than 0."""

    start: tuple[float, float]
    end: tuple[float, float]
    colour: str = BLACK
    width: float = 2.0
    bend: float = 0.0


@dataclass(frozen=True, eq=False)
class Solid:
    """Faces in space of a drawing: shape (faces, corners, 3), and their colours, shape (faces, 3), 0 to 1."""

    corners: Array
    colours: Array


@dataclass(frozen=True, eq=False)
class Surface:
    """A height over a grid, drawn in space: x, y, z of shape (rows, columns)."""

    x: Array
    y: Array
    z: Array
    colours: str = "viridis"


Mark = (
    Curve | Scatter | Bars | Band | Area | Line | Span | Map | Levels | Faces | Text | Arrow | Solid | Surface
)


def with_unit(name: str, unit: str) -> str:
    """Write a quantity as axes name it.

    Parameters
    ----------
    name, unit : str
        The quantity and its unit; an empty one is that of a dimensionless number.

    Returns
    -------
    str
        The name with the unit in brackets; the name alone for an empty unit.
    """
    return f"{name} ({unit})" if unit else name
