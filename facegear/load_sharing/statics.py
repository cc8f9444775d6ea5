"""Load sharing of the machine at rest: equilibrium at each position of the mesh cycle."""

import numpy as np

from facegear.arrays import Array
from facegear.transmission.flanks import significant_forces
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import static_equilibrium


def static_forces(machine: Machine, positions: int) -> Array:
    """Compute the elastic mesh forces with k and e frozen at evenly spaced positions.

    This is the limit of slow running: damping and inertia vanish, and who carries load follows from
    stiffness, backlash and transmission error alone.

    Parameters
    ----------
    machine : Machine
        The machine.
    positions : int
        Number of positions in the mesh cycle.

    Returns
    -------
    (1, positions, meshes) array
        N.

    Raises
    ------
    NotConverged
        If no equilibrium is found; the message names the position.
    """
    static_machine, cycles = at_rest(machine), np.arange(positions) / positions
    return significant_forces(
        np.array([[static_equilibrium(static_machine, float(at)).forces for at in cycles]])
    )


def mean_equilibrium_forces(machine: Machine) -> Array:
    """Compute the elastic mesh forces at mean stiffness without transmission error.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    (1, 1, meshes) array
        N.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    return significant_forces(static_equilibrium(at_rest(machine)).forces[None, None, :])
