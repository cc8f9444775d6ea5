"""Figures of a casing: load sharing with and without it, its modes over speed, acceleration of its
sensors.
"""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.report.figures.colours import BLUE, RED, grey
from facegear.report.figures.description import Axis, Figure, Key, Panel
from facegear.report.figures.marks import Bars, Curve, Mark, Scatter, Text

CASING_MODE = 0.5
"""Part of the kinetic energy in the casing from which a mode is drawn as one of the casing."""
ORDER_COLOURS = (BLUE, RED, "#2e8b57", "#8a5fbf", "#c77f1a", grey(0.35), grey(0.55), grey(0.7))
"""Colour of each order of the mesh."""


def casing_figures(
    sharing: pd.DataFrame, campbell: pd.DataFrame, crossings: pd.DataFrame
) -> tuple[Figure, ...]:
    """Draw what the casing does to the machine.

    Parameters
    ----------
    sharing : DataFrame
        Mesh forces: mesh, force_n, force_on_fixed_seats_n.
    campbell : DataFrame
        Modes over speed: line, speed_rpm, frequency_hz, casing_energy_fraction.
    crossings : DataFrame
        Crossings of modes of the casing with orders of the mesh: order, frequency_hz, speed_rpm.

    Returns
    -------
    tuple of Figure
        Load sharing and the Campbell diagram.
    """
    return load_sharing(sharing), campbell_diagram(campbell, crossings)


def load_sharing(sharing: pd.DataFrame) -> Figure:
    """Draw the force of every mesh on the casing and on seats that stand still, side by side.

    Parameters
    ----------
    sharing : DataFrame
        As in `casing_figures`.

    Returns
    -------
    Figure
        One panel, two bars a mesh.
    """
    count = len(sharing)
    positions: Array = np.arange(count, dtype=np.float64)[::-1] * 2.6
    ticks = [(float(position), mesh) for position, mesh in zip(positions, sharing["mesh"], strict=True)]
    bars: list[Mark] = [
        Bars(
            positions + 0.45,
            1e-3 * sharing["force_on_fixed_seats_n"].to_numpy(),
            flat=True,
            colour=grey(0.65),
        ),
        Bars(positions - 0.45, 1e-3 * sharing["force_n"].to_numpy(), flat=True, colour=BLUE),
    ]
    keys = [Key("on the casing", BLUE, area=True), Key("on seats that stand still", grey(0.65), area=True)]
    panel = Panel(Axis("Force of the mesh", "kN"), Axis("", "", ticks=ticks), bars, height=0.5 + 0.12 * count)
    return Figure([panel], title="Load sharing with and without the casing", keys=keys)


def campbell_diagram(campbell: pd.DataFrame, crossings: pd.DataFrame) -> Figure:
    """Draw the modes of the machine over speed, those of the casing in colour, with orders of the mesh.

    Parameters
    ----------
    campbell : DataFrame
        As in `casing_figures`.
    crossings : DataFrame
        As in `casing_figures`.

    Returns
    -------
    Figure
        One panel, kHz over rpm.
    """
    last = float(campbell["speed_rpm"].max())
    top = (
        1.08 * float(crossings["frequency_hz"].max())
        if len(crossings)
        else float(campbell["frequency_hz"].max())
    )
    marks: list[Mark] = []
    for _, line in campbell.groupby("line"):
        if line["frequency_hz"].min() > top:
            continue
        is_casing = line["casing_energy_fraction"].mean() >= CASING_MODE
        colour = RED if is_casing else grey(0.7)
        marks.append(
            Curve(
                line["speed_rpm"], 1e-3 * line["frequency_hz"], colour=colour, width=1.0 if is_casing else 0.6
            )
        )
    for order in sorted(set(crossings["order"])):
        row = crossings[crossings["order"] == order].iloc[0]
        slope = row["frequency_hz"] / row["speed_rpm"]
        end = min(last, top / slope)
        marks.append(
            Curve(
                np.array([0.0, end]),
                1e-3 * slope * np.array([0.0, end]),
                colour=grey(0.5),
                line="dash",
                width=0.8,
            )
        )
        marks.append(Text(0.96 * end, 0.96e-3 * slope * end, f"{order}x", shift=(-12.0, 2.0), paper=True))
    if len(crossings):
        marks.append(
            Scatter(
                crossings["speed_rpm"],
                1e-3 * crossings["frequency_hz"],
                np.full(len(crossings), 3.5),
                colour=RED,
            )
        )
    keys = [Key("modes of the casing", RED), Key("other modes", grey(0.7))]
    across = Axis("Speed of the pinions", "rpm", low=0.0, high=last)
    panel = Panel(across, Axis("Frequency", "kHz", low=0.0, high=1e-3 * top), marks, height=3.0)
    return Figure([panel], title="Modes of the machine on its casing", keys=keys)


def sensor_figures(sensors: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the acceleration of every sensor over speed, a curve for each order of the mesh.

    Parameters
    ----------
    sensors : DataFrame
        speed_rpm, order, sensor, acceleration_m_per_s2.

    Returns
    -------
    tuple of Figure
        One figure with a panel a sensor.
    """
    panels = []
    orders = sorted(set(sensors["order"]))
    for name, rows in sensors.groupby("sensor", sort=False):
        curves: list[Mark] = [
            Curve(
                rows.loc[rows["order"] == order, "speed_rpm"],
                rows.loc[rows["order"] == order, "acceleration_m_per_s2"],
                colour=ORDER_COLOURS[order - 1],
                width=1.0,
            )
            for order in orders
        ]
        across = Axis("Speed of the pinions", "rpm")
        panels.append(Panel(across, Axis("Acceleration", "m/s2", logarithmic=True), curves, title=str(name)))
    keys = [Key(f"{order} x mesh", ORDER_COLOURS[order - 1]) for order in orders]
    return (Figure(panels, title="Acceleration of the casing by orders of the mesh", keys=keys),)
