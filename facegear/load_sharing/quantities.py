"""What one machine among many is judged by: a few numbers of its load sharing, quasi-static or in motion."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.bearing_forces import bearing_forces
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.guide import Guide, guide_of
from facegear.dynamics.steady_state.simulate import build_model
from facegear.errors import NotConverged
from facegear.load_sharing.bearings import bearing_mass
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.groups import LoadGroup, load_groups
from facegear.load_sharing.hardest_cycles import hardest_cycles
from facegear.load_sharing.hunting import hunting_cycle, hunting_length
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.quantity_names import PAST_LAW, quantity_names
from facegear.load_sharing.run import measured_motion
from facegear.load_sharing.tally import tally
from facegear.transmission.flanks import past_law
from facegear.transmission.machine import Machine

POSITIONS = 8
"""Positions of a mesh cycle in the quasi-static motion."""


@dataclass(frozen=True, eq=False)
class FlankLoads:
    """Mean and largest force of every flank (2 meshes,), N, drive flanks first."""

    mean: Array
    largest: Array


Found = tuple[dict[str, float], FlankLoads]
"""What a machine is judged by, and the loads of its flanks."""


def quasi_static_quantities(machine: Machine, cycles: int) -> Found:
    """Of `cycles` mesh cycles spread over the hunting cycle; the largest loads also of its hardest ones.

    Raises NotConverged.
    """
    run = hunting_cycle(machine, POSITIONS, max(hunting_length(machine) // cycles, 1))
    hard = hardest_cycles(run)
    groups, shared, even, names = _counted(machine.without_errors, dynamic=False)
    counted, hardest = (tally(motion.flank_forces.T, POSITIONS, groups) for motion in (run, hard))
    largest_mean = np.maximum(counted.largest_mean, hardest.largest_mean)
    largest = np.maximum(counted.largest, hardest.largest)
    values = (
        *(largest_mean / even)[shared],
        *(value for value, group in zip(counted.coefficients, groups, strict=True) if group.splits_load),
        largest.max(),
        counted.open,
        counted.reversed,
        bearing_mass(np.moveaxis(run.bearings, 0, -1)),
    )
    named = dict(zip(names, map(float, values), strict=True))
    if machine.tables is not None:
        past = (past_law(machine, motion.cycles, motion.flank_forces).max() for motion in (run, hard))
        named[PAST_LAW] = float(max(past))
    return named, FlankLoads(counted.mean, largest)


def dynamic_quantities(
    machine: Machine,
    speed_rpm: float,
    settings: Settings,
    options: SharingOptions,
    guide: Guide | None = None,
) -> Found:
    """Of the motion reached from static equilibrium; `guide`: an orbit of a like machine.

    Raises NotConverged naming the speed.
    """
    model = build_model(machine)
    motion = measured_motion(model, speed_rpm, settings, options, guide)
    groups, shared, even, names = _counted(machine.without_errors, dynamic=True)
    counted = tally(motion.flank_loads, motion.per_period, groups)
    loaded = np.where(counted.largest_mean > 0.0, counted.largest_mean, np.nan)
    values = (
        *(counted.largest_mean / even)[shared],
        *(counted.largest_load / loaded)[shared],
        *(value for value, group in zip(counted.coefficients, groups, strict=True) if group.splits_load),
        counted.largest.max(),
        counted.open,
        counted.reversed,
        bearing_mass(bearing_forces(model, motion.track)),
    )
    named = dict(zip(names, map(float, values), strict=True))
    if machine.tables is not None:
        named[PAST_LAW] = float(motion.past_law.max())
    return named, FlankLoads(counted.mean, counted.largest)


def orbit_of(machine: Machine, speed_rpm: float, settings: Settings, options: SharingOptions) -> Guide | None:
    """The orbit that a machine comes to from static equilibrium as a guide for like ones, if it is one."""
    try:
        response = measured_motion(build_model(machine), speed_rpm, settings, options).response
    except NotConverged:
        return None
    integrator = Integrator(response.system, response.frequency, settings.tolerance, settings.order)
    return guide_of(integrator, response.orbit)


class _Counted(NamedTuple):
    """Groups of meshes that share a load, their meshes group by group, even share of each mesh (meshes,), N,
    and the names of what is counted.
    """

    groups: tuple[LoadGroup, ...]
    shared: list[int]
    even: Array
    names: tuple[str, ...]


@lru_cache(maxsize=8)
def _counted(machine: Machine, dynamic: bool) -> _Counted:
    layout, groups = machine.layout, load_groups(machine.layout)
    shared = [mesh for group in groups for mesh in group.meshes]
    return _Counted(groups, shared, even_shares(machine), quantity_names(layout, dynamic))
