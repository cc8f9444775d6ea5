"""Pareto fronts by evolution (NSGA-II of pymoo, Deb et al. 2002).

Every design is written down, so that a kill costs none.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Mask
from facegear.errors import FacegearError
from facegear.io import journal

Evaluate = Callable[[tuple[float, ...]], Mapping[str, float]]
"""What is wanted of a design, by name, given the values of its variables. Raises FacegearError if none."""
GENERATION, ERROR = "generation", "error"


@dataclass(frozen=True)
class Variable:
    """A number of a design between `low` and `high`, on `steps` evenly spaced values where they are given."""

    name: str
    low: float
    high: float
    steps: int | None = None
    logarithmic: bool = False

    def snapped(self, part: Array) -> Array:
        """Parts 0 to 1 of the range (same shape), moved to the nearest that is allowed."""
        return part if self.steps is None else np.round(part * (self.steps - 1)) / (self.steps - 1)

    def value(self, part: float) -> float:
        """The number at a part of the range."""
        if self.logarithmic:
            return float(self.low * (self.high / self.low) ** part)
        return float(self.low + (self.high - self.low) * part)


@dataclass(frozen=True)
class Task:
    """Variables, names of the objectives, limits of what has one, and which of them all are to be `large`.

    The others are to be small. A limit is the least for what is to be large, else the most.
    """

    variables: tuple[Variable, ...]
    objectives: tuple[str, ...]
    limits: tuple[tuple[str, float], ...] = ()
    large: frozenset[str] = frozenset()

    @property
    def goals(self) -> tuple[str, ...]:
        """All that is asked of a design."""
        return (*self.objectives, *(name for name, _ in self.limits))

    def sign(self, name: str) -> float:
        """Takes a goal's value to something that is to be small."""
        return -1.0 if name in self.large else 1.0

    def costs(self, designs: pd.DataFrame) -> Array:
        """(designs, objectives): objectives of designs, all to be small."""
        signs = [self.sign(name) for name in self.objectives]
        return designs[list(self.objectives)].to_numpy(float) * signs


@dataclass(frozen=True)
class Effort:
    """Designs of a generation, generations, and the seed of all that is random."""

    population: int
    generations: int
    seed: int


def evolve(
    task: Task,
    evaluate: Evaluate,
    effort: Effort,
    partial: str | Path,
    identity: str,
    on_progress: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Every design tried, in order. Columns: generation, the variables, the goals, error.

    `partial` keeps every design as soon as it is known; under the same `identity` a killed evolution is
    replayed from it and goes on. A design without results is a row with its error and breaks all limits. It
    ends before its last generation where it finds no design that is new.
    """
    known = {tuple(row["design"]): row for row in journal.read(partial, identity)}
    rows: list[tuple[Any, ...]] = []
    algorithm = _algorithm(task, effort)
    with journal.appending(partial, identity) as append:
        while algorithm.has_next():
            asked = algorithm.ask()
            if asked is None:
                break  # of designs on few steps, no new one is left
            evaluated = []
            for parts in asked.get("X"):
                design = tuple(
                    variable.value(part) for variable, part in zip(task.variables, parts, strict=True)
                )
                if design not in known:
                    known[design] = _row(evaluate, design, task.goals)
                    append(known[design])
                on_progress()
                evaluated.append(known[design])
                values = evaluated[-1]["values"] or [np.nan] * len(task.goals)
                rows.append((algorithm.n_gen, *design, *values, evaluated[-1][ERROR]))
            _tell(algorithm, asked, evaluated, task)
    names = [variable.name for variable in task.variables]
    return pd.DataFrame(rows, columns=[GENERATION, *names, *task.goals, ERROR])


def feasible(designs: pd.DataFrame, task: Task) -> Mask:
    """Which designs have results and hold every limit."""
    held = np.array(designs[ERROR] == "")
    for name, limit in task.limits:
        held &= task.sign(name) * (designs[name].to_numpy() - limit) <= 0.0
    return held


def front(designs: pd.DataFrame, task: Task) -> pd.DataFrame:
    """The feasible designs that no other beats in every objective, each once, by the first objective."""
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting  # of the extra `search`

    names = [variable.name for variable in task.variables]
    held = designs[feasible(designs, task)].drop_duplicates(names)
    if held.empty:
        return held
    best = NonDominatedSorting().do(task.costs(held), only_non_dominated_front=True)
    return held.iloc[np.sort(best)].sort_values(list(task.objectives), kind="stable").reset_index(drop=True)


def hypervolumes(islands: Mapping[int, pd.DataFrame], task: Task) -> pd.DataFrame:
    """Share of the box between the best and the worst of all islands' front that each island has covered.

    Of all its designs up to each generation; a tenth is added to the box, so that its corners count.
    Columns: seed, generation, hypervolume. Empty where no design is feasible.
    """
    from pymoo.indicators.hv import HV  # a library of the extra `search`

    whole = front(pd.concat(islands.values(), ignore_index=True), task)
    rows = []
    size, costs = len(task.objectives), task.costs(whole)
    ideal, worst = (costs.min(axis=0), costs.max(axis=0)) if len(whole) else (0, 1)
    span = np.where(worst > ideal, np.subtract(worst, ideal), 1.0)
    box = HV(ref_point=np.full(size, 1.1))
    for seed, designs in islands.items() if len(whole) else ():
        for generation in sorted(designs[GENERATION].unique()):
            held = front(designs[designs[GENERATION] <= generation], task)
            parts = (task.costs(held) - ideal) / span
            rows.append((seed, generation, float(box(parts)) / 1.1**size if len(held) else 0.0))
    return pd.DataFrame(rows, columns=["seed", GENERATION, "hypervolume"])


def _row(evaluate: Evaluate, design: tuple[float, ...], goals: Sequence[str]) -> dict[str, Any]:
    try:
        values = evaluate(design)
        objectives = [float(values[name]) for name in goals]
    except FacegearError as error:
        return {"design": design, "values": None, ERROR: str(error).splitlines()[0]}
    if not np.isfinite(objectives).all():
        missing = next(name for name, value in zip(goals, objectives, strict=True) if not np.isfinite(value))
        return {"design": design, "values": None, ERROR: f"{missing} is not defined for every sample"}
    return {"design": design, "values": objectives, ERROR: ""}


def _algorithm(task: Task, effort: Effort) -> Any:
    from pymoo.algorithms.moo.nsga2 import NSGA2  # a library of the extra `search`
    from pymoo.core import problem as problems
    from pymoo.core import repair

    class Snap(repair.Repair):
        def _do(self, problem: Any, X: Array, **_: Any) -> Array:
            return np.column_stack([variable.snapped(X[:, i]) for i, variable in enumerate(task.variables)])

    count = len(task.variables)
    problem = problems.Problem(
        n_var=count, n_obj=len(task.objectives), n_ieq_constr=len(task.limits) + 1, xl=0.0, xu=1.0
    )
    algorithm = NSGA2(pop_size=effort.population, repair=Snap())
    algorithm.setup(problem, termination=("n_gen", effort.generations), seed=effort.seed, verbose=False)
    return algorithm


def _tell(algorithm: Any, asked: Any, rows: list[dict[str, Any]], task: Task) -> None:
    """Give the algorithm the objectives and by how much limits are broken, 1e9 for what has no results."""
    from pymoo.core.evaluator import Evaluator  # as above
    from pymoo.problems.static import StaticProblem

    size = len(task.objectives)
    signs = np.array([task.sign(name) for name in task.goals])
    limits = np.array([limit for _, limit in task.limits])
    nothing = ([1e9] * size, [1e9] * (len(limits) + 1))
    objectives = [
        (
            signs[:size] * row["values"][:size],
            np.append(signs[size:] * (np.array(row["values"][size:]) - limits), 0.0),
        )
        if row["values"]
        else nothing
        for row in rows
    ]
    static = StaticProblem(
        algorithm.problem,
        F=np.array([row[0] for row in objectives]),
        G=np.array([row[1] for row in objectives]),
    )
    Evaluator().eval(static, asked)
    algorithm.tell(infills=asked)
