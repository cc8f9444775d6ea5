"""The groups of meshes that share a load, from plain config values."""

from collections.abc import Mapping
from typing import Any

from facegear.config.machine_layout import wired_layout
from facegear.load_sharing.groups import load_groups


def group_kinds(values: Mapping[str, Any]) -> list[str]:
    """Kinds of groups of a whole config: inputs and idlers for the paper's machine."""
    groups = load_groups(wired_layout(values["transmission"], values["tooth_pair"]))
    return list(dict.fromkeys(group.kind.value for group in groups))
