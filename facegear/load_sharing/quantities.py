"""Quantities by which one machine among many is judged: its load sharing, quasi-static or in motion."""

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


MachineQuantities = tuple[dict[str, float], FlankLoads]
"""Values of the quantities by their names, and the loads of the flanks."""


def quasi_static_quantities(machine: Machine, cycles: int) -> MachineQuantities:
    """Compute the quantities of mesh cycles spread over the hunting cycle; the largest loads also of its
    hardest cycles.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    cycles : int
        Number of mesh cycles.

    Returns
    -------
    MachineQuantities
        Values in the units of `quantity_names`, forces in N.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    run = hunting_cycle(machine, POSITIONS, max(hunting_length(machine) // cycles, 1))
    hard = hardest_cycles(run)
    groups, sharing_meshes, even, names = _meshes_that_share(machine.without_errors, dynamic=False)
    counts, hardest = (tally(motion.flank_forces.T, POSITIONS, groups) for motion in (run, hard))
    largest_mean = np.maximum(counts.largest_mean, hardest.largest_mean)
    largest = np.maximum(counts.largest, hardest.largest)
    values = (
        *(largest_mean / even)[sharing_meshes],
        *(value for value, group in zip(counts.coefficients, groups, strict=True) if group.splits_load),
        largest.max(),
        counts.open,
        counts.reversed_fraction,
        bearing_mass(np.moveaxis(run.bearings, 0, -1)),
    )
    quantities = dict(zip(names, map(float, values), strict=True))
    if machine.tables is not None:
        past = (past_law(machine, motion.cycles, motion.flank_forces).max() for motion in (run, hard))
        quantities[PAST_LAW] = float(max(past))
    return quantities, FlankLoads(counts.mean, largest)


def dynamic_quantities(
    machine: Machine,
    speed_rpm: float,
    settings: Settings,
    options: SharingOptions,
    guide: Guide | None = None,
) -> MachineQuantities:
    """Compute the quantities of the motion reached from static equilibrium.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Cycles and samples.
    guide : Guide or None
        Orbit of a similar machine, from which the search starts.

    Returns
    -------
    MachineQuantities
        Values in the units of `quantity_names`, forces in N.

    Raises
    ------
    NotConverged
        If the integration fails; the message names the speed.
    """
    model = build_model(machine)
    motion = measured_motion(model, speed_rpm, settings, options, guide)
    groups, sharing_meshes, even, names = _meshes_that_share(machine.without_errors, dynamic=True)
    counts = tally(motion.flank_loads, motion.per_period, groups)
    largest_means = np.where(counts.largest_mean > 0.0, counts.largest_mean, np.nan)
    values = (
        *(counts.largest_mean / even)[sharing_meshes],
        *(counts.largest_load / largest_means)[sharing_meshes],
        *(value for value, group in zip(counts.coefficients, groups, strict=True) if group.splits_load),
        counts.largest.max(),
        counts.open,
        counts.reversed_fraction,
        bearing_mass(bearing_forces(model, motion.track)),
    )
    quantities = dict(zip(names, map(float, values), strict=True))
    if machine.tables is not None:
        quantities[PAST_LAW] = float(motion.past_law.max())
    return quantities, FlankLoads(counts.mean, counts.largest)


def orbit_of(machine: Machine, speed_rpm: float, settings: Settings, options: SharingOptions) -> Guide | None:
    """Return the orbit that a machine comes to from static equilibrium, as a guide for similar machines.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Cycles and samples.

    Returns
    -------
    Guide or None
        None where the motion is no orbit, or where the integration fails.
    """
    try:
        response = measured_motion(build_model(machine), speed_rpm, settings, options).response
    except NotConverged:
        return None
    integrator = Integrator(response.system, response.frequency, settings.tolerance, settings.order)
    return guide_of(integrator, response.orbit)


class _SharingMeshes(NamedTuple):
    """Groups of meshes that share a load, their meshes group by group, even share of each mesh (meshes,), N,
    and the names of the quantities.
    """

    groups: tuple[LoadGroup, ...]
    sharing_meshes: list[int]
    even: Array
    names: tuple[str, ...]


@lru_cache(maxsize=8)
def _meshes_that_share(machine: Machine, dynamic: bool) -> _SharingMeshes:
    layout, groups = machine.layout, load_groups(machine.layout)
    sharing_meshes = [mesh for group in groups for mesh in group.meshes]
    return _SharingMeshes(groups, sharing_meshes, even_shares(machine), quantity_names(layout, dynamic))
