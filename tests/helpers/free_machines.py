"""Behaviour of a machine without damping and clearance: its modes, and its rotation as a whole."""

import numpy as np

from facegear.arrays import Array
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.linear_model import lumped_model
from facegear.machine.modes import Modes, drive_flanks, modes_of


def natural_modes(layout: Layout, mesh_stiffness: float) -> Modes:
    """All modes of the free, undamped, time-averaged system with every mesh on its drive flank (N/m)."""
    linear = lumped_model(layout)
    return modes_of(linear, drive_flanks(layout, linear, mesh_stiffness))


def rigid_rotation(layout: Layout) -> Array:
    """The motion of all bodies turning together without mesh deflection, shape (dof,)."""
    motion = np.zeros(layout.dof)
    pinions, bodies = len(layout.pinions), len(layout.bodies)
    motion[3 : DOF_PER_BODY * pinions : DOF_PER_BODY] = 1.0 / layout.pinion_radius
    motion[DOF_PER_BODY * pinions + 3 : DOF_PER_BODY * bodies : DOF_PER_BODY] = 1.0 / layout.gear_radius
    return motion
