"""Runs of many machines, side by side where the lanes have their physics."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.abreast.rows import row_of
from facegear.dynamics.integrator.integrator import Integrator


@dataclass(frozen=True, eq=False)
class Ends:
    """What many runs leave: states (machines, periods, 2, n) at the end of each period, and steps
    (machines,).
    """

    states: Array
    steps: Integers
    status: Integers


def run_alike(integrators: Sequence[Integrator], starts: Array, periods: int) -> Ends:
    """Run machines of one structure from starts (machines, 2, n) by phase."""
    from facegear.dynamics.abreast.lanes import make_lanes
    from facegear.dynamics.abreast.run import Queue, run_abreast

    rows = [row_of(one.packed) for one in integrators]
    shape, first = rows[0].structure, integrators[0]
    count = len(rows)
    ends = np.zeros((count, periods, 2, shape.n))
    steps, status = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    queue = Queue(np.array([row.values for row in rows]), np.ascontiguousarray(starts), ends, steps, status)
    run_abreast(shape, make_lanes(shape, first.order), queue, first.tolerance)
    return Ends(ends, steps, status)
