"""What the friction chain takes of a config's pair: its stored contact with sliding, and its lubrication."""

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lubrication import LubricationSection, lubrication_request
from facegear.config.tooth_pair import ToothPair, materials, pair_design
from facegear.contact.hertz import contact_modulus
from facegear.lubrication.loss import hat_slip
from facegear.lubrication.places import LoadedContact, loaded_contacts, places, stored_lines
from facegear.lubrication.request import Lubrication


def contacts_of(ltca: pd.DataFrame, pressure: Arrays, section: ToothPair) -> tuple[LoadedContact, ...]:
    """The contact at rising torques; ltca, pressure: of stage contact.

    Raises ConfigError for a section without bodies.
    """
    design = pair_design(section)
    unloaded = dict(zip(ltca["position"], 1e-6 * ltca["unloaded_ste_um"], strict=True))
    lines = stored_lines(design, pressure, unloaded)
    where = places(design, pressure, lines, contact_modulus(materials(section)))
    return loaded_contacts(where, hat_slip(design, pressure))


def lubrication_of(section: LubricationSection, teeth: ToothPair) -> Lubrication:
    """How the flanks of the pair are lubricated."""
    return lubrication_request(
        section, contact_modulus(materials(teeth)), pair_design(teeth).pinion_pitch_radius
    )
