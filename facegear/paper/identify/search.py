"""Global search over the undisclosed inputs, one branch at a time."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import scipy.optimize
import scipy.stats
from numpy.typing import NDArray

from facegear.dynamics.motion import Settings
from facegear.paper.identify.budget import Budget
from facegear.paper.identify.inputs import (
    Branch,
    Inputs,
    Meaning,
    Space,
    StiffnessAt,
    StiffnessLoad,
    Waveform,
    machine_with,
    stiffness_torque,
)
from facegear.paper.identify.objective import Misfit, misfit
from facegear.paper.identify.targets import Targets
from facegear.progress import Progress
from facegear.transmission.machine import Machine
from facegear.transmission.phases import PhaseConvention

NUMBERS = 3
QUICK = Settings(tolerance=1e-3, refine=False, settle=128, dwell=64, window=64, samples=64)
QUICK_SWEEP = Settings(tolerance=1e-3, refine=False, settle=64, dwell=48, window=16, samples=32)


@dataclass(frozen=True, eq=False)
class Problem:
    """All but the inputs: base machine, size of e(t) in m, stiffness by load, targets, ranges.

    `load_for_mean` is the torque on a mesh (N m) at which contact analysis gives the paper's mean stiffness.
    """

    base: Machine
    error_size: float
    stiffness: StiffnessAt
    load_for_mean: float
    targets: Targets
    space: Space

    def machine(self, inputs: Inputs) -> Machine:
        """The machine with a set of inputs."""
        return machine_with(self.base, inputs, self.error_size, self.stiffness, self.load_for_mean)


def search_branch(problem: Problem, branch: Branch, budget: Budget) -> pd.DataFrame:
    """Scan a branch with a Sobol sequence, then refine its best points by differential evolution.

    Every evaluation is a row, so that the landscape and separate optima can be read from the result.
    """
    rows: list[dict[str, object]] = []
    progress = Progress(f"identify {branch.name}", budget.scan + budget.population * (budget.generations + 1))

    def evaluate(unit: NDArray[np.float64]) -> float:
        inputs = problem.space.inputs(branch, unit)
        found = misfit_of(problem, inputs)
        torque = stiffness_torque(problem.base, inputs, problem.load_for_mean)
        row = {**inputs_row(inputs), "stiffness_torque_n_m": torque, **misfit_row(found)}
        rows.append({**row, "evaluation": len(rows)})
        progress.step()
        return found.total

    sobol = scipy.stats.qmc.Sobol(NUMBERS, seed=budget.seed)
    units = sobol.random(budget.scan)
    values = np.array([evaluate(unit) for unit in units])
    if budget.generations > 0:
        best = units[np.argsort(values, kind="stable")[: budget.population]]
        scipy.optimize.differential_evolution(
            evaluate,
            [(0.0, 1.0)] * NUMBERS,
            init=best,
            maxiter=budget.generations,
            mutation=(0.4, 0.9),
            polish=False,
            tol=0.0,
            seed=budget.seed,
        )
    return pd.DataFrame(rows)


def misfit_of(problem: Problem, inputs: Inputs) -> Misfit:
    """Misfit of one set of inputs."""
    return misfit(problem.machine(inputs), problem.targets, QUICK, QUICK_SWEEP)


def inputs_of(row: Mapping[str, Any]) -> Inputs:
    """The set of inputs that a row of a table holds."""
    branch = Branch(
        Meaning(row["meaning"]),
        row["phasing"] == "in_step",
        PhaseConvention(row["phase_convention"]),
        Waveform(row["waveform"]),
        StiffnessLoad(row["stiffness_load"]),
    )
    return Inputs(
        branch, float(row["per_input_n_m"]), float(row["tail_share"]), float(row["error_phase_deg"]) / 360.0
    )


def inputs_row(inputs: Inputs) -> dict[str, object]:
    """A set of inputs as the cells of a table."""
    branch = inputs.branch
    return {
        "branch": branch.name,
        "meaning": branch.meaning.value,
        "phasing": "in_step" if branch.in_step else "mesh",
        "phase_convention": branch.convention.value,
        "waveform": branch.waveform.value,
        "stiffness_load": branch.load.value,
        "per_input_n_m": inputs.torque,
        "tail_share": inputs.tail_share,
        "error_phase_deg": 360.0 * inputs.error_phase,
    }


def misfit_row(found: Misfit) -> dict[str, object]:
    """A misfit as the cells of a table."""
    return {
        "misfit": found.total,
        "sharing_misfit": found.sharing,
        "worst_mean": found.worst_mean,
        **{f"jump_{i + 1}_off": value for i, value in enumerate(found.jumps)},
    }
