"""Safety and life of the tooth pair under its duty cycle."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from numpy.typing import NDArray

from facegear.config.base import parse
from facegear.config.strength import Strength, duty_bins, rating_request
from facegear.config.tooth_pair import pair
from facegear.errors import ConfigError
from facegear.geometry.analysis import section_contact_ratio
from facegear.stages.outcome import Outcome
from facegear.strength.contact_pressure import contact_pressure
from facegear.strength.rating import rate
from facegear.strength.rating_tables import curve_table, damage_table, rating_table, safety_table
from facegear.strength.root_tables import root_from_arrays


def rating(
    stress: Mapping[str, NDArray],
    by_torque: pd.DataFrame,
    duty_spectrum: pd.DataFrame | None = None,
    *,
    tooth_pair: Mapping[str, Any],
    strength: Mapping[str, Any] | None,
) -> Outcome:
    """`safety`, `rating`, `damage` and `curves` (tables) from the root stress of stage root_stress.

    `by_torque`: table of stage contact. `duty_spectrum`: table of stage duty_loads, where the loads are the
    machine's. Raises ConfigError without section strength.
    """
    if strength is None:
        raise ConfigError("strength", None, "given for safety and life")
    section, design = parse(Strength, strength), pair(tooth_pair).design
    request = rating_request(section, design, duty_spectrum)
    roots = {body: root_from_arrays(stress, body) for body in request.bodies}
    pressure = contact_pressure(by_torque)
    found = rate(design, section_contact_ratio(design), roots, pressure, request)
    worst = min(found, key=lambda one: one.safety / one.required)
    where = f"{worst.duty.body.replace('_', ' ')}, {worst.duty.flank}"
    told = f"{where}, {worst.failure} ({worst.method})"
    return Outcome(
        {
            "safety": safety_table(found, pressure),
            "rating": rating_table(found, pressure, roots),
            "damage": damage_table(found, duty_bins(section), pressure),
            "curves": curve_table(found),
        },
        f"nearest to its limit: {told}, safety {worst.safety:.2f} where {worst.required:g} is required",
    )
