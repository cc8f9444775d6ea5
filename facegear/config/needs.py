"""What each stage needs of a config: the exact slices that its results depend on.

The names are those of the rules (and `machine`, for those that measure it); the keys of a slice are the
arguments of the stage's function in `facegear.stages`, or the fields of the record of the machine that it
takes.
"""

from collections.abc import Mapping
from typing import Any

from facegear.config.lumped_model import TEETH
from facegear.config.modal import modes_need_contact
from facegear.config.variants import GAPS, moves_pair
from facegear.errors import ConfigError
from facegear.load_sharing.quantity_names import of_contact

Slice = dict[str, str | tuple[str, ...]]

_PAIR: Slice = {"tooth_pair": "tooth_pair"}
_MESH: Slice = {**_PAIR, "mesh": "mesh"}
_COMPLIANCE: Slice = {**_MESH, "contact": "contact"}
_MACHINE: Slice = {"transmission": "transmission", "teeth": tuple(f"tooth_pair.{key}" for key in TEETH)}
_BRANCHES: Slice = {**_MACHINE, "branches": "branches", "speed_rpm": "dynamics.speed_rpm"}
_ACCURACY: Slice = {"accuracy": "dynamics.accuracy"}
_SHARING: Slice = {
    **_MACHINE,
    **_ACCURACY,
    "speed_rpm": "dynamics.speed_rpm",
    "options": "load_sharing",
}
_CAUSES = tuple(f"tolerances.{key}" for key in ("causes", "correlations", "model", "seed", "hunting_cycles"))
_CONTACT: Slice = {"pair": ("tooth_pair", "mesh", "contact", "mesh_stiffness")}
_SEARCH: Slice = {
    **_PAIR,
    **_ACCURACY,
    "transmission": "transmission",
    "speed_rpm": "dynamics.speed_rpm",
    "options": "load_sharing",
    "search": "search",
    "tolerances": "tolerances",
    **_CONTACT,
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
    "modal": {
        **_MACHINE,
        "mean_stiffness": "mesh_stiffness.mean_n_per_m",
        "source": "mesh_stiffness.source",
        "definition": "modal.stiffness",
    },
    "dynamics_response": {**_MACHINE, **_ACCURACY, "speed_rpm": "dynamics.speed_rpm"},
    "dynamics_sweep_chunk": {**_MACHINE, "sweep": "dynamics.sweep"},
    "dynamics_sweep": {**_MACHINE, "sweep": "dynamics.sweep"},
    "branches_starts": _BRANCHES,
    "branches": {**_BRANCHES, "sweep": "dynamics.sweep"},
    "branches_loci": _BRANCHES,
    "load_sharing": _SHARING,
    "following": {
        **_MACHINE,
        **_ACCURACY,
        "speed_rpm": "dynamics.speed_rpm",
        "positions": "load_sharing.hunting_positions",
        "cycles": "load_sharing.followed_cycles",
    },
    "tolerances_chunk": {**_SHARING, "tolerances": _CAUSES, **_CONTACT},
    "tolerances_map": {
        **_SHARING,
        "tolerances": (*_CAUSES, "tolerances.confidence", "tolerances.load_map"),
        **_CONTACT,
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

LOADING = (
    "torques_n_m",
    "positions_per_pitch",
    "fillet_contact",
    "neighbour_coupling",
    "edge_contact",
)
"""Keys of section contact that say how the bodies are loaded, and nothing of how they give way."""
DONE_WITHOUT = {"compliance": {"tooth_pair": GAPS, "contact": LOADING}}
"""Keys inside an argument that a stage does without."""

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
    "tolerances_map": ("stiffness",),
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
        raise ConfigError("transmission", None, "given for modes, dynamics and load sharing")
    found = {
        name: _value(values, keys)
        if isinstance(keys, str)
        else {key.rsplit(".", 1)[-1]: _value(values, key) for key in keys}
        for name, keys in NEEDS[rule].items()
    }
    for name, keys in DONE_WITHOUT.get(rule, {}).items():
        for key in keys:
            found[name] = without(found[name], key)
    if "pair" in found and not many_contacts(rule, values):
        found["pair"] = None
    return found


OWN_SECTION = {
    **dict.fromkeys(("branches_starts", "branches", "branches_loci"), "branches"),
    **dict.fromkeys(("tolerances_chunk", "tolerances_map", "tolerances"), "tolerances"),
    **dict.fromkeys(("search_island", "search"), "search"),
    "rating": "strength",
    "duty_loads": "strength",
}
"""Optional section of the config without which there is nothing for a stage to do."""


def require_sections(rule: str, values: Mapping[str, Any]) -> None:
    """Raises ConfigError where a config lacks the section that a rule is about."""
    section = OWN_SECTION.get(rule)
    if section is not None and values[section] is None:
        raise ConfigError(section, None, f"given, as rule {rule} needs it")


def many_contacts(rule: str, values: Mapping[str, Any]) -> bool:
    """Whether the machines among many of a rule have a contact analysis of their own.

    `values`: plain ones of a whole config. Samples of tolerances have where a cause moves the tooth pair or
    `tooth_contact` is set; designs of a search where a variable, or a cause of a percentile, moves it, or an
    objective asks for what contact alone tells.
    """
    tolerances, search = values["tolerances"], values["search"]
    causes = [key for cause in (tolerances or {}).get("causes", ()) for key in cause["moves"]]
    if rule in ("tolerances_chunk", "tolerances_map"):
        return tolerances is not None and (tolerances["tooth_contact"] or moves_pair(causes))
    if search is None:
        return False
    goals = [*search["objectives"], *search["constraints"]]
    robust = any(goal["percentile"] is not None for goal in goals)
    keys = [key for variable in search["variables"] for key in variable["sets"]]
    asked = any(of_contact(text) for goal in goals for text in (*goal["largest_of"], *goal["smallest_of"]))
    return asked or moves_pair(keys) or (robust and moves_pair(causes))


def stages_before(rule: str, values: Mapping[str, Any]) -> list[str]:
    """A rule and all whose results it uses, with the plain values of a whole config."""
    stiffness = values["mesh_stiffness"]
    if rule == "stiffness" and stiffness["source"] == "harmonics":
        return [rule]
    if rule == "modal" and modes_need_contact(values):
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


def without(values: Any, key: str) -> Any:
    """A copy of nested mappings without one dotted key."""
    first, _, rest = key.partition(".")
    if not isinstance(values, Mapping) or first not in values:
        return values
    kept = {name: value for name, value in values.items() if name != first}
    return {**kept, first: without(values[first], rest)} if rest else kept
