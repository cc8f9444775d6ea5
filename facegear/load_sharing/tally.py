"""Compiled: what is counted of the loads of all flanks over a motion, in one pass over its instants."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.load_sharing.groups import LoadGroup
from facegear.machine_code.compiler import compiler


class Tally(NamedTuple):
    """Of F = 2 M flanks, drive flanks first, and G groups of meshes. A mesh's load is that of its more
    heavily loaded flank.

    mean, largest (F,): force of each flank, N. largest_mean (M,): largest mean load of a mesh cycle, N.
    coefficients (G,): mean over time of the largest load of a group over its mean, nan where nothing is ever
    loaded. open, reversed: fraction of the time in which one of the meshes that share a load carries nothing,
    and in which a mesh is loaded on the flank that carries less on average.
    """

    mean: Array
    largest: Array
    largest_mean: Array
    coefficients: Array
    open: float
    reversed: float

    @property
    def largest_load(self) -> Array:
        """Of each mesh (M,), N."""
        drive, back = np.split(self.largest, 2)
        return np.maximum(drive, back)


def tally(flank_forces: Array, per_cycle: int, groups: tuple[LoadGroup, ...]) -> Tally:
    """Of forces (F, K), none negative, at `per_cycle` instants of each mesh cycle, N."""
    starts = np.cumsum([0, *(len(group.meshes) for group in groups)])
    members = np.array([mesh for group in groups for mesh in group.meshes], dtype=np.int64)
    flanks, count = flank_forces.shape
    mean, largest = np.zeros(flanks), np.zeros(flanks)
    largest_mean, coefficients = np.zeros(flanks // 2), np.zeros(len(groups))
    open_, reversed_ = _tally(
        np.ascontiguousarray(flank_forces),
        per_cycle,
        starts,
        members,
        mean,
        largest,
        largest_mean,
        coefficients,
    )
    return Tally(mean, largest, largest_mean, coefficients, open_ / count, reversed_ / count)


@compiler(nogil=True)
def _tally(
    forces: Array,
    per_cycle: int,
    starts: Integers,
    members: Integers,
    mean: Array,
    largest: Array,
    largest_mean: Array,
    coefficients: Array,
) -> tuple[int, int]:
    """Write the fields of a Tally; how many instants are open and reversed. Group g has the meshes
    members[starts[g]:starts[g + 1]].
    """
    flanks, count = forces.shape
    meshes = flanks // 2
    for f in range(flanks):
        total = 0.0
        for k in range(count):
            total += forces[f, k]
            largest[f] = max(largest[f], forces[f, k])
        mean[f] = total / count
    for m in range(meshes):
        for begin in range(0, count, per_cycle):
            total = 0.0
            for k in range(begin, begin + per_cycle):
                total += max(forces[m, k], forces[m + meshes, k])
            largest_mean[m] = max(largest_mean[m], total / per_cycle)
    idle = np.zeros(meshes, dtype=np.int64)
    for m in range(meshes):
        idle[m] = m if mean[m + meshes] > mean[m] else m + meshes
    open_, reversed_ = 0, 0
    defined = np.zeros(coefficients.size)
    for k in range(count):
        empty, turned = False, False
        for m in range(meshes):
            turned = turned or forces[idle[m], k] > 0.0
        for g in range(coefficients.size):
            total, heaviest = 0.0, 0.0
            paths = starts[g + 1] - starts[g]
            for at in range(starts[g], starts[g + 1]):
                m = members[at]
                load = max(forces[m, k], forces[m + meshes, k])
                empty = empty or load == 0.0
                total += load
                heaviest = max(heaviest, load)
            if total > 0.0:
                coefficients[g] += min(max(paths * heaviest / total, 1.0), paths)
                defined[g] += 1.0
        open_ += empty
        reversed_ += turned
    for g in range(coefficients.size):
        coefficients[g] = coefficients[g] / defined[g] if defined[g] > 0.0 else np.nan
    return open_, reversed_
