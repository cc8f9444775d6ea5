"""What one machine among many is judged by: a few numbers of its load sharing, quasi-static or in motion."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.bearing_forces import bearing_history
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.guide import Guide, guide_of
from facegear.dynamics.steady_state.simulate import build_model
from facegear.errors import NotConverged
from facegear.load_sharing.bearings import bearing_mass
from facegear.load_sharing.groups import load_groups
from facegear.load_sharing.hardest_cycles import hardest_cycles
from facegear.load_sharing.hunting import LoadHistory, hunting_cycle, hunting_length
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.quantity_names import PAST_LAW, quantity_names
from facegear.load_sharing.run import measured_motion
from facegear.load_sharing.statistics import defined_mean
from facegear.transmission.flanks import carried, past_law
from facegear.transmission.layout import Layout
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
    shared = _shared(machine.layout)
    values = (
        *np.maximum(run.mesh_load_factors, hard.mesh_load_factors)[shared],
        *_coefficients(run),
        max(run.loads.max(), hard.loads.max()),
        *_shares(run, shared),
        bearing_mass(run.bearings),
    )
    forces = run.flank_forces
    largest = np.maximum(forces.max(axis=0), hard.flank_forces.max(axis=0))
    named = _named(machine.layout, values, dynamic=False)
    if machine.tables is not None:
        past = (past_law(machine, motion.cycles, motion.flank_forces).max() for motion in (run, hard))
        named[PAST_LAW] = float(max(past))
    return named, FlankLoads(forces.mean(axis=0), largest)


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
    response = measured_motion(model, speed_rpm, settings, options, guide)
    forces = carried(response.forces)
    flanks = np.concatenate([np.maximum(forces, 0.0), np.maximum(-forces, 0.0)], axis=1)
    cycles = np.arange(len(flanks)) / response.per_period
    run, shared = LoadHistory(machine, response.per_period, cycles, flanks), _shared(machine.layout)
    values = (
        *run.mesh_load_factors[shared],
        *run.dynamic_factors[shared],
        *_coefficients(run),
        run.loads.max(),
        *_shares(run, shared),
        bearing_mass(bearing_history(model, response)),
    )
    loads = FlankLoads(flanks.mean(axis=0), flanks.max(axis=0))
    named = _named(machine.layout, values, dynamic=True)
    if machine.tables is not None:
        named[PAST_LAW] = float(response.past_law.max())
    return named, loads


def orbit_of(machine: Machine, speed_rpm: float, settings: Settings, options: SharingOptions) -> Guide | None:
    """The orbit that a machine comes to from static equilibrium as a guide for like ones, if it is one."""
    try:
        response = measured_motion(build_model(machine), speed_rpm, settings, options)
    except NotConverged:
        return None
    return guide_of(response.system, response.orbit)


def _named(layout: Layout, values: tuple[float, ...], dynamic: bool) -> dict[str, float]:
    return dict(zip(quantity_names(layout, dynamic), map(float, values), strict=True))


def _shared(layout: Layout) -> list[int]:
    """Meshes that share a load, group by group."""
    return [mesh for group in load_groups(layout) for mesh in group.meshes]


def _coefficients(run: LoadHistory) -> list[float]:
    """Mean coefficient of each group."""
    return [defined_mean(run.coefficients(group)) for group in run.groups]


def _shares(run: LoadHistory, shared: list[int]) -> tuple[float, float]:
    """Fraction of the time in which one of the meshes that share a load carries nothing, and in which a mesh
    is loaded on the flank that carries less on average.
    """
    drive, back = np.split(run.flank_forces, 2, axis=1)
    works_back = back.mean(axis=0) > drive.mean(axis=0)
    reversed_ = np.any(np.where(works_back, drive, back) > 0.0, axis=1)
    return float((run.loads[:, shared] == 0.0).any(axis=1).mean()), float(reversed_.mean())
