"""Mean split of loads and largest forces of meshes over the numbers of a study."""

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from facegear.plots.colours import mesh_looks
from facegear.plots.compare import split_label
from facegear.plots.description import Axis, Curve, Figure, Look, Panel

MARKERS = ("circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "star")
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
    looks = mesh_looks(dict.fromkeys(forces["mesh"]))
    name, unit = split_label(str(forces["axis"].iloc[0]))
    if unit == "N/m":
        forces, unit = forces.assign(number=1e-6 * forces["number"]), "N/µm"
    numbers = forces["number"]
    is_wide = numbers.min() > 0.0 and numbers.max() > WIDE * numbers.min()
    across = Axis(name, unit, logarithmic=bool(is_wide))
    panels = []
    for beside, rows in forces.groupby("beside", sort=False):
        group_rows = rows[rows["group"] != ""]
        panels += [
            Panel(
                across,
                Axis("Mean fraction of the\nload of its group", "%"),
                list(_curves(group_rows, looks, "fraction", 100.0, in_legend=False)),
                title=str(beside),
                height=1.9,
            ),
            Panel(
                across,
                Axis("Largest dynamic\nforce", "kN", low=0.0),
                list(_curves(rows, looks, "largest_n", 1e-3)),
                height=1.9,
            ),
        ]
    return Figure(panels, title=title)


def _curves(
    rows: pd.DataFrame, looks: Mapping[str, Any], column: str, scale: float, in_legend: bool = True
) -> Iterator[Curve]:
    """A curve a mesh; hollow marks where the motion does not repeat with the mesh cycle."""
    colours = list(dict.fromkeys(look["colour"] for look in looks.values()))
    for mesh, every in rows.groupby("mesh", sort=False):
        look = looks[str(mesh)]
        marker = MARKERS[colours.index(look["colour"]) % len(MARKERS)]
        sorted_rows = every.sort_values("number")
        yield Curve(
            sorted_rows["number"],
            scale * sorted_rows[column],
            str(mesh),
            width=1.3,
            marker=marker,
            in_legend=in_legend,
            **look,
        )
        irregular_rows = sorted_rows[sorted_rows["motion"] != PERIODIC]
        if len(irregular_rows):
            hollow: Look = {"colour": look["colour"], "line": "none", "marker": marker, "hollow": True}
            yield Curve(
                irregular_rows["number"], scale * irregular_rows[column], str(mesh), in_legend=False, **hollow
            )
