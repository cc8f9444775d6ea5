"""A machine at rest with what decides its load sharing: stiffness, load and backlash of its paths."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine.flank_errors import constant_errors
from facegear.machine.flanks import flank_law, significant_forces
from facegear.machine.layout import Side
from facegear.machine.loaded_modes import pressed_springs
from facegear.machine.machine import Machine
from facegear.machine.mesh_frames import FlankFrame
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import Equilibria, settle
from facegear.sharing.closed_form import SplitMachine, plane_freedom
from facegear.sharing.even_shares import even_shares
from facegear.sharing.groups import GroupKind, LoadGroup, MapOptions, split_groups

NO_PUSH = 1e-9
"""Part of a mesh force below which a bearing carries nothing in a direction: rounding of normals."""


@dataclass(frozen=True)
class PathWrenches:
    """Effects of a unit force of an idler's mesh of a group, whose torque its second mesh balances.

    Attributes
    ----------
    group_frame, second_frame
        Lines of contact of the flanks that work: of the mesh of the group, and of the second one.
    """

    group_frame: FlankFrame
    second_frame: FlankFrame

    @property
    def arm(self) -> float:
        """Torque on the pinion over the force of the group's mesh, over that of a drive flank."""
        return abs(self.group_frame.arm)

    @property
    def second_force(self) -> float:
        """Force of the second mesh."""
        return abs(self.group_frame.arm / self.second_frame.arm)

    @property
    def on_pinion(self) -> Array:
        """Force of both meshes along the pinion's x, y, z, (3,), against the unit force."""
        return np.array(self.group_frame.normal) + self.second_force * np.array(self.second_frame.normal)

    @property
    def on_gears(self) -> tuple[float, float]:
        """Forces on the gear of the group's mesh and on the second gear, square to their axis."""
        first, second = (
            float(np.hypot(*frame.gear_normal[::2])) for frame in (self.group_frame, self.second_frame)
        )
        return first, self.second_force * second

    @property
    def meshes(self) -> float:
        """Compliance of both meshes over that of two meshes with a unit force."""
        return 0.5 * (1.0 + self.second_force**2)


class MappedMachine:
    """A machine at rest, with the stiffness and load of its paths; computed when asked for.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.
    """

    def __init__(self, machine: Machine) -> None:
        self.machine = machine

    @cached_property
    def machine_at_rest(self) -> Machine:
        """The machine reduced to what static questions need (`facegear.machine.static_gears.at_rest`)."""
        return at_rest(self.machine)

    @cached_property
    def base(self) -> Equilibria:
        """Equilibrium (one sample) with the machine's own errors but without drawn ones. Raises
        NotConverged.
        """
        return self.equilibria(np.zeros((1, len(self.machine.layout.pinions))))

    @cached_property
    def forces(self) -> Array:
        """Load magnitude (meshes,), N, of each mesh in `base`, with the machine's own errors alone."""
        return np.abs(significant_forces(self.base.forces)[0])

    @cached_property
    def mesh_springs(self) -> Array:
        """Tangent stiffness (meshes,), N/m, of each mesh under its load at rest, both flanks added; 0 if
        unloaded.
        """
        springs = np.diagonal(pressed_springs(self.machine_at_rest)[1])
        return np.asarray(springs.reshape(2, -1).sum(axis=0))

    def equilibria(self, late: Array) -> Equilibria:
        """Solve static equilibria of samples in which the upper meshes of the pinions are late.

        Stiffness and errors of the flanks are means over the mesh cycle.

        Parameters
        ----------
        late : (samples, pinions) array
            Lateness beside the machine's own errors, m along the drive flank's line of action; positive
            unloads the drive flank of the pinion's upper mesh, and loads its back flank.

        Returns
        -------
        Equilibria
            One for each sample, in m and N. Raises NotConverged.
        """
        layout = self.machine.layout
        meshes, upper = len(layout.meshes), [layout.mesh_index(i, Side.UPPER) for i in range(late.shape[1])]
        tangential = np.zeros((len(late), meshes))
        tangential[:, upper] = late
        on_flanks = np.concatenate([tangential, -layout.back_arm * tangential], axis=1)
        errors = constant_errors(self.machine_at_rest) + on_flanks
        names = [f"sample {number}" for number in range(len(late))]
        return settle(
            self.machine_at_rest, flank_law(self.machine_at_rest).mean(), np.zeros(len(late)), errors, names
        )

    def idler_forces(self, group: LoadGroup, late: Array) -> Array:
        """Compute the loads of the meshes of a group of idlers whose paths are late.

        Parameters
        ----------
        group : LoadGroup
            Idlers.
        late : (samples, paths) array
            Lateness of each path, m along the line of action of the group's mesh; positive unloads the path.

        Returns
        -------
        (samples, paths) array
            Magnitudes, N, in the order of group.meshes. Raises NotConverged.
        """
        pinions, every = self.pinions(group), np.zeros((len(late), len(self.machine.layout.pinions)))
        every[:, pinions] = late * self.working_flank(group) / self.path_wrenches(group).arm
        return np.abs(significant_forces(self.equilibria(every).forces)[:, list(group.meshes)])

    def working_flank(self, group: LoadGroup) -> Array:
        """Tell on which flank the upper mesh of each path is loaded without drawn errors.

        Parameters
        ----------
        group : LoadGroup
            Idlers.

        Returns
        -------
        (paths,) array
            Sign, dimensionless: 1 on the drive flank or without load, -1 on the back flank.
        """
        layout, forces = self.machine.layout, self.base.forces[0]
        upper = [layout.mesh_index(i, Side.UPPER) for i in self.pinions(group)]
        return np.where(forces[upper] < 0.0, -1.0, 1.0)

    def pinions(self, group: LoadGroup) -> Integers:
        """Return the index in `layout.pinions` of the pinion of each mesh of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes,) array of int
            In the order of group.meshes, dimensionless.
        """
        return np.array([self.machine.layout.meshes[mesh][0] for mesh in group.meshes])

    def even(self, group: LoadGroup) -> Array:
        """Return the nominal even share of each mesh of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes,) array
            N; nan where there is none.
        """
        return np.asarray(even_shares(self.machine)[list(group.meshes)])

    def load(self, group: LoadGroup) -> float:
        """Return the load W that the meshes of a group carry together without drawn errors.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            N.
        """
        return float(self.forces[list(group.meshes)].sum())

    def factor(self, group: LoadGroup) -> float:
        """Compute the largest K_gamma of a group's meshes: load without drawn errors over nominal even
        share.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            Mesh load factor, dimensionless; nan without an even share.
        """
        return float((self.forces[list(group.meshes)] / self.even(group)).max())

    def group_spring(self, group: LoadGroup) -> float:
        """Return the mean stiffness of all loaded meshes of the pinions of a group, on both gears.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            N/m; nan where none is loaded.
        """
        pinions = self.pinions(group)
        is_on_pinion = [i in pinions for i, _ in self.machine.layout.meshes]
        springs = self.mesh_springs[is_on_pinion]
        has_load = springs > 0.0
        return float(springs[has_load].mean()) if has_load.any() else float("nan")

    def bearing(self, group: LoadGroup) -> float:
        """Return the mean tangential (x) stiffness of the bearings of the pinions of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            N/m.
        """
        bodies = [self.machine.layout.pinions[i].body for i in self.pinions(group)]
        return float(np.mean([body.bearing[0] for body in bodies]))

    def path_wrenches(self, group: LoadGroup) -> PathWrenches:
        """Return what a unit force of a group's mesh does to an idler and to both gears.

        Parameters
        ----------
        group : LoadGroup
            Idlers, all of which work on the flanks of the first.

        Returns
        -------
        PathWrenches
            Dimensionless, for a unit force along the working flank of the group's mesh.
        """
        layout, mesh = self.machine.layout, group.meshes[0]
        gear = layout.meshes[mesh][1]
        flank = 1 if self.base.forces[0][mesh] < 0.0 else 0
        return PathWrenches(layout.flank_frames[gear][flank], layout.flank_frames[1 - gear][1 - flank])

    def idler_push(self, group: LoadGroup) -> float:
        """Return the force of both meshes of an idler on its bearing over that of the group's mesh, as a
        force along the tangent that bends the bearing alike.

        Parameters
        ----------
        group : LoadGroup
            Idlers.

        Returns
        -------
        float
            Dimensionless: twice the cosine of the pressure angle of spur teeth.
        """
        return self._along_tangent(group, self.path_wrenches(group).on_pinion)

    def input_push(self, group: LoadGroup) -> float:
        """Return half the force on an input's bearing by the difference of its two mesh forces, as a force
        along the tangent that bends the bearing alike.

        Parameters
        ----------
        group : LoadGroup
            Meshes of an input.

        Returns
        -------
        float
            Dimensionless: 1 for spur teeth, whose bearings count as alike along both directions.
        """
        layout = self.machine.layout
        if layout.kind is None:
            return 1.0
        flank = 0 if self.base.forces[0][list(group.meshes)].sum() >= 0.0 else 1
        first, second = (np.array(frames[flank].normal) for frames in layout.flank_frames)
        return 0.5 * self._along_tangent(group, first - second)

    def _along_tangent(self, group: LoadGroup, push: Array) -> float:
        """Return the tangential force that bends the bearings of the first pinion of a group as much as a
        force `push` (3,) along x, y, z does; directions without force need no bearing.
        """
        bearing = np.array(self.machine.layout.pinions[self.pinions(group)[0]].body.bearing)
        has_push = np.abs(push) > NO_PUSH
        return float(np.sqrt((push[has_push] ** 2 * bearing[0] / bearing[has_push]).sum()))

    def deviation(self, group: LoadGroup, options: MapOptions) -> float:
        """Return the standard deviation of the lateness of a path.

        Parameters
        ----------
        group : LoadGroup
            Idlers; paths of inputs are late by their backlash alone.
        options : MapOptions
            Deviations of meshes and places.

        Returns
        -------
        float
            m along the line of action of the group's mesh; 0 for inputs.
        """
        if group.kind is not GroupKind.IDLERS:
            return 0.0
        path = self.path_wrenches(group)
        return options.deviation(float(path.on_pinion[0]), path.arm)

    def path_stiffness(self, group: LoadGroup) -> float:
        """Return the stiffness k_e of a path through an idler: two meshes and the bearing in series.

        It is `SplitMachine.path_stiffness` with the group's mean mesh and bearing stiffness.

        Parameters
        ----------
        group : LoadGroup
            Idlers.

        Returns
        -------
        float
            N/m along the line of action.
        """
        meshes = self.path_wrenches(group).meshes
        push = self.idler_push(group)
        form = SplitMachine(1, 1, 1.0, self.group_spring(group), 0.0, push, idler_meshes=meshes)
        return form.path_stiffness(self.bearing(group))

    def freedom(self, group: LoadGroup) -> float:
        """Compute `plane_freedom` of the face gears on their own bearings: 0 fixed, 1 one of them floats.

        The radial stiffness of a gear's bearing is the mean of x and y.

        Parameters
        ----------
        group : LoadGroup
            Idlers, the paths between both gears.

        Returns
        -------
        float
            The number, dimensionless.
        """
        layout = self.machine.layout
        gear = layout.meshes[group.meshes[0]][1]
        bearings = [0.5 * (member.body.bearing[0] + member.body.bearing[1]) for member in layout.gears]
        stiffness, pushes = self.path_stiffness(group), self.path_wrenches(group).on_gears
        return plane_freedom(len(group.meshes), stiffness, (bearings[gear], bearings[1 - gear]), pushes)

    def backlash(self, group: LoadGroup) -> float:
        """Return the mean normal backlash of the meshes of a group, from flank to flank (twice the half
        backlash).

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        float
            m.
        """
        return float(2.0 * self.machine.half_backlash[list(group.meshes)].mean())

    def number(self, group: LoadGroup, deviation: float) -> float:
        """Compute the dimensionless number that decides the sharing of a group, the abscissa of the
        load-sharing map.

        Parameters
        ----------
        group : LoadGroup
            Idlers: k_e times `deviation` over the load W. Meshes of an input: backlash times mesh
            stiffness over W.
        deviation : float
            Standard deviation of the lateness of a path, m; not used for inputs.

        Returns
        -------
        float
            The number, dimensionless; nan where the group carries nothing.
        """
        load = self.load(group)
        if load <= 0.0:
            return float("nan")
        if group.kind is GroupKind.IDLERS:
            return self.path_stiffness(group) * deviation / load
        return self.backlash(group) * self.group_spring(group) / load


def groups_of_kind(machine: Machine, kind: GroupKind) -> list[LoadGroup]:
    """Return the groups of meshes of one kind that split a load.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    kind : GroupKind
        Idlers, which have a map over the deviation of their errors, or inputs, over their misfit.

    Returns
    -------
    list of LoadGroup
        Empty where there is none.
    """
    return [group for group in split_groups(machine.layout) if group.kind is kind]
