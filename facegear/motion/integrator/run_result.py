"""Result of a run: its status and what the kernels hand back, and checks of its arguments."""

import math
from dataclasses import dataclass

from facegear._kernels import motion
from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.integrator.records import Sums

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
        Fraction of the time open, on the drive and on the back flank; only with samples, batches or tangents.
    divergence : float
        Integral of the trace of the equations' matrix; only with tangents.
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
    """Return the step at which the last Taylor term of the fastest disturbance is 100 times the tolerance.

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
