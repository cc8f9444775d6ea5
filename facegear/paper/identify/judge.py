"""How well an optimum is known: many starts at full accuracy, and sensitivity to each number."""

import string
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.averages import mean_interval
from facegear.dynamics.steady_state.simulate import build_model, static_start
from facegear.load_sharing.run import disturb
from facegear.paper.identify.inputs import Inputs
from facegear.paper.identify.objective import coefficients
from facegear.paper.identify.search import Problem, inputs_of, misfit_of
from facegear.progress import Progress
from facegear.transmission.machine import Machine

SPREAD = 20e-6
CONFIRMED = 0.05
MEANS_WITHIN = 0.15
LOOKED_AT = 150
CONFIDENCE = 0.95
STEPS = {"torque": 0.02, "tail_share": 0.01, "error_phase": 5.0 / 360.0}
"""Changes by which sensitivity is measured: relative for the torque, absolute for the others."""
NAMES = ("inputs_mean", "idlers_mean", "idlers_minimum")


@dataclass(frozen=True, eq=False)
class Judged:
    """Tables over all sets: the sets themselves, their coefficients at each backlash, their sensitivity."""

    sets: pd.DataFrame
    coefficients: pd.DataFrame
    sensitivity: pd.DataFrame


def confirmed(problem: Problem, evaluations: pd.DataFrame, settings: Settings, slack: float) -> pd.DataFrame:
    """The search's best points that full accuracy confirms, best first.

    The search is quick; where several motions exist side by side full accuracy may reach another one. A point
    is kept if its largest deviation of a mean stays within CONFIRMED of the quick one; `judged_worst_mean` is
    the accurate one. Points up to `slack` times the best misfit are looked at, at most LOOKED_AT.
    """
    ranked = evaluations.sort_values("misfit", kind="stable")
    ranked = ranked[ranked["misfit"] <= slack * ranked["misfit"].iloc[0]].head(LOOKED_AT)
    progress = Progress("confirming at full accuracy", len(ranked))
    kept = []
    for row in ranked.to_dict("records"):
        worst = _worst_mean(problem, inputs_of(row), settings)
        if abs(worst - float(row["worst_mean"])) <= CONFIRMED:
            kept.append({**row, "judged_worst_mean": worst})
        progress.step()
    return pd.DataFrame(kept, columns=[*ranked.columns, "judged_worst_mean"])


def judge_sets(problem: Problem, optima: pd.DataFrame, settings: Settings, starts: int, seed: int) -> Judged:
    """Judge confirmed rows of a search at full accuracy; sets are named a, b, c ... in their order.

    The first set whose means all lie within MEANS_WITHIN of the paper's, or else the first, is `recommended`.
    Raises NotConverged.
    """
    sets, coefficients, sensitivity = [], [], []
    good = optima["judged_worst_mean"] <= MEANS_WITHIN
    chosen = int(good.to_numpy().argmax())
    progress = Progress("judging sets", len(optima))
    for number, row in enumerate(optima.to_dict("records")):
        name = string.ascii_lowercase[number % 26] + (str(number // 26) if number >= 26 else "")
        inputs = inputs_of(row)
        sets.append({"set": name, "recommended": number == chosen, **row})
        found = coefficients_table(problem, inputs, settings, starts, seed)
        coefficients.append(found.assign(set=name))
        sensitivity.append(sensitivity_table(problem, inputs).assign(set=name))
        progress.step()
    return Judged(pd.DataFrame(sets), pd.concat(coefficients), pd.concat(sensitivity))


def _worst_mean(problem: Problem, inputs: Inputs, settings: Settings) -> float:
    """Largest deviation of a fitted mean from the paper's, each backlash from its own static equilibrium."""
    machine = problem.machine(inputs)
    worst = 0.0
    for target in problem.targets.backlash:
        model = build_model(replace(machine, half_backlash=0.5 * target.backlash))
        start = static_start(model)
        inputs_mean, idlers_mean, _ = coefficients(model, problem.targets.speed, settings, start)
        worst = max(worst, abs(inputs_mean - target.inputs), abs(idlers_mean - target.idlers))
    return worst


def coefficients_table(
    problem: Problem, inputs: Inputs, settings: Settings, starts: int, seed: int
) -> pd.DataFrame:
    """Fitted coefficients from static equilibrium and over disturbed starts, one row each."""
    machine = problem.machine(inputs)
    rows = []
    for target in problem.targets.backlash:
        one = replace(machine, half_backlash=0.5 * target.backlash)
        values = _from_starts(one, problem.targets.speed, settings, starts, seed)
        wanted = (target.inputs, target.idlers, target.idlers_minimum)
        for column, name in enumerate(NAMES):
            rows.append(
                {
                    "backlash_um": 1e6 * target.backlash,
                    "quantity": name,
                    "paper": wanted[column],
                    "from_equilibrium": values[0, column],
                    "starts_mean": float(np.nanmean(values[:, column])),
                    "starts_half_width": _half_width(values[:, column]),
                    "starts_low": float(np.nanmin(values[:, column])),
                    "starts_high": float(np.nanmax(values[:, column])),
                }
            )
    return pd.DataFrame(rows)


def _from_starts(machine: Machine, speed: float, settings: Settings, starts: int, seed: int) -> np.ndarray:
    """Coefficients (starts, 3)."""
    model = build_model(machine)
    first = static_start(model)
    random = np.random.default_rng(seed)
    states = [first, *(disturb(model, first, SPREAD, random) for _ in range(starts - 1))]
    return np.array([coefficients(model, speed, settings, state) for state in states])


def _half_width(values: np.ndarray) -> float:
    """Half-width of the confidence interval of the mean over starts; 0 for a single start."""
    values = values[np.isfinite(values)]
    if values.size < 2:
        return 0.0
    return float(mean_interval(values, CONFIDENCE))


def sensitivity_table(problem: Problem, inputs: Inputs) -> pd.DataFrame:
    """Misfit a step below and above each number."""
    rows = []
    middle = misfit_of(problem, inputs).total
    for name, step in STEPS.items():
        value = getattr(inputs, name)
        size = step * value if name == "torque" else step
        ends: list[dict[str, Any]] = [
            {name: _allowed(problem, name, value + change)} for change in (-size, size)
        ]
        below, above = (misfit_of(problem, replace(inputs, **end)) for end in ends)
        rows.append(
            {
                "number": name,
                "step": size,
                "misfit_below": below.total,
                "misfit": middle,
                "misfit_above": above.total,
            }
        )
    return pd.DataFrame(rows)


def _allowed(problem: Problem, name: str, value: float) -> float:
    """The value brought into the range searched; the phase wraps."""
    if name == "error_phase":
        return value % 1.0
    low, high = getattr(problem.space, name)
    return min(max(value, low), high)
