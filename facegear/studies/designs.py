"""Goals of a search for a design, as designed or with its tolerances."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from facegear.build.checks import check_positions
from facegear.build.lower_gear import check_lower_gear
from facegear.build.machine_layout import wired_layout
from facegear.build.plans import jump_range
from facegear.build.tooth_pair import ToothPair
from facegear.motion.plan import JumpRange
from facegear.quantities import is_jump_quantity, matching_names
from facegear.schema.base import parse
from facegear.schema.changes import add_changes, movable, set_numbers, variable_part
from facegear.schema.studies import ObjectiveSection, Search
from facegear.schema.tolerances import Tolerances
from facegear.schema.transmission import Transmission
from facegear.studies.evolution import Task, Variable
from facegear.studies.machines import Question, VariedMachine
from facegear.studies.sampling import changes, population, samples
from facegear.studies.tooth_contact import Values

Quantities = dict[str, float]


@dataclass(frozen=True, eq=False, kw_only=True)
class SearchedMachine(VariedMachine):
    """The machine whose numbers are free, as plain config values: what the stages of the search are given."""

    tooth_pair: Values
    search: Values

    @cached_property
    def section(self) -> Search:
        """Section `search` of the config."""
        return Search.of_config(self.search)

    @property
    def values(self) -> dict[str, Any]:
        """Plain values of `variable_part` that variables may change: transmission, tooth pair and speed."""
        return variable_part(self.transmission, self.tooth_pair, self.speed_rpm)


def task(section: Search) -> Task:
    """Return variables, objectives and limits of section `search`, as `evolution.evolve` takes them.

    Parameters
    ----------
    section : Search
        Section `search` of the config.

    Returns
    -------
    Task
        Variables with their ranges, names of the goals, limits, and which goals are better large.
    """
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
    machine: SearchedMachine, cycles: int, count: int
) -> Callable[[Sequence[float] | None], tuple[Quantities, Quantities]]:
    """Return a function that evaluates a design: all goals of a search, nominal or as percentiles over
    samples.

    It raises FacegearError for a design that cannot be built, or of which a sample cannot.

    Parameters
    ----------
    machine : SearchedMachine
        The machine whose numbers are free.
    cycles : int
        Number of mesh cycles of the hunting cycle, or of the motion, over which loads are taken.
    count : int
        Number of samples of each design where percentiles are asked for; all designs have the same ones.

    Returns
    -------
    Callable[[Sequence[float] | None], tuple[Quantities, Quantities]]
        Function from the values of the search's variables (None: the config's own) to the goals by name,
        and all quantities of the machine without deviations by column, in the units of their columns.
    """
    section = machine.section
    tolerances = Tolerances.of_config(machine.tolerances) if section.robust and machine.tolerances else None
    causes = population(tolerances) if tolerances else None
    keys = [key for variable in section.variables for key in variable.sets]
    moves = [key for cause in causes.causes for key, _ in cause.gains] if causes else []
    start = movable(machine.values, [*keys, *moves])
    question = Question(section.model, cycles, machine.accuracy, machine.options)
    ask, ask_varied = (
        machine.judge_of(replace(question, jumps=within), "this design") for within in _jumps(section)
    )
    names = machine.columns(wired_layout(start["transmission"], machine.tooth_pair), question, jumps=True)
    sample_changes = [changes(causes, row) for row in samples(causes, 0, count)] if causes else []

    def assess(design: Sequence[float] | None) -> tuple[Quantities, Quantities]:
        """Return the goals of a design by name, and all quantities of its nominal machine by column."""
        numbers = zip(section.variables, design, strict=True) if design is not None else ()
        design_values = set_numbers(
            start, {key: float(number) for variable, number in numbers for key in variable.sets}
        )
        pair = parse(ToothPair, design_values["tooth_pair"], "this design")
        check_lower_gear(pair, design_values["transmission"]["face_gears"])
        check_positions(pair, parse(Transmission, design_values["transmission"], "this design"))
        nominal = ask(design_values)
        sample_quantities = [
            ask_varied(add_changes(design_values, increments)) for increments in sample_changes
        ]
        goals = {}
        for goal in (*section.objectives, *section.constraints):
            goals[goal.name] = _goal(goal, names, nominal, sample_quantities)
        return goals, nominal

    return assess


def _goal(
    goal: ObjectiveSection, names: Sequence[str], nominal: Quantities, sample_quantities: Sequence[Quantities]
) -> float:
    """Return the value of an objective or constraint of one design.

    It is the worst of all quantities whose names begin as the goal says: the smallest where large is
    good, else the largest. Without a percentile it is that of the nominal machine, else the percentile (0
    to 100) over samples.
    """
    columns = [name for start in goal.quantities for name in matching_names(start, names)]
    worst = min if goal.large else max
    if goal.percentile is None:
        return worst(nominal[name] for name in columns)
    return float(
        np.percentile(
            [worst(values[name] for name in columns) for values in sample_quantities], goal.percentile
        )
    )


def _jumps(section: Search) -> tuple[JumpRange | None, JumpRange | None]:
    """Return the ranges in which jumps are looked for, of the nominal machine and of its samples.

    A range is None where no goal without, or with, a percentile asks for the margin to a jump.
    """
    goals = (*section.objectives, *section.constraints)
    percentile_goals = {
        goal.percentile is not None for goal in goals if any(map(is_jump_quantity, goal.quantities))
    }
    within = jump_range(section.jumps)
    return (within if False in percentile_goals else None, within if True in percentile_goals else None)
