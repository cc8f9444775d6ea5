"""The keys of the config behind the quantities that computations refuse by words of their own."""

import difflib
import json
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NoReturn, Self, TypeVar, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails, PydanticCustomError

from facegear.errors import ConfigError, ConfigErrors, InvalidInput
from facegear.number_format import count_noun
from facegear.schema.plausibility import plausibility_notes, unit_suggestion

KEYS = {
    "element size": "mesh.resolution",
    "element depth below the fillets": "fillet_depth_mm",
    "profile refinement": "contact.refinement.profile",
    "torques of the contact analysis": "contact.torques_n_m",
    "modelled teeth of the pinion": "contact.sector.pinion_teeth",
    "modelled teeth of the face gear": "contact.sector.face_gear_teeth",
    "rounding of the rack's tip": "tooth_pair.pinion.rack_tip_radius_modules",
    "rounding of the shaper's tip": "tooth_pair.shaper.tip_rounding_modules",
    "gauges on the fillets": "contact.root_stress",
    "torque of the mesh stiffness": "mesh_stiffness.torque_n_m",
    "variation of the mesh stiffness": "mesh_stiffness.variation",
    "mesh stiffness": "mesh_stiffness",
    "pinions": "transmission.pinions",
    "face gears": "transmission.face_gears",
    "torques": "transmission.torque",
    "lags of the transmission error": "transmission.transmission_error.phasing",
    "order of an excitation": "transmission.excitations",
    "half backlashes": "transmission.single_meshes",
}
"""Dotted keys by the words of the computations; a quantity without a key keeps its words."""


def config_error(error: InvalidInput) -> ConfigError:
    """Translate a refusal by a computation into one that names config keys, by KEYS.

    Parameters
    ----------
    error : InvalidInput
        Refusal by a computation, which names a quantity, and others in backquotes, in words.

    Returns
    -------
    ConfigError
        The same refusal with keys of the config.
    """
    requirement = re.sub("`(.*?)`", lambda match: KEYS.get(match[1], match[1]), error.requirement)
    return ConfigError(KEYS.get(error.quantity, error.quantity), error.value, requirement)


@contextmanager
def keys_named() -> Iterator[None]:
    """Context or decorator in which InvalidInput of a computation becomes ConfigError with the config
    key.

    Yields
    ------
    None
        Once, for the statements of the `with` block.
    """
    try:
        yield
    except InvalidInput as error:
        raise config_error(error) from error


class Section(BaseModel):
    """A part of the config: frozen, unknown keys refused, numbers finite and never booleans or text."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    @classmethod
    def of_config(cls, values: Mapping[str, Any]) -> Self:
        """Build the section from plain values of a validated config, without repeating its checks.

        Parameters
        ----------
        values : Mapping[str, Any]
            Plain values of the section.

        Returns
        -------
        Self
            The section.
        """
        token = _VALIDATED.set(True)
        try:
            return cls.model_validate_json(json.dumps(values))
        finally:
            _VALIDATED.reset(token)


_VALIDATED = ContextVar("validated", default=False)
"""Whether values are typed again that were validated with the whole config."""

SectionType = TypeVar("SectionType", bound=Section)


def refuse(key: str, value: object, requirement: str) -> NoReturn:
    """Refuse a value inside a validator of a section, whose error pydantic collects.

    Raises an error that the loader prints as `section.key = value: must be <requirement>`.

    Parameters
    ----------
    key : str
        Key, relative to the section that is validated.
    value : object
        The value that is refused.
    requirement : str
        What the value must be, in words.
    """
    _refuse_all([(key, value, requirement)])


def require_all(*checks: Callable[[], None]) -> None:
    """Run checks inside a validator, so that all that they refuse is reported at once.

    A check calls `refuse` or raises ConfigError with a key relative to the section that is validated.

    Parameters
    ----------
    *checks : Callable[[], None]
        Functions without arguments that raise for a value they refuse.
    """
    refusals: list[tuple[str, object, str]] = []
    for check in () if _VALIDATED.get() else checks:
        try:
            check()
        except InvalidInput as error:
            key_error = config_error(error)
            refusals.append((key_error.key, key_error.value, key_error.requirement))
        except ConfigError as error:
            refusals.append((error.key, error.value, error.requirement))
        except PydanticCustomError as error:
            refusals += (error.context or {})["refused"]
    if refusals:
        _refuse_all(refusals)


def _refuse_all(refusals: Sequence[tuple[str, object, str]]) -> NoReturn:
    """Raise the pydantic error that holds refused values, each as key, value and requirement."""
    raise PydanticCustomError("refused", "refused", {"refused": list(refusals)})


def parse(model: type[SectionType], values: Mapping[str, Any], source: str = "config") -> SectionType:
    """Validate plain values against a section model, and return the section with its defaults filled in.

    Parameters
    ----------
    model : type[SectionType]
        Class of the section.
    values : Mapping[str, Any]
        Plain values, as read from YAML.
    source : str
        What the error names as the origin of the values, such as a file's name.

    Returns
    -------
    SectionType
        The validated section.

    Raises
    ------
    ConfigErrors
        With one line for every mistake.
    """
    try:
        text = json.dumps(values, allow_nan=True, default=_refuse_value)
    except (TypeError, ValueError, RecursionError) as error:
        problem = f"holds something that is not a number, text, list or mapping ({error})"
        raise ConfigErrors(source, [problem]) from None
    try:
        return model.model_validate_json(text)
    except ValidationError as error:
        lines = _lines(model, values, error.errors(include_url=False))
        raise ConfigErrors(source, _with_likely_units(lines, values)) from None


def _with_likely_units(lines: list[str], values: Mapping[str, Any]) -> list[str]:
    """Add to error lines the notes on values whose wrong unit may have caused them, in place, and return
    them.

    A face width in m is refused because it is narrower than the gear's face, which alone says little.
    """
    notes = {note.partition(" = ")[0].partition("[")[0]: note for note in plausibility_notes(values)}
    for key, note in notes.items():
        sections = key.split(".")
        starts = (key, ".".join(sections[:2]) + ".", f"{sections[0]}.")
        about = [number for number, line in enumerate(lines) if key in line]
        about += [number for start in starts for number, line in enumerate(lines) if line.startswith(start)]
        if not about:
            continue
        caused = about[0]
        if lines[caused].startswith(key):
            # A bound of the schema is wider than what these teeth suggest, and fits more units.
            lines[caused] = lines[caused].partition("; is it in ")[0] + f"; {note.partition(': ')[2]}"
        else:
            lines[caused] += f"; {note}"
    return lines


def _refuse_value(value: object) -> NoReturn:
    """Raise TypeError for a value that JSON cannot hold, such as a date without quotes in YAML."""
    raise TypeError(f"{value}: put text in quotes")


def _lines(model: type[Section], values: Mapping[str, Any], mistakes: list[ErrorDetails]) -> list[str]:
    """Return one line of text for each refused value, from pydantic's mistakes.

    A misspelt key is not reported again as a missing one. All rules that one value breaks share a line.
    """
    locations = [_location(details, values) for details in mistakes]
    intended_keys = [
        [*location[:-1], _nearest(model, location)]
        for location, details in zip(locations, mistakes, strict=True)
        if details["type"] == "extra_forbidden"
    ]
    lines: dict[str, list[str]] = {}
    for location, details in zip(locations, mistakes, strict=True):
        if details["type"] == "missing" and location in intended_keys:
            continue
        if _follows(details) or _is_other_kind(location, details, locations):
            continue
        for line in _messages(model, details, location):
            head, _, rule = line.partition(": must ")
            lines.setdefault(head, []).append(rule)
    return [_one_line(head, rules) for head, rules in lines.items()]


def _one_line(head: str, rules: Sequence[str]) -> str:
    """Return the line of one value: `head`, its key and value, then all different rules joined by `or`."""
    distinct = list(dict.fromkeys(rule for rule in rules if rule))
    if not distinct:
        return head
    return f"{head}: must " + ", or ".join(
        [distinct[0], *(rule.removeprefix("be ") for rule in distinct[1:])]
    )


def _is_other_kind(
    location: list[int | str], details: ErrorDetails, locations: list[list[int | str]]
) -> bool:
    """Whether a mistake only says that a mapping is no text, while keys inside it are refused by name."""
    if not isinstance(details["input"], Mapping) or details["type"] in ("refused", "missing"):
        return False
    depth = len(location)
    return any(len(deeper) > depth and deeper[:depth] == location for deeper in locations)


def _follows(details: ErrorDetails) -> bool:
    """Whether a list is too short only without its refused items, each of which has a line of its own."""
    return details["type"] == "too_short" and len(details["input"]) >= details["ctx"]["min_length"]


def _messages(model: type[Section], details: ErrorDetails, location: list[int | str]) -> list[str]:
    """Return the lines `key = value: must be ...` for one mistake that pydantic found."""
    kind = details["type"]
    if kind == "refused":
        section = _dotted(location)
        return [
            f"{'.'.join([section, key]).strip('.')} = {json.dumps(value, default=str)}: must be {known_keys}"
            for key, value, known_keys in details["ctx"]["refused"]
        ]
    key = _dotted(location) or "(the whole file)"
    if kind == "extra_forbidden":
        known_keys = _keys_at(model, location[:-1])
        return [
            f"{key} = {_value_text(details['input'])}: unknown key; "
            f"{suggestion(str(location[-1]), known_keys)}"
        ]
    if kind == "missing":
        return [f"{key} = (missing): this key is required"]
    if kind in ("too_short", "too_long"):
        words, name = ("at least", "min_length") if kind == "too_short" else ("at most", "max_length")
        count = details["ctx"][name]
        items = f"{words} {count_noun(count, 'item')}"
        return [f"{key} = {_value_text(details['input'])}: must have {items}, not {len(details['input'])}"]
    if kind in RULES:
        rule = RULES[kind]
    elif kind == "string_pattern_mismatch":
        rule = NAME_RULE.get(details["ctx"]["pattern"], f"match {details['ctx']['pattern']}")
    elif kind in ("string_too_short", "string_too_long"):
        words, name = ("at least", "min_length") if kind == "string_too_short" else ("at most", "max_length")
        count = details["ctx"][name]
        rule = f"have {words} {count_noun(count, 'character')}"
    else:
        message = details["msg"].removeprefix("Input ").removeprefix("Value error, ")
        rule = message.replace("should ", "", 1) if message.startswith("should ") else message
        rule += _likely_unit(key, details)
    return [f"{key} = {_value_text(details['input'])}: must {rule}"]


NAME_RULE = {
    r"^[a-z][a-z0-9_]{0,39}$": "be at most 40 lower-case letters, digits and underscores, "
    "starting with a letter",
    r"^[a-z][a-z0-9_]*$": "be lower-case letters, digits and underscores, starting with a letter",
}
"""Rules of names in words, by the patterns of the schema."""
RULES = {
    "string_type": "be text",
    "int_type": "be a whole number",
    "int_from_float": "be a whole number",
    "bool_type": "be true or false",
    "tuple_type": "be a list",
    "list_type": "be a list",
    "dict_type": "be a mapping of keys to values",
    "model_type": "be a mapping of keys to values",
    "model_attributes_type": "be a mapping of keys to values",
}
"""Rules in words by the kind of mistake, where the validation library speaks of its own types."""


def _likely_unit(key: str, details: ErrorDetails) -> str:
    """Return the end of a line on the unit that a number was likely given in; empty if none fits."""
    value, bounds = details["input"], details.get("ctx", {})
    if not isinstance(value, int | float):
        return ""
    low, high = bounds.get("ge", bounds.get("gt")), bounds.get("le", bounds.get("lt"))
    return "" if low is None and high is None else unit_suggestion(key, value, low, high)


NEW_KEYS = {
    "a_n_per_m": "sin_n_per_m",
    "b_n_per_m": "cos_n_per_m",
    "least_bending_safety": "min_bending_safety",
    "least_pitting_safety": "min_pitting_safety",
    "longest_found": "longest_start_period",
    "most_branches": "max_branches",
}
"""Keys and columns of earlier versions, each with its name of today."""


def suggestion(key: str, known_keys: Collection[str]) -> str:
    """Suggest in words what an unknown key should be.

    A key of an earlier version gets its new name. Otherwise the most similar key is suggested, or else
    all keys are listed.

    Parameters
    ----------
    key : str
        The unknown key.
    known_keys : Collection[str]
        Keys that are allowed here.

    Returns
    -------
    str
        The suggestion as the end of a message, such as "did you mean 'module_mm'?".
    """
    if (new_key := NEW_KEYS.get(key)) in known_keys:
        return f"`{key}` is now `{new_key}`"
    nearest = _closest(key, known_keys)
    return f"did you mean {nearest!r}?" if nearest else f"allowed here: {', '.join(sorted(known_keys))}"


def _location(details: ErrorDetails, values: Any) -> list[int | str]:
    """Return keys and list positions down to a mistake, without names of types that pydantic adds.

    `values` are the plain values that were validated, to tell keys from such names.
    """
    named_by_user = details["type"] in ("extra_forbidden", "missing")
    location: list[int | str] = []
    for depth, part in enumerate(details["loc"], start=1):
        is_key = isinstance(values, Mapping) and part in values
        last = named_by_user and depth == len(details["loc"])
        if not (is_key or last) and _is_union_tag(part):
            continue
        location.append(part)
        is_present = is_key or (
            isinstance(values, list | tuple) and isinstance(part, int) and part < len(values)
        )
        values = values[part] if is_present else None
    return location


def _is_union_tag(part: int | str) -> bool:
    """Whether a part of a location is a type's or model's name: keys of a config are lower-case words."""
    return isinstance(part, str) and (part in _TYPE_NAMES or part[:1].isupper() or "[" in part or "-" in part)


_TYPE_NAMES = {"float", "int", "str", "bool"}
"""Names of types that pydantic adds to the location of a mistake."""


def _dotted(location: list[int | str]) -> str:
    """Return a location of pydantic as a dotted key with indices in brackets."""
    text = ""
    for part in location:
        text += f"[{part}]" if isinstance(part, int) else f"{'.' if text else ''}{part}"
    return text


def _value_text(value: Any) -> str:
    """Return a value as JSON of at most 60 letters."""
    text = json.dumps(value, default=str)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _nearest(model: type[Section], location: list[int | str]) -> str | None:
    """Return the known key nearest in spelling to the last part of a location; None if none is near."""
    return _closest(str(location[-1]), _keys_at(model, location[:-1]))


def _closest(key: str, keys: Iterable[str]) -> str | None:
    """Return the key spelt most like another, None if none is; capitals and hyphens do not count."""
    normalised_key = key.lower().replace("-", "_").replace(" ", "_")
    close = difflib.get_close_matches(normalised_key, sorted(keys), n=1, cutoff=0.6)
    return close[0] if close else None


def _keys_at(model: type[BaseModel], location: list[int | str]) -> set[str]:
    """Return the keys that sections at a location, given from `model` down, may hold, unions included.

    A part of the location is a key of a section, or a name in a mapping of sections, such as a pinion's.
    """
    kinds: list[Any] = [model]
    for part in location:
        if not isinstance(part, int):
            kinds = [inner for kind in kinds for inner in _kinds_below(kind, part)]
    return {key for kind in kinds if get_origin(kind) is not dict for key in kind.model_fields}


def _kinds_below(kind: Any, part: str) -> list[Any]:
    """Return the kinds of values at a key of a section class, or at any name of a mapping."""
    if get_origin(kind) is dict:
        return _kinds_in(get_args(kind)[1])
    field = kind.model_fields.get(part)
    return [] if field is None else _kinds_in(field.annotation)


def _kinds_in(annotation: Any) -> list[Any]:
    """Return all section classes and mappings inside a type annotation: in unions and lists."""
    is_section = isinstance(annotation, type) and issubclass(annotation, BaseModel)
    if is_section or get_origin(annotation) is dict:
        return [annotation]
    return [kind for part in get_args(annotation) for kind in _kinds_in(part)]
