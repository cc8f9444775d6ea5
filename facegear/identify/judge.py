"""How well an optimum is known: many starts at full accuracy, and sensitivity to each number."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import scipy.stats

from facegear.dynamics.motion import Settings
from facegear.dynamics.simulate import model, static_start
from facegear.identify.inputs import Inputs, machine_with
from facegear.identify.objective import coefficients
from facegear.identify.search import Problem, misfit_of
from facegear.load_sharing.run import disturb
from facegear.transmission.machine import Machine

SPREAD = 20e-6
CONFIDENCE = 0.95
STEPS = {"torque": 0.02, "tail_share": 0.01, "error_phase": 5.0 / 360.0}
"""Changes by which sensitivity is measured: relative for the torque, absolute for the others."""
NAMES = ("inputs_mean", "idlers_mean", "idlers_minimum")


@dataclass(frozen=True)
class Judgement:
    """Tables of one optimum: coefficients at each backlash, and change of the misfit with each number."""

    coefficients: pd.DataFrame
    sensitivity: pd.DataFrame


def judge(problem: Problem, inputs: Inputs, settings: Settings, starts: int, seed: int) -> Judgement:
    """Judge one set of inputs; the first start is static equilibrium. Raises NotConverged."""
    machine = machine_with(problem.base, inputs, problem.error_size, problem.stiffness)
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
    return Judgement(pd.DataFrame(rows), _sensitivity(problem, inputs))


def _from_starts(machine: Machine, speed: float, settings: Settings, starts: int, seed: int) -> np.ndarray:
    """Coefficients (starts, 3)."""
    ready = model(machine)
    first = static_start(ready)
    random = np.random.default_rng(seed)
    states = [first, *(disturb(ready, first, SPREAD, random) for _ in range(starts - 1))]
    return np.array([coefficients(ready, speed, settings, state) for state in states])


def _half_width(values: np.ndarray) -> float:
    """Half-width of the confidence interval of the mean over starts; 0 for a single start."""
    values = values[np.isfinite(values)]
    if values.size < 2:
        return 0.0
    quantile = scipy.stats.t.ppf(0.5 + 0.5 * CONFIDENCE, values.size - 1)
    return float(quantile * values.std(ddof=1) / np.sqrt(values.size))


def _sensitivity(problem: Problem, inputs: Inputs) -> pd.DataFrame:
    """Misfit a step below and above each number."""
    rows = []
    middle = misfit_of(problem, inputs).total
    for name, step in STEPS.items():
        value = getattr(inputs, name)
        size = step * value if name == "torque" else step
        below, above = (
            misfit_of(problem, replace(inputs, **{name: _allowed(problem, name, value + sign * size)}))
            for sign in (-1.0, 1.0)
        )
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
