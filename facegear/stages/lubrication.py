"""Sliding, loss, heat, film and scuffing of the pair under load."""

from math import pi

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.loaded_teeth import contacts_of, lubrication_of
from facegear.config.lubrication import LubricationSection, limits_of, map_speeds
from facegear.config.tooth_pair import ToothPair, pair
from facegear.errors import ConfigError
from facegear.lubrication.assessment import (
    by_torque_table,
    limit_table,
    local_arrays,
    map_table,
    position_table,
)
from facegear.lubrication.excitation import excitation_table
from facegear.lubrication.machine_loss import LoadedPair
from facegear.stages.outcome import Outcome


def lubrication(
    ltca: pd.DataFrame,
    pressure: Arrays,
    tooth_pair: ToothPair,
    lubrication: LubricationSection | None,
    speed_rpm: float,
) -> Outcome:
    """`by_torque`, `positions`, `limits`, `map`, `excitation` (tables) and `local` (arrays) from stored
    contact.

    ltca, pressure: of stage contact. Raises ConfigError without section lubrication, TooHot where a body
    passes the oil's flash point, NotConverged where bulk temperatures do not settle.
    """
    section = lubrication_section(lubrication)
    loaded = loaded_pair(ltca, pressure, section, tooth_pair)
    limits, speed = limits_of(section), speed_rpm * pi / 30
    states = loaded.states(speed)
    table = by_torque_table(loaded, states, speed, limits)
    content = {
        "by_torque": table,
        "positions": position_table(loaded, states),
        "limits": limit_table(loaded, states),
        "map": map_table(loaded, map_speeds(section, speed_rpm)),
        "local": local_arrays(loaded, states, speed),
        "excitation": excitation_table(loaded, states, pair(tooth_pair).design),
    }
    last = table.iloc[-1]
    summary = (
        f"mesh efficiency {last['efficiency']:.4f} at {last['torque_n_m']:g} N m and {speed_rpm:g} rpm, "
        f"contact up to {last['contact_temperature_c']:.0f} C ({last['friction_model']} friction)"
    )
    return Outcome(content, summary)


def lubrication_section(section: LubricationSection | None) -> LubricationSection:
    """Section lubrication. Raises ConfigError without it."""
    if section is None:
        raise ConfigError("lubrication", None, "given, for friction and heat")
    return section


def loaded_pair(
    ltca: pd.DataFrame,
    pressure: Arrays,
    section: LubricationSection,
    tooth_pair: ToothPair,
) -> LoadedPair:
    """The stored contact of the pair with its sliding, by torque."""
    return LoadedPair(contacts_of(ltca, pressure, tooth_pair), lubrication_of(section, tooth_pair))
