"""One evolution of designs, from one seed."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd

from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.progress import Progress
from facegear.schema.changes import movable, nominal
from facegear.studies.designs import SearchedMachine, assessor, task
from facegear.studies.evolution import Effort, Task, evolve, front, hypervolumes
from facegear.studies.machines import WHOLE


def search_island(
    seed: int, partial: str | Path | None = None, code: str = "", **machine_fields: Any
) -> Outcome:
    """Evolve designs from one seed by NSGA-II; several seeds give independent islands.

    Parameters
    ----------
    seed : int
        Seed of the random numbers.
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Fingerprint of the code; rows in `partial` count only for the same config and code.
    **machine_fields : Any
        Fields of SearchedMachine, as plain config values and arrays.

    Returns
    -------
    Outcome
        Table `designs`, a row for every design tried: values of the variables, generation, goals
        (objectives and limited quantities), error (empty if there is none).
    """
    machine = SearchedMachine.of_stage(**machine_fields)
    section = machine.section
    assess = assessor(machine, section.hunting_cycles, section.samples)
    effort = Effort(section.population, section.generations, seed)
    progress = Progress(f"search from seed {seed}", effort.population * effort.generations)
    identity = machine.identity(seed, code)
    with TemporaryDirectory() as folder:
        partial_file = Path(folder) / "partial" if partial is None else partial
        designs = evolve(
            task(section), lambda design: assess(design)[0], effort, partial_file, identity, progress.step
        )
    failure_count = int((designs["error"] != "").sum())
    return Outcome(
        {"designs": designs},
        f"{count_noun(len(designs), 'design')}, {failure_count} of them cannot be built or computed",
    )


def search(islands: Sequence[pd.DataFrame], **machine_fields: Any) -> Outcome:
    """Join the designs of all islands, find their Pareto front, and compute its winners at full
    accuracy.

    Parameters
    ----------
    islands : Sequence[pd.DataFrame]
        Table `designs` of each island, in the order of the config's seeds.
    **machine_fields : Any
        Fields of SearchedMachine, as plain config values and arrays.

    Returns
    -------
    Outcome
        Tables `designs` (all, with column seed), `front` (designs that hold every limit and that no
        other beats in all objectives), `hypervolume` (by seed and generation) and `winners` (see
        `_winners`).
    """
    machine = SearchedMachine.of_stage(**machine_fields)
    search_task, by_seed = task(machine.section), dict(zip(machine.section.seeds, islands, strict=True))
    every = pd.concat([rows.assign(seed=seed) for seed, rows in by_seed.items()], ignore_index=True)
    best = front(every, search_task)
    volumes = hypervolumes(by_seed, search_task)
    return Outcome(
        {
            "designs": every,
            "front": best,
            "hypervolume": volumes,
            "winners": _winners(best, search_task, machine),
        },
        f"front of {count_noun(len(best), 'design')} out of {len(every)}; {_spread(volumes)}",
    )


def _spread(volumes: pd.DataFrame) -> str:
    """Say by how many percent the hypervolumes of different seeds differ after their last generation."""
    if volumes.empty:
        return "none of them holds every limit"
    last = volumes.groupby("seed")["hypervolume"].last()
    percent = 100.0 * (last.max() - last.min()) / last.mean()
    return f"hypervolume of {count_noun(len(last), 'seed')} within {percent:.2g} %"


def _winners(best: pd.DataFrame, search_task: Task, machine: SearchedMachine) -> pd.DataFrame:
    """Tabulate the nominal design and the winners of the front.

    Columns: design (label), variables, goals at full accuracy, `<goal>_searched` as the search computed
    them with few samples and mesh cycles, then all other quantities at full accuracy.
    """
    coarse = assessor(machine, machine.section.hunting_cycles, machine.section.samples)
    full = assessor(machine, WHOLE, machine.section.winner_samples)
    names = [variable.name for variable in search_task.variables]
    rows = []
    for label, design in {"nominal": None, **choose_winners(best, search_task)}.items():
        coarse_goals, (goals, quantities) = coarse(design)[0], full(design)
        values = dict(zip(names, design if design is not None else _nominal(machine), strict=True))
        searched_goals = {f"{goal}_searched": coarse_goals[goal] for goal in search_task.goals}
        other_quantities = {name: value for name, value in quantities.items() if name not in goals}
        rows.append({"design": label, **values, **goals, **searched_goals, **other_quantities})
    columns = ["design", *names, *(key for key in rows[0] if key not in ("design", *names))]
    return pd.DataFrame(rows, columns=columns)


def _nominal(machine: SearchedMachine) -> list[float]:
    """Return the value of each variable in the config; nan where a variable sets several keys whose
    values differ.
    """
    free = [variable.sets for variable in machine.section.variables]
    start = movable(machine.values, [key for keys in free for key in keys])
    return [nominal(start, keys) for keys in free]


def choose_winners(best: pd.DataFrame, search_task: Task) -> dict[str, tuple[float, ...]]:
    """Choose designs of a front: the best in each objective, and a compromise if there are several
    objectives.

    The compromise is nearest to the point of all best values, each objective over its range on the
    front.

    Parameters
    ----------
    best : pd.DataFrame
        Designs of the front, a row each, with a column for each variable and objective.
    search_task : Task
        Variables and objectives of the search.

    Returns
    -------
    dict[str, tuple[float, ...]]
        Values of the variables of each design, in their own units, by label: `least <objective>`, `most
        <objective>` or `compromise`. Empty for an empty front.
    """
    if best.empty:
        return {}
    goals = search_task.costs(best)
    extreme = {name: "most" if name in search_task.large else "least" for name in search_task.objectives}
    row_by_label = {
        f"{extreme[name]} {name}": int(goals[:, i].argmin()) for i, name in enumerate(search_task.objectives)
    }
    span = np.ptp(goals, axis=0)
    if len(search_task.objectives) > 1:
        parts = (goals - goals.min(axis=0)) / np.where(span > 0.0, span, 1.0)
        row_by_label["compromise"] = int(np.linalg.norm(parts, axis=1).argmin())
    names = [variable.name for variable in search_task.variables]
    return {label: tuple(map(float, best.loc[row, names])) for label, row in row_by_label.items()}
