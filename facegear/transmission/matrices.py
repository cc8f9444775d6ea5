"""Matrices of the lumped model: bodies, bearings, meshes."""

import numpy as np

from facegear.arrays import Array
from facegear.transmission.layout import DOF_PER_BODY, Layout, Tilt


def mass_diagonal(layout: Layout) -> Array:
    """Return the diagonal of the mass matrix M: m, m, m, I for each body, then the tilts' inertias.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (dof,) array
        kg and kg m2.
    """
    bodies = [value for body in layout.bodies for value in (*3 * (body.mass,), body.inertia)]
    return np.array(bodies + [value for tilt in _tilts(layout) for value in 2 * (tilt.inertia,)])


def bearing_diagonal(layout: Layout) -> Array:
    """Return the diagonal of the bearing stiffness K: k_x, k_y, k_z, 0 for each body, then the tilts.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (dof,) array
        N/m and N m/rad.
    """
    bodies = [value for body in layout.bodies for value in (*body.bearing, 0.0)]
    return np.array(bodies + [value for tilt in _tilts(layout) for value in 2 * (tilt.stiffness,)])


def bearing_matrix(layout: Layout) -> Array:
    """Return the bearing stiffness K with the cross-coupling of x and y.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (dof, dof) array
        N/m and N m/rad.
    """
    matrix = np.diag(bearing_diagonal(layout))
    for k, body in enumerate(layout.bodies):
        x = DOF_PER_BODY * k
        matrix[x, x + 1] = matrix[x + 1, x] = body.bearing_xy
    return matrix


def flank_jacobian(layout: Layout) -> Array:
    """Return the derivative of the flanks' deflections by the DOF.

    The deflection along the line of action is this times q, minus the transmission error. A pinion's x is
    tangential to the face gear and its y is along the face gear's axis.

    Parameters
    ----------
    layout : Layout
        The layout.

    Returns
    -------
    (2 meshes, dof) array
        Drive flanks, then back flanks; m/m, and m/rad for rotations.
    """
    return layout.kinematics.flank_rows(layout)


def _tilts(layout: Layout) -> list[Tilt]:
    return [tilt for gear in layout.gears if (tilt := gear.body.tilt) is not None]
