"""The inputs that a config's search goes over."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from facegear.paper.config.sections import Design, Identify, Ranges, SearchBudget
from facegear.paper.identify.inputs import Space
from facegear.paper.identify.patterns import READINGS, half_turn_patterns
from facegear.paper.identify.random_inputs import Plausible
from facegear.paper.identify.search import Budget


def plausible_inputs(
    section: Identify, design: Design, values: Mapping[str, Any], ltca: pd.DataFrame
) -> Plausible:
    """What the random inputs of a design are drawn from; `values` are those of a whole config."""
    patterns = tuple(READINGS if design == "random" else half_turn_patterns())
    return Plausible(search_space(section.ranges, values, ltca), patterns, section.random.seed)


def search_space(section: Ranges, values: Mapping[str, Any], ltca: pd.DataFrame) -> Space:
    """Ranges of the inputs in SI; k(t) is known at the loads of the contact table."""
    return Space(
        torque=section.per_input_n_m,
        tail_share=section.tail_share,
        variation=section.stiffness_variation,
        bearings=section.stiffer_bearings_n_per_m,
        loads=(float(ltca["torque_n_m"].min()), float(ltca["torque_n_m"].max())),
        gears=len(values["transmission"]["face_gears"]),
    )


def search_budget(section: SearchBudget) -> Budget:
    """What a search may cost, and which patterns go on."""
    return Budget(
        population=section.population,
        generations=section.generations,
        seed=section.seed,
        starts=section.starts,
        by_mean=section.by_mean,
        by_upper=section.by_upper,
        places=section.places,
        again_within=section.again_within,
    )
