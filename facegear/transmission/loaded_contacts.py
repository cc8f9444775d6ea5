"""Which flanks and bearings with clearance the mean torques press together, and which they leave apart.

Decided by load: what carries less than NOTHING of the largest flank force is open, what carries more than
LOADED is closed. In between rounding and the last digits of a torque would decide: `undecided`.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array, Mask
from facegear.mesh_law.law import past_levels
from facegear.transmission.flanks import constant_errors, flank_gaps, flank_law
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest

OPEN_SHARE, CLOSED_SHARE = 1e-9, 1e-6
"""Shares of the largest flank force: a contact with at most OPEN_SHARE is open, with at least CLOSED_SHARE
closed.
"""
RIGID = 1e-13
"""Share of the stiffest motion's stiffness below which a motion is free."""
MAX_SETS = 50
"""Largest number of active sets that are tried."""
BALANCE_TOLERANCE = 1e-9
"""Largest force out of balance, over the largest load, of an accepted result."""


class Contact(StrEnum):
    """State of a flank or of a bearing's ring under the mean torques."""

    OPEN = "open"
    IN_CONTACT = "closed"
    UNCERTAIN = "undecided"


@dataclass(frozen=True, eq=False)
class LoadedContacts:
    """Contacts that the mean torques press together.

    Attributes
    ----------
    flanks : (2 meshes,)
        Forces, N, drive flanks first.
    stiffness : (2 meshes,)
        Slope of each flank's force there, N/m, or what it would be in contact.
    compression : (2 meshes,)
        Compression of each flank by its law, m; 0 for one that is open.
    past_law : (2 meshes,)
        Whether the compression is beyond the last level of the flank's law.
    rings : (pinions,)
        Forces of the bearings, N; nan where a bearing has no clearance.
    ring_positions : (pinions, 2)
        Positions of the pinions in their rings, m; nan where a bearing has no clearance.
    """

    flanks: Array
    stiffness: Array
    compression: Array
    past_law: Mask
    rings: Array
    ring_positions: Array

    def flank_states(self) -> list[Contact]:
        """Return the state of every flank.

        Returns
        -------
        list of Contact
            Drive flanks first.
        """
        return [self._state(force) for force in self.flanks]

    def ring_states(self) -> list[Contact | None]:
        """Return the state of every pinion's bearing.

        Returns
        -------
        list of Contact or None
            None for a bearing without clearance.
        """
        return [None if np.isnan(force) else self._state(force) for force in self.rings]

    def any_undecided(self) -> bool:
        """Whether some contact is neither open nor closed for certain.

        Returns
        -------
        bool
            True if a flank or a bearing is undecided.
        """
        return Contact.UNCERTAIN in [*self.flank_states(), *self.ring_states()]

    def _state(self, force: float) -> Contact:
        largest = self.flanks.max()
        if force <= OPEN_SHARE * largest:
            return Contact.OPEN
        return Contact.IN_CONTACT if force >= CLOSED_SHARE * largest else Contact.UNCERTAIN


def loaded_contacts(machine: Machine) -> LoadedContacts:
    """Return the contacts of geometric meshes with the mean law and constant errors.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.

    Returns
    -------
    LoadedContacts
        Forces in N, stiffness in N/m.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    pinions, static_machine = len(machine.layout.pinions), at_rest(machine)
    rings, positions = np.full(pinions, np.nan), np.full((pinions, 2), np.nan)
    forces = forces_by_active_sets(static_machine)
    constant = np.tile(machine.mean_stiffness, 2)
    if forces is not None:
        past_law = np.zeros(constant.size, bool)
        return LoadedContacts(forces, constant, forces / constant, past_law, rings, positions)
    from facegear.transmission.statics import bearing_forces, mean_equilibrium  # compiled

    equilibrium = mean_equilibrium(static_machine)
    ringed = machine.linear.rings.body
    rings[ringed] = np.hypot(*bearing_forces(static_machine, equilibrium)[0, ringed, :2].T)
    positions[ringed] = equilibrium.displacements[0, machine.linear.ring_coordinates]
    over = (
        static_machine.linear.rows @ equilibrium.displacements[0]
        - constant_errors(machine)
        - flank_gaps(machine)
    )
    if machine.own_softening is not None:
        over += np.tile(machine.own_softening, 2) * equilibrium.flank_forces[0]
    law, compression = flank_law(machine).mean(), np.maximum(over, 0.0)
    stiffness = constant if machine.constant_stiffness else law.slope(np.zeros(1), compression[None])[0]
    past = past_levels(law, compression[None]) > 0.0
    return LoadedContacts(equilibrium.flank_forces[0], stiffness, compression, past, rings, positions)


def forces_by_active_sets(machine: Machine) -> Array | None:
    """Compute the flank forces at mean stiffness: the statics of one position without compiled code.

    Each step solves the springs of the flanks that were closed after the last step.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.

    Returns
    -------
    (2 meshes,) array or None
        N. None for bearings with clearance or a stiffness that depends on the load, and where the flanks do
        not settle or leave a loaded body free.
    """
    linear = machine.static_machine.linear
    if linear.rings.body.size or not machine.constant_stiffness:
        return None
    scale = 1.0 / np.sqrt(linear.mass.diagonal())
    jacobian = linear.rows * scale
    bearing = linear.stiffness * np.outer(scale, scale)
    loads = linear.loads * scale
    stiffness = np.tile(machine.mean_stiffness, 2)
    gaps = constant_errors(machine) + flank_gaps(machine)
    contact_mask = np.arange(gaps.size) < len(machine.layout.meshes)
    for _ in range(MAX_SETS):
        active_stiffness = np.where(contact_mask, stiffness, 0.0)
        matrix = bearing + (jacobian.T * active_stiffness) @ jacobian
        displacements = np.linalg.lstsq(matrix, loads + jacobian.T @ (active_stiffness * gaps), rcond=RIGID)[
            0
        ]
        over = jacobian @ displacements - gaps
        if ((over > 0.0) == contact_mask).all():
            residual = matrix @ displacements - loads - jacobian.T @ (active_stiffness * gaps)
            return (
                active_stiffness * over
                if np.abs(residual).max() <= BALANCE_TOLERANCE * np.abs(loads).max()
                else None
            )
        contact_mask = over > 0.0
    return None
