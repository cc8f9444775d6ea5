"""Periodic torques on bodies: propellers, engines, rotors, at orders of the body's own turns."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.transmission.drive_line import DriveLine
from facegear.transmission.layout import Layout
from facegear.transmission.linear_model import LinearModel

WHOLE = 1e-9
"""Distance of a frequency over that of the mesh from a whole number that counts as rounding."""


@dataclass(frozen=True)
class Excitation:
    """Torque `amplitude` cos(order turns + phase) beside the mean torque of a body.

    Attributes
    ----------
    body : int
        Its number in the layout; the torque acts where the body's mean torque acts.
    order : float
        Vibrations in one turn of the body, dimensionless.
    teeth : int
        Of the body.
    amplitude : float
        N m.
    phase : float
        At the start, rad.
    """

    body: int
    order: float
    teeth: int
    amplitude: float
    phase: float = 0.0

    @property
    def of_mesh(self) -> float:
        """Frequency over that of the mesh, dimensionless."""
        return self.order / self.teeth

    @property
    def mesh_harmonic(self) -> int:
        """Number of the mesh harmonic with this frequency. Raises InvalidInput where there is none."""
        nearest = round(self.of_mesh)
        if nearest < 1 or abs(self.of_mesh - nearest) > WHOLE * nearest:
            multiples = (
                f"an order that is a multiple of {self.teeth}, the teeth of its body, for motion in time, "
                "which repeats with the mesh; vibration at the orders of turns (shaft_orders) takes every one"
            )
            raise InvalidInput("order of an excitation", self.order, multiples)
        return nearest


def rigid_rotation(layout: Layout, linear: LinearModel, line: DriveLine | None) -> Array:
    """Return the common rotation of all bodies, which no mesh and no bearing feels.

    Parameters
    ----------
    layout : Layout
        Bodies, with geometric meshes.
    linear : LinearModel
        Their coordinates.
    line : DriveLine or None
        Turning masses behind torsional springs.

    Returns
    -------
    (n,) array
        1 for each pinion and the teeth's ratio for each gear, dimensionless.
    """
    pinions = len(layout.pinions)
    ratio = layout.pinion_teeth / layout.gear_teeth
    turns = np.array([1.0 if body < pinions else ratio for body in range(len(layout.bodies))])
    rotation = np.zeros(linear.size)
    rotation[: layout.dof][layout.spins] = turns
    for body, first, chain in () if line is None else line.chains():
        rotation[first : first + len(chain)] = turns[body]
    return rotation


def without_rigid_rotation(force: Array, linear: LinearModel, rotation: Array) -> Array:
    """Take off a force what turns all bodies together, which strains nothing.

    Parameters
    ----------
    force : (n,) array
        N and N m.
    linear : LinearModel
        Coordinates and masses.
    rotation : (n,) array
        `rigid_rotation`, dimensionless.

    Returns
    -------
    (n,) array
        N and N m: the rest, in balance with the inertia of all bodies.
    """
    inertia = linear.momentum(rotation)
    return np.asarray(force - inertia * (rotation @ force) / (rotation @ inertia))
