"""Root stress and pressure under the mesh forces of a running machine, at one speed and over speed."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.quantities import BODIES
from facegear.strength.columns import DYNAMIC_STRESS_COLUMNS, STRESS_OVER_SPEED_COLUMNS
from facegear.strength.flank_contacts import FlankContact, largest_pressure
from facegear.ties import first_largest_rows


def dynamic_stress_table(
    forces: Mapping[str, Array],
    positions: Mapping[str, Array],
    arms: Mapping[str, float],
    contacts: Mapping[str, Mapping[str, FlankContact]],
) -> pd.DataFrame:
    """Tabulate the stress of each mesh under its forces.

    `mean`: largest over the passage with the mesh's mean force, on the flank that carries more; `running`:
    largest of the history, every tooth with its share of the force of that moment (a tooth is quasi-static);
    `bound`: with the largest force of each flank all through the passage.

    Parameters
    ----------
    forces : Mapping[str, array]
        Forces along the normal of the loaded flank by mesh, (n,) N, negative on the back flank, evenly in
        time.
    positions : Mapping[str, array]
        Positions of the loaded flank in the mesh cycle by mesh, (n,), in pitches, in [0, 1).
    arms : Mapping[str, float]
        Torque on the pinion over the force of each flank along its normal, m.
    contacts : Mapping[str, Mapping[str, FlankContact]]
        Contacts by mesh and flank.

    Returns
    -------
    DataFrame
        One row a mesh, columns as DYNAMIC_STRESS_COLUMNS.
    """
    rows = [_row(mesh, force, positions[mesh], arms, contacts[mesh]) for mesh, force in forces.items()]
    return pd.DataFrame(rows, columns=list(DYNAMIC_STRESS_COLUMNS))


def _row(
    mesh: str,
    force: Array,
    positions: Array,
    arms: Mapping[str, float],
    contacts: Mapping[str, FlankContact],
) -> tuple[str | float | bool, ...]:
    """Return the row of DYNAMIC_STRESS_COLUMNS of one mesh: forces, dynamic factor, stress and pressure
    in MPa.

    `force` (n,), N, is negative on the back flank; `positions` (n,), in pitches, are those of the loaded
    flank; `arms` (m) and `contacts` go by flank. The dynamic factor is the largest over the mean magnitude of
    the force.
    """
    mean, max_force = float(np.abs(force).mean()), float(np.abs(force).max())
    by_flank = {"drive": np.maximum(force, 0.0), "back": np.maximum(-force, 0.0)}
    loaded_flanks = {flank: part for flank, part in by_flank.items() if part.any()} or {
        "drive": by_flank["drive"]
    }
    torques = {flank: arms[flank] * part for flank, part in loaded_flanks.items()}
    steady_flank = max(torques, key=lambda flank: float(torques[flank].mean()))
    steady, steady_torque = contacts[steady_flank], arms[steady_flank] * mean
    max_torque = {flank: float(part.max()) for flank, part in torques.items()}
    stresses: list[float] = []
    for body in BODIES:
        running = (contacts[at].history[body](part, positions) for at, part in torques.items())
        bounds = (contacts[at].history[body].over_passage(torque) for at, torque in max_torque.items())
        largest = max(float(values.max()) for values in running)
        stresses += [steady.tension[body](steady_torque), largest, max(bounds)]
    stresses.append(steady.pressure.at(steady_torque))
    stresses.append(largest_pressure((contacts[at], torque) for at, torque in max_torque.items()))
    within = all(steady.is_solved(torque) for torque in (steady_torque, max(max_torque.values())))
    factor = max_force / mean if mean > 0.0 else np.nan
    return (mesh, mean, max_force, factor, *(1e-6 * stress for stress in stresses), within)


EQUAL_FORCES = 1e-3
"""Relative difference of largest forces below which motions are equally hard: most often they are one."""
ROUNDING = 1e-12
"""Relative tolerance of speeds, for the rounding error of a path that ends at a limit."""
FORCE_COLUMNS = ("motion", "class", "speed_rpm", "mesh", "largest_force_n")
"""Columns of the tables of largest forces."""


def swept_forces(sweep: pd.DataFrame) -> pd.DataFrame:
    """Select the mesh with the largest force at each speed and direction of a sweep.

    Parameters
    ----------
    sweep : DataFrame
        Long table of a sweep: columns quantity, body_or_mesh, direction, speed_rpm, class and value; rows
        with quantity `largest_elastic_force_n` are used.

    Returns
    -------
    DataFrame
        Columns as FORCE_COLUMNS; `motion` is `sweep` and the direction.
    """
    rows = sweep[sweep["quantity"] == "largest_elastic_force_n"].reset_index(drop=True)
    worst = first_largest_rows(rows, "value", ["direction", "speed_rpm"])
    worst = worst.assign(motion="sweep " + worst["direction"])
    table = worst.rename(columns={"body_or_mesh": "mesh", "value": "largest_force_n"})
    return table[list(FORCE_COLUMNS)]


def branch_forces(branches: pd.DataFrame, speeds: Array) -> pd.DataFrame:
    """Select the mesh with the largest force on every stable stretch of a branch, at the given speeds it
    covers.

    Forces are interpolated linearly between the points of a branch. A stretch lies between two
    neighbouring stable points and has both its ends. Speeds of points that differ from one of `speeds` by
    rounding are that one.

    Parameters
    ----------
    branches : DataFrame
        Table of branches by point and mesh: columns branch, period, point, mesh, speed_rpm, peak_force_n,
        stable.
    speeds : (n,) array
        Speeds, rpm.

    Returns
    -------
    DataFrame
        Columns as FORCE_COLUMNS; `motion` is `branch` and its number, `class` the period as `period-2`.
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
            force_at_speed = (1.0 - part) * force[at] + part * force[at + 1]
            mesh = meshes[at] if force[at] >= force[at + 1] else meshes[at + 1]
            forces += [
                (f"branch {number}", f"period-{period}", float(rpm), mesh, float(value))
                for rpm, value in zip(inside, force_at_speed, strict=True)
            ]
    return pd.DataFrame(forces, columns=list(FORCE_COLUMNS))


def _without_rounding(values: Array, exact: Array) -> Array:
    """Return values (m,), each replaced by the nearest of `exact` (n,) if it differs from it by rounding
    alone.
    """
    nearest = exact[np.abs(values[:, None] - exact).argmin(axis=1)]
    return np.where(np.abs(values - nearest) <= ROUNDING * nearest, nearest, values)


def stress_table(
    forces: pd.DataFrame,
    static_force: float,
    arms: Mapping[str, float],
    contacts: Mapping[str, Mapping[str, FlankContact]],
) -> pd.DataFrame:
    """Tabulate the stress under the largest force of each motion.

    The force is taken to act all through the passage, on the flank where it does more. `worst`: the hardest
    of all motions known at that speed, and those as hard.

    Parameters
    ----------
    forces : DataFrame
        Columns as FORCE_COLUMNS.
    static_force : float
        Largest force of all meshes at rest, N; 0 without load.
    arms : Mapping[str, float]
        Torque on the pinion over the force of each flank along its normal, m.
    contacts : Mapping[str, Mapping[str, FlankContact]]
        Contacts by mesh and flank.

    Returns
    -------
    DataFrame
        Columns as STRESS_OVER_SPEED_COLUMNS.
    """
    loads = [
        list(dict.fromkeys((contact, arms[flank] * force) for flank, contact in contacts[mesh].items()))
        for mesh, force in zip(forces["mesh"], forces["largest_force_n"].to_numpy(), strict=True)
    ]
    max_force = forces.groupby("speed_rpm")["largest_force_n"].transform("max")
    table = forces.assign(
        dynamic_factor=forces["largest_force_n"] / static_force if static_force > 0.0 else np.nan,
        **{
            f"{body}_mpa": [
                1e-6 * max(contact.tension[body](torque) for contact, torque in near) for near in loads
            ]
            for body in BODIES
        },
        pressure_mpa=[1e-6 * largest_pressure(near) for near in loads],
        within_torques_solved=[all(contact.is_solved(torque) for contact, torque in near) for near in loads],
        worst=forces["largest_force_n"] >= (1.0 - EQUAL_FORCES) * max_force,
    )
    return table.sort_values(["speed_rpm", "motion"], kind="stable", ignore_index=True)[
        list(STRESS_OVER_SPEED_COLUMNS)
    ]
