"""Largest force on a tooth in each of its passages through a mesh, from the forces of a running machine."""

from collections.abc import Iterator

import numpy as np

from facegear.arrays import Array, Integers

CLASSES = 16
"""Classes of equal share into which the passages of a tooth through a mesh are sorted."""
STEEP = 10.0
"""Power of the force by which the hardest loaded tooth is chosen, about the slope of an S-N curve."""


def passage_forces(largest: Array) -> Array:
    """Return the largest force in every mesh cycle and the one after it.

    A tooth is in mesh for about two mesh cycles; the last one is followed by the first.

    Parameters
    ----------
    largest : (cycles, flanks) array
        Largest force of each mesh cycle, N, not negative.

    Returns
    -------
    (cycles, flanks) array
        Largest force of each passage, N.
    """
    return np.maximum(largest, np.roll(largest, -1, axis=0))


def hardest_tooth(passages: Array, tooth_numbers: Integers) -> list[Array]:
    """Return the forces that the hardest loaded tooth of a body meets in each of its meshes.

    The sum of the forces to the power STEEP decides which tooth that is.

    Parameters
    ----------
    passages : (cycles, meshes) array
        Forces on one flank, N.
    tooth_numbers : (cycles, meshes) array of int
        Index of the tooth that is in mesh.

    Returns
    -------
    list of (n,) array
        Forces in each mesh, N.
    """
    scale = passages.max()
    harm = np.bincount(
        tooth_numbers.ravel(), weights=(passages / scale if scale > 0.0 else passages).ravel() ** STEEP
    )
    worst = int(np.argmax(harm))
    return [column[teeth == worst] for column, teeth in zip(passages.T, tooth_numbers.T, strict=True)]


def classes(forces: Array) -> Iterator[tuple[float, float]]:
    """Sort the passages of one flank into classes, from the largest to the smallest force.

    Each class has the largest force of its passages, so that its damage is never less than theirs.

    Parameters
    ----------
    forces : (n,) array
        Force of each passage, N.

    Yields
    ------
    float, float
        Share of the passages, 0 to 1, and force, N.
    """
    sorted_forces = np.sort(forces)[::-1]
    for part in np.array_split(sorted_forces, min(CLASSES, np.unique(sorted_forces).size)):
        yield part.size / sorted_forces.size, float(part[0])
