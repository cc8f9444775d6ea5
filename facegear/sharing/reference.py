"""References of the dynamic coefficients: the machine at rest, run slowly, at all speeds."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.harmonics import Harmonics
from facegear.machine.flanks import significant_forces
from facegear.machine.machine import Machine
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import static_equilibrium
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.motion.sweeps.sweep import carried_over
from facegear.progress import Progress
from facegear.sharing.even_shares import group_average, lost_contact, sharing_coefficient
from facegear.sharing.groups import SharingOptions, split_groups
from facegear.sharing.run import FIRST_WINDOW, follow_first_window, watched_for
from facegear.sharing.statistics import average, densely_sampled


def static_forces(machine: Machine, positions: int) -> Array:
    """Compute the elastic mesh forces by static equilibrium at evenly spaced positions of one mesh cycle.

    Stiffness and transmission error are frozen at each position. This is the limit of slow running:
    damping and inertia vanish, and who carries load follows from stiffness, backlash and transmission
    error alone.

    Parameters
    ----------
    machine : Machine
        The machine.
    positions : int
        Number of positions in the mesh cycle, from its start.

    Returns
    -------
    (1, positions, meshes) array
        N, positive where the pinion drives; the first axis is the cycle.

    Raises
    ------
    NotConverged
        If no equilibrium is found; the message names the position.
    """
    static_machine, cycles = at_rest(machine), np.arange(positions) / positions
    return significant_forces(
        np.array([[static_equilibrium(static_machine, float(at)).forces for at in cycles]])
    )


def mean_equilibrium_forces(machine: Machine) -> Array:
    """Compute the elastic mesh forces by static equilibrium at mean stiffness, without transmission error.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    (1, 1, meshes) array
        N, one cycle with one position.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    return significant_forces(static_equilibrium(at_rest(machine)).forces[None, None, :])


SHARES = ("maximum", "lost_fraction", "undefined_fraction")
"""Columns of both tables."""
REFERENCE_COLUMNS = ("quantity", "group", "kind", "mean", "minimum", *SHARES)
"""Columns of reference_table()."""
SPEED_COLUMNS = ("speed_rpm", "group", "kind", "mean", "half_width", *SHARES, "motion")
"""Columns of speed_range_table()."""
POSITIONS = 64
"""Positions in a mesh cycle."""
SLOW_PERIODS = 4
"""Mesh cycles that the slow run lasts."""


def reference_table(machine: Machine, settings: Settings, options: SharingOptions) -> pd.DataFrame:
    """Compute the coefficients without dynamics.

    `static`: equilibrium at every position of the mesh cycle; `quasi_static`: the same model run slowly,
    which tends to the static one; `equilibrium`: mean stiffness, no transmission error; `no_error` and
    `no_error_no_backlash`: the static one without errors (e(t), constant ones of single meshes, pinions out
    of place) and without backlash. Runouts and pitch deviations are in none of them.

    Parameters
    ----------
    machine : Machine
        The machine.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Speed of the slow run.

    Returns
    -------
    pd.DataFrame
        One row a quantity and group, columns REFERENCE_COLUMNS.

    Raises
    ------
    NotConverged
        If an equilibrium or a motion is not found.
    """
    machine = replace(machine, imperfections=machine.imperfections.without_slow_errors)
    imperfections = machine.imperfections
    quiet = replace(
        imperfections,
        series={},
        error=np.zeros_like(imperfections.error),
        position=np.zeros_like(imperfections.position),
        outwards=np.zeros_like(imperfections.outwards),
    )
    silent = replace(machine, error=Harmonics(np.zeros(1), np.zeros(1)), imperfections=quiet)
    tight = replace(silent, half_backlash=np.zeros(len(machine.layout.meshes)))
    cases = {
        "static": static_forces(machine, POSITIONS),
        "quasi_static": slow_forces(machine, settings, options.slow_rpm),
        "equilibrium": mean_equilibrium_forces(machine),
        "no_error": static_forces(silent, POSITIONS),
        "no_error_no_backlash": static_forces(tight, POSITIONS),
    }
    rows = [row for quantity, forces in cases.items() for row in _rows(machine, quantity, forces)]
    return pd.DataFrame(rows, columns=list(REFERENCE_COLUMNS))


def slow_forces(machine: Machine, settings: Settings, speed_rpm: float) -> Array:
    """Integrate the motion at a low speed and return the elastic mesh forces over its last mesh cycle.

    A cycle lasts many decay times there, so SLOW_PERIODS cycles from equilibrium are settled.

    Parameters
    ----------
    machine : Machine
        The machine.
    settings : Settings
        Settings of the integration; samples, dwell, settle, window and refine are replaced.
    speed_rpm : float
        Low speed of the pinions, rpm.

    Returns
    -------
    (1, positions, meshes) array
        N, at POSITIONS evenly spaced instants.
    """
    slow = replace(
        settings, samples=POSITIONS, dwell=SLOW_PERIODS, settle=SLOW_PERIODS, window=1, refine=False
    )
    response = simulate(build_model(machine), speed_rpm, slow)
    forces = significant_forces(response.forces).reshape(response.periods, response.per_period, -1)[-1:]
    return forces[:, :: forces.shape[1] // POSITIONS]


def speed_range_table(machine: Machine, settings: Settings, options: SharingOptions) -> pd.DataFrame:
    """Tabulate mean and largest coefficient of each group over a range of speeds, each started from the
    last state.

    Parameters
    ----------
    machine : Machine
        The machine.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Range of speeds, mesh cycles averaged, and confidence level.

    Returns
    -------
    pd.DataFrame
        One row a speed and group, columns SPEED_COLUMNS (`speed_rpm` of the pinions, `motion` the class
        of motion). No rows, and no run, where no meshes share a load.
    """
    if not split_groups(machine.layout):
        return pd.DataFrame(columns=list(SPEED_COLUMNS))
    speeds = np.linspace(options.speeds.first, options.speeds.last, options.speeds.points)
    progress = Progress("load sharing over speed", speeds.size)
    model, rows = build_model(machine), []
    responses = carried_over(
        model,
        speeds,
        watched_for(settings, options, FIRST_WINDOW),
        None,
        lambda motion: follow_first_window(model, motion, settings, options),
        progress.step,
    )
    for speed, response in zip(speeds, responses, strict=True):
        motion = densely_sampled(response)
        for group in split_groups(machine.layout):
            sharing_average = group_average(motion, group, options.confidence)[2]
            rows.append(
                {
                    "speed_rpm": speed,
                    "group": group.name,
                    "kind": group.kind.value,
                    "mean": sharing_average.mean,
                    "half_width": sharing_average.half_width,
                    "maximum": sharing_average.maximum,
                    "lost_fraction": sharing_average.lost_fraction,
                    "undefined_fraction": sharing_average.undefined_fraction,
                    "motion": response.label,
                }
            )
    return pd.DataFrame(rows, columns=list(SPEED_COLUMNS))


def _rows(machine: Machine, quantity: str, forces: Array) -> list[dict[str, object]]:
    """Return one row (columns REFERENCE_COLUMNS) for each group that splits a load, from forces (cycles,
    positions, meshes), N; `quantity` names the case.
    """
    rows: list[dict[str, object]] = []
    for group in split_groups(machine.layout):
        group_forces = forces[..., group.meshes]
        mesh_average = average(sharing_coefficient(group_forces), lost_contact(group_forces), periodic=True)
        rows.append(
            {
                "quantity": quantity,
                "group": group.name,
                "kind": group.kind.value,
                "mean": mesh_average.mean,
                "minimum": mesh_average.minimum,
                "maximum": mesh_average.maximum,
                "lost_fraction": mesh_average.lost_fraction,
                "undefined_fraction": mesh_average.undefined_fraction,
            }
        )
    return rows
