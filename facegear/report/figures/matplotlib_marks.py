"""Marks of a figure as matplotlib draws them."""

from collections.abc import Callable, Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.patches import FancyArrowPatch
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from facegear.report.figures.marks import (
    Area,
    Arrow,
    Band,
    Bars,
    ColourScale,
    Curve,
    Faces,
    Levels,
    Line,
    Map,
    Scatter,
    Solid,
    Span,
    Surface,
    Text,
)

LINES = {"solid": "-", "dash": "--", "dot": ":", "dashdot": "-.", "none": "none"}
"""Matplotlib's name of each kind of line."""
MARKERS = {
    "": "",
    "dot": ".",
    "circle": "o",
    "square": "s",
    "diamond": "D",
    "triangle-up": "^",
    "triangle-down": "v",
    "x": "x",
    "plus": "+",
    "cross": "P",
    "star": "*",
    "pentagon": "p",
    "y-up": "1",
    "y-down": "2",
    "line-ew": "_",
    "line-ns": "|",
}
"""Markers of matplotlib by the names that plotly.js has for them."""
MANY_MARKS = 1000
"""Marks of one curve from which a svg holds them as an image."""


def _colours(scale: ColourScale) -> Any:
    """Return matplotlib's mappable of a colour scale, from which a colour bar is drawn."""
    return plt.cm.ScalarMappable(norm=_norm(scale), cmap=scale.colours)


def _norm(scale: ColourScale) -> Normalize:
    """Return the map from values in the unit of the scale to positions 0 to 1, or to steps between its
    levels.
    """
    if scale.levels:
        return BoundaryNorm(scale.levels, plt.get_cmap(scale.colours).N)
    return Normalize(scale.low, scale.high)


def _curve(on: Axes, mark: Curve, order: float) -> None:
    """Draw a curve, with its line and markers, in axes at height `order` (matplotlib's zorder)."""
    on.plot(
        mark.x,
        mark.y,
        color=mark.colour,
        ls=LINES[mark.line],
        lw=mark.width,
        marker=MARKERS[mark.marker],
        ms=mark.size,
        mfc="white" if mark.hollow else mark.colour,
        alpha=mark.opacity,
        drawstyle="steps-post" if mark.steps else "default",
        solid_capstyle="butt",
        label=mark.name or None,
        zorder=order,
        rasterized=bool(mark.marker) and np.size(mark.x) > MANY_MARKS,
    )


def _scatter(on: Axes, mark: Scatter, order: float) -> None:
    """Draw points with sizes in 1/72 inch, in one colour or coloured by their values, at height `order`."""
    colour_given = {"color": mark.colour} if mark.values is None else {"c": mark.values}
    colours = {} if mark.scale is None else {"norm": _norm(mark.scale), "cmap": mark.scale.colours}
    on.scatter(
        mark.x,
        mark.y,
        np.square(mark.sizes),
        marker=MARKERS[mark.marker],
        linewidths=0,
        label=mark.name or None,
        zorder=order,
        rasterized=np.size(mark.x) > MANY_MARKS,
        **colour_given,
        **colours,
    )


def _bars(on: Axes, mark: Bars, order: float) -> None:
    """Draw bars, lying if `flat`, with error bars if `low` and `high` are given and with their labels
    inside.
    """
    base = np.zeros_like(mark.lengths) if mark.base is None else mark.base
    look = {"color": mark.colour, "label": mark.name or None, "zorder": order, "lw": 0}
    if mark.flat:
        on.barh(mark.positions, mark.lengths, mark.width, left=base, **look)
    else:
        on.bar(mark.positions, mark.lengths, mark.width, bottom=base, **look)
    ends = base + mark.lengths
    if mark.low is not None and mark.high is not None:
        errors = np.array([ends - mark.low, mark.high - ends])
        at = {"xerr": errors} if mark.flat else {"yerr": errors}
        positions = (ends, mark.positions) if mark.flat else (mark.positions, ends)
        on.errorbar(*positions, **at, fmt="none", ecolor="black", capsize=2, lw=0.8, zorder=order)
    for position, middle, label in zip(mark.positions, base + 0.5 * mark.lengths, mark.labels, strict=False):
        at_text = (middle, position) if mark.flat else (position, middle)
        on.text(*at_text, label, ha="center", va="center", color="white", zorder=order)


def _band(on: Axes, mark: Band, order: float) -> None:
    """Draw the area between the two curves of a band, without outline."""
    look = {"color": mark.colour, "alpha": mark.opacity, "lw": 0}
    on.fill_between(mark.x, mark.low, mark.high, label=mark.name or None, zorder=order, **look)


def _area(on: Axes, mark: Area, order: float) -> None:
    """Draw a filled polygon, with an outline if it has a colour for it."""
    look = {"facecolor": mark.colour, "alpha": mark.opacity, "lw": 0.8 if mark.outline else 0}
    edge = mark.outline or "none"
    on.fill(mark.x, mark.y, edgecolor=edge, label=mark.name or None, zorder=order, **look)


def _line(on: Axes, mark: Line, order: float) -> None:
    """Draw a straight line across the panel at a value of the axis `of`, below the other marks."""
    look = {"color": mark.colour, "ls": LINES[mark.line], "lw": mark.width, "label": mark.name or None}
    across = on.axvline if mark.of == "x" else on.axhline
    across(mark.at, 0.0, mark.part, zorder=order - 1.0, **look)


def _span(on: Axes, mark: Span, order: float) -> None:
    """Draw a shaded strip across the panel between two values of the axis `of`, below lines."""
    look = {"color": mark.colour, "alpha": mark.opacity, "lw": 0, "label": mark.name or None}
    across = on.axvspan if mark.of == "x" else on.axhspan
    across(mark.low, mark.high, zorder=order - 1.5, **look)


def _map(on: Axes, mark: Map, order: float) -> None:
    """Draw a field in colours on a grid, from point to point if `smooth`, else one colour around each
    point.
    """
    shading = "gouraud" if mark.smooth else "nearest"
    values = np.ma.masked_invalid(mark.values)
    look = {"norm": _norm(mark.scale), "cmap": mark.scale.colours, "rasterized": True}
    on.pcolormesh(mark.x, mark.y, values, shading=shading, zorder=order - 1.0, **look)


def _levels(on: Axes, mark: Levels, order: float) -> None:
    """Draw a field as areas of one colour between levels; values below the first level count as that."""
    levels = list(mark.scale.levels)
    values = np.clip(np.ma.masked_invalid(mark.values), levels[0], None)
    look = {"norm": _norm(mark.scale), "cmap": mark.scale.colours, "zorder": order - 1.0}
    on.contourf(mark.x, mark.y, values, levels=levels, **look)


def _faces(on: Axes, mark: Faces, order: float) -> None:
    """Draw polygons in the colours of their values."""
    look = {"cmap": mark.colours, "edgecolors": "face", "linewidths": 0.3, "zorder": order}
    on.add_collection(PolyCollection(mark.corners, array=mark.values, **look))


def _text(on: Axes, mark: Text, order: float) -> None:
    """Draw a text at a point of the data, moved by `shift` (1/72 inch), above the marks of its order."""
    paper = {"facecolor": "white", "edgecolor": "none", "pad": 0.5} if mark.paper else None
    on.annotate(
        mark.text,
        (mark.x, mark.y),
        mark.shift,
        textcoords="offset points",
        ha=mark.across,
        va=mark.upright,
        multialignment="center",
        color=mark.colour,
        bbox=paper,
        zorder=order + 1.0,
        annotation_clip=False,
    )


def _arrow(on: Axes, mark: Arrow, order: float) -> None:
    """Draw an arrow, straight or along an arc of height `bend`, as a fraction of its length."""
    look = {"arrowstyle": "-|>", "mutation_scale": 12, "color": mark.colour, "lw": mark.width}
    bend = f"arc3,rad={mark.bend}"
    on.add_patch(FancyArrowPatch(mark.start, mark.end, connectionstyle=bend, zorder=order, **look))


def _solid(on: Any, mark: Solid, order: float) -> None:
    """Draw faces in space in their own colours; `on` are axes in space, `order` has no effect."""
    look = {"facecolors": mark.colours, "edgecolors": mark.colours, "linewidths": 0.2, "rasterized": True}
    on.add_collection3d(Poly3DCollection(mark.corners, **look))


def _surface(on: Any, mark: Surface, order: float) -> None:
    """Draw a surface in space, coloured by its height; `on` are axes in space, `order` has no effect."""
    rows, columns = mark.z.shape
    on.plot_surface(mark.x, mark.y, mark.z, cmap=mark.colours, rcount=rows, ccount=columns // 2)


DRAW: Mapping[type, Callable[..., None]] = {
    Curve: _curve,
    Scatter: _scatter,
    Bars: _bars,
    Band: _band,
    Area: _area,
    Line: _line,
    Span: _span,
    Map: _map,
    Levels: _levels,
    Faces: _faces,
    Text: _text,
    Arrow: _arrow,
    Solid: _solid,
    Surface: _surface,
}
"""How each kind of mark is drawn in axes, above all marks of a lower order."""
