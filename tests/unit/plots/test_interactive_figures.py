"""The interactive form of a figure holds the numbers, names and units of the still picture."""

import json
import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Circle

from facegear.plots.interactive import interactive
from facegear.plots.style import save, styled


@pytest.fixture
def panels():
    """Two panels over a common x axis, as a sweep up and down has them; the lower one has no names."""
    with styled():
        figure, (top, below) = plt.subplots(2, 1, sharex=True)
    yield figure, top, below
    plt.close(figure)


def test_a_curve_keeps_its_values_its_name_and_the_units_of_its_axes(panels):
    figure, top, below = panels
    speed = np.array([1000.0, 2000.0, 3000.0])
    for axis in (top, below):
        axis.plot(
            speed, [1.23456789, np.nan, 3.0], "--", color="tab:red", label="up" if axis is top else None
        )
        axis.set_ylabel("RMS of d (µm)\nwithout its mean")
    below.set_xlabel("Pinion speed (rpm)")
    top.legend()
    figure.suptitle("RMS at 10$^{-4}$ s, $K_\\gamma$")
    described = interactive(figure)
    first, second = described["data"]
    assert first["x"] == [1000.0, 2000.0, 3000.0] and first["y"] == [1.23457, None, 3.0]
    assert (first["name"], second["name"], first["line"]["dash"]) == ("up", "up", "dash")
    assert first["legendgroup"] == second["legendgroup"], "the legend switches a curve in all panels"
    assert [first["showlegend"], second["showlegend"]] == [True, False]
    assert "µm" in first["hovertemplate"] and "rpm" in str(described["layout"]["xaxis"]["unifiedhovertitle"])
    assert first["xaxis"] == second["xaxis"] == "x", "panels above each other are zoomed together"
    assert described["title"] == "RMS at 10<sup>−4</sup> s, K<sub>γ</sub>"


def test_a_map_keeps_the_value_of_every_cell_with_its_unit(panels):
    figure, top, below = panels
    drawn = top.pcolormesh([0.0, 1.0, 2.0], [0.0, 5.0], [[1.0, 2.5]])
    x, y = np.meshgrid([0.0, 1.0], [0.0, 1.0, 2.0])
    smooth = below.pcolormesh(x, y + 0.5 * x, np.ma.masked_greater(y, 1.5), shading="gouraud")
    figure.colorbar(drawn, ax=top, label="Pressure (MPa)")
    cells, uneven = interactive(figure)["data"]
    assert cells["z"] == [[1.0, 2.5]] and cells["x"] == [0.0, 1.0, 2.0] and cells["y"] == [0.0, 5.0]
    assert "Pressure" in cells["hovertemplate"] and "MPa" in cells["hovertemplate"] and cells["showscale"]
    known = np.array(uneven["z"], dtype=float)
    expected = np.array(uneven["y"])[:, None] - 0.5 * np.array(uneven["x"])
    inside = np.isfinite(known)
    np.testing.assert_allclose(known[inside], expected[inside], atol=1e-3)
    assert np.all(expected[inside] < 1.01) and inside.any(axis=0).all(), "what is masked stays blank"
    assert smooth.get_clim() == (uneven["zmin"], uneven["zmax"])


def test_bars_lines_across_a_panel_areas_and_points_are_kept(panels):
    figure, top, below = panels
    top.barh(["tail idler", "input"], [2.0, -1.0], color=["tab:blue", "tab:red"])
    below.axvline(7.0, ymax=0.04, color="k")
    below.axhspan(1.0, 2.0, color="0.5", alpha=0.1)
    below.fill_between([0.0, 1.0], [0.0, 0.0], [1.0, 2.0])
    points = below.scatter([1.0, 2.0], [3.0, 4.0], c=[10.0, 20.0])
    figure.colorbar(points, ax=below, label="Speed (rpm)")
    described = interactive(figure)
    kinds = [(trace["type"], trace.get("fill")) for trace in described["data"]]
    assert kinds == [("bar", None), ("bar", None), ("scatter", "toself"), ("scatter", None)]
    assert [trace["customdata"] for trace in described["data"][:2]] == [["tail idler"], ["input"]]
    assert [trace["x"] for trace in described["data"][:2]] == [[2.0], [-1.0]]
    assert described["data"][3]["marker"]["color"] == [10.0, 20.0]
    line, band = sorted(described["layout"]["shapes"], key=lambda shape: shape["type"])
    assert (line["xref"], line["x0"], line["yref"], line["y1"]) == ("x", 7.0, "y2 domain", 0.04)
    assert (band["yref"], band["y0"], band["y1"]) == ("y2", 1.0, 2.0)


def test_areas_between_levels_say_between_which(panels):
    figure, top, _ = panels
    drawn = top.contourf([0.0, 1.0], [0.0, 1.0], [[0.0, 1.0], [2.0, 3.0]], levels=[0.0, 1.0, 3.0])
    figure.colorbar(drawn, ax=top, label="Gap (um)")
    areas = [trace for trace in interactive(figure)["data"] if trace.get("fill")]
    assert [trace["text"] for trace in areas] == ["0 to 1 um", "1 to 3 um"]


def test_a_drawing_stays_a_still_picture(panels, tmp_path):
    figure, top, _ = panels
    top.add_patch(Circle((0.0, 0.0), 1.0))
    save(figure, tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text())["data"] == []


def test_names_beside_the_last_panel_and_long_lines_below_it_are_not_cut_off(panels):
    """Deflections beside the lines of a mesh law, and the inputs below a study, were cut off."""
    figure, _, below = panels
    below.plot([0.0, 1.0], [1.0, 2.0])
    below.set_xlim(0.0, 1.0)
    narrow = interactive(figure)["layout"]["margin"]["r"]
    below.annotate("68.8 µm", (1.0, 2.0), (3, 0), textcoords="offset points", va="center")
    first, second = "torque per engine 1328 N m; share of the power at the tail 3.4 %;", "meshes geometric"
    figure.supxlabel(f"{first}\n{second}")
    layout = interactive(figure)["layout"]
    assert layout["margin"]["r"] > narrow + 40
    (label,) = [text for text in re.findall(r"'text': '([^']*)'", str(layout)) if "torque" in text]
    assert max(map(len, label.split("<br>"))) < 50
    assert label.replace("<br>", " ") == f"{first} {second}"
