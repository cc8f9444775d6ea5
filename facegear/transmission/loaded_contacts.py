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

NOTHING, LOADED = 1e-9, 1e-6
RIGID = 1e-13
"""Share of the stiffest motion's stiffness below which a motion is free."""
MAX_SETS = 50
BALANCED = 1e-9


class Contact(StrEnum):
    """State of a flank or of a bearing's ring under the mean torques."""

    OPEN = "open"
    CLOSED = "closed"
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class LoadedContacts:
    """What the mean torques press together.

    Attributes
    ----------
    flanks : (2 meshes,)
        Forces, N, drive flanks first.
    stiffness : (2 meshes,)
        Slope of each flank's force there, N/m, or what it would be in contact.
    pressed : (2 meshes,)
        How far each flank is pressed in by its law, m; 0 for one that is open.
    past_law : (2 meshes,)
        Whether it is pressed in past the last level of its law.
    rings : (pinions,)
        Forces of the bearings, N; nan where a bearing has no clearance.
    places : (pinions, 2)
        Where the pinions stand in their rings, m; nan where a bearing has no clearance.
    """

    flanks: Array
    stiffness: Array
    pressed: Array
    past_law: Mask
    rings: Array
    places: Array

    def flank_states(self) -> list[Contact]:
        """Of every flank."""
        return [self._state(force) for force in self.flanks]

    def ring_states(self) -> list[Contact | None]:
        """Of every pinion's bearing; None without clearance."""
        return [None if np.isnan(force) else self._state(force) for force in self.rings]

    def any_undecided(self) -> bool:
        """Whether some contact is neither open nor closed for certain."""
        return Contact.UNDECIDED in [*self.flank_states(), *self.ring_states()]

    def _state(self, force: float) -> Contact:
        largest = self.flanks.max()
        if force <= NOTHING * largest:
            return Contact.OPEN
        return Contact.CLOSED if force >= LOADED * largest else Contact.UNDECIDED


def loaded_contacts(machine: Machine) -> LoadedContacts:
    """Contacts of geometric meshes with the mean law and constant errors. Raises NotConverged."""
    pinions, standing = len(machine.layout.pinions), at_rest(machine)
    rings, positions = np.full(pinions, np.nan), np.full((pinions, 2), np.nan)
    forces = forces_by_active_sets(standing)
    constant = np.tile(machine.mean_stiffness, 2)
    if forces is not None:
        none = np.zeros(constant.size, bool)
        return LoadedContacts(forces, constant, forces / constant, none, rings, positions)
    from facegear.transmission.statics import bearing_forces, mean_equilibrium  # compiled

    equilibrium = mean_equilibrium(standing)
    ringed = machine.linear.rings.body
    rings[ringed] = np.hypot(*bearing_forces(standing, equilibrium)[0, ringed, :2].T)
    positions[ringed] = equilibrium.displacements[0, machine.linear.ring_coordinates]
    over = (
        standing.linear.rows @ equilibrium.displacements[0] - constant_errors(machine) - flank_gaps(machine)
    )
    if machine.own_softening is not None:
        over += np.tile(machine.own_softening, 2) * equilibrium.flank_forces[0]
    law, pressed = flank_law(machine).mean(), np.maximum(over, 0.0)
    stiffness = constant if machine.constant_stiffness else law.slope(np.zeros(1), pressed[None])[0]
    past = past_levels(law, pressed[None]) > 0.0
    return LoadedContacts(equilibrium.flank_forces[0], stiffness, pressed, past, rings, positions)


def forces_by_active_sets(machine: Machine) -> Array | None:
    """Flank forces (2 meshes,) at mean stiffness, N: the statics of one position without compiled code.

    Each step solves the springs of the flanks that were closed after the last one. None for bearings with
    clearance or a stiffness that depends on the load, and where the flanks do not settle or leave a loaded
    body free.
    """
    linear = machine.resting.linear
    if linear.rings.body.size or not machine.constant_stiffness:
        return None
    scale = 1.0 / np.sqrt(linear.mass.diagonal())
    jacobian = linear.rows * scale
    bearing = linear.stiffness * np.outer(scale, scale)
    applied = linear.loads * scale
    stiffness = np.tile(machine.mean_stiffness, 2)
    gaps = constant_errors(machine) + flank_gaps(machine)
    closed = np.arange(gaps.size) < len(machine.layout.meshes)
    for _ in range(MAX_SETS):
        pressed = np.where(closed, stiffness, 0.0)
        matrix = bearing + (jacobian.T * pressed) @ jacobian
        moved = np.linalg.lstsq(matrix, applied + jacobian.T @ (pressed * gaps), rcond=RIGID)[0]
        over = jacobian @ moved - gaps
        if ((over > 0.0) == closed).all():
            missing = matrix @ moved - applied - jacobian.T @ (pressed * gaps)
            return pressed * over if np.abs(missing).max() <= BALANCED * np.abs(applied).max() else None
        closed = over > 0.0
    return None
