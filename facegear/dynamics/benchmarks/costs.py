"""What a sweep costs: against settings, against the number of pinions and of harmonics."""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.dynamics.benchmarks.methods import scipy_method
from facegear.dynamics.benchmarks.problems import Problem
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.motion import Settings
from facegear.dynamics.plan import SweepPlan
from facegear.dynamics.simulate import model, simulate
from facegear.dynamics.sweep import DEFLECTION, Piece, collect, run_speeds
from facegear.harmonics.series import Harmonics
from facegear.transmission.layout import Layout, Role
from facegear.transmission.machine import Machine, balanced_torques, mesh_frequency

Array = NDArray[np.float64]
SPEEDS = 40
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-8)
DWELLS = (32, 128)
PLAIN_PERIODS = 20
OTHER_BRANCH = 0.1
"""Two periodic motions of one class whose RMS differ by this are different motions, not errors."""


def sweep_costs(machine: Machine, plan: SweepPlan, step: Callable[[], None] = lambda: None) -> pd.DataFrame:
    """Settings of a sweep of 40 speeds up against time and the error of the RMS where motions are periodic.

    Columns tolerance, settle_periods, refine, seconds_per_speed, periodic_speeds, rms_error (largest relative
    to the largest mesh at the speed), rms_error_median, plain_seconds_per_speed (SciPy RK45 on NumPy for as
    many periods as ours ran, from a shorter run).
    """
    ready = model(machine)
    speeds = np.linspace(plan.first_rpm, plan.last_rpm, SPEEDS)
    tight = replace(
        plan.settings, tolerance=1e-10, order=None, settle=1024, refine=True, periodic_residual=1e-9
    )
    best = collect(ready, run_speeds(ready, speeds, tight, None))
    rows = []
    for tolerance in TOLERANCES:
        for settle in DWELLS:
            for refine in (True, False):
                settings = replace(
                    plan.settings, tolerance=tolerance, settle=settle, refine=refine, extensions=0
                )
                begin = time.process_time()
                piece = collect(ready, run_speeds(ready, speeds, settings, None))
                seconds = (time.process_time() - begin) / SPEEDS
                errors = _rms_errors(piece, best)
                rows.append(
                    (
                        tolerance,
                        settle,
                        refine,
                        seconds,
                        errors.size,
                        errors.max(initial=0.0),
                        np.median(errors),
                    )
                )
                step()
    names = ["tolerance", "settle_periods", "refine", "seconds_per_speed", "periodic_speeds"]
    table = pd.DataFrame(rows, columns=[*names, "rms_error", "rms_error_median"])
    spent = float(np.mean(best.facts[:, 4]))
    table["plain_seconds_per_speed"] = plain_seconds_per_period(machine, speeds) * spent
    return table


def _rms_errors(piece: Piece, best: Piece) -> Array:
    """Relative RMS errors at the speeds where both found the same periodic motion."""
    row = DEFLECTION.index("ac_rms")
    same = [a == b and str(a).startswith("period-") for a, b in zip(piece.labels, best.labels, strict=True)]
    gap = np.abs(piece.deflection[same, row] - best.deflection[same, row]).max(axis=1)
    errors = gap / best.deflection[same, row].max(axis=1)
    return errors[errors < OTHER_BRANCH]


def plain_seconds_per_period(machine: Machine, speeds: Array) -> float:
    """Time of a mesh period with SciPy's RK45 at 1e-6 on a NumPy right-hand side, mean over three speeds."""
    ready = model(machine)
    run = scipy_method("RK45", plain=True)
    times = []
    for speed in speeds[[len(speeds) // 4, len(speeds) // 2, -1]]:
        state = simulate(ready, float(speed), Settings(settle=32, extensions=0, window=16)).state
        omega = TAU * mesh_frequency(machine.layout, float(speed))
        problem = Problem("plain", ready.system, omega, state, PLAIN_PERIODS, False)
        begin = time.process_time()
        run(problem, 1e-6)
        times.append((time.process_time() - begin) / PLAIN_PERIODS)
    return float(np.mean(times))


def scaling_costs(machine: Machine, speed_rpm: float) -> pd.DataFrame:
    """Time of a mesh period against pinions (evenly spread copies) and harmonics of k.

    Columns pinions, harmonics, coordinates, seconds_per_period.
    """
    settings = Settings(tolerance=1e-4, settle=256, extensions=0, window=256, refine=False)
    rows = []
    order = machine.stiffness.order
    for pinions, harmonics in [
        (1, order),
        (2, order),
        (5, order),
        (8, order),
        (12, order),
        (5, 1),
        (5, 20),
        (5, 40),
    ]:
        ready = model(_resized(machine, pinions, harmonics))
        simulate(ready, speed_rpm, replace(settings, settle=16, window=16))
        begin = time.process_time()
        response = simulate(ready, speed_rpm, settings)
        seconds = time.process_time() - begin
        # An irregular motion is measured over the window and two batches more.
        measured = response.periods * (1.0 if response.period else 18 / 16)
        rows.append((pinions, harmonics, ready.system.size, seconds / (response.spent + measured)))
    return pd.DataFrame(rows, columns=["pinions", "harmonics", "coordinates", "seconds_per_period"])


def _resized(machine: Machine, count: int, harmonics: int) -> Machine:
    """The machine with `count` pinions evenly spread, half of them driving, and as many harmonics of k."""
    old = machine.layout
    pinions = tuple(
        replace(
            old.pinions[0],
            name=f"pinion {i}",
            role=Role.INPUT if i % 2 == 0 else Role.IDLER,
            pitches=round(2.0 * i * old.gear_teeth / count) / 2.0,
        )
        for i in range(count)
    )
    layout: Layout = replace(old, pinions=pinions)
    torque = np.where(np.arange(count) % 2 == 0, np.abs(machine.torques).max() / 20.0, 0.0)
    size = np.r_[0.0, machine.stiffness.amplitudes[1:].max() / np.arange(1, harmonics + 1) ** 2]
    series = Harmonics(size, np.r_[machine.stiffness.mean, np.zeros(harmonics)])
    return replace(machine, layout=layout, torques=balanced_torques(layout, torque), stiffness=series)
