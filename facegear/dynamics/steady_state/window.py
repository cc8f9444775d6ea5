"""The stretch of motion that a result is measured on."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.courses import Course, alone
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.steady_state.averages import BATCHES, Averages, averages
from facegear.dynamics.stretch import Stretch

MAX_SAMPLES = 4096
MAX_IN_ALL = 65_536
"""Samples of a window of many periods; a single period may have MAX_SAMPLES."""
FINENESS = 3.0
"""Samples per period of the fastest motion that a system can answer with."""


@dataclass(frozen=True, eq=False)
class Window:
    """Whole mesh periods: samples (periods * per_period, n) of y, fractions (3, m) of time, ends (periods, 2,
    n) of each period by phase, exact averages, logarithmic growth (periods,) of a disturbance, if one was
    run, and the disturbance (1, 2, n) at the end.
    """

    periods: int
    per_period: int
    samples: Array
    fractions: Array
    ends: Array
    averages: Averages
    growth: Array
    tangent: Array


def run_window(integrator: Integrator, state: Array, periods: int, samples: int) -> Window:
    """window() of one run by itself, without a disturbance."""
    return alone(window(integrator, state, periods, samples))


def window(
    integrator: Integrator, state: Array, periods: int, samples: int, tangent: Array | None = None
) -> Course[Window]:
    """Run periods from a state (2, n) by phase with at least so many samples in each. Raises NotConverged.

    A periodic motion over its own period needs one batch; BATCHES of others show how far chance goes. A
    disturbance (1, 2, n) of length one is moved along and turned.
    """
    per_period = samples_needed(integrator, samples, periods)
    result = yield Stretch(
        integrator,
        state,
        periods,
        tangent,
        samples=per_period,
        batches=min(BATCHES, periods),
        growth=tangent is not None,
    )
    return Window(
        periods=periods,
        per_period=per_period,
        samples=result.samples,
        fractions=result.fractions,
        ends=result.ends,
        averages=averages(integrator, result.sums, periods),
        growth=result.growth,
        tangent=result.tangents,
    )


def samples_needed(integrator: Integrator, minimum: int, periods: int) -> int:
    """Samples per period that show all that moves: `minimum` times a power of two, within memory."""
    wanted = min(FINENESS * integrator.fastest, MAX_SAMPLES)
    maximum = max(MAX_IN_ALL // periods, minimum)
    doublings = max(0, int(np.ceil(np.log2(wanted / minimum))))
    while doublings and minimum * 2**doublings > maximum:
        doublings -= 1
    return minimum * 2**doublings
