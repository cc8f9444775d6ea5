"""Modes of a machine about the place where its torques hold it: which flank works follows from statics."""

import numpy as np
from numpy.typing import NDArray

from facegear.transmission.machine import Machine
from facegear.transmission.matrices import flank_directions
from facegear.transmission.modes import Modes, modes_of, natural_modes


def working_flanks(machine: Machine) -> NDArray[np.bool_]:
    """Flanks in contact at mean stiffness, shape (2 meshes,): all drive flanks, then all back flanks.

    A mesh that carries nothing counts as closed on its drive flank. Raises NotConverged.
    """
    from facegear.transmission.statics import mean_equilibrium  # compiled; printed meshes do without

    drive, back = np.split(mean_equilibrium(machine).flank_forces[0] > 0.0, 2)
    return np.concatenate([drive | ~back, back])


def loaded_modes(machine: Machine) -> Modes:
    """Modes with mean mesh stiffness on the working flanks, and bearings with play as they are pressed.

    On one line of action for printed meshes. Raises NotConverged.
    """
    if not machine.layout.is_geometric:
        return natural_modes(machine.layout, machine.stiffness.mean)
    stiffness = machine.stiffness.mean * np.tile(machine.imperfections.stiffness, 2)
    pressed = np.where(working_flanks(machine), stiffness, 0.0)
    from facegear.transmission.linear_bearings import linear_bearings  # compiled, too

    directions = flank_directions(machine.layout)
    return modes_of(linear_bearings(machine), (pressed * directions.T) @ directions)
