"""The machine of a case from its plain config values."""

from collections.abc import Mapping
from typing import Any

from facegear.config.base import parse
from facegear.config.transmission import ToothNumbers, Transmission, layout, machine, tooth_numbers
from facegear.harmonics.series import Harmonics
from facegear.load_sharing.groups import load_groups
from facegear.transmission.machine import Machine

TEETH = ("pinion_teeth", "face_gear_teeth", "module_mm", "pressure_angle_deg")


def case_machine(values: Mapping[str, Any], stiffness: Harmonics) -> Machine:
    """The lumped machine of a whole config, with the mesh stiffness from its own stage."""
    return machine(parse(Transmission, values["transmission"]), _teeth(values), stiffness)


def group_kinds(values: Mapping[str, Any]) -> list[str]:
    """Kinds of groups of meshes that share a load: inputs and idlers for the paper's machine."""
    groups = load_groups(layout(parse(Transmission, values["transmission"]), _teeth(values)))
    return list(dict.fromkeys(group.kind.value for group in groups))


def _teeth(values: Mapping[str, Any]) -> ToothNumbers:
    return tooth_numbers(**{name: values["tooth_pair"][name] for name in TEETH})
