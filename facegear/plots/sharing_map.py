"""Map of load sharing: K_gamma of idlers and of inputs over the numbers that decide it."""

from collections.abc import Mapping

import pandas as pd

from facegear.load_sharing.sharing_map import AS_GIVEN
from facegear.plots.colours import BLACK, BLUE, GREEN, RED, colour_of, grey
from facegear.plots.description import Axis, Curve, Figure, LineStyle, Panel

FLOATING: Mapping[str, tuple[str, str]] = {
    AS_GIVEN: ("as given", BLACK),
    "upper": ("upper gear floats", BLUE),
    "lower": ("lower gear floats", RED),
    "both": ("both gears float", GREEN),
}
"""Name and colour of each curve of the idlers."""
OTHER_LEVELS: Mapping[int, LineStyle] = {50: "dash", 99: "dashdot"}
"""Percentiles that are drawn beside P95 for the machine as given."""
ALL_CARRY = 1.0 - 1e-9
"""Fraction of samples in which every path carries, from which the closed form may hold."""
HOLDS = 0.02
"""Relative difference from the statics below which a closed form is drawn: little beside what it explains."""
CLOSED_NAME = "closed form"


def figures(curves: pd.DataFrame, inputs: pd.DataFrame, points: pd.DataFrame) -> tuple[Figure, ...]:
    """Describe the map.

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
    """Describe a panel for the idlers, and one for the inputs.

    Parameters
    ----------
    curves, inputs, points : pd.DataFrame
        Tables of stage sharing_map.

    Returns
    -------
    Figure
        Closed forms are broad grey lines where they hold; the machine is a point at each torque.
    """
    panels = []
    if len(curves):
        number, factor = Axis("Lateness of idlers kₑ σ / W", ""), Axis("Kᵧ of the idlers", "")
        marks = [*_idlers(curves), _machine(points, "idlers")]
        panels.append(Panel(number, factor, marks, height=2.6, own_legend=True))
    if len(inputs):
        number, factor = Axis("Misfit of inputs 2 b k / W", ""), Axis("Largest Kᵧ of the inputs", "")
        marks = [*_inputs(inputs), _machine(points, "inputs")]
        panels.append(Panel(number, factor, marks, height=2.6, own_legend=True))
    return Figure(panels, title="Load sharing over what decides it, at rest", shared_x=False)


def _machine(points: pd.DataFrame, kind: str) -> Curve:
    """The machine at each of its torques."""
    rows = points[points["kind"] == kind]
    at = rows["number"].to_numpy(), rows["k_gamma_p95"].to_numpy()
    return Curve(*at, "this machine", BLACK, "none", marker="circle", size=7.0)


def _idlers(curves: pd.DataFrame) -> list[Curve]:
    """P95 for each floating gear; for the machine as given the other percentiles as well."""
    broad: list[Curve] = []
    marks: list[Curve] = []
    for floating, rows in curves.groupby("floating", sort=False):
        words, colour = FLOATING[str(floating)]
        number = rows["number"].to_numpy()
        if _is_close(rows):
            broad.append(_closed_form(number, rows["closed_p95"], not broad))
        marks.append(Curve(number, rows["k_gamma_p95"].to_numpy(), f"idlers, P95, {words}", colour))
        if floating == AS_GIVEN:
            for level, line in OTHER_LEVELS.items():
                values = rows[f"k_gamma_p{level}"].to_numpy()
                marks.append(Curve(number, values, f"idlers, P{level}, {words}", colour, line, width=0.9))
    return broad + marks


def _is_close(rows: pd.DataFrame) -> bool:
    """Whether the closed form holds for a curve as long as every path carries."""
    valid = rows[rows["all_carry"] >= ALL_CARRY]
    return bool((valid["k_gamma_p95"] / valid["closed_p95"] - 1.0).abs().max() < HOLDS)


def _inputs(inputs: pd.DataFrame) -> list[Curve]:
    """The input that shares worst, for each bearing stiffness."""
    broad: list[Curve] = []
    marks: list[Curve] = []
    worst = inputs.groupby(["bearing_n_per_m", "number"])[["k_gamma", "closed"]].max().reset_index()
    for index, (bearing, rows) in enumerate(worst.groupby("bearing_n_per_m")):
        number, factor = rows["number"].to_numpy(), rows["k_gamma"].to_numpy()
        if (rows["k_gamma"] / rows["closed"] - 1.0).abs().max() < HOLDS:
            broad.append(_closed_form(number, rows["closed"], not broad))
        name = f"inputs, bearings {1e-6 * float(bearing):.3g} N/µm"
        marks.append(Curve(number, factor, name, colour_of(index)))
    return broad + marks


def _closed_form(number: pd.Series, values: pd.Series, is_first: bool) -> Curve:
    """A broad line below the computed one, in the legend once."""
    return Curve(number, values.to_numpy(), CLOSED_NAME, grey(0.8), width=4.0, in_legend=is_first)
