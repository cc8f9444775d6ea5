"""Load factors of machines whose idlers' paths are drawn late, by statics."""

import numpy as np

from facegear.arrays import Array
from facegear.load_sharing.groups import GroupKind, LoadGroup
from facegear.load_sharing.mapped_machine import MappedMachine
from facegear.load_sharing.options import MapOptions

LEVELS = (50.0, 95.0, 99.0)
"""Percentiles of K_gamma in tables, %."""
JUDGED_LEVEL = 95.0
"""Percentile that advice is about, %."""


def draws(group: LoadGroup, options: MapOptions) -> Array:
    """Draw the lateness of the paths of a group.

    Parameters
    ----------
    group : LoadGroup
        Idlers.
    options : MapOptions
        Number of samples and seed.

    Returns
    -------
    (samples, paths) array
        Lateness over its standard deviation, dimensionless.
    """
    random = np.random.default_rng(options.seed)
    return random.standard_normal((options.samples, len(group.meshes)))


def group_levels(
    mapped: MappedMachine, group: LoadGroup, deviation: float, options: MapOptions
) -> tuple[float, ...]:
    """Return percentiles of K_gamma of a group by statics.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input, or idlers.
    deviation : float
        Standard deviation of the lateness of a path, m.
    options : MapOptions
        Samples.

    Returns
    -------
    tuple of float
        One for each of LEVELS, dimensionless. Raises NotConverged.
    """
    if group.kind is GroupKind.INPUTS:
        return (mapped.factor(group),) * len(LEVELS)
    forces = mapped.idler_forces(group, deviation * draws(group, options))
    return levels((forces / mapped.even(group)).max(axis=1))


def levels(factors: Array) -> tuple[float, ...]:
    """Return the percentiles LEVELS of drawn values.

    Parameters
    ----------
    factors : (samples,) array
        Values in any unit.

    Returns
    -------
    tuple of float
        In the same unit.
    """
    return tuple(float(value) for value in np.percentile(factors, LEVELS))


def judged_factor(mapped: MappedMachine, group: LoadGroup, options: MapOptions) -> float:
    """Return K_gamma of a group by statics, as advice judges it.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input, or idlers.
    options : MapOptions
        Deviations and samples.

    Returns
    -------
    float
        The percentile JUDGED_LEVEL of idlers, the value of an input; dimensionless. Raises NotConverged.
    """
    deviation = options.deviation(mapped.machine.layout.pressure_angle)
    return group_levels(mapped, group, deviation, options)[LEVELS.index(JUDGED_LEVEL)]
