"""Sliding, loss, heat, film and scuffing of the pair under load."""

from math import pi

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lubrication import LubricationSection, limits_of, lubrication_request, map_speeds
from facegear.config.tooth_pair import ToothPair, pair
from facegear.contact.hertz import contact_modulus
from facegear.errors import ConfigError
from facegear.lubrication.assessment import (
    by_torque_table,
    limit_table,
    local_arrays,
    map_table,
    position_table,
)
from facegear.lubrication.columns import LEFT_OUT
from facegear.lubrication.excitation import excitation_table
from facegear.lubrication.loss import hat_slip
from facegear.lubrication.machine_loss import LoadedPair
from facegear.lubrication.places import loaded_contacts, places, stored_lines
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
    told = (
        f"mesh efficiency {last['efficiency']:.4f} at {last['torque_n_m']:g} N m and {speed_rpm:g} rpm, "
        f"contact up to {last['contact_temperature_c']:.0f} C ({last['friction_model']} friction); {LEFT_OUT}"
    )
    return Outcome(content, told)


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
    teeth = pair(tooth_pair)
    modulus = contact_modulus(teeth.materials)
    known = lubrication_request(section, modulus, teeth.design.pinion_pitch_radius)
    unloaded = dict(zip(ltca["position"], 1e-6 * ltca["unloaded_ste_um"], strict=True))
    lines = stored_lines(teeth.design, pressure, unloaded)
    where = places(teeth.design, pressure, lines, modulus)
    return LoadedPair(loaded_contacts(where, hat_slip(teeth.design, pressure)), known)
