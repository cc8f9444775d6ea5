"""The groups of meshes that share a load, from plain config values."""

from collections.abc import Mapping
from typing import Any

from facegear.config.machine_layout import wired_layout
from facegear.load_sharing.groups import load_groups, split_groups


def split_kinds(values: Mapping[str, Any]) -> list[str]:
    """Return the kinds of the groups that split a load: inputs and idlers for the paper's machine.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    list[str]
        The kinds, each once.
    """
    groups = split_groups(wired_layout(values["transmission"], values["tooth_pair"]))
    return list(dict.fromkeys(group.kind.value for group in groups))


def has_groups(values: Mapping[str, Any]) -> bool:
    """Whether several pinions do the same, whether or not they split a load.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    bool
        True if there is such a group.
    """
    return bool(load_groups(wired_layout(values["transmission"], values["tooth_pair"])))
