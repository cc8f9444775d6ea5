"""Matrices of the lumped model: bodies, bearings, and meshes as they are or as equation (13) says."""

import numpy as np

from facegear.arrays import Array
from facegear.transmission.layout import DOF_PER_BODY, Layout, Tilt


def mass_diagonal(layout: Layout) -> Array:
    """Diagonal of M, shape (dof,): m, m, m, I for each body, then the tilts' inertias, kg and kg m2."""
    bodies = [value for body in layout.bodies for value in (*3 * (body.mass,), body.inertia)]
    return np.array(bodies + [value for tilt in _tilts(layout) for value in 2 * (tilt.inertia,)])


def bearing_diagonal(layout: Layout) -> Array:
    """Diagonal of the bearing stiffness K, shape (dof,): k_x, k_y, k_z, 0 for each body, then tilts; N/m."""
    bodies = [value for body in layout.bodies for value in (*body.bearing, 0.0)]
    return np.array(bodies + [value for tilt in _tilts(layout) for value in 2 * (tilt.stiffness,)])


def bearing_matrix(layout: Layout) -> Array:
    """Bearing stiffness K, shape (dof, dof), with the cross-coupling of x and y, N/m."""
    matrix = np.diag(bearing_diagonal(layout))
    for k, body in enumerate(layout.bodies):
        x = DOF_PER_BODY * k
        matrix[x, x + 1] = matrix[x + 1, x] = body.bearing_xy
    return matrix


def mesh_directions(layout: Layout) -> Array:
    """Derivative of the drive flanks' deflections by the DOF, shape (meshes, dof).

    The deflection along the line of action is this times q, minus the transmission error. A pinion's x is
    tangential to the face gear and its y is along the face gear's axis.
    """
    if layout.is_geometric:
        tangential, separating = mesh_parts(layout)
        return tangential + separating
    return _printed(layout)


def flank_directions(layout: Layout) -> Array:
    """The same for both flanks, shape (2 meshes, dof): all drive flanks, then all back flanks.

    The back flank's normal has the same separating part and the opposite tangential part; as printed it is
    the drive flank's line of action, pulled.
    """
    if layout.is_geometric:
        tangential, separating = mesh_parts(layout)
        return np.concatenate([separating + tangential, separating - tangential])
    printed = _printed(layout)
    return np.concatenate([printed, -printed])


def mesh_parts(layout: Layout) -> tuple[Array, Array]:
    """Tangential and separating motion at the flanks by the DOF, each (meshes, dof), from the geometry.

    A pinion sees the lower gear as the upper one turned half round the pinion's own axis, so its x and y
    change sign there. Gears turn positively as the pinions drive them, and share one axial direction.
    """
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    tangential, separating = np.zeros((2, len(layout.meshes), layout.dof))
    angles = layout.angles
    tilted = {g: DOF_PER_BODY * len(layout.bodies) + 2 * k for k, g in enumerate(layout.tilting)}
    for row, (i, g) in enumerate(layout.meshes):
        side = layout.gears[g].sign
        along = np.array([np.cos(angles[i]), np.sin(angles[i])])
        pinion, gear = DOF_PER_BODY * i, DOF_PER_BODY * (len(layout.pinions) + g)
        tangential[row, pinion] = side * cosine
        tangential[row, gear : gear + 2] = -side * cosine * along
        tangential[row, [pinion + 3, gear + 3]] = layout.pinion_arm, -layout.gear_arm
        separating[row, [pinion + 1, gear + 2]] = side * sine, -side * sine
        if g in tilted:
            # Tilts about x and y lift the rim at the mesh by its distance from the diameter.
            separating[row, tilted[g] : tilted[g] + 2] = side * sine * layout.mesh_radius * along
    return tangential, separating


def rigid_rotation(layout: Layout) -> Array:
    """The motion of all bodies turning together without mesh deflection, shape (dof,)."""
    motion = np.zeros(layout.dof)
    pinions, bodies = len(layout.pinions), len(layout.bodies)
    motion[3 : 4 * pinions : 4] = 1.0 / layout.pinion_radius
    motion[4 * pinions + 3 : 4 * bodies : 4] = 1.0 / layout.gear_radius
    return motion


def _printed(layout: Layout) -> Array:
    """Equation (13) to the letter, shape (meshes, dof)."""
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    angles = layout.angles
    directions = np.zeros((len(layout.meshes), layout.dof))
    for row, (i, g) in zip(directions, layout.meshes, strict=True):
        pinion = DOF_PER_BODY * i
        gear = DOF_PER_BODY * (len(layout.pinions) + g)
        axial = -layout.gears[g].sign
        row[pinion : pinion + 4] = cosine, sine, 0.0, layout.pinion_radius * cosine
        row[gear] = -np.cos(angles[i]) * cosine
        row[gear + 1] = -np.sin(angles[i]) * cosine
        row[gear + 2] = axial * sine
        row[gear + 3] = -layout.gear_radius * cosine
    return directions


def _tilts(layout: Layout) -> list[Tilt]:
    return [tilt for gear in layout.gears if (tilt := gear.body.tilt) is not None]
