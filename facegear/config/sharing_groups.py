"""The groups of meshes that share a load, from plain config values."""

from collections.abc import Mapping
from typing import Any

from facegear.config.base import parse
from facegear.config.transmission import TEETH, Transmission, layout, tooth_numbers
from facegear.load_sharing.groups import load_groups


def group_kinds(values: Mapping[str, Any]) -> list[str]:
    """Kinds of groups of a whole config: inputs and idlers for the paper's machine."""
    teeth = tooth_numbers(**{key: values["tooth_pair"][key] for key in TEETH})
    groups = load_groups(layout(parse(Transmission, values["transmission"]), teeth))
    return list(dict.fromkeys(group.kind.value for group in groups))
