"""Safety and life of the tooth pair under its duty cycle."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from numpy.typing import NDArray

from facegear.config.base import parse
from facegear.config.strength import Strength, rating_request
from facegear.config.tooth_pair import pair
from facegear.errors import ConfigError
from facegear.geometry.analysis import section_contact_ratio
from facegear.stages.outcome import Outcome
from facegear.strength.rating import rate
from facegear.strength.rating_tables import curve_table, damage_table, rating_table
from facegear.strength.root_tables import root_from_arrays


def rating(
    stress: Mapping[str, NDArray],
    duty_loads: pd.DataFrame | None = None,
    *,
    tooth_pair: Mapping[str, Any],
    strength: Mapping[str, Any] | None,
) -> Outcome:
    """`rating`, `damage` and `curves` (tables) from the root stress of stage root_stress.

    `duty_loads`: table of that stage, where K_v and K_gamma are the machine's. Raises ConfigError without
    section strength.
    """
    if strength is None:
        raise ConfigError("strength", None, "required for safety and life")
    loads = None
    if duty_loads is not None:
        loads = (duty_loads["mesh_load_factor"] * duty_loads["dynamic_factor"]).tolist()
    design, request = pair(tooth_pair).design, rating_request(parse(Strength, strength), loads)
    roots = {body: root_from_arrays(stress, body) for body in request.bodies}
    found = rate(design, section_contact_ratio(design), roots, request)
    worst = min(found, key=lambda one: one.safety / one.required)
    told = f"{worst.body.replace('_', ' ')}, {worst.failure} ({worst.method})"
    return Outcome(
        {
            "rating": rating_table(found),
            "damage": damage_table(found, request.duty),
            "curves": curve_table(found),
        },
        f"nearest to its limit: {told}, safety {worst.safety:.2f} where {worst.required:g} is required",
    )
