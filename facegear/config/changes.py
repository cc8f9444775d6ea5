"""One machine with some numbers of its config changed: which may, where one stands, its nominal value."""

from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from facegear.errors import ConfigError

SPEED = "dynamics.speed_rpm"
MACHINE = "transmission."
PAIR = "tooth_pair."
LUBRICATION = "lubrication."
TEETH = ("pinion_teeth", "face_gear_teeth", "module_mm", "pressure_angle_deg")
"""Keys of the tooth pair that the lumped model needs; its other data must not rerun modes or dynamics."""
GAPS = (
    "assembly",
    *("pinion.tip_relief", "pinion.root_relief", "pinion.lead_crowning", "pinion.flanks"),
    *("face_gear.modifications", "face_gear.flanks"),
)
"""Keys of the tooth pair that move unloaded flanks, and no node of the bodies."""
MODULI = tuple(f"{body}material.young_modulus_gpa" for body in ("", "pinion.", "face_gear."))
"""Keys of the tooth pair that a compliance is inversely proportional to."""
WITHOUT_MESHING = tuple(f"{PAIR}{key}" for key in (*GAPS, *MODULI))
"""What of the tooth pair may change without a body being meshed and factorised again."""
SHARED = {"single_pinions": "pinion", "single_gears": "face_gear", "single_meshes": None}
"""Sections of single parts, and the section that holds what all parts of the kind have."""
START = {"position_um": {"x": 0.0, "y": 0.0}, "runout": {"eccentricity_um": 0.0, "phase_deg": 0.0}}
"""What a part without an entry of its own has where the shared section says nothing."""
ONE_SIDE, DIAMETRAL = "clearance_um", "clearance_diametral_um"
"""Two ways in which a config gives the clearance of pinions; the second number is twice the first."""
PLAIN = {"error_um": 0.0, "stiffness_factor": 1.0, "clocking_deg": 0.0}


def variable_part(
    transmission: Mapping[str, Any],
    tooth_pair: Mapping[str, Any],
    speed_rpm: float,
    lubrication: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """The plain values of a config that may change from machine to machine, under the keys that they have."""
    return {
        "transmission": transmission,
        "tooth_pair": tooth_pair,
        "dynamics": {"speed_rpm": speed_rpm},
        "lubrication": lubrication,
    }


def without(values: Any, key: str) -> Any:
    """A copy of nested mappings without one dotted key."""
    first, _, rest = key.partition(".")
    if not isinstance(values, Mapping) or first not in values:
        return values
    kept = {name: value for name, value in values.items() if name != first}
    return {**kept, first: without(values[first], rest)} if rest else kept


def moves_pair(keys: Iterable[str]) -> bool:
    """Whether one of the dotted keys belongs to the tooth pair."""
    return any(key.startswith(PAIR) for key in keys)


def movable(
    values: Mapping[str, Any],
    keys: Iterable[str],
    allowed: Iterable[str] = (MACHINE, SPEED, PAIR, LUBRICATION),
    refused_key: str = "tolerances.causes.moves",
) -> dict[str, Any]:
    """Values as of `variable_part` with an entry for every single part that one of the keys names.

    What such an entry leaves open is filled with what all parts have. Where a key is a clearance to each
    side, clearances given from side to side become clearances to each side. Raises ConfigError for
    `refused_key`, naming the first key that begins with none of the texts `allowed`, or is no number.
    """
    complete, keys = deepcopy(dict(values)), tuple(keys)
    if any(key.endswith(f".{ONE_SIDE}") for key in keys):
        _to_each_side(complete["transmission"])
    for key in keys:
        if not key.startswith(tuple(allowed)):
            names = ", ".join(text.removesuffix(".") for text in allowed)
            raise ConfigError(refused_key, key, f"a number of {names}")
        parts = key.split(".")
        if len(parts) > 3 and parts[1] in SHARED and isinstance(complete[parts[0]].get(parts[1]), dict):
            _enter(complete[parts[0]], parts[1:])
        inside, last = _holder(complete, parts)
        value = inside[last] if _has(inside, last) else None
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ConfigError(refused_key, key, f"a key of {parts[0]} whose nominal value is a number")
    return complete


def moved(values: Mapping[str, Any], changes: Mapping[str, float]) -> dict[str, Any]:
    """Values made by `movable` with the changes added to their nominal values; the others are shared."""
    changed: dict[str, Any] = dict(values)
    copies: dict[str, Any] = {}
    for key, added in changes.items():
        path, _, last = key.rpartition(".")
        holder = _own_copy(changed, path, copies)
        holder[_index_of(holder, last)] += added
    return changed


def _own_copy(changed: dict[str, Any], path: str, copies: dict[str, Any]) -> Any:
    """What stands at a dotted path of values, copied with all that it stands in; `copies` has what was copied
    before, by path.
    """
    if not path:
        return changed
    if path not in copies:
        above, _, part = path.rpartition(".")
        holder = _own_copy(changed, above, copies)
        index = _index_of(holder, part)
        inside = holder[index]
        copies[path] = holder[index] = list(inside) if isinstance(inside, list | tuple) else dict(inside)
    return copies[path]


def nominal(values: Mapping[str, Any], keys: Iterable[str]) -> float:
    """The number that all keys of values made by `movable` have; nan where they differ."""
    numbers = set()
    for key in keys:
        inside, last = _holder(values, key.split("."))
        numbers.add(float(inside[last]))
    return numbers.pop() if len(numbers) == 1 else float("nan")


def placed(values: Mapping[str, Any], numbers: Mapping[str, float]) -> dict[str, Any]:
    """Values made by `movable` with numbers in the place of nominal ones; those of teeth are rounded."""
    changed: dict[str, Any] = dict(values)
    copies: dict[str, Any] = {}
    for key, number in numbers.items():
        path, _, last = key.rpartition(".")
        holder = _own_copy(changed, path, copies)
        holder[_index_of(holder, last)] = round(number) if key.endswith("teeth") else number
    return changed


def _to_each_side(transmission: Mapping[str, Any]) -> None:
    for part in (transmission["pinion"], *transmission["single_pinions"].values()):
        if part.get(DIAMETRAL) is not None:
            part |= {ONE_SIDE: 0.5 * part[DIAMETRAL], DIAMETRAL: None}


def _enter(section: dict[str, Any], parts: list[str]) -> None:
    """Give the named part an entry that says what all parts of its kind have."""
    kind, name, field = parts[:3]
    own = section[kind].setdefault(name, {})
    if own.get(field) is not None:
        return
    shared = SHARED[kind]
    common = (section if shared is None else section[shared]).get(field)
    initial = common if common is not None else START.get(field, PLAIN.get(field))
    if initial is not None:
        own[field] = deepcopy(initial)


def _holder(values: Any, parts: list[str]) -> tuple[Any, Any]:
    """The mapping or list that holds the last part of a dotted key, and that part as its index."""
    for part in parts[:-1]:
        index = _index_of(values, part)
        values = values[index] if _has(values, index) else None
    return values, _index_of(values, parts[-1])


def _index_of(values: Any, part: str) -> str | int:
    return int(part) if isinstance(values, list | tuple) and part.isdecimal() else part


def _has(values: Any, index: str | int) -> bool:
    if isinstance(values, dict):
        return index in values
    return isinstance(values, list) and isinstance(index, int) and index < len(values)
