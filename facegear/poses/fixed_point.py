"""The machine with its teeth where its own forces put them: fixed point of statics and contact over pose.

The pose of every mesh gives a factor on its stiffness, and what the exact unloaded contact closes each flank
by beyond the first order that the meshes' deflections hold. Both are errors of single meshes, so that
everything that is computed of a machine takes them. To first order the line of action's part of a
displacement is the deflection itself and is counted once.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.geometry.conjugate import ConjugateContact, contact_at
from facegear.geometry.design import AssemblyErrors
from facegear.poses.mesh_poses import MeshPoses, mesh_poses
from facegear.poses.surface import STIFFNESS, PoseSurface
from facegear.transmission.flanks import carried
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest as static
from facegear.transmission.statics import Equilibria, mean_equilibrium

TOLERANCE = 1e-6
"""Largest change of a mesh force in the last step, over the largest force."""
STEPS = 60


@dataclass(frozen=True, eq=False)
class OperatingPose:
    """A machine at its converged pose, all of m meshes and flanks that carry.

    Attributes
    ----------
    machine
        With the factors and errors that the poses give to its meshes.
    forces : (m,)
        What each mesh transmits with mean stiffness and no e(t), N; negative on the back flank.
    poses
        Of all meshes, with the assembly errors of the pair in.
    path, angle : (m,)
        Where the unloaded contact of the carrying flank stands along the pinion, m; its error of the shaft
        angle, rad.
    torque : (m,)
        On the pinion by that mesh, N m.
    factor : (m,)
        Stiffness at pose and load over the machine's own.
    closing : (2 m,)
        By what the exact contact closes every flank beyond first order, m, drive flanks first.
    steps
        That were taken, and `change` of the last one relative to the largest force.
    """

    machine: Machine
    forces: Array
    poses: MeshPoses
    path: Array
    angle: Array
    torque: Array
    factor: Array
    closing: Array
    steps: int
    change: float


def operating_pose(
    machine: Machine,
    surface: PoseSurface,
    load: float | None = None,
    second_order: bool = True,
) -> OperatingPose:
    """The fixed point under the machine's mean torques, to TOLERANCE.

    load: torque (N m) at which all stiffnesses are taken whatever the meshes carry, None for their own.
    second_order: whether `closing` counts. Raises InvalidInput for a pose outside the surface, NotConverged.
    """
    own = machine.imperfections.stiffness
    posed, forces = machine, mean_equilibrium(static(machine))
    change = np.inf
    for step in range(1, STEPS + 1):
        result = _posed(machine, surface, forces, load, second_order)
        posed, before = result.machine, result.forces
        forces = mean_equilibrium(static(posed))
        now = carried(forces.forces[0])
        change = float(np.abs(now - before).max() / max(np.abs(now).max(), 1e-300))
        if change < TOLERANCE:
            last = _posed(machine, surface, forces, load, second_order)
            return replace(last, steps=step, change=change)
    tried = f"{STEPS} steps; forces still change by {change:.1e} of the largest (own stiffness {own.max():g})"
    raise NotConverged("operating pose", f"{np.abs(machine.torques).max():g} N m", tried)


def posed_machine(machine: Machine, surface: PoseSurface) -> Machine:
    """The machine with the poses that its own mean torques make. Raises what `operating_pose` raises."""
    return operating_pose(machine, surface).machine


def _posed(
    machine: Machine, surface: PoseSurface, at_rest: Equilibria, load: float | None, second_order: bool
) -> OperatingPose:
    """The machine with the poses of an equilibrium."""
    layout, names = machine.layout, machine.layout.mesh_names
    meshes = len(names)
    forces = carried(at_rest.forces[0])
    poses = _poses(machine, surface, at_rest)
    back = forces < 0.0
    contacts = _contacts(surface, poses, names)
    path = np.array([contacts[mesh + meshes * int(back[mesh])].y for mesh in range(meshes)])
    torque = np.abs(forces) * layout.pinion_arm
    factor = np.ones(meshes)
    for mesh, name in enumerate(names):
        angle = float(poses.shaft_angle_error[mesh])
        surface.require(name, float(torque[mesh]), float(path[mesh]), angle)
        if forces[mesh] != 0.0:
            taken = float(torque[mesh]) if load is None else load
            own = surface.at(STIFFNESS, taken, float(path[mesh]), angle)
            factor[mesh] = own / _nominal(machine, surface, mesh, taken, bool(back[mesh]))
    closing = _closing(machine, surface, poses, contacts) if second_order else np.zeros(2 * meshes)
    return OperatingPose(
        machine=_with(machine, factor, closing),
        forces=forces,
        poses=poses,
        path=path,
        angle=poses.shaft_angle_error,
        torque=torque,
        factor=factor,
        closing=closing,
        steps=0,
        change=0.0,
    )


def _poses(machine: Machine, surface: PoseSurface, at_rest: Equilibria) -> MeshPoses:
    """Poses at the displacements, of pinions that stand where their bearings are, in the pair's assembly."""
    linear, nominal = static(machine).linear, surface.nominal
    moved = at_rest.displacements[0].copy()
    for pinion, position in enumerate(machine.imperfections.position):
        moved[4 * pinion : 4 * pinion + 2] += position
    motion = mesh_poses(linear, machine.layout, surface.pair.mean_radius, moved)
    side = np.array([machine.layout.gears[g].sign for _, g in machine.layout.meshes])
    return MeshPoses(
        offset=motion.offset + side * nominal.offset,
        axial_shift=motion.axial_shift + nominal.axial_shift,
        shaft_angle_error=motion.shaft_angle_error + side * nominal.shaft_angle_error,
        outward=motion.outward,
    )


def _contacts(surface: PoseSurface, poses: MeshPoses, names: tuple[str, ...]) -> list[ConjugateContact]:
    """Unloaded contact of all drive flanks, then all back flanks."""
    contacts = []
    for back in (False, True):
        for mesh, name in enumerate(names):
            errors = poses.errors(mesh, back)
            contact = contact_at(surface.pair, errors)
            if contact is None:
                where = f"offset {1e6 * errors.offset:.4g} um, axial shift {1e6 * errors.axial_shift:.4g} um"
                raise NotConverged("operating pose", f"mesh {name}", f"no flanks face each other at {where}")
            contacts.append(contact)
    return contacts


def _closing(
    machine: Machine, surface: PoseSurface, poses: MeshPoses, contacts: list[ConjugateContact]
) -> Array:
    """Exact transmission error of every flank less what its deflection has of it, both from the nominal."""
    pair, layout, meshes = surface.pair, machine.layout, len(machine.layout.meshes)
    closing = np.zeros(2 * meshes)
    for flank, contact in enumerate(contacts):
        mesh, back = flank % meshes, flank >= meshes
        nominal = assembled(machine, surface, mesh, back)
        at_rest = contact_at(pair, nominal)
        if at_rest is None:
            continue
        met = poses.errors(mesh, back)
        beyond = pair.gear_base_radius / np.cos(pair.pressure_angle) - pair.mean_radius
        shift = met.axial_shift - nominal.axial_shift
        shift += beyond * (met.shaft_angle_error - nominal.shaft_angle_error)
        first = np.cos(layout.pressure_angle) * (met.offset - nominal.offset)
        first -= np.sin(layout.pressure_angle) * shift
        closing[flank] = contact.transmission_error - at_rest.transmission_error - first
    return closing


def assembled(machine: Machine, surface: PoseSurface, mesh: int, back: bool) -> AssemblyErrors:
    """What a flank meets of the pair's assembly without any motion."""
    side = machine.layout.gears[machine.layout.meshes[mesh][1]].sign
    nominal = surface.nominal
    return replace(
        nominal,
        offset=(-side if back else side) * nominal.offset,
        shaft_angle_error=side * nominal.shaft_angle_error,
    )


def _nominal(machine: Machine, surface: PoseSurface, mesh: int, torque: float, back: bool) -> float:
    """Stiffness (N/m) that the machine's own law stands for: as assembled, at the load if it follows that."""
    if machine.tables is not None:
        return surface.at(STIFFNESS, torque, *nominal_contact(machine, surface, mesh, back))
    contact = contact_at(surface.pair, surface.nominal)
    assert contact is not None
    return surface.at(STIFFNESS, surface.reference_torque, contact.y, surface.nominal.shaft_angle_error)


def nominal_contact(machine: Machine, surface: PoseSurface, mesh: int, back: bool) -> tuple[float, float]:
    """Unloaded path (m) and error of the shaft angle (rad) of a flank as assembled, without any motion."""
    errors = assembled(machine, surface, mesh, back)
    contact = contact_at(surface.pair, errors)
    assert contact is not None
    return contact.y, errors.shaft_angle_error


def _with(machine: Machine, factor: Array, closing: Array) -> Machine:
    """The machine with a factor on the stiffness of each mesh, and flanks closed by `closing` (2 meshes,)."""
    flaws = machine.imperfections
    drive, back = np.split(closing, 2)
    return replace(
        machine,
        imperfections=replace(
            flaws,
            stiffness=flaws.stiffness * factor,
            error=flaws.error - 0.5 * (drive - back),
            half_backlash=machine.half_backlashes - 0.5 * (drive + back),
        ),
    )
