"""Marks of a figure as traces, shapes and annotations of plotly.js."""

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from contourpy import FillType, contour_generator

from facegear.arrays import Array
from facegear.number_format import format_number
from facegear.report.figures.colours import scale_colours
from facegear.report.figures.description import Key
from facegear.report.figures.marks import (
    Area,
    Band,
    Bars,
    ColourScale,
    Curve,
    Faces,
    Levels,
    Line,
    Map,
    Scatter,
    Span,
    Text,
)
from facegear.report.figures.plotly_values import (
    MAP_DIGITS,
    PIXELS,
    VALUE_FORMAT,
    Part,
    PlotlyAxes,
    css_colour,
    legend_text,
    markup,
    numbers,
    straight,
)

STEPS = 12
"""Colours that stand for a scale."""


SYMBOLS = {
    "dot": "circle",
    "plus": "cross-thin-open",
    "x": "x-thin-open",
    "y-up": "y-up-open",
    "y-down": "y-down-open",
    "line-ew": "line-ew-open",
    "line-ns": "line-ns-open",
}
"""Symbols of plotly.js where they are not named as the markers of a description."""


def traces(target: PlotlyAxes, mark: Any) -> list[Part]:
    """Return what plotly.js draws of a mark with values.

    Parameters
    ----------
    target : PlotlyAxes
        Panel with plotly's names of its axes.
    mark : Mark
        The mark.

    Returns
    -------
    list of dict
        Traces; none for a line or band across the panel and for a text.
    """
    return list(TRACES[type(mark)](target, mark)) if type(mark) in TRACES else []


def shape(target: PlotlyAxes, mark: Line | Span) -> Part:
    """Return plotly's shape of a line or band across a panel, below its traces.

    Parameters
    ----------
    target : PlotlyAxes
        Panel with plotly's names of its axes.
    mark : Line or Span
        The mark.

    Returns
    -------
    dict
        The shape.
    """
    along = "y" if mark.of == "x" else "x"
    ends = (mark.at, mark.at) if isinstance(mark, Line) else (mark.low, mark.high)
    across = (0.0, mark.part if isinstance(mark, Line) else 1.0)
    values = numbers([*ends, *across])
    keys = (f"{mark.of}0", f"{mark.of}1", f"{along}0", f"{along}1")
    corners, along_axis = (target.x, target.y) if mark.of == "x" else (target.y, target.x)
    look: Part = (
        {"type": "line", "line": _line_look(mark)}
        if isinstance(mark, Line)
        else {"type": "rect", "fillcolor": css_colour(mark.colour, mark.opacity), "line": {"width": 0}}
    )
    at = dict(zip(keys, values, strict=True))
    return {**look, f"{mark.of}ref": corners, f"{along}ref": f"{along_axis} domain", **at, "layer": "below"}


def note(target: PlotlyAxes, mark: Text) -> Part:
    """Return plotly's annotation of a text at a point of the data.

    Parameters
    ----------
    target : PlotlyAxes
        Panel with plotly's names of its axes.
    mark : Text
        The mark.

    Returns
    -------
    dict
        The annotation.
    """
    return {
        "x": float(mark.x),
        "y": float(mark.y),
        "xref": target.x,
        "yref": target.y,
        "showarrow": False,
        "text": markup(mark.text),
        "xshift": round(PIXELS * mark.shift[0], 1),
        "yshift": round(PIXELS * mark.shift[1], 1),
        "xanchor": mark.across,
        "yanchor": "middle" if mark.upright == "center" else mark.upright,
        "font": {"size": 11, "color": mark.colour},
    }


def key_trace(key: Key) -> Part:
    """Return a trace without points, which puts an entry into the legend that no other trace gives.

    Parameters
    ----------
    key : Key
        The entry.

    Returns
    -------
    dict
        Trace of plotly.js.
    """
    blank = {"type": "scatter", "x": [None], "y": [None], "showlegend": True, "name": legend_text(key.name)}
    if key.area:
        square = {"symbol": "square", "size": 10, "color": css_colour(key.colour, key.opacity)}
        return {**blank, "mode": "markers", "marker": square}
    mode = "+".join(["lines"] * (key.line != "none") + ["markers"] * bool(key.marker))
    mark = {"marker": _marker(key.marker, key.colour, 6.0, key.hollow)} if key.marker else {}
    return {**blank, "mode": mode, "line": _line_look(key), **mark}


def level_bar(target: PlotlyAxes, scale: ColourScale, middle: tuple[float, float], bar: Part) -> Part:
    """Return a point that is not seen, for the bar of colours between levels.

    Parameters
    ----------
    target : PlotlyAxes
        Panel with plotly's names of its axes.
    scale : ColourScale
        The scale with its levels.
    middle : tuple of float
        Middle of the panel, in units of its axes.
    bar : dict
        Size and title of the bar.

    Returns
    -------
    dict
        The trace.
    """
    count = len(scale.levels) - 1
    faces = level_colours(scale)
    steps = [[end / count, face] for number, face in enumerate(faces) for end in (number, number + 1)]
    ticks = {
        "tickvals": list(range(count + 1)),
        "ticktext": [format_number(level) for level in scale.levels],
    }
    return {
        "type": "scatter",
        "mode": "markers",
        "x": [middle[0]],
        "y": [middle[1]],
        "opacity": 0,
        "showlegend": False,
        "hoverinfo": "skip",
        "name": "",
        "marker": {
            "color": [0],
            "cmin": 0,
            "cmax": count,
            "colorscale": steps,
            "showscale": True,
            "colorbar": {**bar, **ticks},
        },
        **target.axes,
    }


def level_colours(scale: ColourScale) -> list[str]:
    """Return the colours between the levels of a scale.

    Parameters
    ----------
    scale : ColourScale
        The scale.

    Returns
    -------
    list of str
        Colours `#rrggbb`, evenly spaced on the scale, from the lowest interval to the highest.
    """
    count = len(scale.levels) - 1
    return scale_colours(
        scale.colours, (number / (count - 1) if count > 1 else 0.5 for number in range(count))
    )


def _line_look(mark: Curve | Line | Key) -> Part:
    """Return plotly's attributes of a line: colour, width (px) and dash."""
    return {"color": mark.colour, "width": round(PIXELS * mark.width, 2), "dash": mark.line}


def _marker(marker: str, colour: str, size: float, hollow: bool) -> Part:
    """Return plotly's attributes of a marker of `size` points (1/72 inch): symbol, colour and size, px."""
    symbol = SYMBOLS.get(marker, marker)
    is_open = hollow and not symbol.endswith("-open")
    across = PIXELS * size * (0.5 if marker == "dot" else 1.0)
    return {"symbol": f"{symbol}-open" if is_open else symbol, "color": colour, "size": round(across, 2)}


def _identity(target: PlotlyAxes, name: str, colour: str, in_legend: bool = True) -> Part:
    """Return name, legend group and legend flag of a trace; without a name it takes that of the panel's
    y axis and stands in no legend.
    """
    return {
        "name": legend_text(name) if name else markup(target.panel.y.name),
        "legendgroup": f"{name} {colour}" if name else "",
        "showlegend": bool(name) and in_legend,
    }


def _curve(target: PlotlyAxes, mark: Curve) -> Iterator[Part]:
    """Yield the trace of a curve with its line and markers."""
    mode = "+".join(["lines"] * (mark.line != "none") + ["markers"] * bool(mark.marker))
    look = _line_look(mark) if mark.line != "none" else {"color": mark.colour}
    yield {
        "type": "scatter",
        "x": numbers(mark.x),
        "y": numbers(mark.y),
        **target.axes,
        **_identity(target, mark.name, mark.colour, mark.in_legend),
        "mode": mode or "none",
        "line": {**look, "shape": "hv" if mark.steps else "linear"},
        **({"marker": _marker(mark.marker, mark.colour, mark.size, mark.hollow)} if mark.marker else {}),
        **({"opacity": mark.opacity} if mark.opacity < 1.0 else {}),
        "hovertemplate": target.hover_template(),
    }


def _scatter(target: PlotlyAxes, mark: Scatter) -> Iterator[Part]:
    """Yield the trace of points with their sizes, in one colour or coloured by their values."""
    marker: Part = _marker(mark.marker, mark.colour, 1.0, False)
    marker["size"] = numbers(PIXELS * np.asarray(mark.sizes), 3)
    value = ""
    if mark.values is not None and mark.scale is not None:
        marker |= {"color": numbers(mark.values), **_colouring(mark.scale, "c")}
        value = f"{markup(mark.scale.name)} %{{marker.color:{VALUE_FORMAT}}} {markup(mark.scale.unit)}"
    yield {
        "type": "scatter",
        "mode": "markers",
        "x": numbers(mark.x),
        "y": numbers(mark.y),
        "marker": marker,
        **target.axes,
        **_identity(target, mark.name, mark.colour),
        "hovertemplate": target.hover_template(value),
    }


def _bars(target: PlotlyAxes, mark: Bars) -> Iterator[Part]:
    """Yield the trace of bars, lying if `flat`, with error bars; the pointer shows a bar's position, by
    its tick's name if it has one, and its length.
    """
    axis = target.panel.y if mark.flat else target.panel.x
    names = {round(place_of, 6): name for place_of, name in axis.ticks}
    base = np.zeros_like(mark.lengths) if mark.base is None else mark.base
    along, over = ("y", "x") if mark.flat else ("x", "y")
    unit = target.panel.x.unit if mark.flat else target.panel.y.unit
    value = f"%{{customdata[1]:{VALUE_FORMAT}}} {markup(unit)}"
    errors = {}
    if mark.low is not None and mark.high is not None:
        ends = base + mark.lengths
        whiskers = {"array": numbers(mark.high - ends), "arrayminus": numbers(ends - mark.low)}
        errors = {f"error_{over}": {"type": "data", "symmetric": False, "thickness": 1, **whiskers}}
    positions = [names.get(round(float(at), 6), format_number(float(at))) for at in mark.positions]
    yield {
        "type": "bar",
        "orientation": "h" if mark.flat else "v",
        over: numbers(mark.lengths),
        along: numbers(mark.positions),
        "base": numbers(base),
        "width": mark.width,
        "marker": {"color": mark.colour},
        "customdata": [
            [markup(name), length] for name, length in zip(positions, numbers(mark.lengths), strict=True)
        ],
        **({"text": list(map(markup, mark.labels)), "textposition": "inside"} if mark.labels else {}),
        **errors,
        **target.axes,
        **_identity(target, mark.name, mark.colour, mark.in_legend),
        "hovertemplate": f"%{{customdata[0]}}: {value}" if target.closest else value,
    }


def _filled_area(target: PlotlyAxes, x: Array, y: Array, colour: str, name: str = "") -> Part:
    """Return the trace of a filled polygon (x, y of its ring (n,), parts separated by nan) without
    outline; it stands in no legend and shows nothing beside the pointer.
    """
    return {
        "type": "scatter",
        "mode": "lines",
        "x": numbers(x),
        "y": numbers(y),
        "fill": "toself",
        "fillcolor": colour,
        "line": {"width": 0},
        **target.axes,
        **_identity(target, name, colour),
        "showlegend": False,
        "hoverinfo": "skip",
    }


def _band(target: PlotlyAxes, mark: Band) -> Iterator[Part]:
    """Yield the area between the two curves of a band as a filled polygon."""
    x, low, high = (np.asarray(values, dtype=float) for values in (mark.x, mark.low, mark.high))
    ring = np.concatenate([x, x[::-1]]), np.concatenate([low, high[::-1]])
    yield _filled_area(target, *ring, css_colour(mark.colour, mark.opacity), mark.name)


def _area(target: PlotlyAxes, mark: Area) -> Iterator[Part]:
    """Yield the trace of a filled polygon, with an outline if it has a colour for it."""
    area = _filled_area(target, mark.x, mark.y, css_colour(mark.colour, mark.opacity), mark.name)
    yield {**area, "line": {"width": 1, "color": mark.outline}} if mark.outline else area


def _colouring(scale: ColourScale, letter: str) -> Part:
    """Return plotly's attributes of a colour scale in STEPS colours, without its bar. `letter`: `c` for
    markers, `z` for maps.
    """
    positions = np.linspace(0.0, 1.0, STEPS)
    colours = scale_colours(scale.colours, positions)
    return {
        f"{letter}min": float(scale.low),
        f"{letter}max": float(scale.high),
        "colorscale": [[round(float(at), 4), colour] for at, colour in zip(positions, colours, strict=True)],
        "showscale": False,
    }


def _map(target: PlotlyAxes, mark: Map) -> Iterator[Part]:
    """Yield the heatmap of a field on a grid; uneven rows are interpolated to even ones."""
    x, y, values = straight(mark)
    value = f"{markup(mark.scale.name)} %{{z:{VALUE_FORMAT}}} {markup(mark.scale.unit)}"
    yield {
        "type": "heatmap",
        "x": numbers(x),
        "y": numbers(y),
        **target.axes,
        "z": [numbers(row, MAP_DIGITS) for row in values],
        "zsmooth": "best" if mark.smooth else False,
        **_colouring(mark.scale, "z"),
        "connectgaps": False,
        "hoverongaps": False,
        "name": markup(mark.scale.name),
        "hovertemplate": target.hover_template(value),
    }


def _levels(target: PlotlyAxes, mark: Levels) -> Iterator[Part]:
    """Yield a filled area for each step between two levels of a field; values below the first level
    count as that.
    """
    levels = mark.scale.levels
    values = np.ma.masked_invalid(mark.values).clip(levels[0], None)
    between = contour_generator(mark.x, mark.y, values, fill_type=FillType.OuterOffset)
    for (low, high), colour in zip(pairwise(levels), level_colours(mark.scale), strict=True):
        rings = [
            points[first:last]
            for points, offsets in zip(*between.filled(low, high), strict=True)
            for first, last in pairwise(offsets)
        ]
        if rings:
            split_label = np.vstack([np.vstack([ring, [[np.nan, np.nan]]]) for ring in rings])[:-1]
            area = _filled_area(target, split_label[:, 0], split_label[:, 1], colour)
            words = f"{format_number(low)} to {format_number(high)} {markup(mark.scale.unit)}"
            yield area | {"hoverinfo": "text", "hoveron": "fills", "text": words}


def _faces(target: PlotlyAxes, mark: Faces) -> Iterator[Part]:
    """Yield polygons as filled areas, one trace for all polygons of the same of STEPS colours."""
    values = np.asarray(mark.values, dtype=float)
    low, high = values.min(), values.max()
    step = np.minimum(((values - low) / ((high - low) or 1.0) * STEPS).astype(int), STEPS - 1)
    colours = scale_colours(mark.colours, (np.arange(STEPS) + 0.5) / STEPS)
    for number in np.unique(step):
        corners = mark.corners[step == number]
        ring_points = np.concatenate(
            [corners, corners[:, :1], np.full((len(corners), 1, 2), np.nan)], axis=1
        ).reshape(-1, 2)
        yield _filled_area(target, ring_points[:-1, 0], ring_points[:-1, 1], colours[number])


TRACES: Mapping[type, Callable[[PlotlyAxes, Any], Iterator[Part]]] = {
    Curve: _curve,
    Scatter: _scatter,
    Bars: _bars,
    Band: _band,
    Area: _area,
    Map: _map,
    Levels: _levels,
    Faces: _faces,
}
"""Traces of each kind of mark that has values."""
