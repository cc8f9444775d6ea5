"""One machine with some numbers of its config changed: where a key stands, and its nominal value."""

from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from facegear.errors import ConfigError

SPEED = "dynamics.speed_rpm"
MACHINE = "transmission."
SHARED = {"single_pinions": "pinion", "single_gears": "face_gear", "single_meshes": None}
"""Sections of single parts, and the section that holds what all parts of the kind have."""
START = {"position_um": {"x": 0.0, "y": 0.0}, "runout": {"eccentricity_um": 0.0, "phase_deg": 0.0}}
"""What a part without an entry of its own has where the shared section says nothing."""
PLAIN = {"error_um": 0.0, "stiffness_factor": 1.0, "clocking_deg": 0.0}


def movable(
    transmission: Mapping[str, Any], keys: Iterable[str], told: str = "tolerances.causes.moves"
) -> dict[str, Any]:
    """Section `transmission` with an entry for every part that one of the keys names.

    What such an entry leaves open is filled with what all parts have. Raises ConfigError for `told`, naming
    the first key that is no number of the section.
    """
    complete = deepcopy(dict(transmission))
    for key in keys:
        if key == SPEED:
            continue
        if not key.startswith(MACHINE):
            raise ConfigError(told, key, f"a number of transmission, or {SPEED}")
        parts = key.removeprefix(MACHINE).split(".")
        if len(parts) > 2 and parts[0] in SHARED and isinstance(complete.get(parts[0]), dict):
            _enter(complete, parts)
        inside, last = _holder(complete, parts)
        found = inside[last] if _has(inside, last) else None
        if isinstance(found, bool) or not isinstance(found, int | float):
            allowed = "a key of transmission whose nominal value is a number"
            raise ConfigError(told, key, allowed)
    return complete


def moved(
    transmission: Mapping[str, Any], speed_rpm: float, changes: Mapping[str, float]
) -> tuple[dict[str, Any], float]:
    """A section made by `movable`, and the speed, with the changes added to their nominal values."""
    changed = deepcopy(dict(transmission))
    for key, added in changes.items():
        if key == SPEED:
            speed_rpm += added
            continue
        inside, last = _holder(changed, key.removeprefix(MACHINE).split("."))
        inside[last] = inside[last] + added
    return changed, speed_rpm


def nominal(transmission: Mapping[str, Any], keys: Iterable[str]) -> float:
    """The number that all keys of a section made by `movable` have; nan where they differ."""
    found = set()
    for key in keys:
        inside, last = _holder(transmission, key.removeprefix(MACHINE).split("."))
        found.add(float(inside[last]))
    return found.pop() if len(found) == 1 else float("nan")


def placed(transmission: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """A section made by `movable` with numbers put in the place of nominal ones."""
    changed = deepcopy(dict(transmission))
    for key, value in values.items():
        inside, last = _holder(changed, key.removeprefix(MACHINE).split("."))
        inside[last] = value
    return changed


def _enter(section: dict[str, Any], parts: list[str]) -> None:
    """Give the named part an entry that says what all parts of its kind have."""
    kind, name, field = parts[:3]
    own = section[kind].setdefault(name, {})
    if own.get(field) is not None:
        return
    shared = SHARED[kind]
    common = (section if shared is None else section[shared]).get(field)
    found = common if common is not None else START.get(field, PLAIN.get(field))
    if found is not None:
        own[field] = deepcopy(found)


def _holder(values: Any, parts: list[str]) -> tuple[Any, Any]:
    """The mapping or list that holds the last part of a dotted key, and that part as its index."""
    for part in parts[:-1]:
        place = _place(values, part)
        values = values[place] if _has(values, place) else None
    return values, _place(values, parts[-1])


def _place(values: Any, part: str) -> str | int:
    return int(part) if isinstance(values, list | tuple) and part.isdecimal() else part


def _has(values: Any, place: str | int) -> bool:
    if isinstance(values, dict):
        return place in values
    return isinstance(values, list) and isinstance(place, int) and place < len(values)
