"""Flanks and bearings with clearance that the mean torques press together, and those that they leave apart.

The load decides: a contact with at most OPEN_SHARE of the largest flank force is open, one with at least
CLOSED_SHARE is closed. In between, rounding and the last digits of a torque would decide: `undecided`.

Stiffness of the flanks that carry load, about the place where the torques hold the machine. Behind the teeth
of a mesh lies a body, of which only some modes are kept. What they leave out is a static compliance R (2, 2)
between the two flanks of the mesh, the residual of MacNeal 1971 without mass. With the slopes D of the teeth
of both flanks and the deflections d,

    F = S d,   S = (D^-1 + R)^-1 = (1 + D R)^-1 D

A flank that presses alone has its entry of the diagonal of R in series with its teeth. Where both flanks of a
mesh press, S couples them: teeth on both of its flanks bend one rim.
"""

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.machine.flanks import flank_edges, flank_law
from facegear.machine.machine import Machine
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import bearing_forces, mean_equilibrium
from facegear.machine.supports import has_rolling_bearings
from facegear.meshing.law import past_levels

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
        """Whether some contact's force lies between the shares OPEN_SHARE and CLOSED_SHARE of the
        largest.

        Returns
        -------
        bool
            True if a flank or a bearing is undecided.
        """
        return Contact.UNCERTAIN in [*self.flank_states(), *self.ring_states()]

    def _state(self, force: float) -> Contact:
        """Return the state of a contact by its force, N, over the largest flank force: open up to
        OPEN_SHARE, in contact from CLOSED_SHARE, uncertain between.
        """
        largest = self.flanks.max()
        if force <= OPEN_SHARE * largest:
            return Contact.OPEN
        return Contact.IN_CONTACT if force >= CLOSED_SHARE * largest else Contact.UNCERTAIN


def loaded_contacts(machine: Machine) -> LoadedContacts:
    """Return the contacts of geometric meshes in equilibrium under the mean torques.

    The equilibrium has the mean law over the mesh cycle, constant errors, and no e(t).

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
    constant = machine.mean_flank_stiffness
    if forces is not None:
        past_law = np.zeros(constant.size, bool)
        return LoadedContacts(forces, constant, forces / constant, past_law, rings, positions)
    equilibrium = mean_equilibrium(static_machine)
    ringed = machine.linear.rings.body
    rings[ringed] = np.hypot(*bearing_forces(static_machine, equilibrium)[0, ringed, :2].T)
    positions[ringed] = equilibrium.displacements[0, machine.linear.ring_coordinates]
    over = static_machine.linear.rows @ equilibrium.displacements[0] - flank_edges(machine)
    if machine.own_softening is not None:
        over += np.tile(machine.own_softening, 2) * equilibrium.flank_forces[0]
    law, compression = flank_law(machine).mean(), np.maximum(over, 0.0)
    stiffness = constant if machine.constant_stiffness else law.slope(np.zeros(1), compression[None])[0]
    past = past_levels(law, compression[None]) > 0.0
    return LoadedContacts(equilibrium.flank_forces[0], stiffness, compression, past, rings, positions)


def forces_by_active_sets(machine: Machine) -> Array | None:
    """Compute the flank forces at mean stiffness: the statics of one position without compiled code.

    It starts with all drive flanks closed. Each step solves the linear springs of the closed flanks, then
    closes the flanks whose deflection exceeds their gap, until the set no longer changes.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.

    Returns
    -------
    (2 meshes,) array or None
        N, drive flanks first. None for bearings with clearance or whose stiffness depends on the load, as
        that of the flanks may, and where the set does not settle in MAX_SETS steps or leaves a loaded
        body free.
    """
    linear = machine.static_machine.linear
    if linear.rings.body.size or has_rolling_bearings(machine.drive_line) or not machine.constant_stiffness:
        return None
    masses = linear.mass.diagonal()
    scale = np.where(masses > 0.0, 1.0 / np.sqrt(np.where(masses > 0.0, masses, 1.0)), 1.0 / linear.lengths)
    jacobian = linear.rows * scale
    bearing = linear.stiffness * np.outer(scale, scale)
    loads = linear.loads * scale
    stiffness = machine.mean_flank_stiffness
    gaps = flank_edges(machine)
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


SAMPLES = 64
"""Phases at which the softened stiffness is computed, for each harmonic of the teeth's own stiffness."""


def flank_springs(machine: Machine, contacts: LoadedContacts, contact_mask: Mask) -> Array:
    """Return the stiffness matrix of all flanks, averaged over the mesh cycle, at the mean torques.

    It maps deflections of flanks to their forces and is diagonal, but for `coupled_meshes`, whose two
    flanks have entries between them.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    contacts : LoadedContacts
        Contacts of the machine under its mean torques.
    contact_mask : (2 meshes,) array of bool
        Which flanks count as pressed, drive flanks first; the others have zeros.

    Returns
    -------
    (2 meshes, 2 meshes) array
        N/m.
    """
    springs = np.diag(np.where(contact_mask, contacts.stiffness, 0.0))
    for mesh in coupled_meshes(machine, contact_mask).tolist():
        flanks = [mesh, mesh + len(machine.layout.meshes)]
        springs[np.ix_(flanks, flanks)] = _coupled_stiffness(machine, contacts, mesh)
    return springs


def coupled_meshes(machine: Machine, contact_mask: Mask) -> Integers:
    """Return the meshes whose two flanks both press (wedged) and have a compliance between them in
    `Machine.softening`.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    contact_mask : (2 meshes,) array of bool
        Which flanks count as pressed, drive flanks first.

    Returns
    -------
    (n,) array of int
        Indices of meshes.
    """
    if machine.softening is None:
        return np.zeros(0, np.int64)
    return np.flatnonzero(contact_mask.reshape(2, -1).all(axis=0) & (machine.softening[:, 0, 1] != 0.0))


def _coupled_stiffness(machine: Machine, contacts: LoadedContacts, mesh: int) -> Array:
    """Return the stiffness (2, 2), N/m, of a wedged mesh, drive flank first: (1 + D R)^-1 D averaged over
    phases.

    D holds the slopes of both flanks' laws at their compression, R the compliance behind the teeth. A law
    in proportion to the compression is taken of the teeth alone, with the whole of R: the series of a
    softened stiffness ends at the order of the teeth's own. Other laws hold the diagonal of R already.
    """
    assert machine.softening is not None
    behind, law, compression = machine.softening[mesh], flank_law(machine), contacts.compression
    if machine.constant_stiffness:
        law, compression = flank_law(replace(machine, softening=None)), np.ones_like(compression)
    else:
        behind = behind * (1.0 - np.eye(2))
    count = SAMPLES * (machine.stiffness.order + 1)
    slopes = law.slope(np.arange(count) / count, np.repeat(compression[None], count, axis=0))
    teeth = slopes[:, [mesh, mesh + len(machine.layout.meshes)], None] * np.eye(2)
    return np.asarray(np.linalg.solve(np.eye(2) + teeth @ behind, teeth).mean(axis=0))
