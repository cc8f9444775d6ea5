"""Error against time for every method, setting and problem."""

import statistics
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.motion.steady_state.mesh_samples import mesh_response
from facegear.motion.steady_state.statistics import moments
from validation.dynamics import heyoka_peer
from validation.dynamics.methods import Method
from validation.dynamics.problems import SAMPLES, ComparedResult, Problem

REFERENCE = 1e-15
"""Tolerance of the reference of regular motion, relative. heyoka.py at 1e-11 lies within 7e-12 of it."""
REFERENCE_TOLERANCE = 1e-8
"""Tolerance of the reference of irregular motion, relative."""
REFERENCE_PERIODS = 16_000
"""Mesh periods of the reference of irregular motion."""
COLUMNS = ["problem", "method", "setting", "error", "interval", "seconds", "preparation_seconds", "failure"]


@dataclass(frozen=True)
class Budget:
    """Most repeats of each run for the median CPU time, fewer once they take `longest` seconds together.

    A method stops at its first run longer than that.
    """

    repeats: int = 9
    longest: float = 1.0
    longest_irregular: float = 3.0

    def limit(self, problem: Problem) -> float:
        """Return the longest run of a problem.

        Parameters
        ----------
        problem : Problem
            The problem.

        Returns
        -------
        float
            Time, s.
        """
        return self.longest_irregular if problem.compared_result is ComparedResult.RMS else self.longest


def work_precision(
    problems: Sequence[Problem],
    methods: Iterable[Method],
    budget: Budget,
    step: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Measure error and time of each run.

    Errors of deflections over the length scale; of the RMS, with the 95 % half-width that chance leaves in it
    (0 otherwise); of the tangents over the largest entry of their matrix. `seconds` is the run alone (its
    share, where several run at once), `preparation_seconds` the time before it (memory; heyoka.py compiles
    then).

    Parameters
    ----------
    problems : Sequence[Problem]
        Problems to solve.
    methods : Iterable[Method]
        Methods to compare.
    budget : Budget
        Repeats and longest runs.
    step : Callable[[], None]
        Called after each method.

    Returns
    -------
    DataFrame
        One row for each run, columns COLUMNS.
    """
    references = {problem.name: reference(problem) for problem in problems}
    rows = []
    for method in methods:
        for problem in problems:
            method.prepare(replace(problem, periods=1), method.settings[0])()
            for setting in method.settings:
                row = measure(problem, method, setting, references[problem.name], budget)
                rows.append((problem.name, method.name, setting, *row))
                *_, seconds, _, failure = row
                if failure or seconds > budget.limit(problem):
                    break
            step()
    return pd.DataFrame(rows, columns=COLUMNS)


def reference(problem: Problem) -> tuple[Array, Array]:
    """Return the reference for `compared_values`: heyoka.py at a tight tolerance.

    For the RMS of irregular motion a much longer run takes the place of the tighter one.

    Parameters
    ----------
    problem : Problem
        The problem.

    Returns
    -------
    (...) array, (...) array
        Values and their half-widths, dimensionless or, of the RMS, in m.

    Raises
    ------
    ImportError
        If heyoka.py is not installed.
    """
    import heyoka

    if problem.compared_result is ComparedResult.RMS:
        longer = replace(problem, periods=REFERENCE_PERIODS)
        return compared_values(problem, heyoka_peer.trajectory(heyoka)(longer, REFERENCE_TOLERANCE)())
    is_tangents = problem.compared_result is ComparedResult.TANGENTS
    prepare = (heyoka_peer.tangents if is_tangents else heyoka_peer.trajectory)(heyoka)
    return compared_values(problem, prepare(problem, REFERENCE)())


def compared_values(problem: Problem, states: Array) -> tuple[Array, Array]:
    """Return the values whose differences are errors, and their half-widths.

    Tangents count in mesh deflections and their rates.

    Parameters
    ----------
    problem : Problem
        The problem.
    states : (...) array
        Result of a run, in the problem's unit.

    Returns
    -------
    (...) array, (...) array
        Values and their half-widths, dimensionless or, of the RMS, in m.
    """
    system = problem.system
    if problem.compared_result is ComparedResult.TANGENTS:
        weights = np.tile(np.abs(system.mesh_jacobian).max(axis=0), 2)
        matrix = states * weights[:, None] / weights
        return matrix, np.zeros(matrix.shape)
    deflections = mesh_response(system, states, SAMPLES)[0]
    if problem.compared_result is ComparedResult.RMS:
        return ac_rms(deflections)
    return deflections / system.scale, np.zeros(deflections.shape)


def error_of(problem: Problem, states: Array, exact: tuple[Array, Array]) -> tuple[float, float]:
    """Return the error of a run against the reference, and its half-width.

    Parameters
    ----------
    problem : Problem
        The problem.
    states : (...) array
        Result of the run, in the problem's unit.
    exact : tuple of (...) array
        Values and half-widths of the reference, in their unit.

    Returns
    -------
    float, float
        Error and half-width, relative.
    """
    values, doubt = compared_values(problem, states)
    if problem.compared_result is ComparedResult.RMS:
        error = float((np.abs(values - exact[0]) / exact[0]).mean())
        return error, float((np.hypot(doubt, exact[1]) / exact[0]).mean())
    largest = np.abs(exact[0]).max() if problem.compared_result is ComparedResult.TANGENTS else 1.0
    return float(np.abs(values - exact[0]).max() / largest), 0.0


def ac_rms(deflections: Array) -> tuple[Array, Array]:
    """Return the RMS without mean of each mesh and its 95 % half-width.

    Parameters
    ----------
    deflections : (samples, meshes) array
        Mesh deflections, m.

    Returns
    -------
    (meshes,) array, (meshes,) array
        RMS and half-width, m.
    """
    rms = moments(deflections, SAMPLES, False)
    return rms.ac_rms, rms.ac_rms_interval


def measure(
    problem: Problem, method: Method, setting: float, exact: tuple[Array, Array], budget: Budget
) -> tuple[float, float, float, float, str]:
    """Measure error and time of a method.

    A run whose motion is irregular is measured once: its length gives the time its accuracy already.

    Parameters
    ----------
    problem : Problem
        The problem.
    method : Method
        The method.
    setting : float
        Tolerance, relative, or number of steps a period.
    exact : tuple of (...) array
        Values and half-widths of the reference, in their unit.
    budget : Budget
        Repeats and longest runs.

    Returns
    -------
    tuple
        Error and its half-width, relative; median time of a run and time of its preparation, s; message of a
        failure.
    """
    times = []
    begin = time.process_time()
    preparation = 0.0
    try:
        run = method.prepare(problem, setting)
        preparation = time.process_time() - begin
        for _ in range(1 if problem.compared_result is ComparedResult.RMS else budget.repeats):
            begin = time.process_time()
            values = run()
            times.append(time.process_time() - begin)
            if sum(times) > budget.longest:
                break
    except Exception as error:  # a solver that fails is a result of the comparison
        error_text = f"{type(error).__name__}: {error}".splitlines()[0][:100]
        return np.nan, np.nan, time.process_time() - begin, preparation, error_text
    return *error_of(problem, values, exact), statistics.median(times) / method.together, preparation, ""


def cheapest_within_chance(table: pd.DataFrame, problem: str) -> pd.DataFrame:
    """Select for each method its cheapest setting whose RMS and those of all finer ones agree with the
    reference.

    Chance allows a mean gap of the half-width.

    Parameters
    ----------
    table : DataFrame
        Table of `work_precision`.
    problem : str
        Name of the problem.

    Returns
    -------
    DataFrame
        Columns method, setting, error, interval, seconds; one row for each method that has such a setting.
    """
    rows = []
    for method, curve in table[table["problem"] == problem].groupby("method", sort=False):
        agrees = (curve["error"] <= curve["interval"]).to_numpy()
        accurate_rows = curve[np.logical_and.accumulate(agrees[::-1])[::-1]]
        if len(accurate_rows):
            best = accurate_rows.loc[accurate_rows["seconds"].idxmin()]
            rows.append((method, best["setting"], best["error"], best["interval"], best["seconds"]))
    return pd.DataFrame(rows, columns=["method", "setting", "error", "interval", "seconds"])


def seconds_at(table: pd.DataFrame, problem: str, method: str, error: float) -> float:
    """Interpolate the time of a method at an error between its settings, in logarithms.

    Parameters
    ----------
    table : DataFrame
        Table of `work_precision`.
    problem : str
        Name of the problem.
    method : str
        Name of the method.
    error : float
        Error, relative.

    Returns
    -------
    float
        Time, s; NaN beyond the settings.
    """
    rows = table[(table["problem"] == problem) & (table["method"] == method)].dropna(subset="error")
    best = rows.sort_values("error")
    accurate_rows = best[best["error"] <= error]
    if accurate_rows.empty:
        return float("nan")
    cheapest = accurate_rows.loc[accurate_rows["seconds"].idxmin()]
    worse = best[(best["error"] > error) & (best["seconds"] < cheapest["seconds"])]
    if worse.empty:
        return float(cheapest["seconds"])
    near = worse.loc[worse["error"].idxmin()]
    weight = np.log(error / cheapest["error"]) / np.log(near["error"] / cheapest["error"])
    return float(cheapest["seconds"] * (near["seconds"] / cheapest["seconds"]) ** weight)


def gain(table: pd.DataFrame, problem: Problem, methods: Sequence[Method]) -> str:
    """Say how much longer than ours the next best method takes, single runs and runs side by side, in words.

    Parameters
    ----------
    table : DataFrame
        Table of `work_precision`.
    problem : Problem
        The problem.
    methods : Sequence[Method]
        Methods, ours first.

    Returns
    -------
    str
        The text.
    """
    alone = [method.name for method in methods if method.together == 1]
    beside = [method.name for method in methods if method.together > 1]
    if problem.compared_result is ComparedResult.RMS:
        enough = cheapest_within_chance(table, problem.name).set_index("method")["seconds"]
        ratio = enough.reindex(alone[1:]).min() / enough[alone[0]]
        return f"{problem.name}: {ratio:.1f} times the next best where only chance is left of the error"
    ratios = [_over_ours(table, problem.name, *names) for names in (alone, beside) if names]
    return f"{problem.name}: {', side by side '.join(ratios)}"


def _over_ours(table: pd.DataFrame, problem: str, our_method: str, *rest: str) -> str:
    seconds = pd.Series({name: seconds_at(table, problem, name, 1e-6) for name in rest}, dtype=float)
    if seconds.isna().all():
        return "no other method"
    ratio = seconds.min() / seconds_at(table, problem, our_method, 1e-6)
    return f"{ratio:.1f} times the next best at 1e-6 ({seconds.idxmin()})"
