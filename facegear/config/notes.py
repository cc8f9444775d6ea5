"""What a user is told once when a run starts."""

from collections.abc import Mapping
from typing import Any

PRINTED = (
    "transmission.mesh_kinematics = printed: equation (13) of the source paper to the letter, to compare "
    "with it; lever arms, signs of the lower meshes and back flanks are not a gearbox's (docs/theory.md)"
)


def notes(values: Mapping[str, Any]) -> list[str]:
    """Lines for a config that reproduces no publication and yet takes the publication's way of counting."""
    transmission = values["transmission"]
    own = values["reproduction"] is None and transmission is not None
    return [PRINTED] if own and transmission["mesh_kinematics"] == "printed" else []
