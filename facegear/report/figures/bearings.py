"""Figure of the rolling bearings: stiffness and load zone over the machine's torque."""

import numpy as np
import pandas as pd

from facegear.report.figures.colours import shades
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import Curve, Line

TOLERANCE = 1e-4
"""Relative difference up to which bearings count as doing the same."""


def bearing_figures(over_torque: pd.DataFrame) -> list[Figure]:
    """Draw the bearings over torque.

    Parameters
    ----------
    over_torque : DataFrame
        Table `over_torque` of stage bearing_life.

    Returns
    -------
    list of Figure
        One figure.
    """
    along = Axis("Torque over that of the config", "")
    stiffness, zone = [], []
    groups = _group_equal(over_torque)
    nominal = Line(1.0, line="dot")
    for (names, rows), colour in zip(groups, shades(len(groups)), strict=True):
        at = rows["load_fraction"].to_numpy(float)
        label = ", ".join(names)
        stiffness.append(Curve(at, 1e-6 * rows["radial_stiffness_n_per_m"], label, colour))
        zone.append(Curve(at, rows["zone_deg"], "", colour))
    panels = [
        Panel(along, Axis("Stiffness along the load", "N/µm", low=0.0), [nominal, *stiffness], height=2.0),
        Panel(along, Axis("Load zone", "deg", low=0.0), [nominal, *zone], height=1.4),
    ]
    return [Figure(panels)]


def _group_equal(over_torque: pd.DataFrame) -> list[tuple[list[str], pd.DataFrame]]:
    """Return the names of bearings that do the same at all torques, with the rows of one of them."""
    groups: list[tuple[list[str], pd.DataFrame]] = []
    columns = ["radial_n", "radial_stiffness_n_per_m", "zone_deg"]
    for (pinion, letter), rows in over_torque.groupby(["pinion", "bearing"], sort=False):
        numbers = rows[columns].to_numpy(float)
        for names, group_rows in groups:
            group_numbers = group_rows[columns].to_numpy(float)
            if np.allclose(
                numbers, group_numbers, rtol=TOLERANCE, atol=TOLERANCE * np.abs(group_numbers).max()
            ):
                names.append(f"{pinion} {letter}")
                break
        else:
            groups.append(([f"{pinion} {letter}"], rows))
    return groups
