"""The one place that writes figures."""

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.figure import Figure as MplFigure

from facegear.io.atomic import atomic_path
from facegear.report.figures import draw_plotly
from facegear.report.figures.description import Figure
from facegear.report.figures.draw_matplotlib import draw, place_parts, styled


def save(figure: Figure, *paths: str | Path) -> None:
    """Write a figure to files.

    Parameters
    ----------
    figure : Figure
        The figure.
    *paths : str or Path
        Files to write. The suffix names the format: one that matplotlib knows, or `.json` for plotly.js
        (`facegear.report.figures.draw_plotly`).
    """
    pages = [path for path in paths if Path(path).suffix == ".json"]
    for path in pages:
        with atomic_path(path) as temporary:
            draw_plotly.write(figure, temporary)
    if still_paths := [path for path in paths if path not in pages]:
        save_drawn(draw(figure), *still_paths)


def save_drawn(mpl_figure: MplFigure, *paths: str | Path) -> None:
    """Write a drawing of matplotlib to files and close it.

    The same drawing gives the same bytes, whatever other files are written: its parts are placed once, an svg
    holds no date, and its inner names follow from a fixed salt.

    Parameters
    ----------
    mpl_figure : matplotlib.figure.Figure
        The drawing.
    *paths : str or Path
        Files to write; the suffix names the format.
    """
    with styled():
        place_parts(mpl_figure)
        for path in paths:
            with atomic_path(path) as temporary:
                mpl_figure.savefig(
                    temporary, metadata={"Date": None} if Path(path).suffix == ".svg" else None
                )
    plt.close(mpl_figure)
