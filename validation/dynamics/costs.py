"""Cost of a sweep against its settings."""

import itertools
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.machine import Machine, mesh_frequency
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, SweepPlan
from facegear.motion.steady_state.simulate import Model, build_model, simulate
from facegear.motion.sweeps.sweep import Piece, collect, run_speeds
from validation.dynamics.methods import scipy_method
from validation.dynamics.problems import ComparedResult, Problem

SPEEDS = 40
"""Number of speeds of the sweep."""
TOLERANCES = (1e-3, 1e-4, 3e-5, 1e-6, 1e-8)
"""Tolerances that are compared, relative."""
DWELLS = (32, 128)
"""Mesh periods of settling that are compared."""
PLAIN_PERIODS = 20
"""Mesh periods of the shorter run by SciPy."""


def sweep_costs(machine: Machine, plan: SweepPlan, step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """Compare settings of a sweep of 40 speeds up by time and error of the RMS where motions are periodic.

    Each periodic motion is run again from its own state at a tight tolerance, so that the error is that of
    the orbit found and not of the branch chosen. Columns tolerance, settle_periods, refine,
    seconds_per_speed, periodic_speeds, not_confirmed (periodic speeds whose class is another one then),
    rms_error (largest of the confirmed, relative to the largest mesh at the speed), rms_error_median,
    plain_seconds_per_speed (SciPy RK45 on NumPy for as many periods as ours ran, from a shorter run).

    Parameters
    ----------
    machine : Machine
        The machine.
    plan : SweepPlan
        Plan of the sweep.
    step : Callable[[], None]
        Called after each row.

    Returns
    -------
    DataFrame
        One row for each setting.
    """
    model = build_model(machine)
    speeds = np.linspace(plan.first_rpm, plan.last_rpm, SPEEDS)
    plain = plain_seconds_per_period(machine, speeds)
    rows = []
    for tolerance, settle, refine in itertools.product(TOLERANCES, DWELLS, (True, False)):
        settings = replace(plan.settings, tolerance=tolerance, settle=settle, refine=refine, extensions=0)
        begin = time.process_time()
        piece = collect(model, run_speeds(model, speeds, settings, None))
        seconds = (time.process_time() - begin) / SPEEDS
        periodic, errors = _rms_errors(model, piece, plan.settings)
        rows.append(
            {
                "tolerance": tolerance,
                "settle_periods": settle,
                "refine": refine,
                "seconds_per_speed": seconds,
                "periodic_speeds": periodic,
                "not_confirmed": periodic - errors.size,
                "rms_error": errors.max(initial=0.0),
                "rms_error_median": np.median(errors),
                "plain_seconds_per_speed": plain * piece.periods_run.mean(),
            }
        )
        step()
    return pd.DataFrame(rows)


def _rms_errors(model: Model, piece: Piece, settings: Settings) -> tuple[int, Array]:
    """Number of periodic speeds, and the relative RMS errors of those that are the same motion when tight."""
    tight = replace(settings, tolerance=1e-10, order=None, periodic_residual=1e-9, extensions=0)
    periodic = np.flatnonzero(piece.periodic)
    errors = []
    for i in periodic:
        best = collect(model, run_speeds(model, piece.speeds[i : i + 1], tight, piece.state(int(i))))
        if best.period[0] == piece.period[i]:
            rms, exact = piece.deflection_ac_rms[i], best.deflection_ac_rms[0]
            errors.append(np.abs(rms - exact).max() / exact.max())
    return len(periodic), np.array(errors)


def plain_seconds_per_period(machine: Machine, speeds: Array) -> float:
    """Measure the time of a mesh period with SciPy's RK45 at 1e-6 on a NumPy right-hand side.

    Parameters
    ----------
    machine : Machine
        The machine.
    speeds : (n,) array
        Speeds of the sweep, rpm.

    Returns
    -------
    float
        Mean over three speeds, s.
    """
    model = build_model(machine)
    prepare = scipy_method("RK45", plain=True)
    times = []
    for speed in speeds[[len(speeds) // 4, len(speeds) // 2, -1]]:
        state = simulate(model, float(speed), Settings(settle=32, extensions=0, window=16)).state
        omega = TAU * mesh_frequency(machine.layout, float(speed))
        problem = Problem("plain", model.system, omega, state, PLAIN_PERIODS, ComparedResult.DEFLECTIONS)
        run = prepare(problem, 1e-6)
        begin = time.process_time()
        run()
        times.append((time.process_time() - begin) / PLAIN_PERIODS)
    return float(np.mean(times))
