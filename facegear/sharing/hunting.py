"""Quasi-static load sharing over the hunting cycle, with its hardest cycles and its tables."""

from dataclasses import dataclass
from functools import cached_property
from math import lcm

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.machine.drive_line import DriveLine
from facegear.machine.flank_errors import slow_errors
from facegear.machine.flanks import significant_forces
from facegear.machine.machine import Machine
from facegear.machine.shaft_tables import bearing_names, ring_strains, shaft_bearing_loads, tilting_moments
from facegear.machine.statics import Equilibria, bearing_forces, equilibria
from facegear.sharing.even_shares import even_shares, even_torques, sharing_coefficient
from facegear.sharing.groups import LoadGroup, load_groups


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
        """Load (K, meshes), N, of each mesh: the force of its more heavily loaded flank."""
        drive, back = np.split(self.flank_forces, 2, axis=1)
        return np.maximum(drive, back)

    @cached_property
    def largest_loads(self) -> Array:
        """Largest load (meshes,), N, of each mesh at the K instants."""
        return np.asarray(self.loads.max(axis=0))

    @property
    def groups(self) -> tuple[LoadGroup, ...]:
        """Groups of meshes that are compared with each other (`load_groups`)."""
        return load_groups(self.machine.layout)

    def coefficients(self, group: LoadGroup) -> Array:
        """Compute the load-sharing coefficient of a group at each instant: largest load over the mean of
        its meshes.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (K,) array
            Dimensionless, 1 to the number of meshes; nan where no mesh carries any, or nothing is split.
        """
        if not group.splits_load:
            return np.full(len(self.loads), np.nan)
        return sharing_coefficient(self.loads[:, list(group.meshes)])

    @property
    def largest_torque(self) -> float:
        """Largest magnitude of a mean torque on a pinion, N m: the load at which all K_gamma are stated."""
        return float(np.abs(self.machine.torques[: len(self.machine.layout.pinions)]).max())

    @cached_property
    def cycle_means(self) -> Array:
        """Mean load (cycles, meshes), N, of each mesh over the instants of each mesh cycle."""
        return self.loads.reshape(-1, self.positions, self.loads.shape[1]).mean(axis=1)

    @cached_property
    def mesh_load_factors(self) -> Array:
        """K_gamma of each mesh (meshes,): its largest mean of a mesh cycle over its nominal even share.

        ISO 6336-1 and AGMA 6123; what happens within a mesh cycle is K_v. nan without an even share.
        """
        return self.cycle_means.max(axis=0) / even_shares(self.machine)

    @cached_property
    def dynamic_factors(self) -> Array:
        """K_v (meshes,) of each mesh: its largest load over its largest mean of a mesh cycle; nan without
        load.
        """
        largest = self.cycle_means.max(axis=0)
        return self.largest_loads / np.where(largest > 0.0, largest, np.nan)

    def path_factors(self, group: LoadGroup) -> Array:
        """Return `mesh_load_factors` (K_gamma) of the meshes of a group.

        Parameters
        ----------
        group : LoadGroup
            Meshes that share a load.

        Returns
        -------
        (meshes of the group,) array
            Dimensionless, in the order of group.meshes; nan without an even share.
        """
        return self.mesh_load_factors[list(group.meshes)]

    def group_ratios(self, group: LoadGroup) -> Array:
        """Return the largest load of each mesh over the mean load of all meshes of the group at all
        instants.

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
    """Return the largest finite value; nan and infinite values are left out.

    Parameters
    ----------
    values : array of any shape (...)
        Any unit.

    Returns
    -------
    float
        In the same unit; nan where no value is finite.
    """
    defined_values = values[np.isfinite(values)]
    return float(defined_values.max()) if defined_values.size else float("nan")


@dataclass(frozen=True, eq=False)
class HuntingCycle(LoadHistory):
    """Quasi-static motion of a machine."""

    at_rest: Equilibria

    @cached_property
    def bearings(self) -> Array:
        """Force (K, bodies, 3), N, of each body on its bearing at each equilibrium, along x, y, z."""
        return bearing_forces(self.machine, self.at_rest)


def hunting_length(machine: Machine) -> int:
    """Return after how many mesh cycles the pattern of the errors repeats.

    It is the least common multiple of the tooth numbers of pinion and gear, of those with errors that turn.

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
    """Compute static equilibria of the mesh cycles until the pattern repeats: the limit of slow running.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    positions : int
        Number of evenly spaced positions in each mesh cycle.
    every : int
        Only every so-many-th mesh cycle of `hunting_length` is computed; 1 takes all.

    Returns
    -------
    HuntingCycle
        Flank forces (N) and equilibria at K = mesh cycles x positions instants.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    return at_cycles(machine, np.arange(0, hunting_length(machine), every), positions)


def at_cycles(machine: Machine, whole: Integers, positions: int) -> HuntingCycle:
    """Compute static equilibria at evenly spaced positions of chosen mesh cycles.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    whole : (n,) array of int
        Numbers of the mesh cycles of the hunting cycle, counted from 0.
    positions : int
        Number of positions in each mesh cycle.

    Returns
    -------
    HuntingCycle
        Flank forces (N) and equilibria at K = n x positions instants, in the order of `whole`.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    cycles = (whole[:, None] + np.arange(positions) / positions).ravel()
    at_rest = equilibria(machine, cycles)
    return HuntingCycle(machine, positions, cycles, significant_forces(at_rest.flank_forces), at_rest)


def hardest_cycles(spread: HuntingCycle) -> HuntingCycle:
    """Compute the mesh cycles that are likely to be the hardest of each mesh, from some spread over the
    hunting cycle.

    What changes from cycle to cycle are the errors of the flanks, known for all cycles. The mean load of a
    mesh is nearly linear in them; the linear law through the cycles given says which of the others are the
    hardest.

    Parameters
    ----------
    spread : HuntingCycle
        Some mesh cycles of the hunting cycle.

    Returns
    -------
    HuntingCycle
        The hardest cycles, or `spread` itself where it is the whole hunting cycle.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    machine, length = spread.machine, hunting_length(spread.machine)
    sampled_cycles = spread.cycles[:: spread.positions].astype(np.int64)
    if sampled_cycles.size >= length:
        return spread
    slow = slow_errors(machine, np.arange(length, dtype=float) + 0.5)
    slow -= slow[sampled_cycles].mean(axis=0)
    means = spread.cycle_means
    law = np.linalg.lstsq(slow[sampled_cycles], means - means.mean(axis=0), rcond=None)[0]
    return at_cycles(machine, np.unique((slow @ law).argmax(axis=0)), spread.positions)


MESH_COLUMNS = (
    "mesh",
    "group",
    "mean_n",
    "least_n",
    "largest_n",
    "even_share_n",
    "torque_n_m",
    "k_gamma",
    "group_ratio",
    "drive_fraction",
    "back_fraction",
    "open_fraction",
    "wedged_fraction",
    "first_open_cycle",
)
"""Columns of mesh_table()."""


GROUP_COLUMNS = (
    *("group", "kind", "mean", "least", "largest", "k_gamma", "group_ratio", "undefined_fraction"),
    *("torque_n_m", "mesh_cycles", "kkt_residual"),
)
"""Columns of group_table()."""


def mesh_table(run: LoadHistory) -> pd.DataFrame:
    """Return load, mesh load factor and state of each mesh.

    `even_share_n` and `torque_n_m` (on the pinion) are the nominal even share that K_gamma counts from, empty
    with it where that is nothing. `group_ratio`: largest load over the mean of the group's own loads. The
    fractions are of the time on each flank, open, and wedged (both). `first_open_cycle` is empty where the
    mesh never opens; `group` and `group_ratio` where the mesh shares its load with none.

    Parameters
    ----------
    run : LoadHistory
        Loads over a motion.

    Returns
    -------
    pd.DataFrame
        One row a mesh, columns MESH_COLUMNS.
    """
    layout = run.machine.layout
    names, even = layout.mesh_names, even_shares(run.machine)
    nominal_torques = even_torques(run.machine)
    group, ratio = _group_ratios(run)
    drive, back = (flank > 0.0 for flank in np.split(run.flank_forces, 2, axis=1))
    is_open = ~drive & ~back
    rows = []
    for mesh, load in enumerate(run.loads.T):
        opens = np.flatnonzero(is_open[:, mesh])
        rows.append(
            (
                names[mesh],
                group[mesh],
                load.mean(),
                load.min(),
                run.largest_loads[mesh],
                even[mesh],
                nominal_torques[mesh],
                run.mesh_load_factors[mesh],
                ratio[mesh],
                drive[:, mesh].mean(),
                back[:, mesh].mean(),
                is_open[:, mesh].mean(),
                (drive & back)[:, mesh].mean(),
                run.cycles[opens[0]] if opens.size else np.nan,
            )
        )
    return pd.DataFrame(rows, columns=list(MESH_COLUMNS))


def group_table(run: HuntingCycle) -> pd.DataFrame:
    """Tabulate coefficient, largest K_gamma and group ratio of each group.

    Parameters
    ----------
    run : HuntingCycle
        Quasi-static motion.

    Returns
    -------
    pd.DataFrame
        One row a group, columns GROUP_COLUMNS; mean, least and largest are of the coefficient, nan where
        nothing is split. `torque_n_m` is the largest torque on a pinion, to which all values belong.
    """
    rows = []
    for group in run.groups:
        coefficient = run.coefficients(group)
        defined_values = coefficient[~np.isnan(coefficient)]
        low, mean, high = (
            (defined_values.min(), defined_values.mean(), defined_values.max())
            if defined_values.size
            else (np.nan, np.nan, np.nan)
        )
        rows.append(
            (
                group.name,
                group.kind.value,
                mean,
                low,
                high,
                largest(run.path_factors(group)),
                run.group_ratios(group).max(),
                np.isnan(coefficient).mean(),
                run.largest_torque,
                len(run.cycles) // run.positions,
                run.at_rest.residual.max(),
            )
        )
    return pd.DataFrame(rows, columns=list(GROUP_COLUMNS))


def bearing_table(run: HuntingCycle, line: DriveLine | None = None) -> pd.DataFrame:
    """Return the forces on the bearings.

    A pinion's x is tangential and y along the gears' axis, both radial for its bearing; a face gear's axis is
    z.

    Parameters
    ----------
    run : HuntingCycle
        Quasi-static motion.
    line : DriveLine or None
        Drive line, whose shafts have bearings of their own.

    Returns
    -------
    pd.DataFrame
        One row a body, then one a bearing of the drive line's shafts: body, mean force along x, y, z, mean
        and largest radial force and largest axial force, N.
    """
    names, forces, rows = list(run.machine.layout.body_names), run.bearings, []
    if line is not None:
        names += [f"{names[pinion]} bearing {letter}" for pinion, letter in bearing_names(line)]
        strains = ring_strains(run.machine, run.at_rest.displacements)
        tilting = tilting_moments(run.machine, run.at_rest)
        loads = shaft_bearing_loads(line, forces, tilting, run.at_rest.shafts, strains)
        forces = np.concatenate([forces, loads[..., :3]], axis=1)
    for name, force in zip(names, forces.transpose(1, 0, 2), strict=True):
        radial = np.hypot(force[:, 0], force[:, 1])
        rows.append((name, *force.mean(axis=0), radial.mean(), radial.max(), np.abs(force[:, 2]).max()))
    columns = ("body", "mean_x_n", "mean_y_n", "mean_z_n", "mean_radial_n", "largest_radial_n")
    return pd.DataFrame(rows, columns=[*columns, "largest_axial_n"])


def cycle_table(run: LoadHistory) -> pd.DataFrame:
    """Return the mean load of every mesh in each mesh cycle.

    Parameters
    ----------
    run : LoadHistory
        Loads over a motion.

    Returns
    -------
    pd.DataFrame
        One row a cycle: columns cycle, then one a mesh, N.
    """
    frame = pd.DataFrame(run.cycle_means, columns=[f"{name} (N)" for name in run.machine.layout.mesh_names])
    frame.insert(0, "cycle", np.arange(len(frame)))
    return frame


def _group_ratios(run: LoadHistory) -> tuple[list[str], Array]:
    """Return each mesh's group name ("" without one) and its `group_ratios` (meshes,), nan without one."""
    names = [""] * len(run.machine.layout.meshes)
    ratios = np.full(len(names), np.nan)
    for group in run.groups:
        for mesh, ratio in zip(group.meshes, run.group_ratios(group), strict=True):
            names[mesh], ratios[mesh] = group.name, ratio
    return names, ratios
