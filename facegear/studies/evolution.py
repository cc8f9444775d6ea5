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
from facegear.io import documents

Evaluate = Callable[[tuple[float, ...]], Mapping[str, float]]
"""Function that returns the goals of a design by name, given the values of its variables.

Raises FacegearError for a design without results.
"""
GENERATION, ERROR = "generation", "error"
"""Columns of the generation's number and of the text of a design's error."""


@dataclass(frozen=True)
class Variable:
    """A number of a design between `low` and `high`, on `steps` evenly spaced values where they are given."""

    name: str
    low: float
    high: float
    steps: int | None = None
    logarithmic: bool = False

    def snapped(self, part: Array) -> Array:
        """Round parts of the range to the nearest of `steps` evenly spaced parts; without steps all are
        allowed.

        Parameters
        ----------
        part : (...) array
            Parts of the range between `low` and `high`, fractions from 0 to 1.

        Returns
        -------
        (...) array
            Nearest allowed parts, fractions from 0 to 1.
        """
        return part if self.steps is None else np.round(part * (self.steps - 1)) / (self.steps - 1)

    def value(self, part: float) -> float:
        """Return the number at a part of the range: low + (high - low) part, or low (high / low)^part if
        logarithmic.

        Parameters
        ----------
        part : float
            Part of the range, a fraction from 0 to 1.

        Returns
        -------
        float
            The number, in the unit of the variable.
        """
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
        """Names of objectives and limited quantities."""
        return (*self.objectives, *(name for name, _ in self.limits))

    def sign(self, name: str) -> float:
        """Return the factor by which a goal is multiplied so that smaller is better.

        Parameters
        ----------
        name : str
            Name of an objective or limited quantity.

        Returns
        -------
        float
            Factor -1 for a goal that is to be large, else 1.
        """
        return -1.0 if name in self.large else 1.0

    def costs(self, designs: pd.DataFrame) -> Array:
        """Return the objectives of designs with signs by which smaller is better in each.

        Parameters
        ----------
        designs : pd.DataFrame
            Table with a row for each design and a column for each objective.

        Returns
        -------
        (designs, objectives) array
            Costs in the units of the objectives.
        """
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
    """Search for designs by NSGA-II (Deb et al. 2002), and keep every design as soon as its results are
    there.

    Under the same identity a killed evolution is replayed from the journal and goes on. A design without
    results is a row with its error and breaks all limits. The evolution ends before its last generation
    where it finds no design that is new.

    Parameters
    ----------
    task : Task
        Variables, objectives and limits.
    evaluate : Evaluate
        Function from a design's values, in the order of the variables, to its goals by name.
    effort : Effort
        Size of a generation, number of generations, and seed.
    partial : str or Path
        Journal file, to which each design is appended as soon as it is evaluated.
    identity : str
        Text that must equal that of the journal, or its designs are not reused.
    on_progress : Callable[[], None]
        Called after each design, those from the journal included.

    Returns
    -------
    pd.DataFrame
        Every design tried, in order; columns generation (from 1), the variables by name, the goals (NaN
        without results) and error (empty text without one).
    """
    results_by_design = {tuple(row["design"]): row for row in documents.read_journal(partial, identity)}
    rows: list[tuple[Any, ...]] = []
    algorithm = _algorithm(task, effort)
    with documents.appending(partial, identity) as append:
        while algorithm.has_next():
            offspring = algorithm.ask()
            if offspring is None:
                break  # of designs on few steps, no new one is left
            results = []
            for parts in offspring.get("X"):
                design = tuple(
                    variable.value(part) for variable, part in zip(task.variables, parts, strict=True)
                )
                if design not in results_by_design:
                    results_by_design[design] = _row(evaluate, design, task.goals)
                    append(results_by_design[design])
                on_progress()
                results.append(results_by_design[design])
                values = results[-1]["values"] or [np.nan] * len(task.goals)
                rows.append((algorithm.n_gen, *design, *values, results[-1][ERROR]))
            _tell(algorithm, offspring, results, task)
    names = [variable.name for variable in task.variables]
    return pd.DataFrame(rows, columns=[GENERATION, *names, *task.goals, ERROR])


def feasible(designs: pd.DataFrame, task: Task) -> Mask:
    """Find the designs that have results and keep every limit; a value on the limit keeps it.

    Parameters
    ----------
    designs : pd.DataFrame
        Table as `evolve` returns it.
    task : Task
        Variables, objectives and limits.

    Returns
    -------
    (designs,) array of bool
        True for a feasible design.
    """
    is_feasible = np.array(designs[ERROR] == "")
    for name, limit in task.limits:
        is_feasible &= task.sign(name) * (designs[name].to_numpy() - limit) <= 0.0
    return is_feasible


def front(designs: pd.DataFrame, task: Task) -> pd.DataFrame:
    """Find the Pareto front: the feasible designs that no other feasible one dominates.

    Parameters
    ----------
    designs : pd.DataFrame
        Table as `evolve` returns it.
    task : Task
        Variables, objectives and limits.

    Returns
    -------
    pd.DataFrame
        Rows of the table on the front, each design once, sorted by the objectives in turn; empty without
        a feasible design.
    """
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting  # of the extra `search`

    names = [variable.name for variable in task.variables]
    candidates = designs[feasible(designs, task)].drop_duplicates(names)
    if candidates.empty:
        return candidates
    best = NonDominatedSorting().do(task.costs(candidates), only_non_dominated_front=True)
    return (
        candidates.iloc[np.sort(best)]
        .sort_values(list(task.objectives), kind="stable")
        .reset_index(drop=True)
    )


def hypervolumes(islands: Mapping[int, pd.DataFrame], task: Task) -> pd.DataFrame:
    """Compute the share of the objectives' box that the front of each island covers, generation by
    generation.

    The box lies between the best and the worst values of the common front of all islands, each objective
    scaled to 0..1. Its worst corner is moved out to 1.1, so that the front's ends count. Each share takes
    all designs of an island up to the generation.

    Parameters
    ----------
    islands : Mapping[int, pd.DataFrame]
        Table of `evolve` by the seed of each independent evolution (island).
    task : Task
        Variables, objectives and limits.

    Returns
    -------
    pd.DataFrame
        Columns seed, generation and hypervolume (share of the box, 0 to 1); empty where no design is
        feasible.
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
            front_designs = front(designs[designs[GENERATION] <= generation], task)
            parts = (task.costs(front_designs) - ideal) / span
            rows.append((seed, generation, float(box(parts)) / 1.1**size if len(front_designs) else 0.0))
    return pd.DataFrame(rows, columns=["seed", GENERATION, "hypervolume"])


def _row(evaluate: Evaluate, design: tuple[float, ...], goals: Sequence[str]) -> dict[str, Any]:
    """Evaluate one design and return its journal entry: keys design, values (in the order of `goals`) and
    error.

    For an error, or a goal that is not finite, values is None and error a text; else error is empty.
    """
    try:
        values = evaluate(design)
        objectives = [float(values[name]) for name in goals]
    except FacegearError as error:
        return {"design": design, "values": None, ERROR: str(error).splitlines()[0]}
    if not np.isfinite(objectives).all():
        undefined_goal = next(
            name for name, value in zip(goals, objectives, strict=True) if not np.isfinite(value)
        )
        return {"design": design, "values": None, ERROR: f"{undefined_goal} is not defined for every sample"}
    return {"design": design, "values": objectives, ERROR: ""}


def _algorithm(task: Task, effort: Effort) -> Any:
    """Return pymoo's NSGA-II, set up for parts of the variables' ranges (0 to 1), rounded to their steps.

    Its constraints are the limits of the task and one more, by which designs without results are refused.
    """
    from pymoo.algorithms.moo.nsga2 import NSGA2  # a library of the extra `search`
    from pymoo.core import problem as problems  # as above
    from pymoo.core.repair import Repair  # as above

    class Snap(Repair):
        def _do(self, problem: Any, X: Array, **_: Any) -> Array:
            return np.column_stack([variable.snapped(X[:, i]) for i, variable in enumerate(task.variables)])

    count = len(task.variables)
    problem = problems.Problem(
        n_var=count, n_obj=len(task.objectives), n_ieq_constr=len(task.limits) + 1, xl=0.0, xu=1.0
    )
    algorithm = NSGA2(pop_size=effort.population, repair=Snap())
    algorithm.setup(problem, termination=("n_gen", effort.generations), seed=effort.seed, verbose=False)
    return algorithm


def _tell(algorithm: Any, offspring: Any, rows: list[dict[str, Any]], task: Task) -> None:
    """Give the algorithm the costs and constraint violations of the designs that it asked for.

    `offspring` is the algorithm's population, `rows` are the journal entries of its designs in the same
    order. Costs and limits have signs by which smaller is better, and a violation is positive. Designs
    without results get 1e9 for all of them.
    """
    from pymoo.core.evaluator import Evaluator  # as above
    from pymoo.problems.static import StaticProblem  # as above

    size = len(task.objectives)
    signs = np.array([task.sign(name) for name in task.goals])
    limits = np.array([limit for _, limit in task.limits])
    penalty = ([1e9] * size, [1e9] * (len(limits) + 1))
    objectives = [
        (
            signs[:size] * row["values"][:size],
            np.append(signs[size:] * (np.array(row["values"][size:]) - limits), 0.0),
        )
        if row["values"]
        else penalty
        for row in rows
    ]
    static = StaticProblem(
        algorithm.problem,
        F=np.array([row[0] for row in objectives]),
        G=np.array([row[1] for row in objectives]),
    )
    Evaluator().eval(static, offspring)
    algorithm.tell(infills=offspring)
