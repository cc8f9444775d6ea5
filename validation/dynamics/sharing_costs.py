"""Load sharing of one machine at one speed: time and error over random machines."""

import statistics
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd

from facegear.machine.machine import Machine
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.sharing.even_shares import group_average
from facegear.sharing.groups import SharingOptions
from facegear.sharing.run import Sharing, load_sharing_of_many
from facegear.sharing.statistics import Average, densely_sampled
from validation.dynamics.convergence import exact

COUNT = 20
"""Number of random machines."""
REPEATS = 3
"""Number of runs whose median time is taken."""
MORE_CYCLES = 10
"""Times the cycles over which the averages of irregular motion are taken again."""


@dataclass(frozen=True, eq=False)
class RandomMachine:
    """A machine with torques, backlash and e(t) of its own, and its speed in rpm; factors of the original."""

    machine: Machine
    speed_rpm: float
    torque_factor: float
    backlash_factor: float
    error_factor: float


def random_machines(machine: Machine, count: int, seed: int = 1) -> Iterator[RandomMachine]:
    """Draw machines between a quarter of the torque and twice as much, at 1000 to 15 000 rpm.

    Parameters
    ----------
    machine : Machine
        The original.
    count : int
        Number of machines.
    seed : int
        Seed of the random numbers.

    Yields
    ------
    RandomMachine
        One machine.
    """
    random = np.random.default_rng(seed)
    for _ in range(count):
        torque = float(np.exp(random.uniform(np.log(0.25), np.log(2.0))))
        error, backlash = random.uniform(0.2, 1.2), random.uniform(0.5, 1.5)
        variant = replace(
            machine,
            torques=torque * machine.torques,
            half_backlash=backlash * machine.half_backlash,
            error=machine.error.scale(error),
        )
        yield RandomMachine(variant, random.uniform(1e3, 15e3), torque, backlash, error)


def sharing_costs(
    machine: Machine,
    settings: Settings,
    options: SharingOptions,
    count: int = COUNT,
    step: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Measure time and error of load sharing over random machines.

    Columns: factors and speed_rpm, motion, motions_from_starts, periods_run, seconds (median CPU time of warm
    runs with all starts), seconds_together (the same where all machines run side by side, over their number),
    mean, error, chance, motion_exact.

    error: largest change of a group's mean coefficient, which lies between one and the number of paths, when
    a periodic motion is run again from its own state at 1e-10 and 4096 samples, or an irregular one for ten
    times as long at a hundredth of the tolerance. chance: what of that the 95 % intervals of both explain.
    mean is that of the group with the largest error.

    Parameters
    ----------
    machine : Machine
        The original.
    settings : Settings
        Settings of the integration.
    options : SharingOptions
        Options of load sharing.
    count : int
        Number of machines.
    step : Callable[[], None]
        Called after each machine.

    Returns
    -------
    DataFrame
        One row for each random machine.
    """
    rows, machines = [], list(random_machines(machine, count))
    cases = [(case.machine, case.speed_rpm) for case in machines]
    together, _ = _measure_time(partial(load_sharing_of_many, cases, settings, options))
    for case in machines:
        seconds, (sharing,) = _measure_time(
            partial(load_sharing_of_many, [(case.machine, case.speed_rpm)], settings, options)
        )
        finer = _again(case, sharing, settings, options)
        rows.append(
            {
                "torque_factor": case.torque_factor,
                "backlash_factor": case.backlash_factor,
                "error_factor": case.error_factor,
                "speed_rpm": case.speed_rpm,
                "motion": sharing.response.label,
                "motions_from_starts": "; ".join(dict.fromkeys(sharing.motions)),
                "periods_run": sharing.response.periods_run,
                "seconds": seconds,
                "seconds_together": together / count,
                **_error(sharing, finer, options),
                "motion_exact": finer.label,
            }
        )
        step()
    return pd.DataFrame(rows)


def _measure_time(run: Callable[[], list[Sharing]]) -> tuple[float, list[Sharing]]:
    """Return the median processor time of REPEATS calls, s, and their result."""
    times, sharings = [], []
    for _ in range(REPEATS):
        begin = time.process_time()
        sharings = run()
        times.append(time.process_time() - begin)
    return statistics.median(times), sharings


def _again(case: RandomMachine, sharing: Sharing, settings: Settings, options: SharingOptions) -> SteadyState:
    """Run the motion once more from where it was left, far finer."""
    model, state = build_model(case.machine), sharing.response.state
    if sharing.response.motion is Motion.PERIODIC:
        return simulate(model, case.speed_rpm, exact(settings), state)
    longer = replace(
        settings,
        tolerance=0.01 * settings.tolerance,
        window=MORE_CYCLES * options.cycles,
        samples=64,
        extensions=0,
    )
    return simulate(model, case.speed_rpm, longer, state)


def _error(sharing: Sharing, finer: SteadyState, options: SharingOptions) -> dict[str, float]:
    """Mean, error and chance of the group whose mean coefficient changes most."""
    fine = densely_sampled(finer)
    pairs: list[tuple[Average, Average]] = [
        (group.average, group_average(fine, group.group, options.confidence)[2]) for group in sharing.groups
    ]
    first, second = max(pairs, key=lambda pair: abs(pair[0].mean - pair[1].mean))
    return {
        "mean": first.mean,
        "error": abs(first.mean - second.mean),
        "chance": float(np.hypot(first.half_width, second.half_width)),
    }


def sharing_summary(table: pd.DataFrame) -> str:
    """Summarise times and errors of periodic and of irregular motions in words.

    Parameters
    ----------
    table : DataFrame
        Table of `sharing_costs`.

    Returns
    -------
    str
        The text.
    """
    periodic = table["motion"].str.startswith("period-")
    times = 1e3 * table["seconds"]
    within = (table["error"] <= table["chance"])[~periodic].sum()
    return (
        f"{times.median():.0f} ms in the median, {times.mean():.0f} ms on average, "
        f"{1e3 * table['seconds_together'].mean():.0f} ms side by side; "
        f"{periodic.sum()} periodic: {times[periodic].median():.0f} ms, error at most "
        f"{table['error'][periodic].max():.1e}; {(~periodic).sum()} irregular: "
        f"{times[~periodic].median():.0f} ms, {within} within chance"
    )
