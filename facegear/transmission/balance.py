"""Whether a static result is one: every force and moment on every body in balance, counted anew.

The solvers keep an account of their own unknowns. This one goes back to the whole matrices, all degrees of
freedom included, so that nothing that a solver leaves out can hide.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.transmission.machine import Machine

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
    linear = machine.linear
    rows, arms, applied = linear.rows[: forces.shape[1]], linear.lengths, linear.loads
    left_over = bearing_loads(machine, displacements) + forces @ rows - applied
    size = np.maximum(np.abs(applied / arms).max(), np.abs(forces).max(axis=1))
    size = np.where(size > 0.0, size, 1.0)
    moved = np.abs(displacements)
    pressed = stiffness * (moved @ np.abs(rows).T + np.abs(gaps))
    terms = moved @ np.abs(linear.stiffness) + pressed @ np.abs(rows)
    return Balance(
        residual=np.abs(left_over / arms).max(axis=1) / size,
        rounding=ROUNDED * EPSILON * (terms / arms).max(axis=1) / size,
    )


def bearing_loads(machine: Machine, displacements: Array) -> Array:
    """Force or moment of every degree of freedom on its bearing, (K, dof), beyond any clearance."""
    linear = machine.linear
    loads = displacements @ machine.alike.linear.stiffness_without_rings
    rings, at = linear.rings, linear.ring_coordinates
    moved = displacements[:, at]
    distance = np.maximum(np.hypot(moved[..., 0], moved[..., 1]), rings.clearance)
    beyond = np.maximum(1.0 - rings.clearance / distance, 0.0)
    loads[:, at] += moved * beyond[..., None] * rings.stiffness[:, None]
    return np.asarray(loads)
