"""Error against time for every method, setting and problem."""

import statistics
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.dynamics.benchmarks.methods import Method, ours
from facegear.dynamics.benchmarks.problems import SAMPLES, Problem
from facegear.dynamics.simulate import mesh_response

Array = NDArray[np.float64]
REFERENCE = 1e-13
REFERENCE_PERIODS = 2000


@dataclass(frozen=True)
class Budget:
    """Repeats of each run for the median CPU time, and the longest run (s) after which a ladder ends."""

    repeats: int = 3
    longest: float = 0.5


def work_precision(
    problems: Sequence[Problem],
    methods: Iterable[Method],
    budget: Budget,
    step: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Columns problem, method, setting, error, seconds, failure; errors over the length scale or of the
    RMS.
    """
    references = {problem.name: reference(problem) for problem in problems}
    rows = []
    for method in methods:
        for problem in problems:
            method.run(problem, method.ladder[0])
            for setting in method.ladder:
                error, seconds, failure = measure(problem, method, setting, references[problem.name], budget)
                rows.append((problem.name, method.name, setting, error, seconds, failure))
                if failure or seconds > budget.longest:
                    break
            step()
    return pd.DataFrame(rows, columns=["problem", "method", "setting", "error", "seconds", "failure"])


def reference(problem: Problem) -> Array:
    """Deflections at tight tolerance; for a statistical problem the RMS of a much longer run."""
    if not problem.statistical:
        return mesh_response(problem.system, ours(problem, REFERENCE), SAMPLES)[0]
    longer = Problem(problem.name, problem.system, problem.frequency, problem.start, REFERENCE_PERIODS, True)
    return rms(mesh_response(problem.system, ours(longer, 1e-8), SAMPLES)[0])


def rms(deflections: Array) -> Array:
    """RMS without mean of each mesh, (meshes,)."""
    return deflections.std(axis=0)


def measure(
    problem: Problem, method: Method, setting: float, exact: Array, budget: Budget
) -> tuple[float, float, str]:
    """Error, median time in s, and what went wrong."""
    times = []
    coordinates = None
    for _ in range(budget.repeats):
        begin = time.process_time()
        try:
            coordinates = method.run(problem, setting)
        except Exception as error:  # a solver that fails is a result of the comparison
            return (
                np.nan,
                time.process_time() - begin,
                f"{type(error).__name__}: {error}".splitlines()[0][:100],
            )
        times.append(time.process_time() - begin)
        if times[-1] > budget.longest:
            break
    deflections = mesh_response(problem.system, coordinates, SAMPLES)[0]
    if problem.statistical:
        error = float(np.abs(rms(deflections) / exact - 1.0).mean())
    else:
        error = float(np.abs(deflections - exact).max() / problem.system.scale)
    return error, statistics.median(times), ""


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
