"""Whether a static result is one: every force and moment on every body in balance, counted anew.

The solvers keep an account of their own unknowns. This one goes back to the whole matrices, all degrees of
freedom included, so that nothing that a solver leaves out can hide.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import bearing_matrix, flank_directions, mesh_directions

EPSILON = float(np.finfo(float).eps)
ROUNDED = 32.0
"""Roundings of the largest terms of a sum that its result may be off by."""


@dataclass(frozen=True, eq=False)
class Balance:
    """What is left over on the bodies at K positions, moments at their arms, N.

    residual (K,): the largest, over the largest applied or mesh force. rounding (K,): what of it the size of
    the numbers that cancel explains, over the same.
    """

    residual: Array
    rounding: Array

    def require(self, accepted: float, names: list[str]) -> None:
        """Raise NotConverged for the worst position whose residual is above `accepted` and rounding."""
        over = self.residual - accepted - self.rounding
        if (over <= 0.0).all():
            return
        worst = int(np.argmax(np.where(np.isnan(over), np.inf, over)))
        allowed = accepted + self.rounding[worst]
        tried = f"forces and moments out of balance by {self.residual[worst]:.2e} over {allowed:.0e}"
        raise NotConverged("static equilibrium", names[worst], tried)


def balance(machine: Machine, displacements: Array, forces: Array, stiffness: Array, gaps: Array) -> Balance:
    """Bearings, contacts and torques on every body, from displacements (K, dof) and contact forces (K, F).

    F contacts: both flanks of every mesh, or every mesh as one with a force of either sign. stiffness, gaps
    (K, F): theirs, N/m and m, which say how well the forces can be known.
    """
    layout = machine.layout
    whole = forces.shape[1] == len(layout.meshes)
    directions = mesh_directions(layout) if whole else flank_directions(layout)
    arms = _arms(layout)
    applied = machine.applied
    left_over = bearing_loads(machine, displacements) + forces @ directions - applied
    size = np.maximum(np.abs(applied / arms).max(), np.abs(forces).max(axis=1))
    size = np.where(size > 0.0, size, 1.0)
    moved = np.abs(displacements)
    pressed = stiffness * (moved @ np.abs(directions).T + np.abs(gaps))
    terms = moved @ np.abs(bearing_matrix(layout)) + pressed @ np.abs(directions)
    return Balance(
        residual=np.abs(left_over / arms).max(axis=1) / size,
        rounding=ROUNDED * EPSILON * (terms / arms).max(axis=1) / size,
    )


def bearing_loads(machine: Machine, displacements: Array) -> Array:
    """Force or moment of every degree of freedom on its bearing, (K, dof); beyond the play where there is."""
    moved = displacements.copy()
    for i in np.flatnonzero(machine.imperfections.clearance > 0.0):
        play = machine.imperfections.clearance[i]
        at = slice(DOF_PER_BODY * i, DOF_PER_BODY * i + 2)
        distance = np.hypot(*moved[:, at].T)[:, None]
        moved[:, at] *= np.maximum(1.0 - play / np.maximum(distance, play), 0.0)
    return np.asarray(moved @ bearing_matrix(machine.layout))


def _arms(layout: Layout) -> Array:
    """Length at which a moment on each degree of freedom counts as a force, (dof,), 1 for forces."""
    arms = np.ones(layout.dof)
    pinions, bodies = len(layout.pinions), len(layout.bodies)
    arms[layout.spins] = np.repeat([layout.pinion_arm, layout.gear_arm], [pinions, bodies - pinions])
    arms[DOF_PER_BODY * bodies :] = layout.mesh_radius
    return arms
