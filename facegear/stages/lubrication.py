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
    """Compute sliding, loss, heat, film and scuffing from stored contact.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    lubrication : LubricationSection or None
        Section `lubrication` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `by_torque`, `positions`, `limits`, `map` and `excitation`, arrays `local`.

    Raises
    ------
    ConfigError
        Without section lubrication.
    TooHot
        Where a body passes the oil's flash point.
    NotConverged
        Where bulk temperatures do not settle.
    """
    section = lubrication_section(lubrication)
    pair_under_load = loaded_pair(ltca, pressure, section, tooth_pair)
    limits, speed = limits_of(section), speed_rpm * pi / 30
    states = pair_under_load.states(speed)
    table = by_torque_table(pair_under_load, states, speed, limits)
    content = {
        "by_torque": table,
        "positions": position_table(pair_under_load, states),
        "limits": limit_table(pair_under_load, states),
        "map": map_table(pair_under_load, map_speeds(section, speed_rpm)),
        "local": local_arrays(pair_under_load, states, speed),
        "excitation": excitation_table(pair_under_load, states, pair(tooth_pair).design),
    }
    last = table.iloc[-1]
    summary = (
        f"mesh efficiency {last['efficiency']:.4f} at {last['torque_n_m']:g} N m and {speed_rpm:g} rpm, "
        f"contact up to {last['contact_temperature_c']:.0f} C ({last['friction_model']} friction)"
    )
    return Outcome(content, summary)


def lubrication_section(section: LubricationSection | None) -> LubricationSection:
    """Return section `lubrication`, or refuse a config without it.

    Parameters
    ----------
    section : LubricationSection or None
        The section, None if the config has none.

    Returns
    -------
    LubricationSection
        The section.

    Raises
    ------
    ConfigError
        Without section lubrication.
    """
    if section is None:
        raise ConfigError("lubrication", None, "given, for friction and heat")
    return section


def loaded_pair(
    ltca: pd.DataFrame,
    pressure: Arrays,
    section: LubricationSection,
    tooth_pair: ToothPair,
) -> LoadedPair:
    """Return the stored contact of the pair with its sliding, by torque.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    section : LubricationSection
        Section `lubrication` of the config.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    LoadedPair
        The loaded and lubricated pair.
    """
    return LoadedPair(contacts_of(ltca, pressure, tooth_pair), lubrication_of(section, tooth_pair))
