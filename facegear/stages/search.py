"""The front of all islands of a search, how far it may be trusted, and its winners at full accuracy."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from facegear.config.changes import movable, nominal
from facegear.number_format import count_noun
from facegear.scenarios.evolution import Task, front, hypervolumes
from facegear.stages.outcome import Outcome
from facegear.variants.designs import SearchedMachine, assessor, task
from facegear.variants.machines import WHOLE


def search(islands: Sequence[pd.DataFrame], **given: Any) -> Outcome:
    """`designs`, `front`, `hypervolume`, `winners` (tables) from the designs of each island.

    `islands`: in the order of the config's seeds; `given`: fields of SearchedMachine.
    """
    machine = SearchedMachine.of_stage(**given)
    asked, by_seed = task(machine.section), dict(zip(machine.section.seeds, islands, strict=True))
    every = pd.concat([rows.assign(seed=seed) for seed, rows in by_seed.items()], ignore_index=True)
    best = front(every, asked)
    covered = hypervolumes(by_seed, asked)
    return Outcome(
        {
            "designs": every,
            "front": best,
            "hypervolume": covered,
            "winners": _winners(best, asked, machine),
        },
        f"front of {count_noun(len(best), 'design')} out of {len(every)}; {_spread(covered)}",
    )


def _spread(covered: pd.DataFrame) -> str:
    if covered.empty:
        return "none of them holds every limit"
    last = covered.groupby("seed")["hypervolume"].last()
    percent = 100.0 * (last.max() - last.min()) / last.mean()
    return f"hypervolume of {count_noun(len(last), 'seed')} within {percent:.2g} %"


def _winners(best: pd.DataFrame, asked: Task, given: SearchedMachine) -> pd.DataFrame:
    """The nominal design and those of the front that win: goals as searched, and all at full accuracy."""
    coarse = assessor(given, given.section.hunting_cycles, given.section.samples)
    full = assessor(given, WHOLE, given.section.winner_samples)
    names = [variable.name for variable in asked.variables]
    rows = []
    for label, design in {"nominal": None, **chosen(best, asked)}.items():
        searched, (goals, quantities) = coarse(design)[0], full(design)
        values = dict(zip(names, design if design is not None else _nominal(given), strict=True))
        compared = {f"{goal}_searched": searched[goal] for goal in asked.goals}
        others = {name: value for name, value in quantities.items() if name not in goals}
        rows.append({"design": label, **values, **goals, **compared, **others})
    columns = ["design", *names, *(key for key in rows[0] if key not in ("design", *names))]
    return pd.DataFrame(rows, columns=columns)


def _nominal(given: SearchedMachine) -> list[float]:
    """Values of the variables in the config; nan where the keys of one differ."""
    free = [variable.sets for variable in given.section.variables]
    start = movable(given.values, [key for keys in free for key in keys])
    return [nominal(start, keys) for keys in free]


def chosen(best: pd.DataFrame, asked: Task) -> dict[str, tuple[float, ...]]:
    """Designs of a front: the best in each objective, and of several objectives the nearest to all bests."""
    if best.empty:
        return {}
    goals = asked.costs(best)
    extreme = {name: "most" if name in asked.large else "least" for name in asked.objectives}
    places = {f"{extreme[name]} {name}": int(goals[:, i].argmin()) for i, name in enumerate(asked.objectives)}
    span = np.ptp(goals, axis=0)
    if len(asked.objectives) > 1:
        parts = (goals - goals.min(axis=0)) / np.where(span > 0.0, span, 1.0)
        places["compromise"] = int(np.linalg.norm(parts, axis=1).argmin())
    names = [variable.name for variable in asked.variables]
    return {label: tuple(map(float, best.loc[row, names])) for label, row in places.items()}
