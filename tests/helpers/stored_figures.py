"""Figures of a stored case, and what each of its two drawings shows."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PathCollection, PolyCollection, QuadMesh
from matplotlib.container import BarContainer, ErrorbarContainer
from matplotlib.contour import ContourSet

import facegear
from facegear.door.outputs import whole_case
from facegear.pipeline.arguments import typed_arguments
from facegear.pipeline.needs import resolved_needs, shared_sources
from facegear.pipeline.report_tables import asked_for
from facegear.pipeline.stage import load
from facegear.pipeline.table import STAGES
from facegear.report.figures.draw_matplotlib import draw
from facegear.report.figures.draw_plotly import interactive
from facegear.report.figures.plotly_values import straight


def stored_figures(config, results):
    """Yield the name and the description of every figure of a case, from its stored files.

    Parameters
    ----------
    config, results : Path
        The config, and the folder above the case's.

    Yields
    ------
    str, Figure
        Name and figure.
    """
    case = whole_case(facegear.load(config)).chain.case
    for stage in STAGES.values():
        if not (stage.figures and asked_for(stage.name, case) and stage.figures.figure_names(case)):
            continue
        upstream = {name: source for name, source in stage.figures.upstream.items() if source.is_needed(case)}
        parts = {name: _part(source, case, Path(results)) for name, source in upstream.items()}
        describe = load(stage.figures.draw)
        needs = typed_arguments(describe, resolved_needs(stage.figures.needs, case))
        yield from zip(stage.figures.figure_names(case), describe(**parts, **needs), strict=True)


def _part(source, case, results):
    file, parts = STAGES[source.stage].files[source.file], []
    for where in source.file_wildcards(case):
        shared = shared_sources(case.cases, source.stage)[where.get("case", case.values["case"])]
        wildcards = {name: text for name, text in where.items() if name != "case"}
        if file.each_text:
            return [file.read(results / shared / file.at({"each": text})) for text in file.each_text(case)]
        parts.append(file.read(results / shared / file.at(wildcards)))
    return parts if source.each_wildcards else parts[0]


def require_equal_drawings(figure):
    """Compare what matplotlib and plotly.js draw of a figure.

    Parameters
    ----------
    figure : Figure
        The figure; no drawing.

    Raises
    ------
    AssertionError
        Where a number, an end of an axis, a label or a name differs.
    """
    page, paper = interactive(figure), draw(figure)
    shown = [axes for axes in paper.axes if axes.get_label() != "<colorbar>"]
    try:
        for number, (panel, axes) in enumerate(zip(figure.panels, shown, strict=True)):
            own = [trace for trace in page["data"] if trace.get("yaxis", "y") == _axis_name(number)]
            _require_equal_panels(panel, axes, own)
            layout = page["layout"][_axis_name(number).replace("y", "yaxis")]
            ends = [10.0**end if panel.y.logarithmic else end for end in layout["range"]]
            np.testing.assert_allclose(axes.get_ylim(), ends, rtol=1e-4, atol=1e-9)
            label = " ".join(layout["title"]["text"].replace("<br>", " ").split())
            assert _words(axes.get_ylabel()) in label, label
        legends = [*paper.legends, *(axes.get_legend() for axes in shown if axes.get_legend())]
        names = {text.get_text() for legend in legends for text in legend.texts}
        assert names == {_words(trace["name"]) for trace in page["data"] if trace.get("showlegend")}
    finally:
        plt.close(paper)


def _axis_name(number):
    return "y" if number == 0 else f"y{number + 1}"


def _words(text):
    plain = text.replace("<br>", " ").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
    return " ".join(plain.split())


def _require_equal_panels(panel, axes, traces):
    data = axes.transData
    errors = [container for container in axes.containers if isinstance(container, ErrorbarContainer)]
    caps = {cap for container in errors for cap in container.lines[1]}
    own = [line for line in axes.lines if line.get_transform() == data and line not in caps]
    lines = [line.get_data() for line in own]
    scattered = [mark for mark in axes.collections if isinstance(mark, PathCollection)]
    lines += [tuple(mark.get_offsets().T) for mark in scattered]
    of_points = [t for t in traces if t["type"] == "scatter" and not t.get("fill") and t.get("opacity") != 0]
    points = [(t["x"], t["y"]) for t in of_points if t["x"] != [None]]
    _require_equal(lines, points)
    bars = [box for box in axes.containers if isinstance(box, BarContainer)]
    flat = [t for t in traces if t["type"] == "bar"]
    heights = [[_length(bar, t["orientation"]) for bar in box] for box, t in zip(bars, flat, strict=True)]
    _require_equal(heights, [t["x" if t["orientation"] == "h" else "y"] for t in flat])
    assert len(errors) == sum("error_x" in t or "error_y" in t for t in flat)
    maps = [mark for mark in axes.collections if isinstance(mark, QuadMesh)]
    marks = [mark for mark in panel.marks if type(mark).__name__ == "Map"]
    for mesh, mark, trace in zip(maps, marks, (t for t in traces if t["type"] == "heatmap"), strict=True):
        np.testing.assert_allclose(np.ma.filled(mesh.get_array(), np.nan).ravel(), np.ravel(mark.values))
        expected = straight(mark)[2]
        np.testing.assert_allclose(np.array(trace["z"], dtype=float), expected, rtol=1e-3, atol=1e-9)
        np.testing.assert_allclose(mesh.get_clim(), (trace["zmin"], trace["zmax"]))
    levels = [mark for mark in axes.collections if isinstance(mark, ContourSet)]
    areas = [t for t in traces if t.get("fill") and t.get("text")]
    paths = [path for mark in levels for path in mark.get_paths() if path.to_polygons()]
    for path, trace in zip(paths, areas, strict=True):
        drawn = sum(_area(*ring.T) for ring in path.to_polygons())
        rings = np.array([trace["x"], trace["y"]], dtype=float)
        ends = np.flatnonzero(np.isnan(rings[0]))
        shown = sum(_area(*ring[:, np.isfinite(ring[0])]) for ring in np.split(rings, ends, axis=1))
        np.testing.assert_allclose(drawn, shown, rtol=1e-3, atol=1e-6)
    bands = [
        mark for mark in axes.collections if isinstance(mark, PolyCollection) and mark.get_array() is None
    ]
    assert len(bands) == sum(type(mark).__name__ == "Band" for mark in panel.marks)


def _length(bar, orientation):
    return bar.get_width() if orientation == "h" else bar.get_height()


def _area(x, y):
    """Signed area of a ring."""
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def _require_equal(given, expected):
    assert len(given) == len(expected)
    for one, other in zip(given, expected, strict=True):
        np.testing.assert_allclose(
            np.array(one, dtype=float), np.array(other, dtype=float), rtol=1e-5, atol=1e-12
        )
