"""Modes of a machine about the place where its torques hold it: which flank works follows from statics."""

import numpy as np
from numpy.typing import NDArray

from facegear.transmission.flanks import constant_errors, flank_gaps
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import bearing_matrix, flank_directions, mass_diagonal
from facegear.transmission.modes import Modes, modes_of, natural_modes

CARRIES = 1e-12
"""Share of the largest flank force below which a force is rounding."""
RIGID = 1e-13
"""Share of the stiffest motion's stiffness below which a motion is free."""
MOST_SETS = 50
BALANCED = 1e-9


def working_flanks(machine: Machine) -> NDArray[np.bool_]:
    """Flanks in contact at mean stiffness, shape (2 meshes,): all drive flanks, then all back flanks.

    A mesh that carries nothing counts as closed on its drive flank. Raises NotConverged.
    """
    forces = _forces_by_active_sets(machine)
    if forces is None:
        from facegear.transmission.statics import mean_equilibrium  # compiled; most machines do without

        forces = mean_equilibrium(machine).flank_forces[0]
    drive, back = np.split(forces > CARRIES * forces.max(), 2)
    return np.concatenate([drive | ~back, back])


def _forces_by_active_sets(machine: Machine) -> NDArray[np.float64] | None:
    """Flank forces (2 meshes,) at mean stiffness, N: the statics of one position without compiled code.

    Each step solves the springs of the flanks that were closed after the last one. None for bearings with
    play, and where the flanks do not settle or leave a loaded body free.
    """
    layout = machine.layout
    if (machine.imperfections.clearance > 0.0).any():
        return None
    scale = 1.0 / np.sqrt(mass_diagonal(layout))
    directions = flank_directions(layout) * scale
    bearing = bearing_matrix(layout) * np.outer(scale, scale)
    applied = np.zeros(layout.dof)
    applied[layout.spins] = machine.torques
    applied *= scale
    stiffness = machine.stiffness.mean * np.tile(machine.imperfections.stiffness, 2)
    gaps = constant_errors(machine) + flank_gaps(machine)
    closed = np.arange(gaps.size) < len(layout.meshes)
    for _ in range(MOST_SETS):
        pressed = np.where(closed, stiffness, 0.0)
        matrix = bearing + (directions.T * pressed) @ directions
        moved = np.linalg.lstsq(matrix, applied + directions.T @ (pressed * gaps), rcond=RIGID)[0]
        over = directions @ moved - gaps
        if ((over > 0.0) == closed).all():
            missing = matrix @ moved - applied - directions.T @ (pressed * gaps)
            return pressed * over if np.abs(missing).max() <= BALANCED * np.abs(applied).max() else None
        closed = over > 0.0
    return None


def loaded_modes(machine: Machine) -> Modes:
    """Modes with mean mesh stiffness on the working flanks, and bearings with play as they are pressed.

    On one line of action for printed meshes. Raises NotConverged.
    """
    if not machine.layout.is_geometric:
        return natural_modes(machine.layout, machine.stiffness.mean)
    stiffness = machine.stiffness.mean * np.tile(machine.imperfections.stiffness, 2)
    pressed = np.where(working_flanks(machine), stiffness, 0.0)
    directions = flank_directions(machine.layout)
    return modes_of(_pressed_bearings(machine), (pressed * directions.T) @ directions)


def _pressed_bearings(machine: Machine) -> Layout:
    if not (machine.imperfections.clearance > 0.0).any():
        return machine.layout
    from facegear.transmission.linear_bearings import linear_bearings  # compiled

    return linear_bearings(machine)
