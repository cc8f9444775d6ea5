"""What the dynamic coefficients are held against: the machine at rest, run slowly, at all speeds."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.dynamics.sweeps.sweep import carried_over
from facegear.harmonics.series import Harmonics
from facegear.load_sharing.coefficients import lost_contact, sharing_coefficient
from facegear.load_sharing.groups import split_groups
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.run import WATCHED, followed, group_average, watched_for
from facegear.load_sharing.sampling import densely_sampled
from facegear.load_sharing.statics import mean_equilibrium_forces, static_forces
from facegear.load_sharing.statistics import average
from facegear.progress import Progress
from facegear.transmission.flanks import significant_forces
from facegear.transmission.machine import Machine

SHARES = ("maximum", "lost_fraction", "undefined_fraction")
REFERENCE_COLUMNS = ("quantity", "group", "kind", "mean", "minimum", *SHARES)
SPEED_COLUMNS = ("speed_rpm", "group", "kind", "mean", "half_width", *SHARES, "motion")
POSITIONS = 64
SLOW_PERIODS = 4


def reference_table(machine: Machine, settings: Settings, options: SharingOptions) -> pd.DataFrame:
    """Coefficients without dynamics, one row a quantity and group.

    `static`: equilibrium at every position of the mesh cycle; `quasi_static`: the same model run slowly,
    which tends to the static one; `equilibrium`: mean stiffness, no transmission error; `no_error` and
    `no_error_no_backlash`: the static one without errors (e(t), constant ones of single meshes, pinions out
    of place) and without backlash. Runouts and pitch deviations are in none of them. Raises NotConverged.
    """
    machine = replace(machine, imperfections=machine.imperfections.without_slow_errors)
    given = machine.imperfections
    quiet = replace(
        given, series={}, error=np.zeros_like(given.error), position=np.zeros_like(given.position)
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
    """Elastic mesh forces over one cycle at a low speed, shape (1, positions, meshes), N.

    A cycle lasts many decay times there, so a few cycles from equilibrium are settled.
    """
    slow = replace(
        settings, samples=POSITIONS, dwell=SLOW_PERIODS, settle=SLOW_PERIODS, window=1, refine=False
    )
    response = simulate(build_model(machine), speed_rpm, slow)
    forces = significant_forces(response.forces).reshape(response.periods, response.per_period, -1)[-1:]
    return forces[:, :: forces.shape[1] // POSITIONS]


def speed_range_table(machine: Machine, settings: Settings, options: SharingOptions) -> pd.DataFrame:
    """Mean and largest coefficient of each group over a range of speeds, the state carried upward.

    No rows, and no run, where no meshes share a load.
    """
    if not split_groups(machine.layout):
        return pd.DataFrame(columns=list(SPEED_COLUMNS))
    speeds = np.linspace(options.speeds.first, options.speeds.last, options.speeds.points)
    progress = Progress("load sharing over speed", speeds.size)
    model, rows = build_model(machine), []
    responses = carried_over(
        model,
        speeds,
        watched_for(settings, options, WATCHED),
        None,
        lambda motion: followed(model, motion, settings, options),
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
                    "lost_fraction": sharing_average.lost,
                    "undefined_fraction": sharing_average.undefined,
                    "motion": response.label,
                }
            )
    return pd.DataFrame(rows, columns=list(SPEED_COLUMNS))


def _rows(machine: Machine, quantity: str, forces: Array) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for group in split_groups(machine.layout):
        own = forces[..., group.meshes]
        mesh_average = average(sharing_coefficient(own), lost_contact(own), periodic=True)
        rows.append(
            {
                "quantity": quantity,
                "group": group.name,
                "kind": group.kind.value,
                "mean": mesh_average.mean,
                "minimum": mesh_average.minimum,
                "maximum": mesh_average.maximum,
                "lost_fraction": mesh_average.lost,
                "undefined_fraction": mesh_average.undefined,
            }
        )
    return rows
