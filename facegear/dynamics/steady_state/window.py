"""The stretch of motion that a result is measured on."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.periods import disturbance_step, make_log, run_periods
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.orbits import require

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Window:
    """Whole mesh periods: samples (periods * per_period, n) of y, shares (3, m) in rad, growth (periods,)
    of a disturbance as a logarithm (empty if none was run), state at the end by phase.
    """

    periods: int
    samples: Array
    shares: Array
    growth: Array
    displacement: Array
    velocity: Array


def run_window(
    packed: Packed, work: Work, displacement: Array, velocity: Array, periods: int, settings: Settings
) -> Window:
    """Run periods from a state, which is left alone. Raises NotConverged where a step fails."""
    none = np.zeros((0, 2, displacement.size))
    return _window(packed, work, displacement, velocity, none, periods, settings, TAU)


def run_disturbed(
    packed: Packed,
    work: Work,
    displacement: Array,
    velocity: Array,
    tangent: Array,
    periods: int,
    settings: Settings,
) -> Window:
    """The same with a disturbance (1, 2, n) of length one, which is moved along and turned."""
    longest = disturbance_step(packed, work.order, settings.tolerance)
    return _window(packed, work, displacement, velocity, tangent, periods, settings, longest)


def _window(
    packed: Packed,
    work: Work,
    displacement: Array,
    velocity: Array,
    tangents: Array,
    periods: int,
    settings: Settings,
    longest: float,
) -> Window:
    displacement, velocity = displacement.copy(), velocity.copy()
    per_period, tolerance = settings.samples, settings.tolerance
    log = make_log(packed, periods, per_period, len(tangents) > 0)
    require(
        run_periods(
            packed, work, displacement, velocity, tangents, periods, per_period, tolerance, log, longest
        )
    )
    samples, shares = log.samples[:, : packed.n], log.shares[:, : packed.m]
    return Window(periods, samples, shares, log.growth, displacement, velocity)
