"""Designs of a search: the front between objectives, and how the islands came to it."""

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, legend_above, styled

GREY, BLUE, ORANGE = "#999999", "#0072B2", "#D55E00"
COLOURS = (BLUE, ORANGE, "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
MARKERS = "sD^vP*"


def front_figure(
    designs: pd.DataFrame, front: pd.DataFrame, winners: pd.DataFrame, objectives: list[str]
) -> Figure:
    """Every design by its first two objectives, by generation where there is but one; front and winners."""
    across, up = objectives[:2] if len(objectives) > 1 else ("generation", objectives[0])
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 4.4))
        known = designs[designs["error"] == ""]
        axis.plot(known[across], known[up], ".", ms=3, color=GREY, label="designs tried", rasterized=True)
        axis.plot(front[across], front[up], "o-", ms=4, lw=1, color=BLUE, label="front")
        for number, row in enumerate(winners.itertuples() if len(objectives) > 1 else ()):
            given = winners.loc[row.Index]
            colour = ORANGE if row.design == "nominal" else "black"
            label, marker = row.design.replace("_", " "), MARKERS[number % len(MARKERS)]
            axis.plot(
                given[f"{across}_searched"],
                given[f"{up}_searched"],
                marker,
                ms=8,
                mfc="none",
                color=colour,
                label=label,
            )
        axis.set_xlabel(across.replace("_", " "))
        axis.set_ylabel(up.replace("_", " "))
        legend_above(axis, 2)
    return figure


def hypervolume_figure(hypervolume: pd.DataFrame) -> Figure:
    """Share of the box of all fronts that each island has covered, over its generations."""
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 3.0))
        for number, (seed, rows) in enumerate(hypervolume.groupby("seed")):
            colour, dash = COLOURS[number % len(COLOURS)], ("-", "--", ":", "-.")[number % 4]
            axis.plot(
                rows["generation"], 100.0 * rows["hypervolume"], dash, color=colour, label=f"seed {seed}"
            )
        axis.set_xlabel("Generation")
        axis.set_ylabel("Hypervolume (%)")
        if len(hypervolume):
            legend_above(axis, 4)
    return figure


def figures(
    designs: pd.DataFrame,
    front: pd.DataFrame,
    hypervolume: pd.DataFrame,
    winners: pd.DataFrame,
    objectives: Sequence[Mapping[str, Any]],
) -> tuple[Figure, ...]:
    """The front between the objectives, and how the islands came to it."""
    names = [objective["name"] for objective in objectives]
    return front_figure(designs, front, winners, names), hypervolume_figure(hypervolume)
