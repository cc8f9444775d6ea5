"""Inputs of the friction chain from a config's pair: its stored contact with sliding, and its lubrication."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lubrication import LubricationSection, lubrication_request
from facegear.config.tooth_pair import ToothPair, materials, pair_design
from facegear.contact.hertz import contact_modulus
from facegear.lubrication.contact_points import LoadedContact, contact_points, loaded_contacts, stored_lines
from facegear.lubrication.loss import hat_slip
from facegear.lubrication.request import Lubrication


def contacts_of(ltca: pd.DataFrame, pressure: Arrays, section: ToothPair) -> tuple[LoadedContact, ...]:
    """Return the loaded contact with its sliding at rising torques.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    tuple[LoadedContact, ...]
        One contact for each torque.

    Raises
    ------
    ConfigError
        For a section without bodies.
    """
    design = pair_design(section)
    unloaded_error = dict(zip(ltca["position"], 1e-6 * ltca["unloaded_ste_um"], strict=True))
    lines = stored_lines(design, pressure, unloaded_error)
    contact_places = contact_points(design, pressure, lines, contact_modulus(materials(section)))
    return loaded_contacts(contact_places, hat_slip(design, pressure))


def lubrication_of(section: LubricationSection, teeth: ToothPair) -> Lubrication:
    """Return how the flanks of the pair are lubricated.

    Parameters
    ----------
    section : LubricationSection
        Section `lubrication` of the config.
    teeth : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Lubrication
        Oil, roughness, friction and bulk temperature in SI units.
    """
    return lubrication_request(
        section, contact_modulus(materials(teeth)), pair_design(teeth).pinion_pitch_radius
    )
