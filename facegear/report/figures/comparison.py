"""Figures that compare: designs of a search, two runs laid over each other."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.report.figures.colours import BLACK, BLUE, RED, colour_of, grey
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import Curve, Line, LineStyle, Look


def curves_compared(
    old: pd.DataFrame, new: pd.DataFrame, x: str, y: str, labels: tuple[str, str], title: str
) -> Figure:
    """Draw two runs' curves of one series above each other, and below them the difference new - old.

    Parameters
    ----------
    old, new : DataFrame
        Tables of one series with columns `x` and `y`, in any unit.
    x, y : str
        Columns across and up.
    labels : (str, str)
        `x` and `y` in words, with their units in brackets.
    title : str
        Title of the figure.

    Returns
    -------
    Figure
        Two panels; the difference is drawn where both tables have the same x.
    """
    joined_curves = old[[x, y]].merge(new[[x, y]], on=x, suffixes=("_old", "_new"))
    (across, across_unit), (up, unit) = (split_label(label) for label in labels)
    top = [
        Curve(old[x], old[y], "old", BLUE, width=2.2, opacity=0.6),
        Curve(new[x], new[y], "new", BLACK, "dash", width=1.1),
    ]
    bottom: list[Curve | Line] = [
        Line(0.0, "y", colour=grey(0.6)),
        Curve(joined_curves[x], joined_curves[f"{y}_new"] - joined_curves[f"{y}_old"], colour=RED, width=1.2),
    ]
    axis = Axis(across, across_unit)
    return Figure(
        [
            Panel(axis, Axis(up, unit), top, height=2.0, own_legend=True),
            Panel(axis, Axis("New - old", unit), bottom, height=1.0),
        ],
        title=title,
    )


def split_label(label: str) -> tuple[str, str]:
    """Part a label into quantity and unit.

    Parameters
    ----------
    label : str
        The quantity with its unit in brackets at the end, such as `force (N)`.

    Returns
    -------
    name, unit : str
        The unit is empty where there is none.
    """
    name, bracket, unit = label.rpartition(" (")
    return (name, unit.removesuffix(")")) if bracket and label.endswith(")") else (label, "")


MARKERS = ("square", "diamond", "triangle-up", "triangle-down", "cross", "star")
"""Markers of the winners, in their order."""
LINES: tuple[LineStyle, ...] = ("solid", "dash", "dot", "dashdot")
"""Lines of the seeds, in their order."""


def front_figure(
    designs: pd.DataFrame, front: pd.DataFrame, winners: pd.DataFrame, objectives: list[str]
) -> Figure:
    """Draw every design that was computed over its first two objectives, the front, and the winners.

    With a single objective it is drawn over the generation, without winners.

    Parameters
    ----------
    designs : pd.DataFrame
        Table `designs` of stage search: error (empty if computed), generation and a column for each
        objective.
    front : pd.DataFrame
        Table `front` of stage search, with the same columns of objectives.
    winners : pd.DataFrame
        Table `winners` of stage search: design and `<objective>_searched`.
    objectives : list[str]
        Names of the objectives.

    Returns
    -------
    Figure
        One panel.
    """
    across, up = objectives[:2] if len(objectives) > 1 else ("generation", objectives[0])
    computed_designs = designs[designs["error"] == ""]
    dots: Look = {"line": "none", "marker": "dot", "size": 3.0}
    marks = [
        Curve(computed_designs[across], computed_designs[up], "designs tried", grey(0.6), **dots),
        Curve(front[across], front[up], "front", BLUE, width=1.0, marker="circle", size=4.0),
    ]
    for number, row in enumerate(winners.itertuples() if len(objectives) > 1 else ()):
        at = winners.loc[[row.Index], f"{across}_searched"], winners.loc[[row.Index], f"{up}_searched"]
        colour = RED if row.design == "nominal" else BLACK
        look: Look = {"line": "none", "marker": MARKERS[number % len(MARKERS)], "size": 8.0, "hollow": True}
        marks.append(Curve(*at, row.design.replace("_", " "), colour, **look))
    return Figure([Panel(_axis(across), _axis(up), marks, height=3.2)])


def _axis(objective: str) -> Axis:
    """Return the axis of an objective, by its name without a unit; the axis of `generation` has whole
    numbers.
    """
    return Axis(objective.replace("_", " "), "", integer=objective == "generation")


def hypervolume_figure(hypervolume: pd.DataFrame) -> Figure:
    """Draw the share of the box of all fronts that each island has covered, over its generations.

    Parameters
    ----------
    hypervolume : pd.DataFrame
        Table `hypervolume` of stage search: seed (one island each), generation and hypervolume, 0 to 1.

    Returns
    -------
    Figure
        One panel, %, with a curve for each seed.
    """
    curves = [
        Curve(
            rows["generation"],
            100.0 * rows["hypervolume"],
            f"seed {seed}",
            colour_of(number + 1),
            LINES[number % len(LINES)],
        )
        for number, (seed, rows) in enumerate(hypervolume.groupby("seed"))
    ]
    return Figure([Panel(Axis("Generation", "", integer=True), Axis("Hypervolume", "%"), curves, height=2.2)])


def search_figures(
    designs: pd.DataFrame,
    front: pd.DataFrame,
    hypervolume: pd.DataFrame,
    winners: pd.DataFrame,
    objectives: Sequence[Mapping[str, Any]],
) -> tuple[Figure, ...]:
    """Draw the front between the objectives, and how the islands came to it.

    Parameters
    ----------
    designs : pd.DataFrame
        Table `designs` of stage search.
    front : pd.DataFrame
        Table `front` of stage search.
    hypervolume : pd.DataFrame
        Table `hypervolume` of stage search.
    winners : pd.DataFrame
        Table `winners` of stage search.
    objectives : Sequence[Mapping[str, Any]]
        Objectives of section `search` of the config; name is read.

    Returns
    -------
    tuple[Figure, ...]
        Those of `front_figure` and `hypervolume_figure`.
    """
    names = [objective["name"] for objective in objectives]
    return front_figure(designs, front, winners, names), hypervolume_figure(hypervolume)
