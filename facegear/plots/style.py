"""One look for all figures, and the one place that writes them."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from facegear.errors import FacegearError
from facegear.io.atomic import atomic_path
from facegear.plots import interactive

STYLE = {
    "figure.dpi": 110,
    "savefig.dpi": 160,
    "figure.constrained_layout.use": True,
    "font.size": 9,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "svg.hashsalt": "facegear",
    "svg.fonttype": "path",
}


COLOURS = ("black", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""That people tell apart who see no red or no green (Okabe and Ito)."""
GEAR_LINES = {"lower": "-", "upper": "--"}
"""Lines of the meshes with each gear; the colour is the pinion's."""
NARROW = 4.7
"""Width in inches of figures that a telephone shows whole: at 500 px their 9 pt text is 12 px high."""


@contextmanager
def styled() -> Iterator[None]:
    """Apply the project's matplotlib style."""
    with plt.rc_context(STYLE):
        yield


def save(figure: Figure, *paths: str | Path) -> None:
    """Write a figure to files and close it.

    The same figure gives the same bytes, whatever other files are written: its parts are placed once, an svg
    holds no date, and its inner names follow from a fixed salt.

    Parameters
    ----------
    figure
        The figure to write.
    *paths
        Files to write. The suffix names the format: one that matplotlib knows, or `.json` for the interactive
        form (`facegear.plots.interactive`).
    """
    with styled():
        lay_out(figure)
        for path in paths:
            suffix = Path(path).suffix
            with atomic_path(path) as temporary:
                if suffix == ".json":
                    interactive.write(figure, temporary)
                else:
                    figure.savefig(temporary, metadata={"Date": None} if suffix == ".svg" else None)
    plt.close(figure)


def rename_texts(figure: Figure, labels: Mapping[str, str]) -> None:
    """Write other words for texts of a figure.

    Parameters
    ----------
    figure : Figure
        The figure.
    labels : mapping of str to str
        New words by the text that stands in the figure.

    Raises
    ------
    FacegearError
        For a text that the figure does not have.
    """
    texts = [text for text in figure.findobj(Text) if text.get_text()]
    words = {text.get_text() for text in texts}
    for before in labels:
        if before not in words:
            text_list = ", ".join(repr(text) for text in sorted(words))
            raise FacegearError(f"labels: {before!r} is no text of this figure, which has {text_list}")
    for text in texts:
        if text.get_text() in labels:
            text.set_text(labels[text.get_text()])


def lay_out(figure: Figure) -> None:
    """Place the parts of a figure for good, at the resolution of its files."""
    figure.set_dpi(STYLE["savefig.dpi"])
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")


def mesh_looks(meshes: Iterable[str]) -> dict[str, dict[str, str]]:
    """Colour and line of each mesh (`pinion/gear`): a colour a pinion, a line a gear."""
    parts = {mesh: mesh.rpartition("/")[::2] for mesh in meshes}
    pinions = list(dict.fromkeys(pinion for pinion, _ in parts.values()))
    return {
        mesh: {"color": COLOURS[pinions.index(pinion) % len(COLOURS)], "ls": GEAR_LINES[gear]}
        for mesh, (pinion, gear) in parts.items()
    }


def legend_above(axis: Axes, columns: int, right: bool = False) -> None:
    """The legend of an axis over it, where it hides no curve; `right`: clear of the offset of its ticks."""
    loc, corner = ("lower right", (1.0, 1.0)) if right else ("lower left", (0.0, 1.0))
    axis.legend(loc=loc, bbox_to_anchor=corner, ncols=columns, borderaxespad=0.2)
