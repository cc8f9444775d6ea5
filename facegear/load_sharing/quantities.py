"""What one machine among many is judged by: a few numbers of its load sharing, quasi-static or in motion."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.bearing_forces import bearing_history
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.simulate import build_model
from facegear.load_sharing.bearings import bearing_mass
from facegear.load_sharing.coefficients import sharing_coefficient
from facegear.load_sharing.groups import load_groups
from facegear.load_sharing.hunting import hunting_cycle, hunting_length
from facegear.load_sharing.options import SharingOptions
from facegear.load_sharing.quantity_names import quantity_names
from facegear.load_sharing.run import load_sharing
from facegear.load_sharing.statistics import defined_mean
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine

POSITIONS = 8
"""Positions of a mesh cycle in the quasi-static motion."""


def quasi_static_quantities(machine: Machine, cycles: int) -> dict[str, float]:
    """Of `cycles` mesh cycles spread over the hunting cycle. Raises NotConverged."""
    run = hunting_cycle(machine, POSITIONS, max(hunting_length(machine) // cycles, 1))
    drive, back = np.split(run.found.flank_forces, 2, axis=1)
    loads, mass = np.maximum(drive, back), bearing_mass(run.bearings)
    return _quantities(machine.layout, loads, _reversed(drive, back), mass, dynamic=False)


def dynamic_quantities(
    machine: Machine, speed_rpm: float, settings: Settings, options: SharingOptions
) -> dict[str, float]:
    """Of the motion reached from static equilibrium. Raises NotConverged naming the speed."""
    model = build_model(machine)
    response = load_sharing(model, speed_rpm, settings, options).response
    forces, mass = response.forces, bearing_mass(bearing_history(model, response))
    drive, back = np.maximum(forces, 0.0), np.maximum(-forces, 0.0)
    return _quantities(machine.layout, np.abs(forces), _reversed(drive, back), mass, dynamic=True)


def _reversed(drive: NDArray[np.float64], back: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where a mesh is loaded on the flank that carries less on average (K,); loads of both (K, meshes)."""
    works_back = back.mean(axis=0) > drive.mean(axis=0)
    return np.any(np.where(works_back, drive, back) > 0.0, axis=1)


def _quantities(
    layout: Layout, loads: NDArray[np.float64], reversed_: NDArray[np.bool_], mass: float, dynamic: bool
) -> dict[str, float]:
    """From the loads of all meshes (K, meshes), N, where one of them is reversed (K,), and the bearings'."""
    groups = load_groups(layout)
    shared = sorted({mesh for group in groups for mesh in group.meshes})
    factors, coefficients = [], []
    for group in groups:
        own = loads[:, list(group.meshes)]
        even = own.mean()
        factors += list(own.max(axis=0) / even if even > 0.0 else np.full(own.shape[1], np.nan))
        coefficients.append(defined_mean(sharing_coefficient(own)))
    opened = (loads[:, shared] == 0.0).any(axis=1).mean() if shared else 0.0
    found = (*factors, *coefficients, loads.max(), opened, reversed_.mean(), mass)
    return dict(zip(quantity_names(layout, dynamic), map(float, found), strict=True))
