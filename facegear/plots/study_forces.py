"""Mean split of loads and largest forces of meshes over the numbers of a study."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, mesh_looks, styled

MARKERS = "osD^vPX"
WIDE = 30.0
"""Ratio of the largest number to the smallest from which the axis is logarithmic."""
PERIODIC = "period-1"


def figures(forces: pd.DataFrame, titles: Mapping[str, str]) -> list[Figure]:
    """A figure for each study over numbers; cells without text may be nan, as they are read."""
    text = {name: forces[name].astype(object).where(forces[name].notna(), "") for name in ("group", "beside")}
    every = forces.assign(**text).groupby("study", sort=False)
    return [forces_figure(rows, titles[str(name)]) for name, rows in every]


def forces_figure(forces: pd.DataFrame, title: str) -> Figure:
    """Two panels for each label of the other axis: fraction of the group's load, largest force."""
    cases = list(forces.groupby("beside", sort=False))
    looks = mesh_looks(dict.fromkeys(forces["mesh"]))
    with styled():
        figure, axes = plt.subplots(
            2 * len(cases), 1, figsize=(NARROW, 1.7 + 2.4 * 2 * len(cases)), sharex=True, squeeze=False
        )
        for number, (beside, rows) in enumerate(cases):
            split, largest = axes[2 * number : 2 * number + 2, 0]
            _curves(split, rows[rows["group"] != ""], looks, "fraction", 100.0)
            _curves(largest, rows, looks, "largest_n", 1e-3)
            split.set(ylabel="Mean fraction of the\nload of its group (%)", title=str(beside))
            largest.set(ylabel="Largest dynamic\nforce (kN)", ylim=(0.0, None))
        numbers = forces["number"]
        if numbers.min() > 0.0 and numbers.max() > WIDE * numbers.min():
            axes[-1, 0].set_xscale("log")
        axes[-1, 0].set_xlabel(str(forces["axis"].iloc[0]))
        figure.legend(*axes[1, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        figure.suptitle(title, fontsize=9)
    return figure


def _curves(
    axis: Axes, rows: pd.DataFrame, looks: Mapping[str, Mapping[str, str]], column: str, scale: float
) -> None:
    """A curve a mesh; hollow marks where the motion does not repeat with the mesh cycle."""
    colours = list(dict.fromkeys(look["color"] for look in looks.values()))
    for mesh, every in rows.groupby("mesh", sort=False):
        look = looks[str(mesh)]
        mark = {"marker": MARKERS[colours.index(look["color"]) % len(MARKERS)], "ms": 4.5}
        own = every.sort_values("number")
        axis.plot(own["number"], scale * own[column], lw=1.3, label=str(mesh), **look, **mark)
        other = own[own["motion"] != PERIODIC]
        if len(other):
            hollow = {**mark, "color": look["color"], "ls": "none", "markerfacecolor": "white"}
            axis.plot(other["number"], scale * other[column], **hollow)
