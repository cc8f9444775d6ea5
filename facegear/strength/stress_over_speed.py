"""Root stress and pressure over speed under the largest mesh force of every motion known there."""

from collections.abc import Collection, Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.geometry.bodies import BODIES
from facegear.strength.columns import STRESS_OVER_SPEED_COLUMNS
from facegear.strength.flank_contacts import FlankContact, largest_pressure
from facegear.ties import first_largest_rows

ALIKE = 1e-3
"""Motions whose largest forces differ by less, relative, are equally hard: most often they are one."""
ROUNDING = 1e-12
"""Of speeds, relative: of a path that ends at a limit."""
FORCE_COLUMNS = ("motion", "class", "speed_rpm", "mesh", "largest_force_n")


def swept_forces(sweep: pd.DataFrame) -> pd.DataFrame:
    """The mesh with the largest force at each speed and direction of a sweep, columns FORCE_COLUMNS."""
    rows = sweep[sweep["quantity"] == "largest_elastic_force_n"].reset_index(drop=True)
    worst = first_largest_rows(rows, "value", ["direction", "speed_rpm"])
    worst = worst.assign(motion="sweep " + worst["direction"])
    named = worst.rename(columns={"body_or_mesh": "mesh", "value": "largest_force_n"})
    return named[list(FORCE_COLUMNS)]


def branch_forces(branches: pd.DataFrame, speeds: Array) -> pd.DataFrame:
    """The same of every stable stretch of a branch at `speeds` (n,) rpm, between its points linearly.

    A stretch has both its ends. Speeds of points that differ from one of `speeds` by rounding are that one.
    """
    forces = []
    for (number, period), rows in branches.groupby(["branch", "period"], sort=False):
        worst = first_largest_rows(rows, "peak_force_n", ["point"], sort=True)
        speed = _without_rounding(worst["speed_rpm"].to_numpy(), speeds)
        force = worst["peak_force_n"].to_numpy()
        stable, meshes = worst["stable"].to_numpy(bool), worst["mesh"].to_numpy()
        goes_on = np.append(stable[2:], False)
        for at in np.flatnonzero(stable[:-1] & stable[1:]):
            first, last = speed[at : at + 2]
            inside = speeds[(speeds >= min(first, last)) & (speeds <= max(first, last))]
            inside = inside[inside != last] if goes_on[at] else inside
            part = (inside - first) / (last - first or 1.0)
            there = (1.0 - part) * force[at] + part * force[at + 1]
            mesh = meshes[at] if force[at] >= force[at + 1] else meshes[at + 1]
            forces += [
                (f"branch {number}", f"period-{period}", float(rpm), mesh, float(value))
                for rpm, value in zip(inside, there, strict=True)
            ]
    return pd.DataFrame(forces, columns=list(FORCE_COLUMNS))


def _without_rounding(values: Array, exact: Array) -> Array:
    """Values (m,) with the nearest of `exact` (n,) in the place of those that differ from it by rounding."""
    nearest = exact[np.abs(values[:, None] - exact).argmin(axis=1)]
    return np.where(np.abs(values - nearest) <= ROUNDING * nearest, nearest, values)


def stress_table(
    forces: pd.DataFrame,
    static_force: float,
    base_radius: float,
    contacts: Mapping[str, Collection[FlankContact]],
) -> pd.DataFrame:
    """Stress under each of `forces` (FORCE_COLUMNS), columns as STRESS_OVER_SPEED_COLUMNS.

    The force is taken to act all through the passage, on the flank where it does more. static_force (N): the
    largest of all meshes at rest, 0 without load; base_radius (m) of the pinion; contacts of each mesh, one a
    flank. `worst`: the hardest of all motions known at that speed, and those as hard.
    """
    torques = base_radius * forces["largest_force_n"].to_numpy()
    loads = list(zip([dict.fromkeys(contacts[mesh]) for mesh in forces["mesh"]], torques, strict=True))
    max_force = forces.groupby("speed_rpm")["largest_force_n"].transform("max")
    table = forces.assign(
        dynamic_factor=forces["largest_force_n"] / static_force if static_force > 0.0 else np.nan,
        **{
            f"{body}_mpa": [
                1e-6 * max(contact.tension[body](torque) for contact in near) for near, torque in loads
            ]
            for body in BODIES
        },
        pressure_mpa=[
            1e-6 * largest_pressure((contact, torque) for contact in near) for near, torque in loads
        ],
        within_torques_solved=[next(iter(near)).solved(torque) for near, torque in loads],
        worst=forces["largest_force_n"] >= (1.0 - ALIKE) * max_force,
    )
    return table.sort_values(["speed_rpm", "motion"], kind="stable", ignore_index=True)[
        list(STRESS_OVER_SPEED_COLUMNS)
    ]
