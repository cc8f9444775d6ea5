"""Flank compliance of one body."""

from collections.abc import Mapping
from typing import Any

from facegear.config.contact_setup import contact_setup
from facegear.contact.gear_flank import GearFlank
from facegear.contact.pair import gear_flank


def compliance(
    body: str, tooth_pair: Mapping[str, Any], mesh: Mapping[str, Any], contact: Mapping[str, Any]
) -> GearFlank:
    """Contact surface and compliance of `body`, pinion or face_gear, whatever loads it.

    Raises ConfigError for a sector with more teeth than the gear and a mesh turned inside out.
    """
    setup = contact_setup(tooth_pair, mesh, contact)
    return gear_flank(setup.pair.design, body, setup.sizes, setup.pair.material(body), setup.plan)
