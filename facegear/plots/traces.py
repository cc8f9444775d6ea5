"""Artists of a matplotlib figure as traces of plotly.js, with the values that they were drawn from."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import Collection, LineCollection, PathCollection, PolyCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle
from matplotlib.text import Annotation, Text

from facegear.arrays import Array
from facegear.plots.plotly_values import colour, markup, name_and_unit, numbers, scale

Trace = dict[str, Any]
PIXELS = 96 / 72
"""Of a page, to a point of a figure."""
MAP_DIGITS = 4
"""Significant digits of a value of a map."""
ROWS = 160
"""Of a map whose rows are not even, drawn again on even ones."""
SYMBOLS = {
    ".": "circle",
    "o": "circle",
    "s": "square",
    "D": "diamond",
    "^": "triangle-up",
    "v": "triangle-down",
    "x": "x-thin-open",
    "*": "star",
    "P": "cross",
    "p": "pentagon",
    "1": "y-up-open",
    "2": "y-down-open",
    "_": "line-ew-open",
    "|": "line-ns-open",
}
UNDRAWN = ("None", "none", "", " ")
"""Styles of a line, or markers, that are not drawn."""
DASHES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}


class StillOnly(Exception):
    """Something of a figure has no interactive form."""


@dataclass(frozen=True)
class Panel:
    """An axes with the names of its plotly axes (`x2`, `y3`), and the names of its curves by their look."""

    axes: Axes
    x: str
    y: str
    names: Mapping[tuple[str, str], str] = field(default_factory=dict)

    @property
    def at(self) -> Trace:
        """Axes of a trace."""
        return {"xaxis": self.x, "yaxis": self.y}

    def quantity(self, axis: str) -> tuple[str, str]:
        """Name and unit of what an axis (`x` or `y`) shows."""
        return name_and_unit(getattr(self.axes, f"get_{axis}label")())


def look(artist: Artist) -> tuple[str, str]:
    """Colour and symbol by which a curve and an entry of a legend are known to be the same."""
    if isinstance(artist, Line2D):
        alone = artist.get_linestyle() in UNDRAWN
        marker = str(artist.get_marker()) if alone else ""
        return colour(artist.get_markeredgecolor() if alone else artist.get_color()), marker
    if isinstance(artist, LineCollection):
        return colour(artist.get_color()[0]), ""
    faces = np.atleast_2d(artist.get_facecolor())
    return (to_hex(faces[0]), "") if faces.size else ("", "")


def named(panel: Panel, artist: Artist, label: str | None = None) -> Trace:
    """What a trace says of its curve: its name in the legend, or that of the entry with the same look."""
    label, key = str(artist.get_label() or "") if label is None else label, look(artist)
    name = label if label and not label.startswith("_") else panel.names.get(key, "")
    return {
        "name": markup(name) or panel.quantity("y")[0],
        "legendgroup": f"{name} {key[0]}",
        "showlegend": bool(name),
    }


def line(panel: Panel, artist: Line2D) -> Trace:
    """A curve."""
    x, y = (np.asarray(artist.get_data(orig=False)[i], dtype=float) for i in (0, 1))
    style, marker = artist.get_linestyle(), str(artist.get_marker())
    drawn = style not in UNDRAWN
    marked = marker not in UNDRAWN
    steps = artist.get_drawstyle() == "steps-post"
    trace = {
        "type": "scatter",
        "x": numbers(x),
        "y": numbers(y),
        **panel.at,
        **named(panel, artist),
        "mode": "+".join(["lines"] * drawn + ["markers"] * marked) or "none",
        "line": {
            "color": colour(artist.get_color()),
            "width": round(PIXELS * artist.get_linewidth(), 2),
            "dash": DASHES.get(style, "dash") if not artist.is_dashed() or style in DASHES else "dash",
            "shape": "hv" if steps else "linear",
        },
    }
    if marked:
        trace["marker"] = _marker(artist, marker)
    if artist.get_alpha() is not None:
        trace["opacity"] = artist.get_alpha()
    return trace


def _marker(artist: Line2D, marker: str) -> Trace:
    if marker not in SYMBOLS:
        raise StillOnly(f"marker {marker}")
    symbol, face = SYMBOLS[marker], artist.get_markerfacecolor()
    hollow = str(face) in ("none", "white")
    size = PIXELS * artist.get_markersize() * (0.5 if marker == "." else 1.0)
    return {
        "symbol": symbol if not hollow or symbol.endswith("-open") else f"{symbol}-open",
        "color": colour(artist.get_markeredgecolor() if hollow else face),
        "size": round(size, 2),
    }


def shape(panel: Panel, artist: Line2D | Rectangle, data: tuple[bool, bool]) -> Trace:
    """A line or band across a panel; `data`: which of x and y count in units of the data."""
    if isinstance(artist, Line2D):
        x, y = (np.asarray(ends, dtype=float) for ends in artist.get_data(orig=False))
        width = round(PIXELS * artist.get_linewidth(), 2)
        dash = DASHES.get(artist.get_linestyle(), "dash")
        line = {"color": colour(artist.get_color()), "width": width, "dash": dash}
        style: Trace = {"type": "line", "line": line}
    else:
        box = artist.get_bbox()
        x, y = np.array([box.x0, box.x1]), np.array([box.y0, box.y1])
        style = {"type": "rect", "fillcolor": colour(artist.get_facecolor()), "line": {"width": 0}}
    references = {
        f"{letter}ref": name if known else f"{name} domain"
        for letter, name, known in zip("xy", (panel.x, panel.y), data, strict=True)
    }
    ends = dict(zip(("x0", "x1", "y0", "y1"), numbers([*x[:2], *y[:2]]), strict=True))
    return {**style, **references, **ends, "layer": "below"}


def bars(panel: Panel, container: BarContainer) -> Iterator[Trace]:
    """Bars, each with the name of its place where the axis has names; one trace for each of their colours."""
    flat = container.orientation == "horizontal"
    axis = panel.axes.yaxis if flat else panel.axes.xaxis
    names = {
        round(float(at), 6): markup(text.get_text())
        for at, text in zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=False)
    }
    for shade in dict.fromkeys(colour(bar.get_facecolor()) for bar in container.patches):
        own = [bar for bar in container.patches if colour(bar.get_facecolor()) == shade]
        boxes = [bar.get_bbox() for bar in own]
        middle = np.array([0.5 * (box.y0 + box.y1) if flat else 0.5 * (box.x0 + box.x1) for box in boxes])
        width = np.array([abs(box.height if flat else box.width) for box in boxes])
        places, lengths = numbers(middle), numbers([box.width if flat else box.height for box in boxes])
        yield {
            "type": "bar",
            "orientation": "h" if flat else "v",
            **({"x": lengths, "y": places} if flat else {"x": places, "y": lengths}),
            "base": numbers([box.x0 if flat else box.y0 for box in boxes]),
            "width": numbers(width),
            "marker": {"color": shade},
            "customdata": [names.get(round(float(at), 6), f"{at:.6g}") for at in middle],
            **panel.at,
            **named(panel, own[0], str(container.get_label())),
        }


def points(panel: Panel, artist: PathCollection) -> Trace:
    """Points, coloured by a value where they are."""
    at = np.asarray(artist.get_offsets(), dtype=float)
    values = artist.get_array()
    marker: Trace = {"size": round(PIXELS * float(np.sqrt(artist.get_sizes()[0])), 2)}
    if values is None:
        marker["color"] = colour(artist.get_facecolor()[0])
    else:
        low, high = artist.get_clim()
        marker |= {"color": numbers(values), "cmin": low, "cmax": high, "colorscale": scale(artist.cmap)}
    return {
        "type": "scatter",
        "mode": "markers",
        "x": numbers(at[:, 0]),
        "y": numbers(at[:, 1]),
        "marker": marker,
        **panel.at,
        **named(panel, artist),
        "showlegend": False,
    }


def segments(panel: Panel, artist: LineCollection) -> Trace:
    """Separate lines of one colour."""
    apart = [np.vstack([segment, [[np.nan, np.nan]]]) for segment in artist.get_segments() if len(segment)]
    at = np.vstack(apart)[:-1] if apart else np.empty((0, 2))
    style = {"color": colour(artist.get_color()[0]), "width": round(PIXELS * artist.get_linewidth()[0], 2)}
    return {
        "type": "scatter",
        "mode": "lines",
        "x": numbers(at[:, 0]),
        "y": numbers(at[:, 1]),
        "line": style,
        **panel.at,
        **named(panel, artist),
    }


def areas(panel: Panel, artist: Collection | Polygon) -> Iterator[Trace]:
    """Filled areas, one for each of the collection's."""
    paths = [artist.get_path()] if isinstance(artist, Polygon) else artist.get_paths()
    faces = np.atleast_2d(artist.get_facecolor())
    for number, path in enumerate(paths):
        rings = [np.vstack([ring, [[np.nan, np.nan]]]) for ring in path.to_polygons(closed_only=False)]
        if not rings:
            continue
        ring = np.vstack(rings)[:-1]
        yield {
            "type": "scatter",
            "mode": "lines",
            "x": numbers(ring[:, 0]),
            "y": numbers(ring[:, 1]),
            "fill": "toself",
            "fillcolor": colour(faces[number % len(faces)]),
            "line": {"width": 0},
            **panel.at,
            **named(panel, artist),
            "showlegend": False,
            "hoverinfo": "skip",
        }


def contours(panel: Panel, artist: ContourSet) -> list[Trace]:
    """Areas between levels, which say between which, and a bar of their colours."""
    traces = list(areas(panel, artist))
    levels, unit = list(artist.levels), ""
    if artist.colorbar is not None:
        unit = " ".join(name_and_unit(artist.colorbar.ax.get_ylabel())[1:])
    shown = [path for path in range(len(artist.get_paths())) if artist.get_paths()[path].to_polygons()]
    steps = list(pairwise(levels))
    for trace, number in zip(traces, shown, strict=True):
        low, high = steps[min(number, len(steps) - 1)]
        trace |= {"hoverinfo": "text", "hoveron": "fills", "text": f"{low:.4g} to {high:.4g} {unit}"}
    return traces


def heat(panel: Panel, artist: QuadMesh) -> Trace:
    """A map. One whose columns stand straight while its rows do not is drawn again on even rows."""
    coordinates, values = artist.get_coordinates(), np.ma.filled(artist.get_array().astype(float), np.nan)
    x, y = coordinates[..., 0], coordinates[..., 1]
    values = values.reshape(x.shape if values.size == x.size else (x.shape[0] - 1, x.shape[1] - 1))
    if not np.allclose(x, x[0]):
        raise StillOnly("a map without straight columns")
    heights = y[:, 0]
    if not np.allclose(y, heights[:, None]):
        heights, values = even_rows(y, values)
    low, high = artist.get_clim()
    smooth = values.shape == (heights.size, x.shape[1])
    return {
        "type": "heatmap",
        "x": numbers(x[0]),
        "y": numbers(heights),
        **panel.at,
        "z": [numbers(row, MAP_DIGITS) for row in values],
        "zsmooth": "best" if smooth else False,
        "zmin": float(low),
        "zmax": float(high),
        "colorscale": scale(artist.cmap),
        "connectgaps": False,
        "hoverongaps": False,
        "showscale": False,
    }


def even_rows(y: Array, values: Array) -> tuple[Array, Array]:
    """Heights that all columns share, and the values there: straight from one row to the next, as drawn."""
    if y.shape != values.shape:
        raise StillOnly("cells without straight rows")
    heights = np.linspace(y.min(), y.max(), ROWS)
    even = np.full((ROWS, y.shape[1]), np.nan)
    at = heights[:, None]
    for ends, known in zip(pairwise(y), pairwise(values), strict=True):
        order = np.argsort(ends, axis=0)
        (low, high), (below, above) = (np.take_along_axis(np.array(rows), order, 0) for rows in (ends, known))
        slope = np.divide(above - below, high - low, out=np.zeros_like(low), where=high > low)
        inside = (at >= low) & (at <= high) & np.isfinite(known).all(axis=0)
        even = np.where(inside, np.where(at == high, above, slope * (at - low) + below), even)
    return heights, even


def note(panel: Panel, artist: Text) -> Trace:
    """A text at a point of the data."""
    x, y = artist.xy if isinstance(artist, Annotation) else artist.get_position()
    away = (
        artist.get_position()
        if isinstance(artist, Annotation) and artist.anncoords == "offset points"
        else (0, 0)
    )
    sides = {"left": "left", "center": "center", "right": "right"}
    heights = {
        "bottom": "bottom",
        "baseline": "bottom",
        "center": "middle",
        "top": "top",
        "center_baseline": "middle",
    }
    return {
        "x": float(x),
        "y": float(y),
        "xref": panel.x,
        "yref": panel.y,
        "showarrow": False,
        "text": markup(artist.get_text()),
        "xshift": PIXELS * away[0],
        "yshift": PIXELS * away[1],
        "xanchor": sides[artist.get_ha()],
        "yanchor": heights[artist.get_va()],
        "font": {"size": round(PIXELS * artist.get_fontsize()), "color": colour(artist.get_color())},
    }


@dataclass(frozen=True)
class Part:
    """What plotly.js draws in a panel: traces, lines and bands across it, and texts."""

    traces: list[Trace]
    shapes: list[Trace]
    notes: list[Trace]


def across(panel: Panel, artist: Artist) -> tuple[bool, bool]:
    """Which of x and y of an artist count in units of the data."""
    return tuple(artist.get_transform().contains_branch_seperately(panel.axes.transData))


def convert(panel: Panel) -> Part:
    """What is drawn in a panel. Raises StillOnly."""
    traces: list[Trace] = []
    shapes: list[Trace] = []
    in_bars = {
        id(bar)
        for container in panel.axes.containers
        if isinstance(container, BarContainer)
        for bar in container.patches
    }
    for artist in panel.axes.collections:
        traces += _collection(panel, artist)
    for container in panel.axes.containers:
        if isinstance(container, BarContainer) and container.patches:
            traces += bars(panel, container)
    for artist in panel.axes.patches:
        if id(artist) in in_bars:
            continue
        if isinstance(artist, Rectangle):
            shapes.append(shape(panel, artist, across(panel, artist)))
        elif isinstance(artist, Polygon):
            traces += areas(panel, artist)
        else:
            raise StillOnly(type(artist).__name__)
    for artist in panel.axes.lines:
        data = across(panel, artist)
        if all(data):
            traces.append(line(panel, artist))
        else:
            shapes.append(shape(panel, artist, data))
    return Part(traces, shapes, [note(panel, text) for text in panel.axes.texts])


def _collection(panel: Panel, artist: Collection) -> list[Trace]:
    if isinstance(artist, QuadMesh):
        return [heat(panel, artist)]
    if isinstance(artist, ContourSet):
        return contours(panel, artist)
    if isinstance(artist, PathCollection):
        return [points(panel, artist)]
    if isinstance(artist, LineCollection):
        return [segments(panel, artist)]
    if isinstance(artist, PolyCollection):
        return list(areas(panel, artist))
    raise StillOnly(type(artist).__name__)
