"""Load sharing of the machine at rest: equilibrium at each position of the mesh cycle."""

import numpy as np

from facegear.arrays import Array
from facegear.transmission.flanks import significant_forces
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import static_equilibrium


def static_forces(machine: Machine, positions: int) -> Array:
    """Elastic mesh forces with k and e frozen at evenly spaced positions, shape (1, positions, meshes), N.

    This is the limit of slow running: damping and inertia vanish, and who carries load follows from
    stiffness, backlash and transmission error alone. Raises NotConverged naming the position.
    """
    standing, cycles = at_rest(machine), np.arange(positions) / positions
    return significant_forces(np.array([[static_equilibrium(standing, float(at)).forces for at in cycles]]))


def mean_equilibrium_forces(machine: Machine) -> Array:
    """Elastic mesh forces at mean stiffness without transmission error, shape (1, 1, meshes), N."""
    return significant_forces(static_equilibrium(at_rest(machine)).forces[None, None, :])
