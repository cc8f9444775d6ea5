"""The search problem of a config, with the contact table that its stiffness comes from."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.machines import case_machine
from facegear.config.stiffness import MeshStiffness
from facegear.errors import ConfigError
from facegear.paper.config.sections import Design, Identify, RandomInputs, fit_targets, search_space
from facegear.paper.identify.patterns import READINGS, half_turn_patterns
from facegear.paper.identify.random_inputs import Plausible
from facegear.paper.identify.search import Problem
from facegear.paper.identify.stiffness import load_for_mean, scaled_stiffness
from facegear.stiffness.curve import load_table


def search_problem(values: Mapping[str, Any], section: Identify, ltca: pd.DataFrame) -> Problem:
    """The problem from the plain values of a whole config and the search asked for.

    Raises ConfigError if no load that was solved gives the wanted mean stiffness.
    """
    stiffness = parse(MeshStiffness, values["mesh_stiffness"])
    if stiffness.mean_n_per_m is None:
        raise ConfigError("mesh_stiffness.mean_n_per_m", None, "a number: the search scales the curve to it")
    table = load_table(ltca)
    load = load_for_mean(table, stiffness.mean_n_per_m, stiffness.definition)
    if load is None:
        allowed = "a range of loads whose mean stiffness reaches mesh_stiffness.mean_n_per_m"
        raise ConfigError("contact.torques_n_m", list(table.torques), allowed)
    shape = scaled_stiffness(table, stiffness.mean_n_per_m, stiffness.harmonics_kept, stiffness.definition)
    return Problem(
        base=case_machine(values, shape(load)),
        error_size=1e-6 * values["transmission"]["transmission_error"]["amplitude_um"],
        stiffness=shape,
        load_for_mean=load,
        targets=fit_targets(section.targets, values["dynamics"]["speed_rpm"]),
        space=search_space(section.ranges),
    )


def plausible_inputs(
    section: RandomInputs, design: Design, loads: tuple[float, float], gears: int
) -> Plausible:
    """What the random inputs of a design are drawn from; loads in N m on the pinion of one mesh."""
    phasings = READINGS if design == "random" else half_turn_patterns()
    return Plausible(search_space(section.ranges), phasings, loads, gears, section.seed)
