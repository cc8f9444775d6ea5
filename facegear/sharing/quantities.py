"""Quantities that one machine among many is judged by: load sharing, loads of flanks and bearings."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from facegear._kernels import samples
from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.machine.flanks import past_law
from facegear.machine.machine import Machine
from facegear.motion.bearing_forces import bearing_forces
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings
from facegear.motion.steady_state.guide import Guide, guide_of
from facegear.motion.steady_state.simulate import build_model
from facegear.quantities import PAST_LAW
from facegear.sharing.even_shares import even_shares
from facegear.sharing.groups import LoadGroup, SharingOptions, load_groups, quantity_names
from facegear.sharing.hunting import hardest_cycles, hunting_cycle, hunting_length
from facegear.sharing.run import measured_motion

LIFE_EXPONENT = 10.0 / 3.0
"""Exponent of roller bearings, ISO 281: life falls as this power of the load."""

MASS_EXPONENT = 3.0 / (7.0 / 9.0 + 29.0 / 27.0)
"""Mass grows as this power of the dynamic rating: of similar roller bearings the first goes with the cube of
their size, the second, ISO 281, with roller length^(7/9) times roller diameter^(29/27)."""

NO_LOAD = 1e-100
"""Square of a load (N2) that counts as none."""

REFERENCE = 1e4
"""Load (N) of the bearing whose mass is the unit."""


def bearing_mass(forces: Array) -> float:
    """Return the mass of all bearings, in masses of one that carries REFERENCE for the same life.

    Each bearing is of one series, as large as its equivalent load P = (mean of F^(10/3))^(3/10) asks for at
    equal life, so that its mass goes with P^1.62; F is the length of the force. Bodies turn at different
    speeds, which is left out.

    Parameters
    ----------
    forces : (bodies, 3, K) array
        Force of every body on its bearing at K evenly spaced times, N.

    Returns
    -------
    float
        Relative to the mass of that bearing.
    """
    square = np.einsum("bik,bik->bk", forces, forces)
    powers = np.exp(0.5 * LIFE_EXPONENT * np.log(np.maximum(square, NO_LOAD)))  # np.power is slower
    equivalent = np.mean(powers, axis=-1) ** (1.0 / LIFE_EXPONENT)
    return float(np.sum((equivalent / REFERENCE) ** MASS_EXPONENT))


class Tally(NamedTuple):
    """Counts and means of F = 2 M flanks, drive flanks first, and G groups of meshes.

    A mesh's load is that of its more heavily loaded flank.

    Attributes
    ----------
    mean, largest : (F,) arrays
        Force of each flank, N.
    largest_mean : (M,) array
        Largest mean load of a mesh cycle, N.
    coefficients : (G,) array
        Mean over time of the largest load of a group over its mean, nan where nothing is ever loaded.
    open : float
        Fraction of the time in which one of the meshes that share a load carries nothing.
    reversed_fraction : float
        Fraction of the time in which a mesh is loaded on the flank that carries less on average.
    """

    mean: Array
    largest: Array
    largest_mean: Array
    coefficients: Array
    open: float
    reversed_fraction: float

    @property
    def largest_load(self) -> Array:
        """Largest load (M,), N, of each mesh: the larger of its two flanks' largest forces."""
        drive, back = np.split(self.largest, 2)
        return np.maximum(drive, back)


def tally(flank_forces: Array, per_cycle: int, groups: tuple[LoadGroup, ...]) -> Tally:
    """Compute mean and largest loads of the flanks, coefficients of groups, and times open or reversed.

    The motion is K instants, whole mesh cycles of `per_cycle` instants each. A compiled kernel does it in
    one pass.

    Parameters
    ----------
    flank_forces : (F, K) array
        Forces of the F = 2 M flanks, drive flanks of all meshes first, none negative, N.
    per_cycle : int
        Number of instants in each mesh cycle.
    groups : tuple of LoadGroup
        Meshes that share a load.

    Returns
    -------
    Tally
        Forces in N, coefficients, and fractions of the time.
    """
    starts = np.cumsum([0, *(len(group.meshes) for group in groups)])
    members = np.array([mesh for group in groups for mesh in group.meshes], dtype=np.int64)
    flanks, count = flank_forces.shape
    mean, largest = np.zeros(flanks), np.zeros(flanks)
    largest_mean, coefficients = np.zeros(flanks // 2), np.zeros(len(groups))
    result = Tally(mean, largest, largest_mean, coefficients, open=0.0, reversed_fraction=0.0)
    open_samples, reversed_samples = samples.tally(flank_forces, per_cycle, starts, members, result)
    return result._replace(open=open_samples / count, reversed_fraction=reversed_samples / count)


POSITIONS = 8
"""Positions of a mesh cycle in the quasi-static motion."""


@dataclass(frozen=True, eq=False)
class FlankLoads:
    """Mean and largest force of every flank (2 meshes,), N, drive flanks first."""

    mean: Array
    largest: Array


MachineQuantities = tuple[dict[str, float], FlankLoads]
"""Values of the quantities by their names, and the loads of the flanks."""


def quasi_static_quantities(machine: Machine, cycles: int) -> MachineQuantities:
    """Compute the quantities of a machine from static equilibria of mesh cycles spread over the hunting
    cycle.

    The hardest mesh cycles, found by a linear law (`hardest_cycles`), are added for the largest loads and
    K_gamma; means and fractions of time are those of the spread cycles alone.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    cycles : int
        Least number of mesh cycles to spread, or all if the hunting cycle is shorter.

    Returns
    -------
    MachineQuantities
        Dictionary of the names of `quantity_names(dynamic=False)`, with PAST_LAW if the machine has
        load-dependent laws; and mean and largest force (N) of each flank.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    run = hunting_cycle(machine, POSITIONS, max(hunting_length(machine) // cycles, 1))
    hard = hardest_cycles(run)
    groups, sharing_meshes, even, names = _meshes_that_share(machine.without_errors, dynamic=False)
    counts, hardest = (tally(motion.flank_forces.T, POSITIONS, groups) for motion in (run, hard))
    largest_mean = np.maximum(counts.largest_mean, hardest.largest_mean)
    largest = np.maximum(counts.largest, hardest.largest)
    values = (
        *(largest_mean / even)[sharing_meshes],
        *(value for value, group in zip(counts.coefficients, groups, strict=True) if group.splits_load),
        largest.max(),
        counts.open,
        counts.reversed_fraction,
        bearing_mass(np.moveaxis(run.bearings, 0, -1)),
    )
    quantities = dict(zip(names, map(float, values), strict=True))
    if machine.tables is not None:
        past = (past_law(machine, motion.cycles, motion.flank_forces).max() for motion in (run, hard))
        quantities[PAST_LAW] = float(max(past))
    return quantities, FlankLoads(counts.mean, largest)


def dynamic_quantities(
    machine: Machine,
    speed_rpm: float,
    settings: Settings,
    options: SharingOptions,
    guide: Guide | None = None,
) -> MachineQuantities:
    """Compute the quantities of a machine from its motion at a speed, reached from static equilibrium.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Mesh cycles and samples of a cycle; they replace window and samples of `settings`.
    guide : Guide or None
        Orbit of a similar machine, from which the search starts; None: from static equilibrium alone.

    Returns
    -------
    MachineQuantities
        Dictionary of the names of `quantity_names(dynamic=True)`, with PAST_LAW if the machine has
        load-dependent laws; and mean and largest force (N) of each flank.

    Raises
    ------
    NotConverged
        If the integration fails; the message names the speed.
    """
    model = build_model(machine)
    motion = measured_motion(model, speed_rpm, settings, options, guide)
    groups, sharing_meshes, even, names = _meshes_that_share(machine.without_errors, dynamic=True)
    counts = tally(motion.flank_loads, motion.per_period, groups)
    largest_means = np.where(counts.largest_mean > 0.0, counts.largest_mean, np.nan)
    values = (
        *(counts.largest_mean / even)[sharing_meshes],
        *(counts.largest_load / largest_means)[sharing_meshes],
        *(value for value, group in zip(counts.coefficients, groups, strict=True) if group.splits_load),
        counts.largest.max(),
        counts.open,
        counts.reversed_fraction,
        bearing_mass(bearing_forces(model, motion.track)),
    )
    quantities = dict(zip(names, map(float, values), strict=True))
    if machine.tables is not None:
        quantities[PAST_LAW] = float(motion.past_law.max())
    return quantities, FlankLoads(counts.mean, counts.largest)


def orbit_of(machine: Machine, speed_rpm: float, settings: Settings, options: SharingOptions) -> Guide | None:
    """Compute the periodic orbit that a machine reaches from static equilibrium, as a guide for similar
    machines.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    speed_rpm : float
        Speed of the pinions, rpm.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Mesh cycles and samples of a cycle.

    Returns
    -------
    Guide or None
        Argument `guide` of `dynamic_quantities`. None where the motion is not periodic, or where the
        integration fails.
    """
    try:
        response = measured_motion(build_model(machine), speed_rpm, settings, options).response
    except NotConverged:
        return None
    integrator = Integrator(response.system, response.frequency, settings.tolerance, settings.order)
    return guide_of(integrator, response.orbit)


class _SharingMeshes(NamedTuple):
    """Groups of meshes that share a load, their meshes group by group, even share of each mesh (meshes,), N,
    and the names of the quantities.
    """

    groups: tuple[LoadGroup, ...]
    sharing_meshes: list[int]
    even: Array
    names: tuple[str, ...]


@lru_cache(maxsize=8)
def _meshes_that_share(machine: Machine, dynamic: bool) -> _SharingMeshes:
    """Return groups, their meshes, even shares (N) and quantity names of a machine.

    The machine is one without errors, so that all samples of a design find the same cached result.
    """
    layout, groups = machine.layout, load_groups(machine.layout)
    sharing_meshes = [mesh for group in groups for mesh in group.meshes]
    return _SharingMeshes(groups, sharing_meshes, even_shares(machine), quantity_names(layout, dynamic))
