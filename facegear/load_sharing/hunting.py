"""Quasi-static load sharing until every tooth has met every other: the machine turned slowly under torque."""

from dataclasses import dataclass
from functools import cached_property
from math import lcm

import numpy as np

from facegear.arrays import Array, Integers
from facegear.load_sharing.coefficients import sharing_coefficient
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.groups import LoadGroup, load_groups
from facegear.transmission.flanks import significant_forces
from facegear.transmission.machine import Machine
from facegear.transmission.statics import Equilibria, bearing_forces, equilibria


@dataclass(frozen=True, eq=False)
class LoadHistory:
    """Loads of all flanks in K = mesh cycles x positions instants of a motion.

    Attributes
    ----------
    machine : Machine
        The machine.
    positions : int
        Instants in a mesh cycle.
    cycles : (K,) array
        Mesh cycles since the start.
    flank_forces : (K, 2 meshes) array
        N, drive flanks first, zero where rounding alone presses.
    """

    machine: Machine
    positions: int
    cycles: Array
    flank_forces: Array

    @cached_property
    def loads(self) -> Array:
        """Load of each mesh (K, meshes), N: its more heavily loaded flank."""
        drive, back = np.split(self.flank_forces, 2, axis=1)
        return np.maximum(drive, back)

    @cached_property
    def largest_loads(self) -> Array:
        """Largest load of each mesh (meshes,), N, at the positions."""
        return np.asarray(self.loads.max(axis=0))

    @property
    def groups(self) -> tuple[LoadGroup, ...]:
        """Meshes that share one load."""
        return load_groups(self.machine.layout)

    def coefficients(self, group: LoadGroup) -> Array:
        """Return the largest load of a group over its mean.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (K,) array
            Dimensionless; nan where no mesh carries any, or nothing is split.
        """
        if not group.splits_load:
            return np.full(len(self.loads), np.nan)
        return sharing_coefficient(self.loads[:, list(group.meshes)])

    @property
    def largest_torque(self) -> float:
        """Largest torque on a pinion, N m, to which all K_gamma belong."""
        return float(np.abs(self.machine.torques[: len(self.machine.layout.pinions)]).max())

    @cached_property
    def cycle_means(self) -> Array:
        """Mean load of each mesh in each mesh cycle (cycles, meshes), N."""
        return self.loads.reshape(-1, self.positions, self.loads.shape[1]).mean(axis=1)

    @cached_property
    def mesh_load_factors(self) -> Array:
        """K_gamma of each mesh (meshes,): its largest mean of a mesh cycle over its nominal even share.

        ISO 6336-1 and AGMA 6123; what happens within a mesh cycle is K_v. nan without an even share.
        """
        return self.cycle_means.max(axis=0) / even_shares(self.machine)

    @cached_property
    def dynamic_factors(self) -> Array:
        """K_v of each mesh (meshes,): its largest load over its largest mean of a mesh cycle; nan without."""
        largest = self.cycle_means.max(axis=0)
        return self.largest_loads / np.where(largest > 0.0, largest, np.nan)

    def path_factors(self, group: LoadGroup) -> Array:
        """Return K_gamma of each path of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes of the group,) array
            Dimensionless.
        """
        return self.mesh_load_factors[list(group.meshes)]

    def group_ratios(self, group: LoadGroup) -> Array:
        """Return the largest load of each path over the mean of the group's own loads.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes of the group,) array
            Dimensionless; nan where the group carries nothing.
        """
        loads = self.loads[:, list(group.meshes)]
        even = loads.mean()
        return (
            self.largest_loads[list(group.meshes)] / even if even > 0.0 else np.full(loads.shape[1], np.nan)
        )


def largest(values: Array) -> float:
    """Return the largest of the defined values.

    Parameters
    ----------
    values : array of any shape (...)
        Any unit.

    Returns
    -------
    float
        In the same unit; nan where there is none.
    """
    defined_values = values[np.isfinite(values)]
    return float(defined_values.max()) if defined_values.size else float("nan")


@dataclass(frozen=True, eq=False)
class HuntingCycle(LoadHistory):
    """Quasi-static motion of a machine."""

    at_rest: Equilibria

    @cached_property
    def bearings(self) -> Array:
        """Force of each body on its bearing (K, bodies, 3), N."""
        return bearing_forces(self.machine, self.at_rest)


def hunting_length(machine: Machine) -> int:
    """Return the number of mesh cycles until the pattern repeats.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    int
        1 without runouts, pitch errors and teeth that differ.
    """
    errors, layout = machine.imperfections, machine.layout
    pinions = bool(errors.pinion_pitch) or any(runout.amplitude != 0.0 for runout in errors.pinion_runout)
    gears = bool(errors.gear_pitch) or any(runout.amplitude != 0.0 for runout in errors.gear_runout)
    if errors.teeth is not None:
        pinions, gears = (a or b for a, b in zip((pinions, gears), errors.teeth.turning, strict=True))
    return lcm(layout.pinion_teeth if pinions else 1, layout.gear_teeth if gears else 1)


def hunting_cycle(machine: Machine, positions: int = 16, every: int = 1) -> HuntingCycle:
    """Compute the equilibria of the mesh cycles until the pattern repeats.

    This is the limit of slow running: damping and inertia vanish.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    positions : int
        Number of positions in each mesh cycle.
    every : int
        Step between the mesh cycles that are taken; 1 takes all.

    Returns
    -------
    HuntingCycle
        Forces in N.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    return at_cycles(machine, np.arange(0, hunting_length(machine), every), positions)


def at_cycles(machine: Machine, whole: Integers, positions: int) -> HuntingCycle:
    """Compute the equilibria of some mesh cycles.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    whole : (n,) array of int
        Mesh cycles, counted from 0.
    positions : int
        Number of positions in each mesh cycle.

    Returns
    -------
    HuntingCycle
        Forces in N.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    cycles = (whole[:, None] + np.arange(positions) / positions).ravel()
    at_rest = equilibria(machine, cycles)
    return HuntingCycle(machine, positions, cycles, significant_forces(at_rest.flank_forces), at_rest)
