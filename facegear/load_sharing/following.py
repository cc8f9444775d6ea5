"""Load sharing of the running machine while its runouts turn, beside the quasi-static one."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.dynamics.following import Followed, follow
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import build_model
from facegear.load_sharing.hunting import HuntingCycle, LoadHistory
from facegear.transmission.machine import Machine


@dataclass(frozen=True, eq=False)
class Running(LoadHistory):
    """The motion at a speed; `lead` and `memory` as in facegear.dynamics.following.Followed."""

    speed_rpm: float
    lead: int
    memory: float


def running(
    machine: Machine, speed_rpm: float, cycles: int, positions: int = 64, settings: Settings | None = None
) -> Running:
    """The first `cycles` mesh cycles of the hunting cycle at a speed. Raises NotConverged."""
    found: Followed = follow(build_model(machine), speed_rpm, 0, cycles, positions, settings)
    return Running(
        machine=machine,
        positions=positions,
        cycles=found.cycles,
        flank_forces=found.flank_forces,
        speed_rpm=speed_rpm,
        lead=found.lead,
        memory=found.memory,
    )


def running_table(moving: Running, still: HuntingCycle) -> pd.DataFrame:
    """One row a group: path factor K_gamma while running, quasi-static over the same cycles and over all.

    `still` is the whole hunting cycle. cut: what following a part of it only does to the quasi-static factor,
    relative; sampling: what every second sample alone does to the running one. memory: difference between two
    starts, over the largest flank force.
    """
    count = len(moving.cycles) // moving.positions
    part = replace(still, flank_forces=still.flank_forces[: count * still.positions])
    coarse = replace(moving, flank_forces=moving.flank_forces[::2])
    rows = []
    for group in moving.groups:
        quasi, whole = (float(one.path_factors(group).max()) for one in (part, still))
        coefficient, factor = moving.coefficients(group), float(moving.path_factors(group).max())
        rows.append(
            {
                "group": group.name,
                "kind": group.kind.value,
                "speed_rpm": moving.speed_rpm,
                "mesh_cycles": count,
                "mean": np.nanmean(coefficient) if np.isfinite(coefficient).any() else np.nan,
                "k_gamma": factor,
                "k_gamma_static": quasi,
                "k_gamma_static_whole": whole,
                "cut": quasi / whole - 1.0,
                "sampling": coarse.path_factors(group).max() / factor - 1.0,
                "lead_cycles": moving.lead,
                "memory": moving.memory,
            }
        )
    return pd.DataFrame(rows)
