"""Matrices of the lumped model, equations (13) to (16)."""

import numpy as np
from numpy.typing import NDArray

from facegear.transmission.layout import DOF_PER_BODY, Layout, Side


def mass_diagonal(layout: Layout) -> NDArray[np.float64]:
    """Diagonal of M, shape (4 bodies,): m, m, m, I for each body, kg and kg m2."""
    return np.array([value for body in layout.bodies for value in (*3 * (body.mass,), body.inertia)])


def bearing_diagonal(layout: Layout) -> NDArray[np.float64]:
    """Diagonal of the bearing stiffness K, shape (4 bodies,): k_x, k_y, k_z, 0 for each body, N/m."""
    return np.array([value for body in layout.bodies for value in (*body.bearing, 0.0)])


def mesh_directions(layout: Layout) -> NDArray[np.float64]:
    """Derivative of the mesh deflections by the DOF, equation (13), shape (meshes, 4 bodies).

    The deflection along the line of action is this times q, minus the transmission error. A pinion's x is
    tangential to the face gear and its y is along the face gear's axis.
    """
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    angles = layout.angles
    directions = np.zeros((len(layout.meshes), DOF_PER_BODY * len(layout.bodies)))
    for row, (i, g) in zip(directions, layout.meshes, strict=True):
        pinion = DOF_PER_BODY * i
        gear = DOF_PER_BODY * (len(layout.pinions) + g)
        axial = 1.0 if layout.gears[g].side is Side.LOWER else -1.0
        row[pinion : pinion + 4] = cosine, sine, 0.0, layout.pinion_radius * cosine
        row[gear] = -np.cos(angles[i]) * cosine
        row[gear + 1] = -np.sin(angles[i]) * cosine
        row[gear + 2] = axial * sine
        row[gear + 3] = -layout.gear_radius * cosine
    return directions


def rigid_rotation(layout: Layout) -> NDArray[np.float64]:
    """The motion of all bodies turning together without mesh deflection, shape (4 bodies,)."""
    motion = np.zeros(DOF_PER_BODY * len(layout.bodies))
    pinions = len(layout.pinions)
    motion[3 : 4 * pinions : 4] = 1.0 / layout.pinion_radius
    motion[4 * pinions + 3 :: 4] = 1.0 / layout.gear_radius
    return motion
