"""What a search asks of a design, as designed or with its tolerances."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from facegear.config.base import parse
from facegear.config.checks import check_places
from facegear.config.lumped_model import TEETH, layout, tooth_numbers
from facegear.config.search import ObjectiveSection, Search
from facegear.config.tolerances import Tolerances, population
from facegear.config.tooth_pair import ToothPair
from facegear.config.transmission import Transmission
from facegear.config.variants import movable, moved, placed
from facegear.load_sharing.quantity_names import columns_of, quantity_names
from facegear.scenarios.evolution import Task, Variable
from facegear.scenarios.sampling import changes, samples
from facegear.stages.many_machines import builder, judge

Found = dict[str, float]


@dataclass(frozen=True, eq=False)
class SearchedMachine:
    """The machine whose numbers are free, as plain config values: the arguments of a stage of the search."""

    harmonics: pd.DataFrame
    tooth_pair: Mapping[str, Any]
    transmission: Mapping[str, Any]
    accuracy: Mapping[str, Any]
    speed_rpm: float
    options: Mapping[str, Any]
    tolerances: Mapping[str, Any] | None


def task(section: Search) -> Task:
    """What is free, what is to be small and what is to hold."""
    return Task(
        variables=tuple(
            Variable(one.name, *one.limits, one.steps, one.scale == "log") for one in section.variables
        ),
        objectives=tuple(one.name for one in section.objectives),
        limits=tuple((one.name, one.at_most) for one in section.constraints),
    )


def assessor(
    given: SearchedMachine, section: Search, cycles: int, count: int
) -> Callable[[Sequence[float] | None], tuple[Found, Found]]:
    """Function of a design's values, None for the nominal ones: its goals, and all quantities as designed.

    Over `cycles` mesh cycles and, where percentiles are asked for, `count` samples. The function raises
    FacegearError for a design that cannot be built, or of which a sample cannot.
    """
    tolerances = parse(Tolerances, given.tolerances) if section.robust and given.tolerances else None
    causes = population(tolerances) if tolerances else None
    keys = [key for variable in section.variables for key in variable.sets]
    moves = [key for cause in causes.causes for key, _ in cause.gains] if causes else []
    start = movable(given.transmission, [*keys, *moves])
    pair = parse(ToothPair, given.tooth_pair)
    numbers = tooth_numbers(**{key: given.tooth_pair[key] for key in TEETH})
    build = builder(given.harmonics, given.tooth_pair, "this design")
    ask = judge(section.model, cycles, given.accuracy, given.options)
    names = quantity_names(layout(parse(Transmission, start), numbers), section.model == "dynamic")
    drawn = [changes(causes, row) for row in samples(causes, 0, count)] if causes else []

    def assess(design: Sequence[float] | None) -> tuple[Found, Found]:
        values = zip(section.variables, design, strict=True) if design is not None else ()
        chosen = placed(start, {key: float(value) for variable, value in values for key in variable.sets})
        check_places(pair, parse(Transmission, chosen, "this design"))
        nominal = ask(build(chosen), given.speed_rpm)
        varied = []
        for added in drawn:
            changed, speed = moved(chosen, given.speed_rpm, added)
            varied.append(ask(build(changed), speed))
        goals = {}
        for goal in (*section.objectives, *section.constraints):
            goals[goal.name] = _goal(goal, names, nominal, varied)
        return goals, nominal

    return assess


def _goal(goal: ObjectiveSection, names: Sequence[str], nominal: Found, varied: Sequence[Found]) -> float:
    columns = [name for start in goal.largest_of for name in columns_of(start, names)]
    if goal.percentile is None:
        return max(nominal[name] for name in columns)
    return float(np.percentile([max(found[name] for name in columns) for found in varied], goal.percentile))
