"""Figures as plotly.js draws them on the page: data and layout."""

import json
from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from facegear.report.figures.description import Axis, Figure, Panel, entries
from facegear.report.figures.marks import Curve, Letter, Levels, Line, Map, Scatter, Span, Text
from facegear.report.figures.plotly_marks import key_trace, level_bar, note, shape, traces
from facegear.report.figures.plotly_values import (
    POSITION_FORMAT,
    Part,
    PlotlyAxes,
    legend_text,
    markup,
    numbers,
)

DPI = 96
"""Pixels of an inch, as browsers count."""
GAP, TITLE, LINE, EDGE, TICKS = 8, 13, 18, 22, 26
"""In pixels: between a panel, or its title, and the legend; size of a panel's title; height of a line; room
for half of a number at the right; height of the numbers below an axis.
"""
MIN_HEIGHT = 280
"""Pixels that every figure is high."""
LEGEND_WIDTH, NARROW_WIDTH, ENTRY, LETTER = 380, 255, 48, 6.6
"""In pixels: width of a legend beside other figures and on a telephone; of its entries the part without
letters, and each letter.
"""
ENTRY_HEIGHT, WHOLE_LEGEND = 28, 2000
"""In pixels: height of an entry of a legend; height from which a legend would be rolled."""
UPRIGHT, LABEL = 7, 48
"""Letters of a tick's name that stand upright, and of the longest line of a label or title."""
BAR = 58
"""Pixels of a bar of colours that lies above all panels, with its numbers and its label."""
LETTERS: tuple[Letter, Letter] = ("x", "y")
"""Axes of a panel."""
APART = 0.2
"""Room between columns of panels, in the width of all."""
SHORT = 1.3
"""Decades of a logarithmic axis below which it names 1, 2 and 5 of each."""


def interactive(figure: Figure) -> dict[str, Any]:
    """Return a figure as data and layout of plotly.js.

    Parameters
    ----------
    figure : Figure
        The figure.

    Returns
    -------
    dict
        `title`, `data` and `layout`, and by how many pixels it is higher on a telephone (`narrow_px`); no
        data where it is a drawing, which the page shows as it stands.
    """
    if figure.is_drawing:
        return {"title": "", "data": [], "layout": {}}
    closest = any(_is_by_point(panel) for panel in figure.panels)
    targets = [
        PlotlyAxes(
            panel,
            _axis_id("x", number % figure.columns if figure.shared_x else number),
            _axis_id("y", number),
            closest,
        )
        for number, panel in enumerate(figure.panels)
    ]
    traces_by_panel = [
        [trace for mark in target.panel.marks for trace in traces(target, mark)] for target in targets
    ]
    domains = _domains(figure)
    _colour_bars(figure, targets, traces_by_panel, domains)
    data = [trace for own_traces in traces_by_panel for trace in own_traces]
    _list_once(data)
    in_legend = {trace["name"] for trace in data if trace.get("showlegend")}
    keys = entries(figure.panels, figure.keys)
    data += [key_trace(key) for key in keys if legend_text(key.name) not in in_legend]
    layout = _layout(figure, targets, domains)
    marks = [(target, mark) for target in targets for mark in target.panel.marks]
    layout["shapes"] = [shape(target, mark) for target, mark in marks if isinstance(mark, Line | Span)]
    layout["annotations"] = [
        *(note(target, mark) for target, mark in marks if isinstance(mark, Text)),
        *(_title(target) for target in targets if target.panel.title),
    ]
    layout["hovermode"] = "closest" if closest else "x unified"
    narrow_px = _legend_height(figure, NARROW_WIDTH) - _legend_height(figure, LEGEND_WIDTH)
    return {"title": markup(figure.title), "data": data, "layout": layout, "narrow_px": round(narrow_px)}


def write(figure: Figure, path: Path) -> None:
    """Write a figure as json text of `interactive`, which the page reads.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : Path
        The json file.
    """
    text = json.dumps(interactive(figure), ensure_ascii=False, separators=(",", ":"))
    path.write_text(text, encoding="utf-8")


def _axis_id(letter: str, number: int) -> str:
    """Return plotly's name of the axis with a number from 0: x, x2, x3 and so on."""
    return letter if number == 0 else f"{letter}{number + 1}"


def _is_by_point(panel: Panel) -> bool:
    """Return whether the pointer shows the nearest mark of a panel, not all curves at one x: for maps,
    points and lying bars.
    """
    return any(
        isinstance(mark, Map | Levels | Scatter)
        or getattr(mark, "flat", False)
        or (isinstance(mark, Curve) and mark.line == "none" and np.size(mark.x) > 1)
        for mark in panel.marks
    )


def _domains(figure: Figure) -> tuple[list[tuple[float, float]], list[tuple[float, float]], float]:
    """Return the (low, high) ends of each column, as a fraction of the whole width from the left, and
    of each row, as a fraction of the whole height from below, and that height of all rows with their
    gaps, px.
    """
    width = (1.0 - APART * (figure.columns - 1)) / figure.columns
    across = [
        (column * (width + APART), column * (width + APART) + width) for column in range(figure.columns)
    ]
    tops, bottoms, at = [], [], 0.0
    for row in range(figure.rows):
        first = row * figure.columns
        panels = figure.panels[first : first + figure.columns]
        tops.append(at)
        at += DPI * max(panel.height for panel in panels)
        bottoms.append(at)
        below = _below(panels[0].x) if figure.shows_x(first) else 0.0
        next_panels = figure.panels[first + figure.columns : first + 2 * figure.columns]
        at += below + GAP + max(LINE * max((_lines(panel.title) for panel in next_panels), default=0), GAP)
    whole = bottoms[-1]
    upwards = [(1.0 - bottom / whole, 1.0 - top / whole) for top, bottom in zip(tops, bottoms, strict=True)]
    return across, [(max(low, 0.0), high) for low, high in upwards], whole


def _lines(text: str) -> int:
    """Count the lines of a text after `narrow`; an empty one has none."""
    return narrow(text).count("\n") + 1 if text else 0


def _below(axis: Axis) -> float:
    """Return the pixels that numbers or names and the label of an x axis take below it."""
    letters = max((len(name) for _, name in axis.ticks), default=0)
    return TICKS + LINE * _lines(axis.label) + LETTER * max(letters - UPRIGHT, 0)


def narrow(text: str) -> str:
    """Break a text into lines of at most LABEL letters, which the narrowest figure holds.

    Parameters
    ----------
    text : str
        The text; lines that fit stay as they are.

    Returns
    -------
    str
        The text with more line ends.
    """
    return "\n".join(part for line in text.split("\n") for part in wrap(line, LABEL) or [""])


def _list_once(data: Sequence[Part]) -> None:
    """Switch off `showlegend` of every trace whose name is in the legend already, in place."""
    names_seen = set()
    for trace in data:
        if trace.get("showlegend"):
            trace["showlegend"] = trace["name"] not in names_seen
            names_seen.add(trace["name"])


def _title(target: PlotlyAxes) -> Part:
    """Return plotly's annotation for the title above the upper left corner of a panel."""
    return {
        "xref": f"{target.x} domain",
        "yref": f"{target.y} domain",
        "x": 0.0,
        "y": 1.0,
        "showarrow": False,
        "xanchor": "left",
        "yanchor": "bottom",
        "text": markup(narrow(target.panel.title)),
        "align": "left",
        "font": {"size": TITLE},
    }


def _layout(figure: Figure, targets: Sequence[PlotlyAxes], domains: Any) -> dict[str, Any]:
    """Return plotly's layout without shapes and annotations: axes, legend, margins and height (px).
    `targets`: one for each panel; `domains`: result of `_domains`.
    """
    across, upwards, inside = domains
    below_legend = _above(figure) + BAR * (figure.shared_scale is not None)
    layout: dict[str, Any] = {
        "legend": {
            "orientation": "h",
            "x": 0,
            "xanchor": "left",
            "y": 1.0 + below_legend / inside,
            "yanchor": "bottom",
            "title": {"text": markup(narrow(figure.legend_title)), "side": "top"},
            "maxheight": WHOLE_LEGEND,
        },
        "barmode": "overlay",
        "margin": {"l": GAP, "r": EDGE + _width_beside(figure), "t": round(below_legend), "b": GAP},
        "separators": ".,",
    }
    middle = figure.rows // 2 * figure.columns
    for number, target in enumerate(targets):
        row, column = divmod(number, figure.columns)
        label = "\n".join(
            text
            for text in (
                target.panel.y.label if figure.shows_y(number) else "",
                figure.y_label if number == middle else "",
            )
            if text
        )
        layout[f"yaxis{target.y[1:]}"] = {
            **_axis(target.panel.y, label, figure.limits(number, "y")),
            "domain": [round(end, 5) for end in upwards[row]],
            "anchor": target.x,
            **({"scaleanchor": target.x, "scaleratio": 1} if target.panel.equal else {}),
        }
        if figure.shows_x(number):
            axis = target.panel.x
            layout[f"xaxis{target.x[1:]}"] = {
                **_axis(axis, axis.label, figure.limits(number, "x")),
                "domain": [round(end, 5) for end in across[column]],
                "anchor": target.y,
                "unifiedhovertitle": {
                    "text": f"{markup(axis.name)} %{{x:{POSITION_FORMAT}}} {markup(axis.unit)}".replace(
                        "<br>", " "
                    )
                },
            }
    height = inside + below_legend + _legend_height(figure, LEGEND_WIDTH) + _below(targets[-1].panel.x) + GAP
    layout["height"] = round(max(height, MIN_HEIGHT))
    return layout


def _above(figure: Figure) -> float:
    """Return the pixels that titles of the first row, and texts at the upper ends of its panels, take
    above it.
    """
    lines = 0
    for number, panel in enumerate(figure.panels[: figure.columns]):
        top = figure.limits(number, "y")[1]
        texts = [mark for mark in panel.marks if isinstance(mark, Text) and mark.upright == "bottom"]
        lines = max(lines, _lines(panel.title) + any(mark.y >= 0.99 * top for mark in texts))
    return GAP + LINE * lines


def _legend_height(figure: Figure, width: float) -> float:
    """Return the pixels that the legend takes in a `width` (px): entries stand beside each other as
    long as they fit.
    """
    height, row, row_width = float(LINE * _lines(figure.legend_title)), 0.0, 0.0
    for key in entries(figure.panels, figure.keys):
        lines = legend_text(key.name).split("<br>")
        entry = ENTRY + LETTER * max(map(len, lines))
        if row_width + entry > width or not row_width:
            height, row, row_width = height + row, 0.0, 0.0
        row, row_width = max(row, ENTRY_HEIGHT + LINE * (len(lines) - 1)), row_width + entry
    return height + row


def _width_beside(figure: Figure) -> int:
    """Return the pixels that texts at the right end of a panel, such as names of curves, take beside it."""
    letters = [
        len(mark.text)
        for number, panel in enumerate(figure.panels)
        for mark in panel.marks
        if isinstance(mark, Text) and mark.across == "left" and mark.x >= figure.limits(number, "x")[1]
    ]
    return round(LETTER * max(letters, default=0))


def _axis(axis: Axis, label: str, ends: tuple[float, float]) -> dict[str, Any]:
    """Return plotly's layout of an axis: label, range, kind and named ticks. `ends`: low and high limit
    in the unit of the axis; plotly gets their logarithms for a logarithmic axis, exchanged for a
    falling one.
    """
    limits = np.log10(ends) if axis.logarithmic else np.array(ends)
    layout_axis: dict[str, Any] = {
        "title": {"text": markup(narrow(label))},
        "type": "log" if axis.logarithmic else "linear",
        "range": numbers(limits[::-1] if axis.is_falling else limits),
        "automargin": True,
    }
    if axis.ticks:
        layout_axis["tickvals"] = [float(at) for at, _ in axis.ticks]
        layout_axis["ticktext"] = [markup(name) for _, name in axis.ticks]
    elif axis.logarithmic and np.ptp(limits) < SHORT:
        layout_axis["dtick"] = "D2"
    elif axis.integer:
        layout_axis["tickformat"] = ",d"
    return layout_axis


def _colour_bars(
    figure: Figure, targets: Sequence[PlotlyAxes], traces_by_panel: Sequence[list[Part]], domains: Any
) -> None:
    """Add to the traces, in place, a bar for each colour scale: beside its panel, or one above all that
    share it. Scales with levels get a trace of their own. `domains`: result of `_domains`.
    """
    _, upwards, inside = domains
    scales_shown = set()
    for number, (target, own_traces) in enumerate(zip(targets, traces_by_panel, strict=True)):
        for scale in target.panel.scales():
            low, high = upwards[number // figure.columns]
            bar = {"len": round(high - low, 5), "y": round(0.5 * (low + high), 5)}
            if figure.shared_scale:
                lying = {"orientation": "h", "x": 0, "xanchor": "left", "len": 1}
                bar = {**lying, "y": 1.0 + _above(figure) / inside, "yanchor": "bottom"}
            side = "top" if figure.shared_scale else "right"
            title = {"text": markup(narrow(scale.label)), "side": side}
            bar |= {"title": title, "thickness": 14, "outlinewidth": 0}
            for trace in own_traces:
                coloured = trace if trace["type"] == "heatmap" else trace.get("marker", {})
                if "colorscale" in coloured:
                    coloured |= {"showscale": scale not in scales_shown, "colorbar": bar}
            if scale.levels:
                x, y = (float(np.mean(figure.limits(number, letter))) for letter in LETTERS)
                own_traces.append(level_bar(target, scale, (x, y), bar))
            scales_shown.add(scale)
