"""The lumped model: rigid bodies on springs, four coordinates each, and the tilts of face gears that rock."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from facegear.arrays import Array
from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.linear_model import LinearModel, Rings
from facegear.transmission.matrices import bearing_matrix, flank_jacobian, mass_diagonal


def lumped_model(
    layout: Layout,
    torques: Array | None = None,
    forces: Array | None = None,
    damping: tuple[float, float] = (0.0, 0.0),
    clearance: Array | None = None,
) -> LinearModel:
    """Return the linear part of a layout; what is left out is zero.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    torques : (bodies,) array or None
        Torques on the bodies, N m.
    forces : (bodies, 3) array or None
        Forces on the bodies along x, y, z, N.
    damping : tuple[float, float]
        Factors of the masses (1/s) and of the bearings (s).
    clearance : (pinions,) array or None
        Radial clearance of the bearings, m.

    Returns
    -------
    LinearModel
        SI units.
    """
    alone = _alone(layout)
    turning, external_forces = np.zeros((2, layout.dof))
    turning[layout.spins] = 0.0 if torques is None else torques
    external_forces[alone.translations] = 0.0 if forces is None else forces
    return replace(
        alone,
        torques=turning,
        forces=external_forces,
        mass_damping=damping[0],
        bearing_damping=damping[1],
        rings=_rings(layout, np.zeros(len(layout.pinions)) if clearance is None else clearance),
    )


@lru_cache(maxsize=16)
def _alone(layout: Layout) -> LinearModel:
    """Return the model without loads, damping and clearance, which all machines of a layout share."""
    zeros = np.zeros(layout.dof)
    return LinearModel(
        labels=layout.dof_names,
        mass=np.diag(mass_diagonal(layout)),
        stiffness=bearing_matrix(layout),
        rows=flank_jacobian(layout),
        torques=zeros,
        forces=zeros,
        lengths=_lengths(layout),
        translations=DOF_PER_BODY * np.arange(len(layout.bodies))[:, None] + np.arange(3),
        mass_damping=0.0,
        bearing_damping=0.0,
        dampers=np.zeros((layout.dof, layout.dof)),
        rings=_rings(layout, np.zeros(len(layout.pinions))),
    )


def _rings(layout: Layout, clearance: Array) -> Rings:
    body = np.flatnonzero(clearance > 0.0)
    return Rings(body, np.array([layout.pinions[i].body.bearing[0] for i in body]), clearance[body])


def _lengths(layout: Layout) -> Array:
    """Return the length of a unit of each coordinate: turns count at the mesh, tilts at the mesh radius."""
    lengths = np.ones(layout.dof)
    radii = [layout.pinion_radius] * len(layout.pinions) + [layout.gear_radius] * len(layout.gears)
    lengths[layout.spins] = radii
    lengths[DOF_PER_BODY * len(layout.bodies) :] = layout.mesh_radius
    return lengths
