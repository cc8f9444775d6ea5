"""Load sharing of the running machine while its runouts turn, beside the quasi-static one."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.flanks import significant_forces
from facegear.machine.machine import Machine
from facegear.motion.between_samples import located_extremes
from facegear.motion.hunting_motion import FollowedMotion, follow
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model
from facegear.sharing.groups import LoadGroup
from facegear.sharing.hunting import HuntingCycle, LoadHistory, largest, mesh_table


@dataclass(frozen=True, eq=False)
class Running(LoadHistory):
    """Motion at a speed; `lead` and `memory` as in facegear.motion.hunting_motion.FollowedMotion."""

    speed_rpm: float
    lead: int
    memory: float

    @cached_property
    def largest_loads(self) -> Array:
        """Largest load (meshes,), N, of each mesh, interpolated between the instants."""
        return located_extremes(self.loads, False)[1]


def running(
    machine: Machine, speed_rpm: float, cycles: int, positions: int = 64, settings: Settings | None = None
) -> Running:
    """Follow the motion at a speed through the first mesh cycles of the hunting cycle, with all errors
    that turn.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    speed_rpm : float
        Speed of the pinions, rpm.
    cycles : int
        Number of mesh cycles returned; the run-up (`lead`) before them is found and left out.
    positions : int
        Number of instants in each mesh cycle.
    settings : Settings or None
        Settings of the integration; None: its defaults.

    Returns
    -------
    Running
        Flank forces (N) at K = cycles x positions instants.

    Raises
    ------
    NotConverged
        If the integration fails.
    """
    history: FollowedMotion = follow(build_model(machine), speed_rpm, 0, cycles, positions, settings)
    return Running(
        machine=machine,
        positions=positions,
        cycles=history.cycles,
        flank_forces=significant_forces(history.flank_forces),
        speed_rpm=speed_rpm,
        lead=history.lead,
        memory=history.memory,
    )


def running_mesh_table(run: Running) -> pd.DataFrame:
    """Tabulate loads and states of each mesh while running: `mesh_table` with the dynamic factor K_v added.

    Parameters
    ----------
    run : Running
        The motion.

    Returns
    -------
    pd.DataFrame
        One row a mesh, columns MESH_COLUMNS of `facegear.sharing.hunting`, with k_v after k_gamma.
    """
    table = mesh_table(run)
    table.insert(table.columns.get_loc("k_gamma") + 1, "k_v", run.dynamic_factors)
    return table


RUNNING_COLUMNS = (
    *("group", "kind", "speed_rpm", "mesh_cycles", "mean", "torque_n_m", "k_gamma", "k_v"),
    *("k_gamma_static", "k_gamma_static_whole", "cut", "sampling", "lead_cycles", "memory"),
)
"""Columns of running_table()."""


def running_table(run: Running, still: HuntingCycle) -> pd.DataFrame:
    """Compare the load sharing of the running machine with the quasi-static one, group by group.

    K_gamma (largest of the group) is given while running, quasi-static over the same cycles and over all.
    k_v: dynamic factor of the mesh whose K_gamma is listed. cut: relative error of the quasi-static
    K_gamma by following a part of the hunting cycle only; sampling: relative change of the running
    K_gamma K_v by every second sample alone. memory: difference between two starts, over the largest
    flank force. torque_n_m: largest torque on a pinion. lead_cycles: mesh cycles run before.

    Parameters
    ----------
    run : Running
        The motion over the first mesh cycles of the hunting cycle.
    still : HuntingCycle
        The whole hunting cycle at rest, quasi-static.

    Returns
    -------
    pd.DataFrame
        One row a group, columns RUNNING_COLUMNS.
    """
    count = len(run.cycles) // run.positions
    part = replace(still, flank_forces=still.flank_forces[: count * still.positions])
    coarse = replace(run, flank_forces=run.flank_forces[::2], positions=run.positions // 2)
    rows = []
    for group in run.groups:
        quasi, whole = (largest(torque.path_factors(group)) for torque in (part, still))
        coefficient, factor = run.coefficients(group), largest(run.path_factors(group))
        dynamic = _dynamic_factor(run, group)
        rows.append(
            {
                "group": group.name,
                "kind": group.kind.value,
                "speed_rpm": run.speed_rpm,
                "mesh_cycles": count,
                "mean": np.nanmean(coefficient) if np.isfinite(coefficient).any() else np.nan,
                "torque_n_m": run.largest_torque,
                "k_gamma": factor,
                "k_v": dynamic,
                "k_gamma_static": quasi,
                "k_gamma_static_whole": whole,
                "cut": quasi / whole - 1.0,
                "sampling": largest(coarse.path_factors(group))
                * _dynamic_factor(coarse, group)
                / (factor * dynamic)
                - 1.0,
                "lead_cycles": run.lead,
                "memory": run.memory,
            }
        )
    return pd.DataFrame(rows, columns=list(RUNNING_COLUMNS))


def _dynamic_factor(history: LoadHistory, group: LoadGroup) -> float:
    """Return K_v of the mesh with the group's largest K_gamma, dimensionless; nan where no mesh has one."""
    factors = history.path_factors(group)
    if not np.isfinite(factors).any():
        return float("nan")
    return float(history.dynamic_factors[group.meshes[int(np.nanargmax(factors))]])
