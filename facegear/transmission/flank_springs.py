"""Stiffness of the flanks that carry load, about the place where the torques hold the machine.

Behind the teeth of a mesh lies a body, of which only some modes are kept. What they leave out is a static
compliance R (2, 2) between the two flanks of the mesh, the residual of MacNeal 1971 without mass. With the
slopes D of the teeth of both flanks and the deflections d,

    F = S d,   S = (D^-1 + R)^-1 = (1 + D R)^-1 D

A flank that presses alone has its entry of the diagonal of R in series with its teeth. Where both flanks of a
mesh press, S couples them: teeth on both of its flanks bend one rim.
"""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.transmission.flanks import flank_law
from facegear.transmission.loaded_contacts import LoadedContacts
from facegear.transmission.machine import Machine

SAMPLES = 64
"""Places in the mesh cycle for each harmonic of the mesh stiffness, as `Harmonics.softened` takes them."""


def flank_springs(machine: Machine, contacts: LoadedContacts, contact_mask: Mask) -> Array:
    """Return the mean stiffness of all flanks over the mesh cycle.

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
    """Return the wedged meshes whose flanks are coupled by what the modes leave out.

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
    """Return the stiffness (2, 2) of a wedged mesh: S at places of the mesh cycle, averaged.

    A law in proportion to the compression is taken of the teeth alone, with the whole of R: the series of a
    softened stiffness ends at the order of the teeth's own.
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
