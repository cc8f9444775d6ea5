"""What one machine among many is judged by: a few numbers of its load sharing, quasi-static or in motion."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.bearing_forces import bearing_history
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import build_model
from facegear.load_sharing.bearings import bearing_mass
from facegear.load_sharing.coefficients import sharing_coefficient
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.groups import load_groups
from facegear.load_sharing.hardest_cycles import hardest_cycles
from facegear.load_sharing.hunting import hunting_cycle, hunting_length
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.quantity_names import quantity_names
from facegear.load_sharing.run import load_sharing
from facegear.load_sharing.statistics import defined_mean
from facegear.transmission.flanks import carried
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine

Array = NDArray[np.float64]
POSITIONS = 8
"""Positions of a mesh cycle in the quasi-static motion."""


def quasi_static_quantities(machine: Machine, cycles: int) -> dict[str, float]:
    """Of `cycles` mesh cycles spread over the hunting cycle; the largest loads also of its hardest ones.

    Raises NotConverged.
    """
    run = hunting_cycle(machine, POSITIONS, max(hunting_length(machine) // cycles, 1))
    hard = hardest_cycles(run)
    means = np.concatenate([run.cycle_means, hard.cycle_means]).max(axis=0)
    peak = max(run.loads.max(), hard.loads.max())
    shared, coefficients = _shared(machine.layout), _coefficients(machine.layout, run.loads)
    drive, back = np.split(run.flank_forces, 2, axis=1)
    found = (
        *(means / even_shares(machine))[shared],
        *coefficients,
        *(peak, _opened(run.loads[:, shared]), _reversed(drive, back).mean(), bearing_mass(run.bearings)),
    )
    return _named(machine.layout, found, dynamic=False)


def dynamic_quantities(
    machine: Machine, speed_rpm: float, settings: Settings, options: SharingOptions
) -> dict[str, float]:
    """Of the motion reached from static equilibrium. Raises NotConverged naming the speed."""
    model = build_model(machine)
    response = load_sharing(model, speed_rpm, settings, options).response
    forces = carried(response.forces)
    drive, back, loads = np.maximum(forces, 0.0), np.maximum(-forces, 0.0), np.abs(forces)
    means = loads.reshape(response.periods, response.per_period, -1).mean(axis=1).max(axis=0)
    shared, mass = _shared(machine.layout), bearing_mass(bearing_history(model, response))
    found = (
        *(means / even_shares(machine))[shared],
        *(loads.max(axis=0) / np.where(means > 0.0, means, np.nan))[shared],
        *_coefficients(machine.layout, loads),
        *(loads.max(), _opened(loads[:, shared]), _reversed(drive, back).mean(), mass),
    )
    return _named(machine.layout, found, dynamic=True)


def _named(layout: Layout, found: tuple[float, ...], dynamic: bool) -> dict[str, float]:
    return dict(zip(quantity_names(layout, dynamic), map(float, found), strict=True))


def _shared(layout: Layout) -> list[int]:
    """Meshes that share a load, group by group."""
    return [mesh for group in load_groups(layout) for mesh in group.meshes]


def _coefficients(layout: Layout, loads: Array) -> list[float]:
    """Mean coefficient of each group from the loads of all meshes (K, meshes), N."""
    return [defined_mean(sharing_coefficient(loads[:, list(group.meshes)])) for group in load_groups(layout)]


def _opened(loads: Array) -> float:
    """Share of the time in which one of the meshes carries nothing; loads (K, meshes), N."""
    return float((loads == 0.0).any(axis=1).mean())


def _reversed(drive: Array, back: Array) -> NDArray[np.bool_]:
    """Where a mesh is loaded on the flank that carries less on average (K,); loads of both (K, meshes)."""
    works_back = back.mean(axis=0) > drive.mean(axis=0)
    return np.any(np.where(works_back, drive, back) > 0.0, axis=1)
