"""The page draws the same figure as a paper: numbers, names, units and kinds of marks."""

import json

import numpy as np
import pytest

from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.draw_matplotlib import draw, save
from facegear.report.figures.draw_plotly import interactive
from facegear.report.figures.marks import (
    Area,
    Arrow,
    Band,
    Bars,
    ColourScale,
    Curve,
    Levels,
    Line,
    Map,
    Scatter,
    Span,
    Text,
)

SPEED, FORCE = Axis("Pinion speed", "rpm"), Axis("RMS of d", "µm", "without its mean")


def figure(*marks, **keywords):
    """Return a figure with all marks in one panel."""
    return Figure([Panel(SPEED, FORCE, marks)], **keywords)


def test_a_curve_keeps_its_values_its_name_and_the_units_of_its_axes():
    speed, values = np.array([1000.0, 2000.0, 3000.0]), np.array([1.23456789, np.nan, -0.0])
    curve = Curve(speed, values, "up", line="dash")
    described = interactive(Figure([Panel(SPEED, FORCE, [curve])] * 2, title="a < b\nand c"))
    first, second = described["data"]
    assert first["x"] == [1000.0, 2000.0, 3000.0] and first["y"] == [1.23457, None, 0.0]
    assert str(first["y"][2]) == "0.0", "no number is minus zero"
    assert (first["name"], second["name"], first["line"]["dash"]) == ("up", "up", "dash")
    assert first["legendgroup"] == second["legendgroup"], "the legend switches a curve in all panels"
    assert [first["showlegend"], second["showlegend"]] == [True, False]
    layout = described["layout"]
    assert "µm" in first["hovertemplate"] and "rpm" in str(layout["xaxis"]["unifiedhovertitle"])
    assert first["xaxis"] == second["xaxis"] == "x", "panels above each other are zoomed together"
    assert layout["yaxis"]["title"]["text"] == "RMS of d (µm)<br>without its mean"
    assert described["title"] == "a &lt; b<br>and c"


def test_a_map_keeps_the_value_of_every_point_with_its_unit():
    scale = ColourScale("Pressure", "MPa", 1.0, 2.5)
    cells = Map(np.array([0.0, 1.0]), np.array([5.0]), np.array([[1.0, 2.5]]), scale)
    x, y = np.meshgrid([0.0, 1.0], [0.0, 1.0, 2.0])
    uneven = Map(x, y + 0.5 * x, np.where(y > 1.5, np.nan, y), ColourScale("y", "", 0.0, 2.0), smooth=True)
    flat, smooth = interactive(Figure([Panel(SPEED, FORCE, [mark]) for mark in (cells, uneven)]))["data"]
    assert flat["z"] == [[1.0, 2.5]] and flat["x"] == [0.0, 1.0] and flat["y"] == [5.0]
    assert "Pressure" in flat["hovertemplate"] and "MPa" in flat["hovertemplate"] and flat["showscale"]
    known = np.array(smooth["z"], dtype=float)
    expected = np.array(smooth["y"])[:, None] - 0.5 * np.array(smooth["x"])
    inside = np.isfinite(known)
    np.testing.assert_allclose(known[inside], expected[inside], atol=1e-3)
    assert np.all(expected[inside] < 1.01) and inside.any(axis=0).all(), "what is not known stays blank"
    assert (smooth["zmin"], smooth["zmax"]) == (0.0, 2.0)


def test_panels_with_one_scale_of_colours_have_one_bar():
    scale = ColourScale("Pressure", "MPa", 0.0, 2.0)
    panel = Panel(SPEED, FORCE, [Map(np.arange(2.0), np.arange(2.0), np.eye(2), scale)])
    traces = interactive(Figure([panel] * 3))["data"]
    assert [trace["showscale"] for trace in traces] == [True, False, False]
    assert len(draw(Figure([panel] * 3)).axes) == 4


def test_bars_lines_across_a_panel_areas_and_points_are_kept():
    ends = np.array([0.0, 1.0])
    names = Axis("", "", ticks=[(0.0, "tail idler"), (1.0, "input")])
    bars = Bars(ends, np.array([2.0, -1.0]), flat=True)
    points = Scatter(ends, ends, ends + 3.0, values=10.0 * ends, scale=ColourScale("v", "rpm", 0.0, 10.0))
    marks = [
        Line(7.0, part=0.04),
        Span(1.0, 2.0, "y"),
        Band(ends, ends, ends + 1.0),
        Area(ends, ends),
        points,
    ]
    described = interactive(Figure([Panel(SPEED, names, [bars]), Panel(SPEED, FORCE, marks)], shared_x=False))
    kinds = [(trace["type"], trace.get("fill")) for trace in described["data"]]
    assert kinds == [("bar", None), ("scatter", "toself"), ("scatter", "toself"), ("scatter", None)]
    assert described["data"][0]["customdata"] == [["tail idler", 2.0], ["input", -1.0]]
    assert described["data"][0]["x"] == [2.0, -1.0]
    assert described["data"][3]["marker"]["color"] == [0.0, 10.0]
    line, span = described["layout"]["shapes"]
    assert (line["xref"], line["x0"], line["yref"], line["y1"]) == ("x2", 7.0, "y2 domain", 0.04)
    assert (span["yref"], span["y0"], span["y1"]) == ("y2", 1.0, 2.0)


def test_areas_between_levels_say_between_which():
    x, y = np.meshgrid([0.0, 1.0], [0.0, 1.0])
    scale = ColourScale("Gap", "µm", 0.0, 3.0, levels=(0.0, 1.0, 3.0))
    described = interactive(figure(Levels(x, y, x + 2.0 * y, scale)))
    areas = [trace for trace in described["data"] if trace.get("fill")]
    assert [trace["text"] for trace in areas] == ["0 to 1 µm", "1 to 3 µm"]


def test_a_drawing_stays_a_still_picture(tmp_path):
    save(figure(Arrow((0.0, 0.0), (1.0, 1.0))), tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text())["data"] == []


def test_names_beside_the_last_panel_and_long_lines_below_it_are_not_cut_off():
    """Deflections beside the lines of a mesh law, and the inputs below a study, were cut off."""
    curve = Curve(np.array([0.0, 1.0]), np.array([1.0, 2.0]))
    end = interactive(figure(curve))["layout"]["xaxis"]["range"][1]
    narrow = interactive(figure(curve))["layout"]["margin"]["r"]
    beside = interactive(figure(curve, Text(end, 2.0, "68.8 µm")))["layout"]
    assert beside["margin"]["r"] > narrow + 40
    words = "torque per engine 1328 N m; share of the power at the tail 3.4 %; meshes geometric"
    label = interactive(Figure([Panel(Axis(words, ""), FORCE, [curve])]))["layout"]["xaxis"]["title"]["text"]
    assert max(map(len, label.split("<br>"))) < 50 and label.replace("<br>", " ") == words


@pytest.mark.parametrize(
    ("axis", "values"),
    [
        (Axis("a", "", low=0.0), [1.0, 3.0]),
        (Axis("a", "", logarithmic=True), [1.0, 1e4]),
        (Axis("a", "", is_falling=True), [2.0, 2.0]),
        (Axis("a", ""), [1.0, 1.0 + 1e-15]),
        (Axis("a", "", low=-1.0, high=7.0), []),
    ],
)
def test_both_drawings_have_the_same_ends_of_an_axis(axis, values):
    described = Figure([Panel(SPEED, axis, [Curve(np.arange(float(len(values))), np.array(values))])])
    page = interactive(described)["layout"]["yaxis"]
    ends = 10.0 ** np.array(page["range"]) if axis.logarithmic else np.array(page["range"])
    np.testing.assert_allclose(draw(described).axes[0].get_ylim(), ends, rtol=1e-5)


def test_a_legend_names_what_is_drawn_once_and_lies_off_every_panel():
    ends = np.array([0.0, 1.0])
    curves = [Curve(ends, n * ends, name) for n, name in enumerate(("one", "two", "one", ""))]
    panel = Panel(SPEED, FORCE, [*curves, Curve(ends, ends, "beside the pointer", in_legend=False)])
    for own in (False, True):
        panel = Panel(SPEED, FORCE, panel.marks, own_legend=own)
        drawn = draw(Figure([panel]))
        drawn.draw_without_rendering()
        (axes,) = drawn.axes
        legend = axes.get_legend() if own else drawn.legends[0]
        assert [text.get_text() for text in legend.texts] == ["one", "two"]
        assert not legend.get_window_extent().overlaps(axes.bbox)
    names = [trace["name"] for trace in interactive(Figure([panel]))["data"] if trace["showlegend"]]
    assert names == ["one", "two"]
