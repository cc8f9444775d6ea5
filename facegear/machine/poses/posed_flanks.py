"""Flanks of all meshes at a pose: energy, force, law and reactions.

The energy of a mesh in contact over its pose: force, law and reactions come from one function. Averaged over
a mesh cycle, a mesh that is compressed by x with its unloaded contact at y and an error g of the shaft angle
stores

    U(x, y, g) = max over F of [x F - G(F, y, g)],   G(F, y, g) = integral of F' / k(F', y, g) from 0 to F,

k the average stiffness of the surface. Then F = U_x, U_y = -G_y and U_g = -G_g, the latter at constant F.
With x = x(q) + closing(q), the exact unloaded contact gives the derivatives of x, y and g by all motions q of
the bodies, so that the reactions are -F x_q + G_y y_q + G_g g_q: the load moves the middle of the contact
away from y and turns the force. Below the smallest torque of the surface k goes on as the power of the load
that it has there, as in the contact of single points.

Flanks of all meshes at a pose: their unloaded contacts, by what these close them, and the energy's slopes.
Flanks are numbered with all drive flanks first, then all back flanks. What deflections hold of an assembly
error to first order is `ideal_slopes`; the rest is counted here.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import NotConverged
from facegear.machine.machine import Machine
from facegear.machine.poses.mesh_poses import PARTS, MeshPoses
from facegear.machine.poses.surface import PoseSurface
from facegear.teeth.conjugate import ConjugateContact, PairNumbers, conjugate_slopes, contact_at
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import FLANKS, errors_at

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)
"""Points and weights of Gauss's rule between two torques of the surface; the integrand is an exponential of a
cubic.
"""


@dataclass(frozen=True)
class MeshEnergy:
    """Elastic energy of a mesh at a force, averaged over the mesh cycle, with U and G of this module.

    Attributes
    ----------
    force
        Along the line of action, N.
    approach
        Compression x of the mesh at that force, m.
    energy
        Elastic energy U = x F - G, J.
    by_path
        G_y, derivative of the complementary energy G by the unloaded path, at constant force, J/m.
    by_angle
        G_g, its derivative by the error of the shaft angle, J/rad.
    """

    force: float
    approach: float
    energy: float
    by_path: float
    by_angle: float

    def with_stiffness_factor(self, factor: float) -> "MeshEnergy":
        """Return the energy of teeth that are `factor` times as stiff, at the same force: all but the
        force are divided by the factor.

        Parameters
        ----------
        factor : float
            Factor on the stiffness, dimensionless.

        Returns
        -------
        MeshEnergy
            N, m and J.
        """
        scaled_parts = (part / factor for part in (self.approach, self.energy, self.by_path, self.by_angle))
        return MeshEnergy(self.force, *scaled_parts)


def mesh_energy(surface: PoseSurface, torque: float, path: float, angle: float) -> MeshEnergy:
    """Return the energy of a mesh under a torque, with the stiffness of the surface at every smaller
    torque.

    G = integral of F' / k(F', y, g) from 0 to F, by Gauss's rule between the surface's torques, and in
    closed form below the smallest of them; k is the average stiffness, y the path, g the angle.

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    torque : float
        Torque on the pinion, N m.
    path : float
        Place of the unloaded contact along the pinion, m.
    angle : float
        Error of the shaft angle, rad.

    Returns
    -------
    MeshEnergy
        N, m and J; zeros without a torque.
    """
    if torque <= 0.0:
        return MeshEnergy(0.0, 0.0, 0.0, 0.0, 0.0)
    base, knots = surface.pair.normal_arm, np.log(surface.nodes.torques)
    stiffness_logs, last = surface.stiffness_logs(path, angle), float(np.log(torque))
    lightest = min(last, float(knots[0]))
    slope = stiffness_logs @ surface.torque_weights(knots[0], 1)
    logs = stiffness_logs[:, 0] + (lightest - knots[0]) * slope
    parts = _light(lightest, logs, slope)
    if last > knots[0]:
        parts += _above(surface, stiffness_logs, np.append(knots[knots < last], last))
        logs = stiffness_logs @ surface.torque_weights(last)
    complementary, by_path, by_angle = parts / base**2
    force = torque / base
    approach = force / float(np.exp(logs[0]))
    return MeshEnergy(force, approach, force * approach - complementary, float(by_path), float(by_angle))


def linear_energy(surface: PoseSurface, load: float, torque: float, path: float, angle: float) -> MeshEnergy:
    """Return the energy of a mesh whose stiffness k is taken at one torque whatever it carries: U = G =
    F^2 / (2 k).

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    load : float
        Torque on the pinion at which the stiffness is taken, N m.
    torque : float
        Torque on the pinion, N m.
    path : float
        Unloaded path, m.
    angle : float
        Error of the shaft angle, rad.

    Returns
    -------
    MeshEnergy
        N, m and J.
    """
    log, by_path, by_angle = surface.stiffness_logs(path, angle) @ surface.torque_weights(float(np.log(load)))
    force = torque / surface.pair.normal_arm
    approach = force / float(np.exp(log))
    energy = 0.5 * force * approach
    return MeshEnergy(force, approach, energy, float(-energy * by_path), float(-energy * by_angle))


def _light(last: float, logs: Array, slope: Array) -> Array:
    """Integrate T / stiffness over the torque T from 0 to exp(last), where the stiffness is a power of T.

    The result (3,) is the complementary energy G for a base radius of 1 m, J, and its derivatives by
    path, J/m, and angle, J/rad. logs, slope (3,): logarithm of the stiffness at `last` with its
    derivatives by path and angle, and the slopes of these three over the logarithm of the torque.
    """
    whole = np.exp(2.0 * last - logs[0]) / (2.0 - slope[0])
    return np.asarray(whole * np.array([1.0, *(slope[1:] / (2.0 - slope[0]) - logs[1:])]))


def _above(surface: PoseSurface, stiffness_logs: Array, ends: Array) -> Array:
    """Integrate T / stiffness over the torque T between the exponentials of the first and last of `ends`.

    The result (3,) is the complementary energy G for a base radius of 1 m, J, and its derivatives by path,
    J/m, and angle, J/rad.

    stiffness_logs: (3, torques) array that `PoseSurface.stiffness_logs` returns. ends: rising logarithms of
    torques in N m, the surface's nodes and the last torque; Gauss's rule is applied between neighbours.
    """
    half = 0.5 * np.diff(ends)[:, None]
    at = ends[:-1, None] + half * (POINTS + 1.0)
    log, by_path, by_angle = np.moveaxis(surface.torque_weights(at) @ stiffness_logs.T, -1, 0)
    weights = half * WEIGHTS * np.exp(2.0 * at - log)
    return np.array([weights.sum(), -(weights * by_path).sum(), -(weights * by_angle).sum()])


def flank_surfaces(machine: Machine, surface: PoseSurface) -> list[PoseSurface]:
    """Return the surface of every flank.

    Parameters
    ----------
    machine : Machine
        The machine.
    surface : PoseSurface
        Contact over the pose.

    Returns
    -------
    list of PoseSurface
        2 meshes entries, drive flanks first.
    """
    layout = machine.layout
    sides = [layout.gears[gear].side.value for _, gear in layout.meshes]
    return [surface.of_flank(side, flank) for flank in FLANKS for side in sides]


def unloaded_contacts(
    surfaces: list[PoseSurface], poses: MeshPoses, names: tuple[str, ...]
) -> list[ConjugateContact]:
    """Return the unloaded contact of all drive flanks, then all back flanks.

    Parameters
    ----------
    surfaces : list of PoseSurface
        Surface of every flank, by `flank_surfaces`.
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
    for flank, surface in enumerate(surfaces):
        mesh = flank % len(names)
        errors = poses.errors(mesh, flank >= len(names))
        contact = contact_at(surface.pair, errors)
        if contact is None:
            pose_text = f"offset {1e6 * errors.offset:.4g} um, axial shift {1e6 * errors.gear_axial:.4g} um"
            problem = f"no flanks face each other at {pose_text}"
            raise NotConverged("operating pose", f"mesh {names[mesh]}", problem)
        contacts.append(contact)
    return contacts


def closing_beyond(
    machine: Machine, surface: PoseSurface, poses: MeshPoses, contacts: list[ConjugateContact]
) -> Array:
    """Return by how much the exact unloaded contact closes every flank beyond what its deflection counts.

    It is the change of the exact transmission error from the flank as assembled, less `ideal_slopes`
    times the change of the assembly errors; 0 where the flanks as assembled do not face each other. A shift
    of a pinion along its axis closes flanks in proportion, so that nothing is beyond.

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
        m, drive flanks first; positive closes the flank.
    """
    surfaces, meshes = flank_surfaces(machine, surface), len(machine.layout.meshes)
    closure = np.zeros(2 * meshes)
    for flank, contact in enumerate(contacts):
        mesh, back, pair = flank % meshes, flank >= meshes, surfaces[flank].pair
        nominal = assembly_errors(machine, surface, mesh, back)
        at_rest = contact_at(pair, nominal)
        if at_rest is None:
            continue
        first = ideal_slopes(pair) @ (_three(poses.errors(mesh, back)) - _three(nominal))
        closure[flank] = contact.transmission_error - at_rest.transmission_error - first
    return closure


def flank_reactions(
    surfaces: list[PoseSurface],
    poses: MeshPoses,
    contacts: list[ConjugateContact],
    energies: list[MeshEnergy],
    loaded_flanks: Integers,
) -> Array:
    """Return the derivatives of the energy of every flank by its errors, over its force.

    It is the derivative of the transmission error, less (G_y dy + G_g dg) / F on the flank that carries.
    For a flank that does not carry it is the limit at no force: the normal of the unloaded contact.

    Parameters
    ----------
    surfaces : list of PoseSurface
        Surface of every flank, by `flank_surfaces`.
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
        energy, pair = energies[flank % meshes], surfaces[flank].pair
        slopes = conjugate_slopes(pair, poses.errors(flank % meshes, flank >= meshes), contact)
        reactions[flank] = slopes.transmission_error
        if flank == loaded_flanks[flank % meshes] and energy.force > 0.0:
            by_angle = np.array([0.0, 0.0, energy.by_angle])
            reactions[flank] -= (energy.by_path * slopes.path + by_angle) / energy.force
    return reactions


def force_slopes(surfaces: list[PoseSurface], reactions: Array) -> Array:
    """Return the slopes of the forces of all flanks as `ForceDirections.slopes`: reactions less
    `ideal_slopes`.

    The column of `outward` is zero. A back flank meets an offset as the opposite one, so that its sign
    changes.

    Parameters
    ----------
    surfaces : list of PoseSurface
        Surface of every flank, by `flank_surfaces`.
    reactions : (2 meshes, 3) array
        Derivatives of `flank_reactions`, m/m and m/rad.

    Returns
    -------
    (2 meshes, parts) array
        m/m and m/rad, columns as PARTS.
    """
    slopes = np.zeros((len(surfaces), len(PARTS)))
    slopes[:, :3] = reactions - [ideal_slopes(surface.pair) for surface in surfaces]
    slopes[len(surfaces) // 2 :, 0] *= -1.0
    return slopes


@lru_cache(maxsize=32)
def ideal_slopes(pair: PairNumbers) -> Array:
    """Return the deflection of a drive flank for a unit offset, axial shift and error of the shaft angle,
    to first order, along the normal of the ideal contact.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.

    Returns
    -------
    (3,) array
        m/m, m/m and m/rad; shared between calls, not to be written.
    """
    line = pair.contact_line(AssemblyErrors())
    assert line is not None  # without errors of assembly there always is one
    return line.error_slopes()[0][:3]


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
    gear = machine.layout.gears[machine.layout.meshes[mesh][1]].side.value
    return errors_at(surface.nominal, gear, FLANKS[int(back)])


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
    flank = mesh + len(machine.layout.meshes) * int(back)
    contact = contact_at(flank_surfaces(machine, surface)[flank].pair, errors)
    assert contact is not None
    return contact.path, errors.shaft_angle_error


def _three(errors: AssemblyErrors) -> Array:
    """Return offset, m, axial shift, m, and shaft angle error, rad, as an array (3,)."""
    return np.array([errors.offset, errors.gear_axial, errors.shaft_angle_error])
