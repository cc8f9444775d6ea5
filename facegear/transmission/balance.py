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
"""Rounding unit of double precision."""
ROUNDING_FACTOR = 32.0
"""Roundings of the largest terms of a sum that its result may be off by."""


@dataclass(frozen=True, eq=False)
class Balance:
    """Force out of balance on the bodies at K positions, moments divided by their arms.

    Attributes
    ----------
    residual : (K,) array
        The largest, over the largest applied or mesh force.
    rounding : (K,) array
        The part that rounding explains by the size of the numbers that cancel, over the same force.
    """

    residual: Array
    rounding: Array

    def require(self, limit: float, names: list[str]) -> None:
        """Raise NotConverged for the worst position whose residual is above the limit and rounding.

        Parameters
        ----------
        limit : float
            Largest residual, relative.
        names : list of str
            Name of each position for the message.

        Raises
        ------
        NotConverged
            If the residual of a position is above the limit and its rounding.
        """
        over = self.residual - limit - self.rounding
        if (over <= 0.0).all():
            return
        worst = int(np.argmax(np.where(np.isnan(over), np.inf, over)))
        limit_with_rounding = limit + self.rounding[worst]
        problem = (
            f"forces and moments out of balance by {self.residual[worst]:.2e} over {limit_with_rounding:.0e}"
        )
        raise NotConverged("static equilibrium", names[worst], problem)


def balance(machine: Machine, displacements: Array, forces: Array, stiffness: Array, gaps: Array) -> Balance:
    """Compute the balance of bearings, contacts and torques on every body.

    Parameters
    ----------
    machine : Machine
        The machine.
    displacements : (K, dof) array
        m and rad.
    forces : (K, F) array
        Contact forces, N.
    stiffness : (K, F) array
        Stiffness of the contacts, N/m, by which rounding of the forces is judged.
    gaps : (K, F) array
        Gaps of the contacts, m, for the same purpose.

    Returns
    -------
    Balance
        Relative to the largest applied or mesh force.

    References
    ----------
    contacts are both flanks of every mesh, or every mesh as one with a force of either sign.
    """
    linear = machine.linear
    rows, arms, loads = linear.rows[: forces.shape[1]], linear.lengths, linear.loads
    left_over = bearing_loads(machine, displacements) + forces @ rows - loads
    size = np.maximum(np.abs(loads / arms).max(), np.abs(forces).max(axis=1))
    size = np.where(size > 0.0, size, 1.0)
    motion_sizes = np.abs(displacements)
    force_sizes = stiffness * (motion_sizes @ np.abs(rows).T + np.abs(gaps))
    terms = motion_sizes @ np.abs(linear.stiffness) + force_sizes @ np.abs(rows)
    return Balance(
        residual=np.abs(left_over / arms).max(axis=1) / size,
        rounding=ROUNDING_FACTOR * EPSILON * (terms / arms).max(axis=1) / size,
    )


def bearing_loads(machine: Machine, displacements: Array) -> Array:
    """Return the force or moment of every degree of freedom on its bearing, beyond any clearance.

    Parameters
    ----------
    machine : Machine
        The machine.
    displacements : (K, dof) array
        m and rad.

    Returns
    -------
    (K, dof) array
        N and N m.
    """
    linear = machine.linear
    loads = displacements @ machine.without_errors.linear.stiffness_without_rings
    rings, at = linear.rings, linear.ring_coordinates
    ring_displacements = displacements[:, at]
    distance = np.maximum(np.hypot(ring_displacements[..., 0], ring_displacements[..., 1]), rings.clearance)
    beyond = np.maximum(1.0 - rings.clearance / distance, 0.0)
    loads[:, at] += ring_displacements * beyond[..., None] * rings.stiffness[:, None]
    return np.asarray(loads)
