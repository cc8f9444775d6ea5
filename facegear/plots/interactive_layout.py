"""Axes, titles and height of the interactive form of a figure."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.category import StrCategoryLocator
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Annotation, Text
from matplotlib.ticker import FixedLocator

from facegear.plots.plotly_values import markup, numbers
from facegear.plots.traces import Panel, Trace

DPI = 96
NUMBER = ".5~g"
"""How a value is written beside the pointer."""
SIDES = {"left": 0.0, "center": 0.5, "right": 1.0}
"""Where the titles of a panel stand, in widths of it."""
GAP, TITLE, LINE, EDGE = 8, 13, 18, 16
"""In pixels: between a panel, or its title, and the legend; size of a panel's title; height of a line; margin
beside and below all that is drawn.
"""
MIN_HEIGHT = 280
"""Pixels that every figure is high."""
LEGEND_WIDTH, ENTRY, LETTER = 430, 50, 6.5
"""In pixels: the narrowest legend; of its entries the part without letters, and each letter."""
UPRIGHT, LABEL = 7, 46
"""Letters of a tick's name that stand upright, and of the longest line of a label."""


@dataclass(frozen=True)
class Frame:
    """The rectangle that holds all panels, in fractions of the figure."""

    left: float
    bottom: float
    width: float
    height: float

    def across(self, axes: Axes) -> list[float]:
        """Left and right end of a panel in widths of the frame."""
        box = axes.get_position()
        return np.clip([(end - self.left) / self.width for end in (box.x0, box.x1)], 0.0, 1.0).tolist()

    def upwards(self, axes: Axes) -> list[float]:
        """Lower and upper end of a panel in heights of the frame."""
        box = axes.get_position()
        return np.clip([(end - self.bottom) / self.height for end in (box.y0, box.y1)], 0.0, 1.0).tolist()


def frame_of(panels: Sequence[Panel]) -> Frame:
    """The rectangle around panels."""
    boxes = [panel.axes.get_position() for panel in panels]
    left, bottom = min(box.x0 for box in boxes), min(box.y0 for box in boxes)
    return Frame(left, bottom, max(box.x1 for box in boxes) - left, max(box.y1 for box in boxes) - bottom)


def legends_of(figure: Figure) -> list[Legend]:
    """Legends of a figure and of its axes."""
    own = [axes.get_legend() for axes in figure.axes]
    return [legend for legend in (*figure.legends, *own) if legend is not None]


def layout_of(figure: Figure, panels: Sequence[Panel], traces: Sequence[Trace]) -> dict[str, Any]:
    """Layout of plotly.js without shapes and notes. Panels above each other share the x axis below them."""
    frame = frame_of(panels)
    inside = frame.height * DPI * figure.get_figheight()
    lines = max(text.count("\n") + 1 if text else 0 for panel in panels for text in _titles(panel).values())
    above = GAP + LINE * lines
    title = markup(next((legend.get_title().get_text() for legend in legends_of(figure)), ""))
    layout: dict[str, Any] = {
        "legend": {
            "orientation": "h",
            "x": 0,
            "xanchor": "left",
            "y": 1.0 + above / inside,
            "yanchor": "bottom",
            "title": {"text": title, "side": "top"},
        },
        "barmode": "overlay",
        "margin": {"l": EDGE, "r": EDGE + _width_beside(panels), "t": round(above), "b": EDGE},
        "separators": ".\u2009",
    }
    for panel in panels:
        layout[f"yaxis{panel.y[1:]}"] = {
            **_axis(panel.axes, "y"),
            "domain": frame.upwards(panel.axes),
            "anchor": panel.x,
            **({"scaleanchor": panel.x, "scaleratio": 1} if panel.axes.get_aspect() == 1.0 else {}),
        }
    for panel in sorted(panels, key=lambda panel: -panel.axes.get_position().y0):
        name, unit = panel.quantity("x")
        layout[f"xaxis{panel.x[1:]}"] = {
            **_axis(panel.axes, "x"),
            "domain": frame.across(panel.axes),
            "anchor": panel.y,
            "unifiedhovertitle": {"text": f"{name} %{{x:{NUMBER}}} {unit}"},
        }
    _name_all(figure, layout, panels)
    below = _height_below(layout[f"xaxis{panels[-1].x[1:]}"])
    layout["height"] = round(max(inside + above + _legend_height(title, traces) + below, MIN_HEIGHT))
    return layout


def titles(panel: Panel) -> list[Trace]:
    """Titles above a panel, as notes of plotly.js."""
    return [
        {
            "xref": f"{panel.x} domain",
            "yref": f"{panel.y} domain",
            "x": SIDES[side],
            "y": 1.0,
            "showarrow": False,
            "xanchor": side,
            "yanchor": "bottom",
            "text": markup(text),
            "align": side,
            "font": {"size": TITLE},
        }
        for side, text in _titles(panel).items()
        if text
    ]


def _titles(panel: Panel) -> dict[str, str]:
    return {side: panel.axes.get_title(loc=side) for side in SIDES}


def _legend_height(title: str, traces: Sequence[Trace]) -> float:
    """Pixels that a legend takes where there is least room for it."""
    names = [trace["name"] for trace in traces if trace.get("showlegend")]
    rows = np.ceil(sum(ENTRY + LETTER * len(name) for name in names) / LEGEND_WIDTH)
    return float(LINE * ((title != "") + 1.2 * rows))


def _width_beside(panels: Sequence[Panel]) -> int:
    """Pixels that texts at the right end of a panel, such as the names of its curves, take beside it."""
    letters = [
        len(text.get_text())
        for panel in panels
        for text in panel.axes.texts
        if text.get_ha() == "left" and _position(text)[0] >= max(panel.axes.get_xlim())
    ]
    return round(LETTER * max(letters, default=0))


def _position(text: Text) -> tuple[float, float]:
    return text.xy if isinstance(text, Annotation) else text.get_position()


def _height_below(axis: dict[str, Any]) -> float:
    """Pixels that ticks and label of the x axis take below all panels."""
    letters = max((len(name) for name in axis.get("ticktext", ())), default=0)
    return LINE * (2 + axis["title"]["text"].count("<br>")) + GAP + LETTER * max(letters - UPRIGHT, 0)


def _name_all(figure: Figure, layout: dict[str, Any], panels: Sequence[Panel]) -> None:
    """Give the labels of the whole figure to the x axis below it and to the y axis in its middle."""
    last, middle = panels[-1], panels[len(panels) // 2]
    for axis, label in (
        (f"xaxis{last.x[1:]}", figure.get_supxlabel()),
        (f"yaxis{middle.y[1:]}", figure.get_supylabel()),
    ):
        title = layout[axis]["title"]
        title["text"] = "<br>".join(
            text for text in (title["text"], markup(_narrow(label.replace("\n", " ")))) if text
        )


def _narrow(label: str) -> str:
    """A label with lines that the narrowest figure holds; lines that fit stay as they are."""
    return "\n".join(part for line in label.split("\n") for part in textwrap.wrap(line, LABEL) or [""])


def _axis(axes: Axes, letter: str) -> dict[str, Any]:
    """Label, range, kind and named ticks of an axis."""
    axis = axes.xaxis if letter == "x" else axes.yaxis
    ends = np.array(getattr(axes, f"get_{letter}lim")())
    logarithmic = axis.get_scale() == "log"
    described: dict[str, Any] = {
        "title": {"text": markup(_narrow(axis.get_label().get_text())), "standoff": 5},
        "type": "log" if logarithmic else "linear",
        "range": numbers(np.log10(ends) if logarithmic else ends),
        "automargin": True,
    }
    if isinstance(axis.get_major_locator(), FixedLocator | StrCategoryLocator) and not logarithmic:
        described["tickvals"] = [float(tick) for tick in axis.get_ticklocs()]
        described["ticktext"] = [markup(text.get_text()) for text in axis.get_ticklabels()]
    return described
