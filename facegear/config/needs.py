"""What each stage needs of a config: the exact slices that its results depend on.

The names are those of the rules (and `machine`, for those that measure it); the keys of a slice are the
arguments of the stage's function in `facegear.stages`.
"""

from collections.abc import Mapping
from typing import Any

from facegear.config.lumped_model import TEETH
from facegear.errors import ConfigError

Slice = dict[str, str | tuple[str, ...]]

_PAIR: Slice = {"tooth_pair": "tooth_pair"}
_MESH: Slice = {**_PAIR, "mesh": "mesh"}
_COMPLIANCE: Slice = {**_MESH, "contact": "contact"}
_MACHINE: Slice = {"transmission": "transmission", "teeth": tuple(f"tooth_pair.{key}" for key in TEETH)}
_BRANCHES: Slice = {**_MACHINE, "branches": "branches", "speed_rpm": "dynamics.speed_rpm"}
_ACCURACY: Slice = {"accuracy": "dynamics.accuracy"}
_SEARCH: Slice = {
    **_PAIR,
    **_ACCURACY,
    "transmission": "transmission",
    "speed_rpm": "dynamics.speed_rpm",
    "options": "load_sharing",
    "search": "search",
    "tolerances": "tolerances",
}

NEEDS: dict[str, Slice] = {
    "geometry": _PAIR,
    "mesh": _MESH,
    "cad": _MESH,
    "compliance": _COMPLIANCE,
    "contact": {**_PAIR, "contact": "contact"},
    "root_stress": {},
    "duty_loads": {**_MACHINE, **_ACCURACY, "strength": "strength"},
    "rating": {**_PAIR, "strength": "strength"},
    "dynamic_root_stress": {**_PAIR, "transmission": "transmission"},
    "stress_over_speed": {**_MACHINE, **_PAIR},
    "stiffness": {"mesh_stiffness": "mesh_stiffness"},
    "modal": {**_MACHINE, "mean_stiffness": "mesh_stiffness.mean_n_per_m"},
    "dynamics_response": {**_MACHINE, **_ACCURACY, "speed_rpm": "dynamics.speed_rpm"},
    "dynamics_sweep_chunk": {**_MACHINE, "sweep": "dynamics.sweep"},
    "dynamics_sweep": {**_MACHINE, "sweep": "dynamics.sweep"},
    "branches_starts": _BRANCHES,
    "branches": {**_BRANCHES, "sweep": "dynamics.sweep"},
    "branches_loci": _BRANCHES,
    "load_sharing": {
        **_MACHINE,
        **_ACCURACY,
        "speed_rpm": "dynamics.speed_rpm",
        "options": "load_sharing",
    },
    "following": {
        **_MACHINE,
        **_ACCURACY,
        "speed_rpm": "dynamics.speed_rpm",
        "positions": "load_sharing.hunting_positions",
        "cycles": "load_sharing.followed_cycles",
    },
    "tolerances_chunk": {
        **_MACHINE,
        **_ACCURACY,
        "speed_rpm": "dynamics.speed_rpm",
        "options": "load_sharing",
        "tolerances": tuple(
            f"tolerances.{key}" for key in ("causes", "correlations", "model", "seed", "hunting_cycles")
        ),
    },
    "tolerances": {"tolerances": "tolerances"},
    "search_island": _SEARCH,
    "search": _SEARCH,
    "ratings": {**_MACHINE, "speed_rpm": "dynamics.speed_rpm"},
    "machine": _MACHINE,
    "hunting": {**_MACHINE, "positions": "load_sharing.hunting_positions"},
    "load_sharing_reference": {
        **_MACHINE,
        **_ACCURACY,
        "range_accuracy": "dynamics.sweep.accuracy",
        "options": "load_sharing",
    },
}

GAPS_ONLY = {
    "compliance": {
        "tooth_pair": ("assembly", "pinion.tip_relief", "pinion.root_relief", "pinion.lead_crowning")
    }
}
"""Keys inside an argument that a stage does without: they move unloaded flanks, and no node of the bodies."""

UPSTREAM = {
    "contact": ("compliance",),
    "root_stress": ("contact",),
    "rating": ("root_stress",),
    "duty_loads": ("stiffness",),
    "dynamic_root_stress": ("root_stress", "dynamics_response"),
    "stress_over_speed": ("root_stress", "dynamics_sweep"),
    "stiffness": ("contact",),
    "dynamics_response": ("stiffness",),
    "dynamics_sweep": ("stiffness",),
    "branches_starts": ("stiffness",),
    "branches": ("branches_starts", "dynamics_sweep"),
    "branches_loci": ("branches",),
    "load_sharing": ("stiffness",),
    "hunting": ("stiffness",),
    "tolerances_chunk": ("stiffness",),
    "tolerances": ("tolerances_chunk",),
    "search_island": ("stiffness",),
    "search": ("search_island",),
}
"""Stages whose results a stage uses."""


def stage_needs(rule: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a stage from the plain values of a whole config.

    Raises ConfigError for modes, dynamics and load sharing of a config of tooth contact alone.
    """
    if "transmission" in NEEDS[rule] and values["transmission"] is None:
        raise ConfigError("transmission", None, "required for modes, dynamics and load sharing")
    found = {
        name: _value(values, keys)
        if isinstance(keys, str)
        else {key.rsplit(".", 1)[-1]: _value(values, key) for key in keys}
        for name, keys in NEEDS[rule].items()
    }
    for name, keys in GAPS_ONLY.get(rule, {}).items():
        for key in keys:
            found[name] = _without(found[name], key.split("."))
    return found


def stages_before(rule: str, values: Mapping[str, Any]) -> list[str]:
    """A rule and all whose results it uses, with the plain values of a whole config."""
    stiffness = values["mesh_stiffness"]
    if rule == "stiffness" and stiffness["source"] == "harmonics":
        return [rule]
    if rule == "modal" and stiffness["mean_n_per_m"] is None:
        return [rule, *stages_before("stiffness", values)]
    before = UPSTREAM.get(rule, ())
    if rule == "rating" and loads_from_machine(values):
        before = (*before, "duty_loads")
    if rule == "stress_over_speed" and values["branches"] is not None:
        before = (*before, "branches")
    return [rule, *(other for near in before for other in stages_before(near, values))]


def loads_from_machine(values: Mapping[str, Any]) -> bool:
    """Whether the rating takes K_v and K_gamma from the machine's motion, by the plain values of a config."""
    return values["strength"] is not None and values["strength"]["load_factors"] == "machine"


def _value(values: Any, key: str) -> Any:
    for part in key.split("."):
        values = values[part] if values is not None else None
    return values


def _without(values: Any, parts: list[str]) -> Any:
    """A copy of nested mappings without one key, given by its parts."""
    if not isinstance(values, Mapping) or parts[0] not in values:
        return values
    rest = {key: value for key, value in values.items() if key != parts[0]}
    return {**rest, parts[0]: _without(values[parts[0]], parts[1:])} if parts[1:] else rest
