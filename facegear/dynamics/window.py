"""The stretch of motion that a result is measured on."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.periods import make_log, run_periods
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Settings
from facegear.dynamics.orbits import require

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Window:
    """Whole mesh periods: samples (periods * per_period, n) of y, shares (3, m) in rad, state at the end
    by phase.
    """

    periods: int
    samples: Array
    shares: Array
    place: Array
    velocity: Array


def run_window(
    packed: Packed,
    work: Work,
    place: Array,
    velocity: Array,
    tangents: Array,
    periods: int,
    settings: Settings,
) -> Window:
    """Run periods from a state, which is left alone; tangents (columns, 2, n) are moved along.

    Raises NotConverged where a step fails.
    """
    place, velocity = place.copy(), velocity.copy()
    log = make_log(packed, periods, settings.samples)
    status = run_periods(
        packed, work, place, velocity, tangents, periods, settings.samples, settings.tolerance, log
    )
    require(status)
    return Window(periods, log.samples[:, : packed.n], log.shares[:, : packed.m], place, velocity)


def joined(windows: list[Window]) -> Window:
    """Windows that follow one another as one."""
    return Window(
        sum(window.periods for window in windows),
        np.concatenate([window.samples for window in windows]),
        np.sum([window.shares for window in windows], axis=0),
        windows[-1].place,
        windows[-1].velocity,
    )
