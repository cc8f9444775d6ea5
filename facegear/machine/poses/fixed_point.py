"""Static equilibrium with pose-dependent contact, by fixed-point iteration.

The pose of every mesh gives a factor on its stiffness, what the exact unloaded contact closes each flank by
beyond the first order that the meshes' deflections hold, and the direction of its force. Law, force and
reactions of a mesh are the derivatives of one energy (`facegear.machine.poses.posed_flanks`), so that the
converged machine
is at rest in a potential. Factor and closure are errors of single meshes and the directions are rows of the
linear model, so that everything that is computed of a machine takes them. To first order the line of action's
part of a displacement is the deflection itself and is counted once.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import NotConverged
from facegear.machine.flanks import significant_forces
from facegear.machine.linear_model import LinearModel
from facegear.machine.machine import Machine
from facegear.machine.poses.mesh_poses import PARTS, ForceDirections, MeshPoses, mesh_poses, rim_levers
from facegear.machine.poses.posed_flanks import (
    closing_beyond,
    flank_reactions,
    flank_surfaces,
    force_slopes,
    linear_energy,
    mesh_energy,
    nominal_contact,
    unloaded_contacts,
)
from facegear.machine.poses.surface import STIFFNESS, PoseSurface
from facegear.machine.static_gears import at_rest as static
from facegear.machine.statics import Equilibria, mean_equilibrium
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import FLANKS, pair_at

TOLERANCE = 1e-6
"""Largest change of a mesh force in the last step, over the largest force."""
STEPS = 60
"""Largest number of steps."""
SAME_FACTOR, FACTOR_STEPS = 1e-13, 100
"""Change of a stiffness factor at which its iteration ends, and the largest number of its steps."""


@dataclass(frozen=True, eq=False)
class OperatingPose:
    """A machine at its converged pose, all of m meshes and flanks that carry.

    Attributes
    ----------
    machine
        With the factors, errors and directions that the poses give to its meshes.
    forces : (m,)
        Force of each mesh with mean stiffness and no e(t), N; negative on the back flank.
    poses
        Poses of all meshes, with the assembly errors of the pair in.
    path, angle : (m,)
        Position of the unloaded contact of the carrying flank along the pinion, m; its error of the shaft
        angle, rad.
    torque : (m,)
        On the pinion by that mesh, N m.
    factor : (m,)
        Stiffness at pose and load over the machine's own.
    flank_closure : (2 m,)
        By what the exact contact closes every flank beyond first order, m, drive flanks first.
    reactions : (m, 3)
        Derivatives of the energy of each mesh by offset, axial shift (N) and error of the shaft angle (N m)
        of the flank that carries, at the same turn of the gears.
    energy : (m,)
        Energy of each mesh, J.
    steps
        Number of steps, and `change` of the last one relative to the largest force.
    """

    machine: Machine
    forces: Array
    poses: MeshPoses
    path: Array
    angle: Array
    torque: Array
    factor: Array
    flank_closure: Array
    reactions: Array
    energy: Array
    steps: int
    change: float


def operating_pose(
    machine: Machine,
    surface: PoseSurface,
    load: float | None = None,
    ideal: bool = False,
) -> OperatingPose:
    """Compute the pose of a machine under its mean torques, by fixed-point iteration.

    Each step solves the equilibrium with mean stiffness and no e(t), then sets stiffness factors,
    closures and directions of the flanks by the poses found, until no mesh force changes by more than
    TOLERANCE of the largest.

    Parameters
    ----------
    machine : Machine
        The machine as assembled.
    surface : PoseSurface
        Contact over the pose.
    load : float or None
        Torque at which all stiffnesses are taken whatever the meshes carry, N m; None for their own.
    ideal : bool
        Whether deflections and forces of the flanks keep to the normals of the ideal contact.

    Returns
    -------
    OperatingPose
        SI units.

    Raises
    ------
    InvalidInput
        For a pose outside the surface.
    NotConverged
        If the forces do not settle, or no equilibrium is found.
    """
    machine_stiffness = machine.imperfections.stiffness
    machine = with_ideal_directions(machine, surface)
    machine_at_pose, forces = machine, mean_equilibrium(static(machine))
    change = np.inf
    for step in range(1, STEPS + 1):
        result = pose_at(machine, surface, forces, load, ideal)
        machine_at_pose, before = result.machine, result.forces
        forces = mean_equilibrium(static(machine_at_pose))
        now = significant_forces(forces.forces[0])
        change = float(np.abs(now - before).max() / max(np.abs(now).max(), 1e-300))
        if change < TOLERANCE:
            last = pose_at(machine, surface, forces, load, ideal)
            return replace(last, steps=step, change=change)
    problem = (
        f"{STEPS} steps; forces still change by {change:.1e} of the largest "
        f"(own stiffness {machine_stiffness.max():g})"
    )
    raise NotConverged("operating pose", f"{np.abs(machine.torques).max():g} N m", problem)


def with_ideal_directions(machine: Machine, surface: PoseSurface) -> Machine:
    """Return the machine with the directions of the ideal contact, at rest with the slopes of rims that bend.

    Parameters
    ----------
    machine : Machine
        The machine.
    surface : PoseSurface
        Contact over the pose.

    Returns
    -------
    Machine
        The same machine where its directions are set, or its bodies are rigid.
    """
    if machine.directions is not None or machine.bodies is None:
        return machine
    zeros = np.zeros((2 * len(machine.layout.meshes), len(PARTS)))
    return replace(machine, directions=ForceDirections(machine.layout, surface.pair.mean_radius, zeros))


def posed_machine(machine: Machine, surface: PoseSurface) -> Machine:
    """Return the machine with the poses that its own mean torques make.

    Parameters
    ----------
    machine : Machine
        The machine as assembled.
    surface : PoseSurface
        Contact over the pose.

    Returns
    -------
    Machine
        The machine at its pose.

    Raises
    ------
    InvalidInput, NotConverged
        As `operating_pose`.
    """
    return operating_pose(machine, surface).machine


def pose_at(
    machine: Machine,
    surface: PoseSurface,
    at_rest: Equilibria,
    load: float | None = None,
    ideal: bool = False,
) -> OperatingPose:
    """Return the machine with the poses of a given equilibrium, one step of `operating_pose`.

    Its forces, poses and torques are those of the equilibrium, which is not solved again.

    Parameters
    ----------
    machine : Machine
        The machine as assembled.
    surface : PoseSurface
        Contact over the pose.
    at_rest : Equilibria
        Equilibrium of a machine of `with_ideal_directions`; its first position is taken.
    load : float or None
        Torque at which all stiffnesses are taken whatever the meshes carry, N m; None for their own.
    ideal : bool
        Whether deflections and forces of the flanks keep to the normals of the ideal contact.

    Returns
    -------
    OperatingPose
        SI units; `steps` and `change` are 0.

    Raises
    ------
    InvalidInput
        For a pose outside the surface.
    NotConverged
        If the flanks of a mesh do not face each other.
    """
    machine = with_ideal_directions(machine, surface)
    layout, names = machine.layout, machine.layout.mesh_names
    meshes = len(names)
    forces = significant_forces(at_rest.forces[0])
    linear, displacements = _whole(machine, at_rest)
    poses = _poses(machine, surface, linear, displacements)
    loaded_flanks = np.arange(meshes) + meshes * (forces < 0.0)
    surfaces = flank_surfaces(machine, surface)
    contacts = unloaded_contacts(surfaces, poses, names)
    path = np.array([contacts[flank].path for flank in loaded_flanks])
    torque, angle = np.abs(layout.mesh_torques(forces)), poses.shaft_angle_error
    factor, energies = np.ones(meshes), []
    for mesh, name in enumerate(names):
        at = float(torque[mesh]), float(path[mesh]), float(angle[mesh])
        loaded_surface = surfaces[loaded_flanks[mesh]]
        loaded_surface.require(name, *at)
        if forces[mesh] != 0.0:
            back = bool(forces[mesh] < 0.0)
            factor[mesh] = _factor(machine, surface, loaded_surface, mesh, at, back, load)
        energy_of_pair = (
            mesh_energy(loaded_surface, *at) if load is None else linear_energy(loaded_surface, load, *at)
        )
        energies.append(energy_of_pair.with_stiffness_factor(_scale(machine, surface, mesh)))
    reactions = flank_reactions(surfaces, poses, contacts, energies, loaded_flanks)
    closure = closing_beyond(machine, surface, poses, contacts)
    slopes = force_slopes(surfaces, reactions)
    if ideal:
        slopes, closure = np.zeros_like(slopes), np.zeros_like(closure)
    middle = surface.pair.mean_radius
    directions = ForceDirections(layout, middle, slopes, None if ideal else rim_levers(layout, middle))
    beyond = directions.added_flank_rows(linear) @ displacements
    return OperatingPose(
        machine=replace(_with(machine, factor, closure - beyond), directions=directions),
        forces=forces,
        poses=poses,
        path=path,
        angle=angle,
        torque=torque,
        factor=factor,
        flank_closure=closure,
        reactions=np.abs(forces)[:, None] * reactions[loaded_flanks],
        energy=np.array([energy.energy for energy in energies]),
        steps=0,
        change=0.0,
    )


def _whole(machine: Machine, at_rest: Equilibria) -> tuple[LinearModel, Array]:
    """Return the linear model at rest with the shafts of its pinions, and its displacements (n,), m and
    rad.
    """
    static_machine, line = static(machine), machine.drive_line
    if line is None or static_machine.drive_line is not None:
        return static_machine.linear, at_rest.displacements[0]
    displacements = line.extend_displacements(machine.lumped_model, at_rest.displacements)[0]
    return replace(static_machine, drive_line=line).linear, displacements


def _poses(machine: Machine, surface: PoseSurface, linear: LinearModel, displacements: Array) -> MeshPoses:
    """Return the poses of all meshes at displacements (n,), m and rad, of the coordinates of `linear`.

    The shift of the pinions' bearings (`imperfections.position`, also along their axes) and the assembly
    errors of the surface's pair are added.
    """
    nominal, displacements_from_assembly = surface.nominal, displacements.copy()
    for pinion, position in enumerate(machine.imperfections.position):
        displacements_from_assembly[4 * pinion : 4 * pinion + 2] += position
    motion = mesh_poses(linear, machine.layout, surface.pair.mean_radius, displacements_from_assembly)
    side = np.array([machine.layout.gears[g].sign for _, g in machine.layout.meshes])
    axial_places = machine.imperfections.outwards[[pinion for pinion, _ in machine.layout.meshes]]
    return MeshPoses(
        offset=motion.offset + side * nominal.offset,
        gear_axial=motion.gear_axial + nominal.gear_axial,
        shaft_angle_error=motion.shaft_angle_error + side * nominal.shaft_angle_error,
        outward=motion.outward + axial_places + nominal.pinion_axial,
        pinion_axial=nominal.pinion_axial,
    )


def _factor(
    machine: Machine,
    surface: PoseSurface,
    loaded_surface: PoseSurface,
    mesh: int,
    at: tuple[float, float, float],
    back: bool,
    load: float | None,
) -> float:
    """Return the factor of the pose on the stiffness of a mesh, dimensionless.

    loaded_surface: that of the flank that carries; at: torque of the mesh on its pinion (N m), unloaded
    path (m) and error of the shaft angle (rad); back: whether the back flank carries; load: torque (N m) at
    which stiffnesses are taken, None for that of the mesh. Forces that follow the load are all multiplied
    by the factor, and then lie at another level of their law: it is found by iteration as the factor with
    which the mesh is compressed at its load as the surface says.
    """
    torque = at[0] if load is None else load
    stiffness = loaded_surface.at(STIFFNESS, torque, *at[1:])
    if machine.tables is None:
        return stiffness / surface.reference_stiffness
    rest, mesh_factor = nominal_contact(machine, surface, mesh, back), machine.imperfections.stiffness[mesh]
    factor = 1.0
    for _ in range(FACTOR_STEPS):
        level = torque / (mesh_factor * factor) if load is None else load
        level = min(level, float(loaded_surface.nodes.torques[-1]))
        before, factor = factor, stiffness / loaded_surface.at(STIFFNESS, level, *rest)
        if abs(factor - before) < SAME_FACTOR:
            break
    return factor


def _scale(machine: Machine, surface: PoseSurface, mesh: int) -> float:
    """Return the stiffness of the machine's teeth in a mesh, without pose, over that of the surface.

    It is the mesh's stiffness factor, times mean stiffness over the surface's reference where there are
    no force tables.
    """
    mesh_factor = float(machine.imperfections.stiffness[mesh])
    return (
        mesh_factor
        if machine.tables is not None
        else mesh_factor * machine.stiffness.mean / surface.reference_stiffness
    )


def _with(machine: Machine, factor: Array, closure: Array) -> Machine:
    """Return the machine with a factor (meshes,) on the stiffness of each mesh, and flanks closed by
    `closure` (2 meshes,), m, drive flanks first.

    What closes both flanks alike is taken off the half backlash, half the difference off the mesh's
    error, which counts along the drive flank and on the back flank as much more as its arm is longer.
    """
    flaws, arm = machine.imperfections, machine.layout.back_arm
    drive, back = np.split(closure, 2)
    return replace(
        machine,
        half_backlash=machine.half_backlash - (arm * drive + back) / (1.0 + arm),
        imperfections=replace(
            flaws, stiffness=flaws.stiffness * factor, error=flaws.error - (drive - back) / (1.0 + arm)
        ),
    )


ERROR_TOLERANCE = 1e-9
"""Difference of errors (m, rad) below which they count as the same."""


@dataclass(frozen=True, eq=False)
class CarryingPairs:
    """Different tooth pairs of a machine at a pose, so that each is analysed once.

    Attributes
    ----------
    designs
        The pair of each different flank, pose and torque; its drive flank carries, its assembly is that
        of the pose.
    torques
        Torque of each pair on the pinion, N m; 0 where it carries none.
    numbers : (m,)
        For each mesh the index of its carrying flank's pair, of its drive flank's where none carries.
    """

    designs: list[PairDesign]
    torques: list[float]
    numbers: Integers


def carrying_pairs(result: OperatingPose, design: PairDesign) -> CarryingPairs:
    """Return the different tooth pairs of a machine at a converged pose, so that each is analysed once.

    Meshes share a pair if flank, assembly errors (to ERROR_TOLERANCE) and torque (to nine digits) are
    equal.

    Parameters
    ----------
    result : OperatingPose
        Converged pose.
    design : PairDesign
        Design as assembled.

    Returns
    -------
    CarryingPairs
        Torques in N m.
    """
    designs: list[PairDesign] = []
    torques: list[float] = []
    number_of_key: dict[tuple[object, ...], int] = {}
    numbers = []
    layout = result.machine.layout
    for mesh, force in enumerate(result.forces.tolist()):
        back, torque = force < 0.0, float(result.torque[mesh])
        gear = layout.contact_gears[layout.meshes[mesh][1]]
        errors = result.poses.errors(mesh, back)
        if not design.is_spur:
            errors = replace(errors, pinion_axial=float(result.poses.outward[mesh]))
        pair = replace(pair_at(design, gear, FLANKS[int(back)]), assembly=errors)
        parts = (errors.offset, errors.shaft_angle_error, errors.gear_axial, errors.pinion_axial)
        teeth = pair.shaft_angle, pair.offset
        key = (back, *teeth, *(round(part / ERROR_TOLERANCE) for part in parts), f"{torque:.9g}")
        if key not in number_of_key:
            number_of_key[key] = len(designs)
            designs.append(pair)
            torques.append(torque)
        numbers.append(number_of_key[key])
    return CarryingPairs(designs, torques, np.array(numbers))
