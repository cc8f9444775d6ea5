"""The groups of meshes that share a load, from plain config values."""

from collections.abc import Mapping
from typing import Any

from facegear.config.machine_layout import wired_layout
from facegear.load_sharing.groups import load_groups, split_groups


def split_kinds(values: Mapping[str, Any]) -> list[str]:
    """Kinds of the groups that split a load, of a whole config: inputs and idlers for the paper's machine."""
    groups = split_groups(wired_layout(values["transmission"], values["tooth_pair"]))
    return list(dict.fromkeys(group.kind.value for group in groups))


def has_groups(values: Mapping[str, Any]) -> bool:
    """Whether several pinions of a whole config do the same, whether or not they split a load."""
    return bool(load_groups(wired_layout(values["transmission"], values["tooth_pair"])))
