"""The stretch of motion that a result is measured on."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.periods import disturbance_step, make_log, run_periods
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.averages import BATCHES, Averages, averages
from facegear.dynamics.steady_state.orbits import require

Array = NDArray[np.float64]
MOST_SAMPLES = 4096
MOST_IN_ALL = 65_536
"""Samples of a window of many periods; a single period may have MOST_SAMPLES."""
FINENESS = 3.0
"""Samples per period of the fastest motion that a system can answer with."""


@dataclass(frozen=True, eq=False)
class Window:
    """Whole mesh periods: samples (periods * per_period, n) of y, shares (3, m) of time, ends (periods, 2, n)
    of each period by phase, exact averages, logarithmic growth (periods,) of a disturbance, if one was run.
    """

    periods: int
    per_period: int
    samples: Array
    shares: Array
    ends: Array
    averages: Averages
    growth: Array


def run_window(
    packed: Packed, work: Work, state: Array, periods: int, settings: Settings, tangent: Array | None = None
) -> Window:
    """Run periods from a state (2, n) by phase, which is left alone. Raises NotConverged where a step fails.

    A periodic motion over its own period needs one batch; BATCHES of others show how far chance goes. A
    disturbance (1, 2, n) of length one is moved along and turned.
    """
    displacement, velocity = state.copy()
    none = np.zeros((0, 2, displacement.size))
    per_period = samples_needed(packed, settings.samples, periods)
    disturbed = tangent is not None
    log = make_log(packed, periods, per_period, growth=disturbed, batches=min(BATCHES, periods))
    tolerance = settings.tolerance
    longest = disturbance_step(packed, work.order, tolerance) if disturbed else TAU
    moved = tangent if disturbed else none
    require(
        run_periods(packed, work, displacement, velocity, moved, periods, per_period, tolerance, log, longest)
    )
    return Window(
        periods=periods,
        per_period=per_period,
        samples=log.samples[:, : packed.n],
        shares=log.shares[:, : packed.m] / (TAU * periods),
        ends=log.ends,
        averages=averages(packed, log.sums, periods),
        growth=log.growth,
    )


def samples_needed(packed: Packed, least: int, periods: int) -> int:
    """Samples per period that show all that moves: `least` times a power of two, within memory."""
    wanted = min(FINENESS * packed.fastest, MOST_SAMPLES)
    most = max(MOST_IN_ALL // periods, least)
    doublings = max(0, int(np.ceil(np.log2(wanted / least))))
    while doublings and least * 2**doublings > most:
        doublings -= 1
    return least * 2**doublings


def run_disturbed(
    packed: Packed, work: Work, state: Array, tangent: Array, periods: int, settings: Settings
) -> tuple[Array, Array]:
    """Ends (periods, 2, n) of each period, and the logarithmic growth (periods,) of a disturbance (1, 2, n)
    of length one, which is moved along and turned.
    """
    displacement, velocity = state.copy()
    tolerance = settings.tolerance
    log = make_log(packed, periods, growth=True)
    longest = disturbance_step(packed, work.order, tolerance)
    require(run_periods(packed, work, displacement, velocity, tangent, periods, 0, tolerance, log, longest))
    return log.ends, log.growth
