"""Error against time for every method, setting and problem."""

import statistics
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.dynamics.steady_state.simulate import mesh_response
from facegear.dynamics.steady_state.statistics import moments
from facegear.validation.dynamics.methods import Method, ours
from facegear.validation.dynamics.problems import SAMPLES, Problem

Array = NDArray[np.float64]
REFERENCE = 1e-13
REFERENCE_TOLERANCE = 1e-8
REFERENCE_PERIODS = 16_000


@dataclass(frozen=True)
class Budget:
    """Repeats of each run for the median CPU time, and the longest run (s) after which a ladder ends."""

    repeats: int = 3
    longest: float = 1.0
    longest_irregular: float = 3.0


def work_precision(
    problems: Sequence[Problem],
    methods: Iterable[Method],
    budget: Budget,
    step: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Columns problem, method, setting, error, interval, seconds, failure; errors over the length scale, or
    of the RMS with the 95 % half-width that chance leaves in it (0 otherwise).
    """
    references = {problem.name: reference(problem) for problem in problems}
    rows = []
    for method in methods:
        for problem in problems:
            method.run(replace(problem, periods=1), method.ladder[0])
            for setting in method.ladder:
                found = measure(problem, method, setting, references[problem.name], budget)
                rows.append((problem.name, method.name, setting, *found))
                failure, seconds = found[3], found[2]
                if failure or seconds > (budget.longest_irregular if problem.statistical else budget.longest):
                    break
            step()
    names = ["problem", "method", "setting", "error", "interval", "seconds", "failure"]
    return pd.DataFrame(rows, columns=names)


def reference(problem: Problem) -> tuple[Array, Array]:
    """Deflections at tight tolerance; for a statistical problem the RMS of a much longer run. Half-widths."""
    if not problem.statistical:
        exact = mesh_response(problem.system, ours(problem, REFERENCE), SAMPLES)[0]
        return exact, np.zeros(exact.shape[1])
    longer = replace(problem, periods=REFERENCE_PERIODS)
    return ac_rms(mesh_response(problem.system, ours(longer, REFERENCE_TOLERANCE), SAMPLES)[0])


def ac_rms(deflections: Array) -> tuple[Array, Array]:
    """RMS without mean of each mesh and its 95 % half-width, each (meshes,)."""
    found = moments(deflections, SAMPLES, False)
    return found.ac_rms, found.ac_rms_interval


def measure(
    problem: Problem, method: Method, setting: float, exact: tuple[Array, Array], budget: Budget
) -> tuple[float, float, float, str]:
    """Error, its half-width, median time in s, and what went wrong.

    A run whose motion is irregular is measured once: its length gives the time its accuracy already.
    """
    times = []
    coordinates = None
    for _ in range(1 if problem.statistical else budget.repeats):
        begin = time.process_time()
        try:
            coordinates = method.run(problem, setting)
        except Exception as error:  # a solver that fails is a result of the comparison
            reported = f"{type(error).__name__}: {error}".splitlines()[0][:100]
            return np.nan, np.nan, time.process_time() - begin, reported
        times.append(time.process_time() - begin)
        if times[-1] > budget.longest:
            break
    deflections = mesh_response(problem.system, coordinates, SAMPLES)[0]
    if not problem.statistical:
        error = float(np.abs(deflections - exact[0]).max() / problem.system.scale)
        return error, 0.0, statistics.median(times), ""
    found, doubt = ac_rms(deflections)
    error = float((np.abs(found - exact[0]) / exact[0]).mean())
    interval = float((np.hypot(doubt, exact[1]) / exact[0]).mean())
    return error, interval, statistics.median(times), ""


def cheapest_within_chance(table: pd.DataFrame, problem: str) -> pd.DataFrame:
    """For each method its cheapest setting whose RMS and those of all finer ones agree with the reference.

    Columns method, setting, error, interval, seconds; one row for each method that has such a setting. Chance
    allows a mean gap of the half-width.
    """
    rows = []
    for method, curve in table[table["problem"] == problem].groupby("method", sort=False):
        agrees = (curve["error"] <= curve["interval"]).to_numpy()
        kept = curve[np.logical_and.accumulate(agrees[::-1])[::-1]]
        if len(kept):
            best = kept.loc[kept["seconds"].idxmin()]
            rows.append((method, best["setting"], best["error"], best["interval"], best["seconds"]))
    return pd.DataFrame(rows, columns=["method", "setting", "error", "interval", "seconds"])


def seconds_at(table: pd.DataFrame, problem: str, method: str, error: float) -> float:
    """Time of a method at an error, interpolated between its settings in logarithms; NaN beyond its
    ladder.
    """
    rows = table[(table["problem"] == problem) & (table["method"] == method)].dropna(subset="error")
    best = rows.sort_values("error")
    reached = best[best["error"] <= error]
    if reached.empty:
        return float("nan")
    cheapest = reached.loc[reached["seconds"].idxmin()]
    worse = best[(best["error"] > error) & (best["seconds"] < cheapest["seconds"])]
    if worse.empty:
        return float(cheapest["seconds"])
    near = worse.loc[worse["error"].idxmin()]
    weight = np.log(error / cheapest["error"]) / np.log(near["error"] / cheapest["error"])
    return float(cheapest["seconds"] * (near["seconds"] / cheapest["seconds"]) ** weight)
