"""The interactive form of a figure: what plotly.js draws from the same artists as the still picture.

A figure is drawn once, with matplotlib. Its artists keep the values that they were drawn from, and from these
follow the traces of `facegear.plots.traces`, so that both forms show the same numbers.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from facegear.plots.interactive_layout import NUMBER, frame_of, layout_of, legends_of, titles
from facegear.plots.plotly_values import colour, markup, name_and_unit
from facegear.plots.traces import (
    DASHES,
    SYMBOLS,
    UNDRAWN,
    Panel,
    StillOnly,
    Trace,
    convert,
    look,
)

ALIGNED = 0.02
"""Widths of a figure within which two panels stand above each other."""


def interactive(figure: Figure) -> dict[str, Any]:
    """`title`, and `data` and `layout` of plotly.js for a figure; no data where it is a drawing."""
    figure.draw_without_rendering()  # gives ticks and texts their values, and panels their places
    try:
        panels = _panels(figure)
        parts = [convert(panel) for panel in panels]
    except StillOnly:
        return {"title": "", "data": [], "layout": {}}
    closest = any(_by_point(trace) for part in parts for trace in part.traces)
    for panel, part in zip(panels, parts, strict=True):
        _hover(panel, part.traces, closest)
    _colour_bars(panels, [part.traces for part in parts])
    traces = [trace for part in parts for trace in part.traces]
    _list_once(figure, traces)
    traces += _keys(figure, traces)
    layout = layout_of(figure, panels, traces)
    layout["shapes"] = [shape for part in parts for shape in part.shapes]
    layout["annotations"] = [
        note for panel, part in zip(panels, parts, strict=True) for note in (*part.notes, *titles(panel))
    ]
    layout["hovermode"] = "closest" if closest else "x unified"
    return {"title": markup(figure.get_suptitle()), "data": traces, "layout": layout}


def write(figure: Figure, path: Path) -> None:
    """Write the interactive form as a file."""
    text = json.dumps(interactive(figure), ensure_ascii=False, separators=(",", ":"))
    path.write_text(text, encoding="utf-8")


def _mappables(axes: Axes) -> list[Any]:
    """Maps and coloured points of an axes that have a bar of colours."""
    return [artist for artist in axes.collections if getattr(artist, "colorbar", None) is not None]


def _panels(figure: Figure) -> list[Panel]:
    """Axes that show data. Those above each other with a common x axis have one in plotly.js, too."""
    bars = {artist.colorbar.ax for axes in figure.axes for artist in _mappables(axes)}
    drawn = [axes for axes in figure.axes if axes not in bars]
    if any(axes.name == "3d" or not axes.axison for axes in drawn):
        raise StillOnly("a drawing")
    names = _names(figure)
    columns: list[Axes] = []
    panels = []
    for number, axes in enumerate(drawn):
        column = next((top for top in columns if _stacked(top, axes)), None)
        if column is None:
            columns.append(column := axes)
        panels.append(Panel(axes, _numbered("x", columns.index(column)), _numbered("y", number), names))
    return panels


def _stacked(top: Axes, axes: Axes) -> bool:
    joined = top.get_shared_x_axes().joined(top, axes)
    return bool(joined and abs(top.get_position().x0 - axes.get_position().x0) < ALIGNED)


def _numbered(letter: str, number: int) -> str:
    return letter if number == 0 else f"{letter}{number + 1}"


def _names(figure: Figure) -> dict[tuple[str, str], str]:
    """Entries of all legends by their look, where only one has it."""
    names: dict[tuple[str, str], set[str]] = {}
    for legend in legends_of(figure):
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
            names.setdefault(look(handle), set()).add(text.get_text())
    return {key: same.pop() for key, same in names.items() if len(same) == 1}


def _by_point(trace: Trace) -> bool:
    """Whether the pointer asks a trace point by point, not along the x axis."""
    return (
        trace["type"] == "heatmap"
        or trace.get("hoveron") == "fills"
        or trace.get("orientation") == "h"
        or (trace.get("mode") == "markers" and len(trace["x"]) > 1)
    )


def _hover(panel: Panel, traces: Sequence[Trace], closest: bool) -> None:
    """Say what stands beside the pointer: values with names and units."""
    (x_name, x_unit), (y_name, y_unit) = panel.quantity("x"), panel.quantity("y")
    x, y = f"%{{x:{NUMBER}}} {x_unit}", f"%{{y:{NUMBER}}} {y_unit}"
    for trace in traces:
        if trace.get("hoverinfo"):
            continue
        if trace["type"] == "heatmap":
            trace["hovertemplate"] = f"{x_name} {x}<br>{y_name} {y}<br>{_map_value(panel)}<extra></extra>"
        elif trace["type"] == "bar":
            value = x if trace["orientation"] == "h" else y
            trace["hovertemplate"] = f"%{{customdata}}: {value}" if closest else value
        else:
            trace["hovertemplate"] = f"{x_name} {x}<br>{y_name} {y}" if closest else y


def _map_value(panel: Panel) -> str:
    """A map's value beside the pointer."""
    labels = [_bar_label(artist) for artist in _mappables(panel.axes)]
    name, unit = name_and_unit(labels[0]) if labels else ("", "")
    return f"{name} %{{z:{NUMBER}}} {unit}"


def _bar_label(artist: Any) -> str:
    bar = artist.colorbar.ax
    return str(bar.get_ylabel() or bar.get_xlabel())


def _list_once(figure: Figure, traces: Sequence[Trace]) -> None:
    """Let each entry of the still's legends stand once, for its curves in all panels."""
    listed = {markup(text.get_text()) for legend in legends_of(figure) for text in legend.get_texts()}
    seen = set()
    for trace in traces:
        if trace.get("showlegend"):
            trace["showlegend"] = trace["name"] in listed and trace["legendgroup"] not in seen
            seen |= {trace["legendgroup"]} if trace["showlegend"] else set()


def _keys(figure: Figure, traces: Sequence[Trace]) -> list[Trace]:
    """Entries of the still's legends that explain a look and are no curve themselves."""
    known = {trace["name"] for trace in traces if trace.get("showlegend")}
    keys = {
        markup(text.get_text()): handle
        for legend in legends_of(figure)
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True)
        if isinstance(handle, Line2D | Patch)
    }
    blank = {"type": "scatter", "x": [None], "y": [None], "showlegend": True}
    return [{**blank, "name": name, **_key(handle)} for name, handle in keys.items() if name not in known]


def _key(handle: Line2D | Patch) -> Trace:
    if isinstance(handle, Patch):
        square = {"symbol": "square", "size": 10, "color": colour(handle.get_facecolor())}
        return {"mode": "markers", "marker": square}
    if handle.get_linestyle() in UNDRAWN:
        symbol = SYMBOLS.get(str(handle.get_marker()), "circle")
        return {
            "mode": "markers",
            "marker": {"symbol": symbol, "color": colour(handle.get_markeredgecolor())},
        }
    dash = DASHES.get(handle.get_linestyle(), "dash")
    return {"mode": "lines", "line": {"color": colour(handle.get_color()), "dash": dash}}


def _colour_bars(panels: Sequence[Panel], traces: Sequence[list[Trace]]) -> None:
    """Give maps and coloured points their bar of colours; those that share one in the still have one here."""
    frame = frame_of(panels)
    shown: list[Axes] = []
    users = [artist.colorbar.ax for panel in panels for artist in _mappables(panel.axes)]
    for panel, own in zip(panels, traces, strict=True):
        for artist in _mappables(panel.axes):
            axes = artist.colorbar.ax
            low, high = (0.0, 1.0) if users.count(axes) > 1 else frame.upwards(panel.axes)
            bar = {
                "title": {"text": markup(_bar_label(artist)), "side": "right"},
                "len": high - low,
                "y": 0.5 * (low + high),
                "thickness": 14,
                "outlinewidth": 0,
            }
            for trace in own:
                target = trace if trace["type"] == "heatmap" else trace.get("marker", {})
                if "colorscale" in target:
                    target |= {"showscale": axes not in shown, "colorbar": bar}
            if isinstance(artist, ContourSet):
                own.append(_level_bar(panel, artist, bar))
            shown.append(axes)


def _level_bar(panel: Panel, artist: ContourSet | ScalarMappable, bar: Trace) -> Trace:
    """A point that is not seen, for the bar of the colours between levels."""
    levels = list(artist.levels)
    count = len(levels) - 1
    faces = [colour(face) for face in np.atleast_2d(artist.get_facecolor())][-count:]
    steps = [[end / count, face] for number, face in enumerate(faces) for end in (number, number + 1)]
    ticks = {"tickvals": list(range(count + 1)), "ticktext": [f"{level:.4g}" for level in levels]}
    return {
        "type": "scatter",
        "mode": "markers",
        "x": [float(np.mean(panel.axes.get_xlim()))],
        "y": [float(np.mean(panel.axes.get_ylim()))],
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
        **panel.at,
    }
