"""What a search asks of a design, as designed or with its tolerances."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from facegear.config.base import parse
from facegear.config.changes import movable, moved, placed, variable_part
from facegear.config.checks import check_positions
from facegear.config.machine_layout import wired_layout
from facegear.config.search import ObjectiveSection, Search, jump_range
from facegear.config.tolerances import Tolerances, population
from facegear.config.tooth_pair import ToothPair
from facegear.config.transmission import Transmission
from facegear.dynamics.sweeps.plan import JumpRange
from facegear.load_sharing.quantity_names import is_jump_quantity, matching_names
from facegear.scenarios.evolution import Task, Variable
from facegear.scenarios.sampling import changes, samples
from facegear.variants.machines import Question, VariedMachine
from facegear.variants.teeth import Values

Quantities = dict[str, float]


@dataclass(frozen=True, eq=False, kw_only=True)
class SearchedMachine(VariedMachine):
    """The machine whose numbers are free, as plain config values: what the stages of the search are given."""

    tooth_pair: Values
    search: Values

    @cached_property
    def section(self) -> Search:
        """What is searched."""
        return Search.of_config(self.search)

    @property
    def values(self) -> dict[str, Any]:
        """What may be free."""
        return variable_part(self.transmission, self.tooth_pair, self.speed_rpm)


def task(section: Search) -> Task:
    """What is free, what is to be small or large and what is to hold."""
    return Task(
        variables=tuple(
            Variable(entry.name, *entry.limits, entry.steps, entry.scale == "log")
            for entry in section.variables
        ),
        objectives=tuple(entry.name for entry in section.objectives),
        limits=tuple((entry.name, entry.limit) for entry in section.constraints),
        large=frozenset(entry.name for entry in (*section.objectives, *section.constraints) if entry.large),
    )


def assessor(
    given: SearchedMachine, cycles: int, count: int
) -> Callable[[Sequence[float] | None], tuple[Quantities, Quantities]]:
    """Function of a design's values, None for the nominal ones: its goals, and all quantities as designed.

    Over `cycles` mesh cycles and, where percentiles are asked for, `count` samples. The function raises
    FacegearError for a design that cannot be built, or of which a sample cannot.
    """
    section = given.section
    tolerances = Tolerances.of_config(given.tolerances) if section.robust and given.tolerances else None
    causes = population(tolerances) if tolerances else None
    keys = [key for variable in section.variables for key in variable.sets]
    moves = [key for cause in causes.causes for key, _ in cause.gains] if causes else []
    start = movable(given.values, [*keys, *moves])
    question = Question(section.model, cycles, given.accuracy, given.options)
    ask, ask_varied = (
        given.judge_of(replace(question, jumps=within), "this design") for within in _jumps(section)
    )
    names = given.columns(wired_layout(start["transmission"], given.tooth_pair), question, jumps=True)
    drawn = [changes(causes, row) for row in samples(causes, 0, count)] if causes else []

    def assess(design: Sequence[float] | None) -> tuple[Quantities, Quantities]:
        numbers = zip(section.variables, design, strict=True) if design is not None else ()
        chosen = placed(start, {key: float(number) for variable, number in numbers for key in variable.sets})
        pair = parse(ToothPair, chosen["tooth_pair"], "this design")
        check_positions(pair, parse(Transmission, chosen["transmission"], "this design"))
        nominal = ask(chosen)
        varied = [ask_varied(moved(chosen, added)) for added in drawn]
        goals = {}
        for goal in (*section.objectives, *section.constraints):
            goals[goal.name] = _goal(goal, names, nominal, varied)
        return goals, nominal

    return assess


def _goal(
    goal: ObjectiveSection, names: Sequence[str], nominal: Quantities, varied: Sequence[Quantities]
) -> float:
    columns = [name for start in goal.quantities for name in matching_names(start, names)]
    worst = min if goal.large else max
    if goal.percentile is None:
        return worst(nominal[name] for name in columns)
    return float(
        np.percentile([worst(values[name] for name in columns) for values in varied], goal.percentile)
    )


def _jumps(section: Search) -> tuple[JumpRange | None, JumpRange | None]:
    """Where jumps are looked for as designed, and in the samples; None where no goal asks."""
    goals = (*section.objectives, *section.constraints)
    asking = {goal.percentile is not None for goal in goals if any(map(is_jump_quantity, goal.quantities))}
    within = jump_range(section.jumps)
    return (within if False in asking else None, within if True in asking else None)
