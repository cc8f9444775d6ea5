"""Result of a run: its status, polynomials of its steps, extrema, integrals; and checks of its arguments."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array, Integers
from facegear.errors import NotConverged


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
    """Deflections of m rows where they change direction in a run, m.

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


def extrema_of(log: motion.Log, rows: int) -> Extrema:
    """Return the extrema that a run of one machine has stored.

    Parameters
    ----------
    log : motion.Log
        Log of the run.
    rows : int
        Number m of rows of meshes, flanks and rings.

    Returns
    -------
    Extrema
        Deflections where they change direction.
    """
    return Extrema(log.turning_points[:rows], log.turning_counts[:rows])


class Sums(NamedTuple):
    """Integrals over the mesh phase (rad), in B batches of whole periods; B = 0 if none were requested.

    Of meshes with two flanks the first `pairs` columns hold half the difference of the deflections of the two
    from their edges, and the difference of their forces.

    Attributes
    ----------
    origin : (n,)
        Reference from which the coordinates are counted.
    level : (m,)
        Reference from which the deflections are counted, m.
    coordinates : (B, n)
        Integral of y - origin over each batch.
    products : (B, n, n)
        Integral of (y - origin) (y - origin)^T over each batch; only the upper triangle is filled.
    deflections, squared : (B, m)
        Integrals of the deflections less `level`, and of their squares, m rad and m^2 rad.
    forces : (2, m)
        Integrals over the whole run of the elastic mesh force, and of its magnitude, over the squared
        mesh frequency.
    minimum, maximum : (m,)
        Extremes of the deflections over the run, m.
    pull : (m,)
        The smallest force of spring and damper of a contact over w^2, negative where flanks are pulled
        together, zero where they never are, at the ends and inner nodes of the steps.
    """

    origin: Array
    level: Array
    coordinates: Array
    products: Array
    deflections: Array
    squared: Array
    forces: Array
    minimum: Array
    maximum: Array
    pull: Array


def sums_of(log: motion.Log, number: int, n: int, m: int) -> Sums:
    """Return the integrals and extremes of one machine of a run.

    Parameters
    ----------
    log : motion.Log
        Log of the run.
    number : int
        Index of the machine in the run.
    n : int
        Number of coordinates.
    m : int
        Number of rows of meshes, flanks and rings.

    Returns
    -------
    Sums
        Integrals without batches where the run was made without.
    """
    if not len(log.coordinates):
        return Sums(
            *(np.zeros(shape) for shape in ((n,), (m,), (0, n), (0, n, n), (0, m), (0, m), (2, m))),
            *(np.zeros(m) for _ in range(3)),
        )
    by_coordinate = ("origin", "coordinates", "products")
    return Sums(
        *(getattr(log, name)[number][..., : n if name in by_coordinate else m] for name in Sums._fields)
    )


SUCCESS, TOO_MANY_STEPS, NOT_FINITE = range(3)
"""Status codes of the kernels at the end of a run."""


@dataclass(frozen=True, eq=False)
class RunResult:
    """Result of a run over whole mesh periods, with n coordinates and m rows of meshes, flanks and rings.

    Attributes
    ----------
    state : (2, n) array
        State at the end.
    ends : (periods, 2, n) array
        State at the end of each period.
    tangents : (columns, 2, n) array
        Disturbances at the end.
    samples : (periods * samples, n) array
        Coordinates at evenly spaced phases, from the start of each period.
    fractions : (3, m) array
        Fractions of the time that each row is open, on its drive flank, on its back flank; zeros without
        samples, batches or tangents.
    divergence : float
        Integral over the phase of the trace of the linearised equations' matrix: the logarithm of the
        determinant of the monodromy matrix. Only with tangents.
    growth : (periods,) array
        Logarithm of the growth of the one tangent in each period, if it was requested.
    steps : int
        Number of steps.
    sums : Sums
        Integrals and extrema over batches of periods.
    """

    state: Array
    ends: Array
    tangents: Array
    samples: Array
    fractions: Array
    divergence: float
    growth: Array
    steps: int
    sums: Sums


def disturbance_step(fastest: float, order: int, tolerance: float) -> float:
    """Return the step h at which the last Taylor term of the fastest disturbance is 100 times the
    tolerance.

    With the order p this is (fastest h)^p / p! = 100 tolerance, which is taken as 0.01 at most.

    The fastest are the most damped; one of half its frequency is then below the tolerance at any order used.

    Parameters
    ----------
    fastest : float
        Angular frequency of the fastest disturbance over the mesh frequency, dimensionless.
    order : int
        Order of the Taylor steps.
    tolerance : float
        Local error of a step over the length scale, dimensionless.

    Returns
    -------
    float
        Length of the step, rad of mesh phase.
    """
    logarithm = math.log(min(100.0 * tolerance, 0.01))
    for i in range(2, order + 1):
        logarithm += math.log(i)
    return math.exp(logarithm / order) / fastest


def require(status: int) -> None:
    """Raise NotConverged unless the status of a run is SUCCESS.

    Parameters
    ----------
    status : int
        Status code of the kernels.

    Raises
    ------
    NotConverged
        If the run took too many steps or the motion grew beyond all bounds.
    """
    messages = {
        TOO_MANY_STEPS: f"a mesh period took more than {motion.MAX_STEPS} steps",
        NOT_FINITE: "the motion grew beyond all bounds",
    }
    if status != SUCCESS:
        raise NotConverged("dynamics", "time integration", messages[status])
