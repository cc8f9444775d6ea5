"""What a run keeps of its steps: their polynomials, and the extrema of the deflections."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import called
from facegear.dynamics.integrator.roots import refine_root
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.records import Record

PARTS = 4
"""A step is looked through in this many parts, each for one change of direction."""


@Record.register
class Steps(NamedTuple):
    """Polynomials of the first S steps of a run; of length 0 where none are kept.

    starts, lengths (S,): mesh phase in the step's period and length, rad. coordinates (S, order + 1, n) and
    deflections (S, order + 1, m): ascending powers of the phase since the start of the step; states (S, m):
    piece of the law that each contact is in, negative on the back flank.
    """

    starts: Array
    lengths: Array
    coordinates: Array
    deflections: Array
    states: Integers


@Record.register
class Extrema(NamedTuple):
    """Deflections where they change direction: values (m, 2, K), maxima, then minima, in the order in which
    they are met; counts (m, 2), also of those that have no room. K = 0 where none are looked for.
    """

    values: Array
    counts: Integers


NO_STEPS = Steps(
    np.zeros(0), np.zeros(0), np.zeros((0, 0, 0)), np.zeros((0, 0, 0)), np.zeros((0, 0), dtype=np.int64)
)
NO_TURNING_POINTS = Extrema(np.zeros((0, 0, 0)), np.zeros((0, 0), dtype=np.int64))


def make_steps(packed: Packed, order: int, count: int) -> Steps:
    """Room for the polynomials of so many steps."""
    m, n = packed.m, packed.n
    return Steps(
        starts=np.zeros(count),
        lengths=np.zeros(count),
        coordinates=np.zeros((count, order + 1, n)),
        deflections=np.zeros((count, order + 1, m)),
        states=np.zeros((count, m), dtype=np.int64),
    )


def make_extrema(packed: Packed, count: int) -> Extrema:
    """Room for so many maxima and as many minima of each deflection."""
    values = np.full((packed.m, 2, count), -np.inf)
    return Extrema(values, np.zeros((packed.m, 2), dtype=np.int64))


@called
def keep_step(packed: Packed, work: Work, s: float, length: float, steps: Steps, number: int) -> None:
    """Write the polynomials of a step that begins at s."""
    steps.starts[number] = s
    steps.lengths[number] = length
    for i in range(work.order + 1):
        for k in range(packed.n):
            steps.coordinates[number, i, k] = work.y[i, k]
        for m in range(packed.m):
            steps.deflections[number, i, m] = work.deflection[i, m]
    for m in range(packed.m):
        steps.deflections[number, 0, m] += work.edge[m]
        steps.states[number, m] = work.state[m]


@called
def add_extrema(packed: Packed, work: Work, length: float, extrema: Extrema) -> None:
    """Write every deflection at which a mesh changes its direction within a step."""
    order = work.order
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
                start = end - 1.0 / PARTS
                t = refine_root(work.polynomial, order - 1, start, end, slope, later) * length
                value = work.deflection[order, m]
                for i in range(order - 1, -1, -1):
                    value = value * t + work.deflection[i, m]
                kind = 0 if slope > 0.0 else 1
                if extrema.counts[m, kind] < extrema.values.shape[2]:
                    extrema.values[m, kind, extrema.counts[m, kind]] = value + work.edge[m]
                extrema.counts[m, kind] += 1
            slope = later
