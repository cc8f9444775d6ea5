"""Steps that a run has stored: their polynomials, and the extrema of the deflections."""

from typing import NamedTuple

from facegear._kernels import motion
from facegear.arrays import Array, Integers


class Steps(NamedTuple):
    """Polynomials of the first S steps of a run.

    starts, lengths (S,): mesh phase in the step's period and length, rad. coordinates (S, order + 1, n) and
    deflections (S, order + 1, m): ascending powers of the phase since the start of the step; states (S, m):
    piece of the law that each contact is in, negative on the back flank.
    """

    starts: Array
    lengths: Array
    coordinates: Array
    deflections: Array
    states: Integers


class Extrema(NamedTuple):
    """Deflections where they change direction.

    `values` (m, 2, K) are maxima, then minima, in the order in which they are met. `counts` (m, 2) include
    those that have not been stored.
    """

    values: Array
    counts: Integers


def steps_of(log: motion.Log) -> Steps:
    """Return the steps that a run of one machine has stored.

    Parameters
    ----------
    log : motion.Log
        Log of the run.

    Returns
    -------
    Steps
        Polynomials of the steps.
    """
    return Steps(*(getattr(log, f"step_{name}") for name in Steps._fields))


def extrema_of(log: motion.Log) -> Extrema:
    """Return the extrema that a run of one machine has stored.

    Parameters
    ----------
    log : motion.Log
        Log of the run.

    Returns
    -------
    Extrema
        Deflections where they change direction.
    """
    return Extrema(log.turning_points, log.turning_counts)
