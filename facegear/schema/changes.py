"""One machine with some numbers of its config changed: which may, where one stands, its nominal value."""

from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from facegear.errors import ConfigError

SPEED = "dynamics.speed_rpm"
"""Key of the operating speed."""
MACHINE = "transmission."
"""Beginning of the keys of the machine."""
PAIR = "tooth_pair."
"""Beginning of the keys of the tooth pair."""
LUBRICATION = "lubrication."
"""Dotted key of the nominal speed, and beginnings of the dotted keys of three sections."""
TEETH = (
    *("pinion_teeth", "face_gear_teeth", "module_mm", "pressure_angle_deg"),
    *("helix_angle_deg", "taper_angle_deg", "shaft_angle_deg", "offset_mm"),
)
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
"""Keys of the tooth pair that may change without a body being meshed and factorised again."""
SHARED_SECTIONS = {"single_pinions": "pinion", "single_gears": "face_gear", "single_meshes": None}
"""Sections of single parts, each with the section that all parts of the kind share."""
START = {"position_um": {"x": 0.0, "y": 0.0, "z": 0.0}, "runout": {"eccentricity_um": 0.0, "phase_deg": 0.0}}
"""Values of a part without an entry of its own where the shared section says nothing."""
ONE_SIDE, DIAMETRAL = "clearance_um", "clearance_diametral_um"
"""Two ways in which a config gives the clearance of pinions; the second number is twice the first."""
PLAIN = {"error_um": 0.0, "stiffness_factor": 1.0, "clocking_deg": 0.0}
"""Values of a single mesh or pinion without an entry of its own, of keys that no shared section has."""


def variable_part(
    transmission: Mapping[str, Any],
    tooth_pair: Mapping[str, Any],
    speed_rpm: float,
    lubrication: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Collect the plain config values that may change from sample to sample or design to design.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Section `transmission`.
    tooth_pair : Mapping[str, Any]
        Section `tooth_pair`.
    speed_rpm : float
        Pinion speed, rpm.
    lubrication : Mapping[str, Any] or None
        Section `lubrication`; None without it.

    Returns
    -------
    dict[str, Any]
        Values under transmission, tooth_pair, dynamics.speed_rpm and lubrication, not copied.
    """
    return {
        "transmission": transmission,
        "tooth_pair": tooth_pair,
        "dynamics": {"speed_rpm": speed_rpm},
        "lubrication": lubrication,
    }


def without(values: Any, key: str) -> Any:
    """Return nested mappings without one dotted key; a key that does not exist changes nothing.

    Parameters
    ----------
    values : Any
        Nested mappings; any other value is returned as it is.
    key : str
        Dotted key to leave out.

    Returns
    -------
    Any
        A copy along the path of the key; the rest is shared.
    """
    first, _, rest = key.partition(".")
    if not isinstance(values, Mapping) or first not in values:
        return values
    remainder = {name: value for name, value in values.items() if name != first}
    return {**remainder, first: without(values[first], rest)} if rest else remainder


def moves_pair(keys: Iterable[str]) -> bool:
    """Whether at least one of the dotted keys lies in section `tooth_pair`.

    Parameters
    ----------
    keys : Iterable[str]
        Dotted keys.

    Returns
    -------
    bool
        True if one does.
    """
    return any(key.startswith(PAIR) for key in keys)


def movable(
    values: Mapping[str, Any],
    keys: Iterable[str],
    prefixes: Iterable[str] = (MACHINE, SPEED, PAIR, LUBRICATION),
    refused_key: str = "tolerances.causes.moves",
) -> dict[str, Any]:
    """Prepare config values so that numbers at some dotted keys can be changed, and check the keys.

    Every single part that one of the keys names gets an entry of its own. Values that the entry leaves
    open are filled with those of all parts. Where a key is a clearance to each side, clearances given
    from side to side become clearances to each side.

    Parameters
    ----------
    values : Mapping[str, Any]
        Result of `variable_part`.
    keys : Iterable[str]
        Dotted keys that will change, such as `transmission.single_pinions.idler 1.position_um.x`.
    prefixes : Iterable[str]
        Beginnings of keys that may change.
    refused_key : str
        Key of the config that an error names.

    Returns
    -------
    dict[str, Any]
        A copy of the values with the entries added.

    Raises
    ------
    ConfigError
        For `refused_key`, with the first key that begins with none of the prefixes or is no number.
    """
    complete, keys = deepcopy(dict(values)), tuple(keys)
    if any(key.endswith(f".{ONE_SIDE}") for key in keys):
        _to_each_side(complete["transmission"])
    for key in keys:
        if not key.startswith(tuple(prefixes)):
            names = ", ".join(text.removesuffix(".") for text in prefixes)
            raise ConfigError(refused_key, key, f"a number of {names}")
        parts = key.split(".")
        if (
            len(parts) > 3
            and parts[1] in SHARED_SECTIONS
            and isinstance(complete[parts[0]].get(parts[1]), dict)
        ):
            _enter(complete[parts[0]], parts[1:])
        inside, last = _holder(complete, parts)
        value = inside[last] if _has(inside, last) else None
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ConfigError(refused_key, key, f"a key of {parts[0]} whose nominal value is a number")
    return complete


def add_changes(values: Mapping[str, Any], changes: Mapping[str, float]) -> dict[str, Any]:
    """Add changes to the nominal values of dotted keys.

    Parameters
    ----------
    values : Mapping[str, Any]
        Result of `movable`.
    changes : Mapping[str, float]
        Increment of each dotted key, in the unit of the key.

    Returns
    -------
    dict[str, Any]
        New values; parts that do not change are shared with `values`.
    """
    new_values: dict[str, Any] = dict(values)
    copies: dict[str, Any] = {}
    for key, increment in changes.items():
        path, _, last = key.rpartition(".")
        holder = _own_copy(new_values, path, copies)
        holder[_index_of(holder, last)] += increment
    return new_values


def _own_copy(values: dict[str, Any], path: str, copies: dict[str, Any]) -> Any:
    """Return the part of the values at a dotted path as a copy that may be changed.

    Everything that contains it is copied into `values`, too, the rest stays shared. `copies` has the
    copies made so far, by path, and gets the new ones.
    """
    if not path:
        return values
    if path not in copies:
        above, _, part = path.rpartition(".")
        holder = _own_copy(values, above, copies)
        index = _index_of(holder, part)
        inside = holder[index]
        copies[path] = holder[index] = list(inside) if isinstance(inside, list | tuple) else dict(inside)
    return copies[path]


def nominal(values: Mapping[str, Any], keys: Iterable[str]) -> float:
    """Return the nominal number that several dotted keys have in common.

    Parameters
    ----------
    values : Mapping[str, Any]
        Result of `movable`.
    keys : Iterable[str]
        Dotted keys.

    Returns
    -------
    float
        Their number, in the unit of the keys; nan where they differ.
    """
    numbers = set()
    for key in keys:
        inside, last = _holder(values, key.split("."))
        numbers.add(float(inside[last]))
    return numbers.pop() if len(numbers) == 1 else float("nan")


def set_numbers(values: Mapping[str, Any], numbers: Mapping[str, float]) -> dict[str, Any]:
    """Replace the nominal values of dotted keys by other numbers.

    Parameters
    ----------
    values : Mapping[str, Any]
        Result of `movable`.
    numbers : Mapping[str, float]
        New number of each dotted key, in the unit of the key; numbers of teeth are rounded.

    Returns
    -------
    dict[str, Any]
        New values; parts that do not change are shared with `values`.
    """
    new_values: dict[str, Any] = dict(values)
    copies: dict[str, Any] = {}
    for key, number in numbers.items():
        path, _, last = key.rpartition(".")
        holder = _own_copy(new_values, path, copies)
        holder[_index_of(holder, last)] = round(number) if key.endswith("teeth") else number
    return new_values


def _to_each_side(transmission: Mapping[str, Any]) -> None:
    """Replace diametral clearances of pinions by half of them under the one-sided key, in place."""
    for part in (transmission["pinion"], *transmission["single_pinions"].values()):
        if part.get(DIAMETRAL) is not None:
            part |= {ONE_SIDE: 0.5 * part[DIAMETRAL], DIAMETRAL: None}


def _enter(section: dict[str, Any], parts: list[str]) -> None:
    """Give a single part an entry of its own with the value that all parts of its kind have, in place.

    `parts` begins with the section of single parts, the part's name and the field. A value that is there
    stays.
    """
    kind, name, field = parts[:3]
    entry = section[kind].setdefault(name, {})
    if entry.get(field) is not None:
        return
    shared_section = SHARED_SECTIONS[kind]
    common = (section if shared_section is None else section[shared_section]).get(field)
    initial = common if common is not None else START.get(field, PLAIN.get(field))
    if initial is not None:
        entry[field] = deepcopy(initial)


def _holder(values: Any, parts: list[str]) -> tuple[Any, Any]:
    """Return the mapping or list that holds the last part of a dotted key, and that part as key or index.

    The holder is None where a part before it does not exist.
    """
    for part in parts[:-1]:
        index = _index_of(values, part)
        values = values[index] if _has(values, index) else None
    return values, _index_of(values, parts[-1])


def _index_of(values: Any, part: str) -> str | int:
    """Return a part of a dotted key: as a number where `values` are a list, else as it is."""
    return int(part) if isinstance(values, list | tuple) and part.isdecimal() else part


def _has(values: Any, index: str | int) -> bool:
    """Whether a mapping holds a key, or a list an index; False for any other values."""
    if isinstance(values, dict):
        return index in values
    return isinstance(values, list) and isinstance(index, int) and index < len(values)
