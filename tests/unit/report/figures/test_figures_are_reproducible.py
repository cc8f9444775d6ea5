"""Equal results give equal files of figures."""

import numpy as np
import pytest

from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.draw_matplotlib import STYLE, save
from facegear.report.figures.marks import Curve


def figure():
    """Return one whose svg holds clip paths and markers, which have made-up names."""
    curve = Curve(np.arange(5.0), np.arange(5.0) ** 2, marker="circle")
    return Figure([Panel(Axis("x", "mm"), Axis("y", "mm"), [curve])], width=3.0)


@pytest.mark.parametrize("ending", ["svg", "png"])
def test_a_figure_drawn_twice_is_the_same_file(tmp_path, ending):
    """The salt for names was set while a figure was drawn, and no longer when it was written."""
    for name in ("first", "again"):
        save(figure(), tmp_path / f"{name}.{ending}")
    assert (tmp_path / f"first.{ending}").read_bytes() == (tmp_path / f"again.{ending}").read_bytes()


def test_a_drawing_does_not_depend_on_the_formats_written_before_it(tmp_path):
    save(figure(), tmp_path / "first.svg")
    save(figure(), tmp_path / "again.png", tmp_path / "again.json", tmp_path / "again.svg")
    assert (tmp_path / "first.svg").read_bytes() == (tmp_path / "again.svg").read_bytes()


def test_every_path_is_written_though_several_have_one_ending(tmp_path):
    """Only the last of two paths with one ending was written."""
    paths = [tmp_path / f"{name}.{ending}" for name in ("first", "last") for ending in ("svg", "png", "json")]
    save(figure(), *paths)
    assert all(path.stat().st_size for path in paths)


def test_a_png_has_the_resolution_of_the_style(tmp_path):
    save(figure(), tmp_path / "a.png")
    width = int.from_bytes((tmp_path / "a.png").read_bytes()[16:20], "big")
    assert width == 3 * STYLE["savefig.dpi"]
