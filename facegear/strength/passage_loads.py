"""Largest force on a tooth in each of its passages through a mesh, from the forces of a running machine."""

from collections.abc import Iterator

import numpy as np

from facegear.arrays import Array, Integers

CLASSES = 16
"""Classes of equal share into which the passages of a tooth through a mesh are sorted."""
STEEP = 10.0
"""Power of the force by which the hardest loaded tooth is chosen, about the slope of an S-N curve."""


def passage_forces(largest: Array) -> Array:
    """Largest force in every mesh cycle and the one after it, (cycles, flanks).

    largest (cycles, flanks): largest force of each mesh cycle, N, not negative. A tooth is in mesh for about
    two mesh cycles; the last one is followed by the first.
    """
    return np.maximum(largest, np.roll(largest, -1, axis=0))


def hardest_tooth(passages: Array, met: Integers) -> list[Array]:
    """Forces (n,) that the hardest loaded tooth of a body meets in each of its meshes.

    passages (cycles, meshes) on one flank, N; met (cycles, meshes): the tooth that is in mesh. The sum of
    the forces to the power STEEP decides.
    """
    scale = passages.max()
    harm = np.bincount(met.ravel(), weights=(passages / scale if scale > 0.0 else passages).ravel() ** STEEP)
    worst = int(np.argmax(harm))
    return [column[teeth == worst] for column, teeth in zip(passages.T, met.T, strict=True)]


def classes(forces: Array) -> Iterator[tuple[float, float]]:
    """(share, force) of the passages (n,) of one flank, from the largest to the smallest force.

    Each class has the largest force of its passages, so that its damage is never less than theirs.
    """
    ordered = np.sort(forces)[::-1]
    for part in np.array_split(ordered, min(CLASSES, np.unique(ordered).size)):
        yield part.size / ordered.size, float(part[0])
