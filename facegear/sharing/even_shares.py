"""Even shares of the meshes, and load-sharing coefficients, equations (25) and (26)."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Mask
from facegear.machine.flanks import significant_forces
from facegear.machine.layout import Layout, Role, Side
from facegear.machine.machine import Machine
from facegear.motion.plan import Motion
from facegear.motion.track import DenseMotion
from facegear.sharing.groups import LoadGroup, SharingOptions
from facegear.sharing.statistics import Average, average, defined_mean, held_over_starts


def sharing_coefficient(forces: Array) -> Array:
    """Return the largest over the mean magnitude of the forces that share a load.

    Equation (25) with two paths, (26) with three.

    Parameters
    ----------
    forces : (..., paths) array
        Elastic mesh forces of either flank without those that are rounding
        (`facegear.machine.flanks.significant_forces`), N.

    Returns
    -------
    (...) array
        Dimensionless, in [1, paths]: 1 for equal loads, the number of paths where one carries all. NaN where
        all forces vanish, as the coefficient is undefined.
    """
    sizes = np.abs(_path_by_path(forces))
    total = sizes.sum(axis=0)
    has_load = total > 0.0
    ratio = len(sizes) * sizes.max(axis=0) / np.where(has_load, total, 1.0)
    return np.where(has_load, np.clip(ratio, 1.0, len(sizes)), np.nan)


def lost_contact(forces: Array) -> Mask:
    """Tell at which instants at least one of the paths carries exactly no force.

    Parameters
    ----------
    forces : (..., paths) array
        Forces without rounding (`facegear.machine.flanks.significant_forces`), N.

    Returns
    -------
    (...) array of bool
        True if the force of some path is 0.
    """
    return (_path_by_path(forces) == 0.0).any(axis=0)


def _path_by_path(forces: Array) -> Array:
    """Move the last axis of forces (..., paths) to the front, (paths, ...), and make each path contiguous.

    Sums over two or three neighbours in memory are slow.
    """
    return np.ascontiguousarray(np.moveaxis(np.asarray(forces, dtype=float), -1, 0))


def even_shares(machine: Machine) -> Array:
    """Compute the nominal even share of the load at each mesh, from torques alone.

    With one face gear a mesh carries its own pinion's torque. Between two, an input gives half of its
    torque to each, and idlers and tails share evenly what the lower gear passes on; without idlers the
    inputs serve the lower gear's own load in proportion to their torques. Mesh load factors (K_gamma of
    ISO 6336-1, AGMA 6123) count from these.

    Parameters
    ----------
    machine : Machine
        Its layout and mean torques on pinions and gears are used.

    Returns
    -------
    (meshes,) array
        Magnitude in N along the line of action, in the order of `Layout.meshes`; nan where a mesh has none.
    """
    forces = _on_drive_flanks(machine)
    size = np.abs(forces) / np.where(forces < 0.0, machine.layout.back_arm, 1.0)
    return np.where(size > 0.0, size, np.nan)


def even_torques(machine: Machine) -> Array:
    """Compute the torque on its pinion of every mesh at the nominal even share of the load.

    Parameters
    ----------
    machine : Machine
        Its layout and mean torques on pinions and gears are used.

    Returns
    -------
    (meshes,) array
        Magnitude in N m, in the order of `Layout.meshes`; nan where a mesh has none.
    """
    size = np.abs(_on_drive_flanks(machine))
    return np.where(size > 0.0, size, np.nan) * machine.layout.pinion_arm


def _on_drive_flanks(machine: Machine) -> Array:
    """Return the forces (meshes,), N, of drive flanks that would put the even shares on the pinions, positive
    where the pinion drives.
    """
    layout = machine.layout
    pinion_torques = machine.torques[: len(layout.pinions)] / layout.pinion_arm
    on_gears = machine.torques[len(layout.pinions) :]
    return significant_forces(_even_forces(layout, pinion_torques, on_gears))


def _even_forces(layout: Layout, coefficients: Array, on_gears: Array) -> Array:
    """Return the forces (meshes,), N, positive where the pinion drives, that share every torque evenly.

    `coefficients` (pinions,) N: torque of each pinion over its arm, the sum of its mesh forces.
    `on_gears` (gears,) N m: torque on each gear; only the lower gear's counts, and only with two gears.
    """
    if len(layout.gears) == 1:
        return coefficients
    inputs = np.array([pinion.role is Role.INPUT for pinion in layout.pinions])
    lower_gear = [gear.side for gear in layout.gears].index(Side.LOWER)
    torques = -on_gears[lower_gear] / layout.gear_arm
    lower = np.where(inputs, 0.5 * coefficients, 0.0)
    if inputs.all():
        total = coefficients.sum()
        lower = coefficients * (torques / total if total != 0.0 else 0.0)
    else:
        lower[~inputs] = (torques - lower.sum()) / (~inputs).sum()
    by_side = {Side.LOWER: lower, Side.UPPER: coefficients - lower}
    return np.concatenate([by_side[gear.side] for gear in layout.gears])


@dataclass(frozen=True, eq=False)
class GroupSharing:
    """Load sharing of one group of meshes.

    Attributes
    ----------
    group : LoadGroup
        Its meshes.
    coefficients : (cycles, samples) array
        Load-sharing coefficient, dimensionless.
    lost_contact : (cycles, samples) array of bool
        Whether a path is without load.
    average : Average
        Averages of the coefficient.
    starts_low, starts_high : float
        Range of the means over the starting states, dimensionless.
    """

    group: LoadGroup
    coefficients: Array
    lost_contact: Mask
    average: Average
    starts_low: float
    starts_high: float


def cycle_forces(motion: DenseMotion) -> Array:
    """Reshape the elastic mesh forces of a motion to mesh cycles and samples.

    Parameters
    ----------
    motion : DenseMotion
        Densely sampled motion over whole mesh cycles.

    Returns
    -------
    (meshes, cycles, samples) array
        N, in the order of `Layout.meshes`.
    """
    return motion.loads.reshape(len(motion.loads), -1, motion.per_period)


def group_average(motion: DenseMotion, group: LoadGroup, confidence: float) -> tuple[Array, Mask, Average]:
    """Compute the load-sharing coefficient of a group over a motion, where contact is lost, and the
    average.

    Parameters
    ----------
    motion : DenseMotion
        Densely sampled motion.
    group : LoadGroup
        Meshes that share a load.
    confidence : float
        Confidence level of the mean from 0 to 1, dimensionless.

    Returns
    -------
    tuple of (cycles, samples) array, (cycles, samples) array of bool and Average
        Coefficient (dimensionless, nan where all forces are 0), whether a path is without load, and
        averages over all defined instants.
    """
    forces = np.moveaxis(cycle_forces(motion)[list(group.meshes)], 0, -1)
    coefficients, lost_mask = sharing_coefficient(forces), lost_contact(forces)
    periodic = motion.response.motion is Motion.PERIODIC
    return coefficients, lost_mask, average(coefficients, lost_mask, confidence, periodic)


def _means(motion: DenseMotion, groups: tuple[LoadGroup, ...]) -> list[float]:
    """Return the mean load-sharing coefficient of each group over a motion, nan where no mesh is ever
    loaded.
    """
    forces = np.moveaxis(cycle_forces(motion), 0, -1)
    return [defined_mean(sharing_coefficient(forces[..., group.meshes])) for group in groups]


def _group(
    motion: DenseMotion,
    group: LoadGroup,
    options: SharingOptions,
    start_means: list[float],
    again: list[float],
) -> GroupSharing:
    """Return the result of one group, with coefficient and lost contact thinned to about
    options.samples a cycle.

    `start_means` are its mean coefficients in the motions from the other starts, which give the range.
    `again` are those of them in the same class of irregular motion, which may widen the half-width
    (`held_over_starts`).
    """
    coefficients, lost_mask, first = group_average(motion, group, options.confidence)
    every = max(coefficients.shape[1] // options.samples, 1)
    defined_means = [mean for mean in (first.mean, *start_means) if not np.isnan(mean)] or [float("nan")]
    return GroupSharing(
        group=group,
        coefficients=coefficients[:, ::every],
        lost_contact=lost_mask[:, ::every],
        average=held_over_starts(first, again, options.confidence),
        starts_low=min(defined_means),
        starts_high=max(defined_means),
    )
