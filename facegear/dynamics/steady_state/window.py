"""The stretch of motion on which a result is measured."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.run_plans import RunPlan, alone
from facegear.dynamics.steady_state.averages import BATCHES, Averages, averages
from facegear.dynamics.stretch import RunRequest

MAX_SAMPLES = 4096
"""Maximum number of samples in a period."""
MAX_IN_ALL = 65_536
"""Maximum number of samples in a window of many periods; a single period may have MAX_SAMPLES."""
FINENESS = 3.0
"""Samples per period of the fastest motion that a system can answer with."""


@dataclass(frozen=True, eq=False)
class Window:
    """A window of whole mesh periods.

    Attributes
    ----------
    periods, per_period : int
        Number of mesh periods, and of samples in each.
    samples : (periods * per_period, n) array
        Samples of the coordinates.
    fractions : (3, m) array
        Fraction of the time that each contact is open, on its drive flank, and on its back flank.
    ends : (periods, 2, n) array
        State by phase at the end of each period.
    averages : Averages
        Exact averages.
    growth : (periods,) array
        Logarithmic growth of a disturbance in each period, if one was run.
    tangent : (1, 2, n) array
        The disturbance at the end.
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
    """Run a single window without a disturbance, see window().

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    periods : int
        Number of mesh periods.
    samples : int
        Least number of samples in each period.

    Returns
    -------
    Window
        The window.
    """
    return alone(window(integrator, state, periods, samples))


def window(
    integrator: Integrator, state: Array, periods: int, samples: int, tangent: Array | None = None
) -> RunPlan[Window]:
    """Run some periods and measure them.

    A periodic motion over its own period needs one batch; BATCHES batches of other motions give confidence
    intervals.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    periods : int
        Number of mesh periods.
    samples : int
        Least number of samples in each period.
    tangent : (1, 2, n) array, optional
        Disturbance of length one (dimensionless), which is integrated along and scaled.

    Returns
    -------
    RunPlan of Window
        Computation that returns the window.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    per_period = samples_needed(integrator, samples, periods)
    result = yield RunRequest(
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
    """Number of samples per period that resolve the fastest motion: `minimum` times a power of two, within
    memory.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    minimum : int
        Least number of samples in each period.
    periods : int
        Number of mesh periods.

    Returns
    -------
    int
        Number of samples in each period.
    """
    target = min(FINENESS * integrator.fastest, MAX_SAMPLES)
    maximum = max(MAX_IN_ALL // periods, minimum)
    doublings = max(0, int(np.ceil(np.log2(target / minimum))))
    while doublings and minimum * 2**doublings > maximum:
        doublings -= 1
    return minimum * 2**doublings
