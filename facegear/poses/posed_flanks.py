"""Flanks of all meshes at a pose: their unloaded contacts, by what these close them, and the energy's slopes.

Flanks are numbered with all drive flanks first, then all back flanks. What deflections hold of an assembly
error to first order is `ideal_slopes`; the rest is counted here.
"""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import NotConverged
from facegear.geometry.conjugate import ConjugateContact, PairNumbers, contact_at
from facegear.geometry.conjugate_slopes import conjugate_slopes
from facegear.geometry.design import AssemblyErrors
from facegear.poses.energy import MeshEnergy
from facegear.poses.mesh_poses import PARTS, MeshPoses
from facegear.poses.surface import PoseSurface
from facegear.transmission.machine import Machine


def unloaded_contacts(
    surface: PoseSurface, poses: MeshPoses, names: tuple[str, ...]
) -> list[ConjugateContact]:
    """Return the unloaded contact of all drive flanks, then all back flanks.

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    poses : MeshPoses
        Poses of the meshes.
    names : tuple of str
        Names of the meshes.

    Returns
    -------
    list of ConjugateContact
        2 meshes entries, in m and rad.

    Raises
    ------
    NotConverged
        If the flanks of a mesh do not face each other.
    """
    contacts = []
    for back in (False, True):
        for mesh, name in enumerate(names):
            errors = poses.errors(mesh, back)
            contact = contact_at(surface.pair, errors)
            if contact is None:
                pose_text = (
                    f"offset {1e6 * errors.offset:.4g} um, axial shift {1e6 * errors.axial_shift:.4g} um"
                )
                raise NotConverged(
                    "operating pose", f"mesh {name}", f"no flanks face each other at {pose_text}"
                )
            contacts.append(contact)
    return contacts


def closing_beyond(
    machine: Machine, surface: PoseSurface, poses: MeshPoses, contacts: list[ConjugateContact]
) -> Array:
    """Return the exact transmission error of every flank less the part that its deflection has.

    Both are counted from the flank as assembled, which closes by nothing where no flanks face each other.

    Parameters
    ----------
    machine : Machine
        The machine.
    surface : PoseSurface
        Contact over the pose.
    poses : MeshPoses
        Poses of the meshes.
    contacts : list of ConjugateContact
        Unloaded contacts of `unloaded_contacts`.

    Returns
    -------
    (2 meshes,) array
        m.
    """
    pair, meshes = surface.pair, len(machine.layout.meshes)
    closure = np.zeros(2 * meshes)
    for flank, contact in enumerate(contacts):
        mesh, back = flank % meshes, flank >= meshes
        nominal = assembly_errors(machine, surface, mesh, back)
        at_rest = contact_at(pair, nominal)
        if at_rest is None:
            continue
        first = ideal_slopes(pair) @ (_three(poses.errors(mesh, back)) - _three(nominal))
        closure[flank] = contact.transmission_error - at_rest.transmission_error - first
    return closure


def flank_reactions(
    surface: PoseSurface,
    poses: MeshPoses,
    contacts: list[ConjugateContact],
    energies: list[MeshEnergy],
    loaded_flanks: Integers,
) -> Array:
    """Return the derivatives of the energy of every flank by its errors, over its force.

    For a flank that does not carry it is the limit at no force: the normal of the unloaded contact.

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    poses : MeshPoses
        Poses of the meshes.
    contacts : list of ConjugateContact
        Unloaded contacts of `unloaded_contacts`.
    energies : list of MeshEnergy
        Energy of each mesh.
    loaded_flanks : (meshes,) array of int
        Index of the flank of each mesh that carries.

    Returns
    -------
    (2 meshes, 3) array
        By offset and axial shift, m/m, and error of the shaft angle, m/rad.
    """
    meshes = len(energies)
    reactions = np.zeros((2 * meshes, 3))
    for flank, contact in enumerate(contacts):
        energy = energies[flank % meshes]
        slopes = conjugate_slopes(surface.pair, poses.errors(flank % meshes, flank >= meshes), contact)
        reactions[flank] = slopes.transmission_error
        if flank == loaded_flanks[flank % meshes] and energy.force > 0.0:
            by_angle = np.array([0.0, 0.0, energy.by_angle])
            reactions[flank] -= (energy.by_path * slopes.path + by_angle) / energy.force
    return reactions


def force_slopes(surface: PoseSurface, reactions: Array, meshes: int) -> Array:
    """Return the slopes of the forces of all flanks as `ForceDirections` has them.

    A back flank meets an offset as the opposite one.

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    reactions : (2 meshes, 3) array
        Derivatives of `flank_reactions`, m/m and m/rad.
    meshes : int
        Number of meshes.

    Returns
    -------
    (2 meshes, parts) array
        m/m and m/rad.
    """
    slopes = np.zeros((2 * meshes, len(PARTS)))
    slopes[:, :3] = reactions - ideal_slopes(surface.pair)
    slopes[meshes:, 0] *= -1.0
    return slopes


def ideal_slopes(pair: PairNumbers) -> Array:
    """Return the part of an offset, an axial shift and an error of the shaft angle that deflections hold.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.

    Returns
    -------
    (3,) array
        m/m, m/m and m/rad.
    """
    cosine, sine = np.cos(pair.pressure_angle), np.sin(pair.pressure_angle)
    return np.array([cosine, -sine, -sine * (pair.gear_base_radius / cosine - pair.mean_radius)])


def assembly_errors(machine: Machine, surface: PoseSurface, mesh: int, back: bool) -> AssemblyErrors:
    """Return the assembly errors that a flank meets without any motion, those of the pair's own assembly.

    Parameters
    ----------
    machine : Machine
        The machine.
    surface : PoseSurface
        Contact over the pose.
    mesh : int
        Index of the mesh.
    back : bool
        Whether it is the back flank.

    Returns
    -------
    AssemblyErrors
        m and rad.
    """
    side = machine.layout.gears[machine.layout.meshes[mesh][1]].sign
    nominal = surface.nominal
    return replace(
        nominal,
        offset=(-side if back else side) * nominal.offset,
        shaft_angle_error=side * nominal.shaft_angle_error,
    )


def nominal_contact(machine: Machine, surface: PoseSurface, mesh: int, back: bool) -> tuple[float, float]:
    """Return unloaded path and error of the shaft angle of a flank as assembled, without any motion.

    Parameters
    ----------
    machine : Machine
        The machine.
    surface : PoseSurface
        Contact over the pose.
    mesh : int
        Index of the mesh.
    back : bool
        Whether it is the back flank.

    Returns
    -------
    pair of float
        m and rad.
    """
    errors = assembly_errors(machine, surface, mesh, back)
    contact = contact_at(surface.pair, errors)
    assert contact is not None
    return contact.y, errors.shaft_angle_error


def _three(errors: AssemblyErrors) -> Array:
    return np.array([errors.offset, errors.axial_shift, errors.shaft_angle_error])
