"""Figures drawn with matplotlib: for papers, and as stills of the page."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import ceil, log10
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as MplFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text as DrawnText
from matplotlib.ticker import (
    FixedLocator,
    LogLocator,
    MaxNLocator,
    NullFormatter,
    NullLocator,
    StrMethodFormatter,
)

from facegear.errors import FacegearError
from facegear.io.atomic import atomic_path
from facegear.number_format import format_number
from facegear.report.figures import draw_plotly
from facegear.report.figures.description import Axis, Figure, Key, Panel, entries
from facegear.report.figures.marks import Bars, Levels, Map
from facegear.report.figures.matplotlib_marks import DRAW, LINES, MARKERS, _colours

STYLE = {
    "figure.dpi": 110,
    "savefig.dpi": 160,
    "figure.constrained_layout.use": True,
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.titlelocation": "left",
    "figure.titlesize": 9,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "svg.hashsalt": "facegear",
    "svg.fonttype": "path",
}
"""Settings of matplotlib for all figures."""


LETTER, HANDLE, LINE_HEIGHT = 0.064, 0.53, 0.18
"""In inches: width of a letter of 9 pt, of an entry of the legend without its name, height of a line."""
TICKS = 0.2
"""Inches of the numbers below an axis."""
SPACE = 0.14
"""Inches between rows of panels."""
UPRIGHT = 6
"""Names of ticks from which those that are too wide stand upright."""
SHORT = 1.3
"""Decades of a logarithmic axis below which it names 1, 2 and 5 of each."""


@contextmanager
def styled() -> Iterator[None]:
    """Apply STYLE, the project's matplotlib settings, inside a `with` block.

    Yields
    ------
    None
        While it holds.
    """
    with plt.rc_context(STYLE):
        yield


def draw(figure: Figure, size: tuple[float, float] | None = None) -> MplFigure:
    """Draw a figure with matplotlib.

    Parameters
    ----------
    figure : Figure
        Description of the figure.
    size : tuple of float, optional
        Width and height in inches; what its panels ask for unless given.

    Returns
    -------
    matplotlib.figure.Figure
        The drawing, whose layout may still move parts (see `place_parts`); the caller closes it.
    """
    width = size[0] if size else figure.width
    with styled():
        mpl_figure = plt.figure(figsize=size or (width, _height(figure)))
        axes = _axes_of(mpl_figure, figure)
        for number, (panel, on) in enumerate(zip(figure.panels, axes, strict=True)):
            _draw_panel(on, panel)
            _frame(on, figure, number, width / figure.columns)
            if panel.own_legend:
                _legend_above(on, entries([panel]), width / figure.columns)
        _colour_bars(mpl_figure, figure, axes)
        shared_keys = entries([panel for panel in figure.panels if not panel.own_legend], figure.keys)
        if shared_keys:
            columns = _columns(shared_keys, width)
            handles = [_handle(key) for key in shared_keys]
            title = figure.legend_title or None
            mpl_figure.legend(handles=handles, loc="outside lower center", ncols=columns, title=title)
        if figure.title:
            mpl_figure.suptitle(wrap_text(figure.title, width))
        if figure.y_label:
            mpl_figure.supylabel(figure.y_label, fontsize=9)
    return mpl_figure


def wrap_text(text: str, width: float) -> str:
    """Break a text of 9 pt into lines that fit into a width, estimated by LETTER; at least 10 letters
    each.

    Parameters
    ----------
    text : str
        The text, with line ends that stay.
    width : float
        Room for it, unit inch.

    Returns
    -------
    str
        The text with more line ends.
    """
    return "\n".join(fill(line, max(int(width / LETTER), 10)) for line in text.split("\n"))


def rename_texts(mpl_figure: MplFigure, labels: Mapping[str, str]) -> None:
    """Write other words for texts of a drawing.

    Parameters
    ----------
    mpl_figure : matplotlib.figure.Figure
        The drawing.
    labels : mapping of str to str
        New words by the text that stands in the drawing.

    Raises
    ------
    FacegearError
        For a text that the drawing does not have.
    """
    texts = [text for text in mpl_figure.findobj(DrawnText) if text.get_text()]
    words = {text.get_text() for text in texts}
    for before in labels:
        if before not in words:
            text_list = ", ".join(repr(text) for text in sorted(words))
            raise FacegearError(f"labels: {before!r} is no text of this figure, which has {text_list}")
    for text in texts:
        if text.get_text() in labels:
            text.set_text(labels[text.get_text()])


def place_parts(mpl_figure: MplFigure) -> None:
    """Run the layout of a drawing once at the resolution of its files, and switch it off: no part moves
    again.

    Parameters
    ----------
    mpl_figure : matplotlib.figure.Figure
        The drawing.
    """
    mpl_figure.set_dpi(STYLE["savefig.dpi"])
    engine = mpl_figure.get_layout_engine()
    if engine is not None:
        engine.execute(mpl_figure)
        mpl_figure.set_layout_engine("none")


def _height(figure: Figure) -> float:
    """Return the height (inches) that all parts of a figure take above each other: panels with titles,
    labels, ticks and legends, the legend of all, the bar of a shared colour scale, and the title.
    """
    margin, height = figure.width / figure.columns, 0.1
    for row in range(figure.rows):
        first = row * figure.columns
        panels = figure.panels[first : first + figure.columns]
        height += max(panel.height for panel in panels) + SPACE
        height += LINE_HEIGHT * max(_lines(wrap_text(panel.title, margin)) for panel in panels)
        height += max(_legend_height(entries([p]) if p.own_legend else [], margin) for p in panels)
        if not panels[0].bare:
            last = figure.shows_x(first)
            names = max((len(name) for _, name in panels[0].x.ticks), default=0) if last else 0
            is_upright = names and len(panels[0].x.ticks) >= UPRIGHT
            height += (TICKS if last else 0.5 * TICKS) + (LETTER * names if is_upright else 0.0)
            height += LINE_HEIGHT * max(_lines(panel.x.label) for panel in panels) if last else 0.0
    shared_keys = entries([panel for panel in figure.panels if not panel.own_legend], figure.keys)
    height += _legend_height(shared_keys, figure.width) + LINE_HEIGHT * bool(figure.legend_title)
    height += 0.55 * (figure.shared_scale is not None)
    return height + LINE_HEIGHT * _lines(wrap_text(figure.title, figure.width))


def _lines(text: str) -> int:
    """Count the lines of a text; an empty one has none."""
    return text.count("\n") + 1 if text else 0


def _columns(keys: Sequence[Key], width: float) -> int:
    """Return the largest number of columns of a legend that fit into `width` (inches), at least 1;
    matplotlib fills one column after the other.
    """
    lengths = [len(key.name) for key in keys]
    for columns in range(len(keys), 1, -1):
        if sum(HANDLE + LETTER * part.max() for part in np.array_split(lengths, columns)) < width:
            return columns
    return 1


def _legend_height(keys: Sequence[Key], width: float) -> float:
    """Return the height of a legend with these entries in a `width`, both in inches; 0 without entries."""
    return LINE_HEIGHT * 1.1 * ceil(len(keys) / _columns(keys, width)) + 0.05 if keys else 0.0


def _axes_of(mpl_figure: MplFigure, figure: Figure) -> list[Axes]:
    """Add one matplotlib axes for each panel to a drawing, in rows and columns with shared axes, and
    return them in the order of the panels.
    """
    heights = [
        max(panel.height for panel in figure.panels[row * figure.columns : (row + 1) * figure.columns])
        for row in range(figure.rows)
    ]
    grid = mpl_figure.add_gridspec(figure.rows, figure.columns, height_ratios=heights)
    axes: list[Axes] = []
    for number, panel in enumerate(figure.panels):
        row, column = divmod(number, figure.columns)
        above = axes[column] if figure.shared_x and row else None
        beside = axes[row * figure.columns] if figure.shared_y and column else None
        if figure.shared_y and figure.shared_x and row and not column:
            beside = None
        kind = {"projection": "3d"} if panel.z else {"sharex": above, "sharey": beside}
        axes.append(mpl_figure.add_subplot(grid[row, column], **kind))
        if above is not None and not figure.shows_x(number):
            axes[-1].tick_params(labelbottom=False)
        if not figure.shows_x(number) and not panel.z:
            axes[-1].tick_params(labelbottom=False)
        if beside is not None:
            axes[-1].tick_params(labelleft=False)
    return axes


def _draw_panel(on: Axes, panel: Panel) -> None:
    """Draw the ground and the marks of a panel, later ones above earlier ones, and switch off the grid
    where it would hide a map or cross bars.
    """
    if panel.ground:
        on.set_facecolor(panel.ground)
    for order, mark in enumerate(panel.marks):
        DRAW[type(mark)](on, mark, 2.0 + 0.001 * order)
    if panel.ground or any(isinstance(mark, Map | Levels) for mark in panel.marks):
        on.grid(visible=False)
    bars = [mark for mark in panel.marks if isinstance(mark, Bars)]
    if bars and not panel.z:
        on.grid(visible=False, axis="y" if bars[0].flat else "x")
    on.set_axisbelow(True)


def _frame(on: Axes, figure: Figure, number: int, width: float) -> None:
    """Set title, labels, limits and ticks of the panel with a number (from 0). `width`: room of the
    title, inches.
    """
    panel = figure.panels[number]
    on.set_title(wrap_text(panel.title, width - 0.4))
    if panel.z:
        _frame_in_space(on, panel)
        return
    for letter in ("x", "y"):
        axis: Axis = getattr(panel, letter)
        low, high = figure.limits(number, letter)
        if axis.logarithmic:
            getattr(on, f"set_{letter}scale")("log")
        getattr(on, f"set_{letter}lim")(*((high, low) if axis.is_falling else (low, high)))
        if figure.shows_y(number) if letter == "y" else figure.shows_x(number):
            getattr(on, f"set_{letter}label")(axis.label)
        _ticks(getattr(on, f"{letter}axis"), axis, log10(high / low) if axis.logarithmic else 0.0, letter)
    if panel.equal:
        on.set_aspect("equal")
    if panel.bare:
        on.set_axis_off()


def _ticks(on: Any, axis: Axis, decades: float, letter: str) -> None:
    """Set the ticks of one of matplotlib's axes, `on`: named ones if the axis has any, else round
    numbers.

    decades: length of a logarithmic axis, 0 for a linear one; letter: `x` or `y`.
    """
    if axis.ticks:
        positions, names = zip(*axis.ticks, strict=True)
        upright = letter == "x" and len(names) >= UPRIGHT and max(map(len, names)) > 3
        on.set_major_locator(FixedLocator(positions))
        on.set_ticklabels(names, rotation=90 if upright else 0)
        on.set_minor_locator(NullLocator())
    elif axis.integer:
        on.set_major_locator(MaxNLocator(integer=True))
    elif axis.logarithmic and decades < SHORT:
        on.set_major_locator(LogLocator(subs=(1, 2, 5) if decades > 0.5 else range(1, 10)))
        on.set_major_formatter(StrMethodFormatter("{x:g}"))
        on.set_minor_formatter(NullFormatter())
    elif not axis.logarithmic:
        on.set_major_locator(MaxNLocator("auto" if letter == "y" else 6, steps=[1, 2, 2.5, 5, 10]))


def _frame_in_space(on: Any, panel: Panel) -> None:
    """Label and limit the three axes of a panel in space, with one scale if `equal`, and set the view
    (elevation and azimuth, deg).
    """
    for letter in "xyz":
        axis = getattr(panel, letter)
        getattr(on, f"set_{letter}label")(axis.label)
        getattr(on, f"{letter}axis").set_major_locator(MaxNLocator(6))
        if axis.low is not None:
            getattr(on, f"set_{letter}lim")(axis.low, axis.high)
    if panel.equal:
        box = [getattr(panel, letter).high - getattr(panel, letter).low for letter in "xyz"]
        on.set_box_aspect(box)
        on.yaxis.set_major_locator(MaxNLocator(2))
    else:
        on.set_box_aspect(None, zoom=0.85)
    on.view_init(elev=panel.view[0], azim=panel.view[1])


def _legend_above(on: Axes, keys: Sequence[Key], width: float) -> None:
    """Draw the legend of a panel above it, and its title above that. `width`: of the panel, inches."""
    if keys:
        columns = _columns(keys, width - 0.5)
        handles = [_handle(key) for key in keys]
        on.legend(
            handles=handles, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=columns, borderaxespad=0.2
        )
        on.set_title(on.get_title(loc="left"), pad=6.0 + 72.0 * _legend_height(keys, width - 0.5))


def _handle(key: Key) -> Any:
    """Return matplotlib's handle of an entry of the legend: a patch if `area`, else a line with its
    marker.
    """
    if key.area:
        return Patch(color=key.colour, alpha=key.opacity, lw=0, label=key.name)
    return Line2D(
        [],
        [],
        color=key.colour,
        ls=LINES[key.line],
        lw=key.width,
        marker=MARKERS[key.marker],
        ms=5,
        mfc="white" if key.hollow else key.colour,
        label=key.name,
    )


def _colour_bars(mpl_figure: MplFigure, figure: Figure, axes: Sequence[Axes]) -> None:
    """Draw colour bars: one above all panels that share a colour scale, else one beside each panel that
    has one.
    """
    if scale := figure.shared_scale:
        mpl_figure.colorbar(_colours(scale), ax=list(axes), location="top", aspect=40, label=scale.label)
        return
    for panel, on in zip(figure.panels, axes, strict=True):
        for scale in panel.scales():
            bar = mpl_figure.colorbar(_colours(scale), ax=on, label=scale.label)
            if scale.levels:
                bar.set_ticks(scale.levels, labels=[format_number(level) for level in scale.levels])


def save(figure: Figure, *paths: str | Path) -> None:
    """Write a figure to files, each at once or not at all.

    Parameters
    ----------
    figure : Figure
        Description of the figure.
    *paths : str or Path
        Files to write. The suffix names the format: one that matplotlib knows, or `.json` for plotly.js
        (`facegear.report.figures.draw_plotly`).
    """
    pages = [path for path in paths if Path(path).suffix == ".json"]
    for path in pages:
        with atomic_path(path) as temporary:
            draw_plotly.write(figure, temporary)
    if still_paths := [path for path in paths if path not in pages]:
        save_drawn(draw(figure), *still_paths)


def save_drawn(mpl_figure: MplFigure, *paths: str | Path) -> None:
    """Write a drawing of matplotlib to files and close it.

    The same drawing gives the same bytes, whatever other files are written: its parts are placed once, an svg
    holds no date, and its inner names follow from a fixed salt.

    Parameters
    ----------
    mpl_figure : matplotlib.figure.Figure
        The drawing.
    *paths : str or Path
        Files to write; the suffix names the format.
    """
    with styled():
        place_parts(mpl_figure)
        for path in paths:
            with atomic_path(path) as temporary:
                mpl_figure.savefig(
                    temporary, metadata={"Date": None} if Path(path).suffix == ".svg" else None
                )
    plt.close(mpl_figure)
