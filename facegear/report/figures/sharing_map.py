"""Figures of the load-sharing map."""

import pandas as pd

from facegear.report.figures.colours import BLACK, colour_of, grey
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import Curve
from facegear.report.figures.sharing import ALL_CARRY, CLOSED_NAME, FLOATING, HOLDS, OTHER_LEVELS
from facegear.sharing.sharing_map import AS_GIVEN


def sharing_map_figures(
    curves: pd.DataFrame, inputs: pd.DataFrame, points: pd.DataFrame
) -> tuple[Figure, ...]:
    """Draw the map of load sharing.

    Parameters
    ----------
    curves, inputs, points : DataFrame
        Tables of stage sharing_map, as `sharing_map_figure` reads them.

    Returns
    -------
    tuple of Figure
        The figure.
    """
    return (sharing_map_figure(curves, inputs, points),)


def sharing_map_figure(curves: pd.DataFrame, inputs: pd.DataFrame, points: pd.DataFrame) -> Figure:
    """Draw K_gamma over the dimensionless number that decides it: a panel for idlers, and one for inputs.

    That is k_e sigma / W of idlers (stiffness of a path, standard deviation of its lateness, load of all
    paths) and 2 b k / W of inputs (backlash, mesh stiffness, load of the input).

    Closed forms are broad grey lines where they hold; the machine is a point at each torque.

    Parameters
    ----------
    curves, inputs, points : DataFrame
        Tables of stage sharing_map, empty where there are no idlers or inputs. All have `number`; curves:
        floating, all_carry, closed_p95, k_gamma_p50 to p99; inputs: bearing_n_per_m, k_gamma, closed;
        points: kind, k_gamma_p95.

    Returns
    -------
    Figure
        Up to two panels.
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
    """Return marks at K_gamma (95th percentile) of the machine over `number`, one for each of its
    torques. `points`: table of stage sharing_map; kind: `idlers` or `inputs`.
    """
    rows = points[points["kind"] == kind]
    at = rows["number"].to_numpy(), rows["k_gamma_p95"].to_numpy()
    return Curve(*at, "this machine", BLACK, "none", marker="circle", size=7.0)


def _idlers(curves: pd.DataFrame) -> list[Curve]:
    """Return curves of K_gamma (95th percentile over drawn errors) of the idlers over `number`, one for
    each choice of floating gears, with other percentiles for the machine as given, and the closed form
    below where it holds.
    """
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
    """Return whether the closed form of the 95th percentile is within HOLDS of the computed one,
    relative, at all points where every path carries load in (nearly) all samples.
    """
    valid = rows[rows["all_carry"] >= ALL_CARRY]
    return bool((valid["k_gamma_p95"] / valid["closed_p95"] - 1.0).abs().max() < HOLDS)


def _inputs(inputs: pd.DataFrame) -> list[Curve]:
    """Return curves of the largest K_gamma of all input groups over `number`, one for each bearing
    stiffness (N/m), with the closed form below where it is within HOLDS.
    """
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
    """Return the closed form `values` over `number`, both (n,), as a broad grey line. Only the first
    one stands in the legend.
    """
    return Curve(number, values.to_numpy(), CLOSED_NAME, grey(0.8), width=4.0, in_legend=is_first)
