"""Map of load sharing: K_gamma of idlers and of inputs over the numbers that decide it."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.load_sharing.sharing_map import AS_GIVEN
from facegear.plots.style import COLOURS, NARROW, legend_above, styled

CURVES = {
    AS_GIVEN: ("as given", COLOURS[0]),
    "upper": ("upper gear floats", COLOURS[1]),
    "lower": ("lower gear floats", COLOURS[2]),
    "both": ("both gears float", COLOURS[3]),
}

ALL_CARRY = 1.0 - 1e-9
"""Fraction of samples in which every path carries, from which the closed form may hold."""
HOLDS = 0.02
"""Relative difference from the statics below which a closed form is drawn: little beside what it explains."""


def figures(curves: pd.DataFrame, inputs: pd.DataFrame, points: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the map.

    Parameters
    ----------
    curves, inputs, points : pd.DataFrame
        Tables of stage sharing_map.

    Returns
    -------
    tuple of Figure
        The figure.
    """
    return (sharing_map_figure(curves, inputs, points),)


def sharing_map_figure(curves: pd.DataFrame, inputs: pd.DataFrame, points: pd.DataFrame) -> Figure:
    """Draw a panel for the idlers, and one for the inputs.

    Parameters
    ----------
    curves, inputs, points : pd.DataFrame
        Tables of stage sharing_map.

    Returns
    -------
    Figure
        Closed forms are broad grey lines where they hold; the machine is a point at each torque.
    """
    kinds = [kind for kind, rows in (("idlers", curves), ("inputs", inputs)) if len(rows)]
    with styled():
        panels = max(len(kinds), 1)
        figure, axes = plt.subplots(panels, 1, figsize=(NARROW, 0.4 + 3.8 * panels), squeeze=False)
        for axis, kind in zip(axes[:, 0], kinds, strict=False):
            if kind == "idlers":
                _draw_idlers(axis, curves)
            else:
                _draw_inputs(axis, inputs)
            points_of_kind = points[points["kind"] == kind]
            at = points_of_kind["number"], points_of_kind["k_gamma_p95"]
            axis.plot(*at, "o", mfc="none", color=COLOURS[4], label="this machine")
            legend_above(axis, 2)
    return figure


def _draw_idlers(axis: Axes, curves: pd.DataFrame) -> None:
    """The percentile judged for each floating gear; for the machine as given the other two as well."""
    by_floating = [(str(floating), rows) for floating, rows in curves.groupby("floating", sort=False)]
    _draw_closed(axis, [(rows["number"], rows["closed_p95"]) for _, rows in by_floating if _is_close(rows)])
    for floating, rows in by_floating:
        words, colour = CURVES[floating]
        axis.plot(rows["number"], rows["k_gamma_p95"], color=colour, label=f"P95, {words}")
        if floating == AS_GIVEN:
            for level, style in ((50, "--"), (99, "-.")):
                label = f"P{level}, {words}"
                axis.plot(rows["number"], rows[f"k_gamma_p{level}"], style, lw=0.9, color=colour, label=label)
    axis.set_xlabel(r"Lateness of idlers $k_e\,\sigma\,/\,W$")
    axis.set_ylabel(r"$K_\gamma$ of the idlers")


def _is_close(rows: pd.DataFrame) -> bool:
    """Whether the closed form holds for a curve as long as every path carries."""
    rows_closed = rows[rows["all_carry"] >= ALL_CARRY]
    return bool((rows_closed["k_gamma_p95"] / rows_closed["closed_p95"] - 1.0).abs().max() < HOLDS)


def _draw_inputs(axis: Axes, inputs: pd.DataFrame) -> None:
    """The input that shares worst, for each bearing stiffness."""
    worst = inputs.groupby(["bearing_n_per_m", "number"])[["k_gamma", "closed"]].max().reset_index()
    by_bearing = [(float(bearing), rows) for bearing, rows in worst.groupby("bearing_n_per_m")]
    near = [rows for _, rows in by_bearing if (rows["k_gamma"] / rows["closed"] - 1.0).abs().max() < HOLDS]
    _draw_closed(axis, [(rows["number"], rows["closed"]) for rows in near])
    for colour, (bearing, rows) in zip(COLOURS, by_bearing, strict=False):
        label = f"bearings of {bearing:.2g} N/m"
        axis.plot(rows["number"], rows["k_gamma"], color=colour, label=label)
    axis.set_xlabel(r"Misfit of inputs $2\,b\,k\,/\,W$")
    axis.set_ylabel(r"Largest $K_\gamma$ of the inputs")


def _draw_closed(axis: Axes, lines: list[tuple[pd.Series, pd.Series]]) -> None:
    """Closed forms as broad lines below the computed curves, named once."""
    for number, (at, values) in enumerate(lines):
        label = "closed form" if number == 0 else None
        axis.plot(at, values, color="0.8", lw=4.0, solid_capstyle="butt", label=label)
