"""Load sharing of the running machine while its runouts turn, beside the quasi-static one."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.dynamics.between_samples import located_extremes
from facegear.dynamics.following import FollowedMotion, follow
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import build_model
from facegear.load_sharing.groups import LoadGroup
from facegear.load_sharing.hunting import HuntingCycle, LoadHistory, largest
from facegear.load_sharing.hunting_tables import mesh_table
from facegear.transmission.flanks import carried
from facegear.transmission.machine import Machine


@dataclass(frozen=True, eq=False)
class Running(LoadHistory):
    """The motion at a speed; `lead` and `memory` as in facegear.dynamics.following.FollowedMotion."""

    speed_rpm: float
    lead: int
    memory: float

    @cached_property
    def largest_loads(self) -> Array:
        """Largest load of each mesh (meshes,), N, located between the positions."""
        return located_extremes(self.loads, False)[1]


def running(
    machine: Machine, speed_rpm: float, cycles: int, positions: int = 64, settings: Settings | None = None
) -> Running:
    """The first `cycles` mesh cycles of the hunting cycle at a speed. Raises NotConverged."""
    following: FollowedMotion = follow(build_model(machine), speed_rpm, 0, cycles, positions, settings)
    return Running(
        machine=machine,
        positions=positions,
        cycles=following.cycles,
        flank_forces=carried(following.flank_forces),
        speed_rpm=speed_rpm,
        lead=following.lead,
        memory=following.memory,
    )


def running_mesh_table(moving: Running) -> pd.DataFrame:
    """As the table of the machine at rest, with the dynamic factor K_v of every mesh."""
    table = mesh_table(moving)
    table.insert(table.columns.get_loc("k_gamma") + 1, "k_v", moving.dynamic_factors)
    return table


RUNNING_COLUMNS = (
    *("group", "kind", "speed_rpm", "mesh_cycles", "mean", "torque_n_m", "k_gamma", "k_v"),
    *("k_gamma_static", "k_gamma_static_whole", "cut", "sampling", "lead_cycles", "memory"),
)


def running_table(moving: Running, still: HuntingCycle) -> pd.DataFrame:
    """One row a group: K_gamma while running, quasi-static over the same cycles and over all; K_v.

    `still` is the whole hunting cycle. k_v: dynamic factor of the path whose K_gamma stands there. cut: what
    following a part of it only does to the quasi-static K_gamma, relative; sampling: what every second sample
    alone does to the running K_gamma K_v. memory: difference between two starts, over the largest flank
    force. torque_n_m: largest torque on a pinion.
    """
    count = len(moving.cycles) // moving.positions
    part = replace(still, flank_forces=still.flank_forces[: count * still.positions])
    coarse = replace(moving, flank_forces=moving.flank_forces[::2], positions=moving.positions // 2)
    rows = []
    for group in moving.groups:
        quasi, whole = (largest(torque.path_factors(group)) for torque in (part, still))
        coefficient, factor = moving.coefficients(group), largest(moving.path_factors(group))
        dynamic = _dynamic_factor(moving, group)
        rows.append(
            {
                "group": group.name,
                "kind": group.kind.value,
                "speed_rpm": moving.speed_rpm,
                "mesh_cycles": count,
                "mean": np.nanmean(coefficient) if np.isfinite(coefficient).any() else np.nan,
                "torque_n_m": moving.largest_torque,
                "k_gamma": factor,
                "k_v": dynamic,
                "k_gamma_static": quasi,
                "k_gamma_static_whole": whole,
                "cut": quasi / whole - 1.0,
                "sampling": largest(coarse.path_factors(group))
                * _dynamic_factor(coarse, group)
                / (factor * dynamic)
                - 1.0,
                "lead_cycles": moving.lead,
                "memory": moving.memory,
            }
        )
    return pd.DataFrame(rows, columns=list(RUNNING_COLUMNS))


def _dynamic_factor(moving: LoadHistory, group: LoadGroup) -> float:
    """K_v of the path with the largest K_gamma, nan where no path has one."""
    factors = moving.path_factors(group)
    if not np.isfinite(factors).any():
        return float("nan")
    return float(moving.dynamic_factors[group.meshes[int(np.nanargmax(factors))]])
