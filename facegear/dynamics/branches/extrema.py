"""Turning points of the mesh deflections over whole mesh periods, to the accuracy of the steps."""

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.advance import advance, after, move
from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.integrator import Integrator, require
from facegear.dynamics.integrator.kernel import kernel
from facegear.dynamics.integrator.periods import DONE, MAX_STEPS, TOO_MANY_STEPS
from facegear.dynamics.integrator.roots import refine_root
from facegear.dynamics.integrator.work import Work

MAX_EXTREMA = 64
"""Turning points of a mesh kept for each mesh period."""
PARTS = 4
"""A step is looked through in this many parts, each for one change of direction."""


def extrema(integrator: Integrator, state: Array, periods: int) -> Array:
    """Maxima and minima (m, 2, most) of each deflection over a run from a state (2, n), each falling, and
    minus infinity where there are fewer. Raises NotConverged where a step fails.
    """
    padded, rows = integrator.padded(state), integrator.rows
    values = np.full((rows, 2, MAX_EXTREMA * periods), -np.inf)
    counts = np.zeros((rows, 2), dtype=np.int64)
    status = _find(
        integrator.packed,
        integrator.work,
        padded[0],
        padded[1],
        periods,
        integrator.tolerance,
        integrator.longest_step(),
        values,
        counts,
    )
    require(status)
    return -np.sort(-values[:, :, : min(counts.max(), values.shape[2])])


@kernel
def _find(
    packed: Packed,
    work: Work,
    displacement: Array,
    velocity: Array,
    periods: int,
    tolerance: float,
    longest: float,
    values: Array,
    counts: Integers,
) -> int:
    """Move displacement and velocity over the periods; write the deflection at every change of its direction.

    values (m, 2, most), counts (m, 2): maxima, then minima; those beyond `maximum` are counted only. Returns
    a status of the integration.
    """
    order = work.order
    for _ in range(periods):
        s, taken = 0.0, 0
        while s < TAU:
            length = advance(packed, work, s, min(TAU, s + longest), displacement, velocity, tolerance)
            for m in range(packed.m):
                power = length
                for i in range(order):
                    work.polynomial[i] = (i + 1) * power * work.deflection[i + 1, m]
                    power *= length
                slope = work.polynomial[0]
                for part in range(PARTS):
                    end = (part + 1.0) / PARTS
                    later = work.polynomial[order - 1]
                    for i in range(order - 2, -1, -1):
                        later = later * end + work.polynomial[i]
                    if slope * later < 0.0 or (later == 0.0 and slope != 0.0):
                        t = (
                            refine_root(work.polynomial, order - 1, end - 1.0 / PARTS, end, slope, later)
                            * length
                        )
                        value = work.deflection[order, m]
                        for i in range(order - 1, -1, -1):
                            value = value * t + work.deflection[i, m]
                        kind = 0 if slope > 0.0 else 1
                        if counts[m, kind] < values.shape[2]:
                            values[m, kind, counts[m, kind]] = value + work.edge[m]
                        counts[m, kind] += 1
                    slope = later
            move(work, length, displacement, velocity)
            s = after(s, length)
            taken += 1
            if taken > MAX_STEPS:
                return TOO_MANY_STEPS
    return DONE
