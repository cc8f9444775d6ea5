"""What a user is told once when a run starts."""

from collections.abc import Mapping
from typing import Any

PRINTED = (
    "transmission.mesh_kinematics = printed: equation (13) of the source paper to the letter, to compare "
    "with it; lever arms, signs of the lower meshes and back flanks are not a gearbox's (docs/theory.md)"
)
SLOW = (
    "transmission: runouts and cumulative pitch deviations enter the quasi-static hunting cycle only; "
    "responses and sweeps leave them out (docs/theory.md)"
)


def notes(values: Mapping[str, Any]) -> list[str]:
    """Lines for a config of one's own that counts as the publication does, and for errors that turn."""
    transmission = values["transmission"]
    if transmission is None:
        return []
    own = values["reproduction"] is None and transmission["mesh_kinematics"] == "printed"
    return [PRINTED] * own + [SLOW] * _turns(transmission)


def _turns(transmission: Mapping[str, Any]) -> bool:
    """Whether a body has a runout or a curve of cumulative pitch deviations."""
    singles = (*transmission["single_pinions"].values(), *transmission["single_gears"].values())
    bodies = (transmission["pinion"], transmission["face_gear"], *singles)
    return any(body.get("runout") or body.get("cumulative_pitch_um") for body in bodies)
