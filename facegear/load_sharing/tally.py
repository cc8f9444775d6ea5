"""Counts and means of the loads of all flanks over a motion, in one pass over its instants."""

from typing import NamedTuple

import numpy as np

from facegear._kernels import samples
from facegear.arrays import Array
from facegear.load_sharing.groups import LoadGroup


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
        """Largest load of each mesh (M,), N."""
        drive, back = np.split(self.largest, 2)
        return np.maximum(drive, back)


def tally(flank_forces: Array, per_cycle: int, groups: tuple[LoadGroup, ...]) -> Tally:
    """Count the loads of a motion.

    Parameters
    ----------
    flank_forces : (F, K) array
        Forces of the flanks, none negative, N.
    per_cycle : int
        Number of instants in each mesh cycle.
    groups : tuple of LoadGroup
        Meshes that share a load.

    Returns
    -------
    Tally
        Forces in N, fractions of the time.
    """
    starts = np.cumsum([0, *(len(group.meshes) for group in groups)])
    members = np.array([mesh for group in groups for mesh in group.meshes], dtype=np.int64)
    flanks, count = flank_forces.shape
    mean, largest = np.zeros(flanks), np.zeros(flanks)
    largest_mean, coefficients = np.zeros(flanks // 2), np.zeros(len(groups))
    result = Tally(mean, largest, largest_mean, coefficients, open=0.0, reversed_fraction=0.0)
    open_samples, reversed_samples = samples.tally(flank_forces, per_cycle, starts, members, result)
    return result._replace(open=open_samples / count, reversed_fraction=reversed_samples / count)
