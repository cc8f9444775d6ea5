"""The machine of a case from its plain config values."""

from collections.abc import Mapping
from typing import Any

from facegear.config.base import parse
from facegear.config.transmission import Transmission, machine, tooth_numbers
from facegear.harmonics.series import Harmonics
from facegear.transmission.machine import Machine

TEETH = ("pinion_teeth", "face_gear_teeth", "module_mm", "pressure_angle_deg")


def case_machine(values: Mapping[str, Any], stiffness: Harmonics) -> Machine:
    """The lumped machine of a whole config, with the mesh stiffness from its own stage."""
    teeth = tooth_numbers(**{name: values["tooth_pair"][name] for name in TEETH})
    return machine(parse(Transmission, values["transmission"]), teeth, stiffness)
