"""What all config sections share: strict parsing, and mistakes told in the user's terms."""

import difflib
import json
from collections.abc import Mapping
from typing import Any, NoReturn, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails, PydanticCustomError

from facegear.errors import ConfigErrors


class Section(BaseModel):
    """A part of the config: frozen, unknown keys refused, numbers finite and never booleans or text."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


SectionType = TypeVar("SectionType", bound=Section)


def refuse(key: str, value: object, allowed: str) -> NoReturn:
    """Refuse a value inside a validator; `key` is relative to the section that is validated.

    Raises an error that the loader prints as `section.key = value: allowed`.
    """
    raise PydanticCustomError(
        "refused", "{allowed}", {"key": key, "value": json.dumps(value, default=str), "allowed": allowed}
    )


def parse(model: type[SectionType], values: Mapping[str, Any], source: str = "config") -> SectionType:
    """Validate plain values (as read from YAML) against a section model.

    Raises ConfigErrors with one line for every mistake.
    """
    try:
        text = json.dumps(values, allow_nan=True)
    except (TypeError, ValueError, RecursionError):
        raise ConfigErrors(source, ["holds something that is not a number, text, list or mapping"]) from None
    try:
        return model.model_validate_json(text)
    except ValidationError as error:
        lines = _lines(model, error.errors(include_url=False))
        raise ConfigErrors(source, list(dict.fromkeys(lines))) from None


def _lines(model: type[Section], found: list[ErrorDetails]) -> list[str]:
    """A line for each mistake; a misspelt key is not told again as a missing one."""
    places = [[part for part in details["loc"] if not _is_union_tag(part)] for details in found]
    meant = [
        [*place[:-1], _nearest(model, place)]
        for place, details in zip(places, found, strict=True)
        if details["type"] == "extra_forbidden"
    ]
    return [
        _line(model, details, place)
        for place, details in zip(places, found, strict=True)
        if details["type"] != "missing" or place not in meant
    ]


def _line(model: type[Section], details: ErrorDetails, location: list[int | str]) -> str:
    kind, context = details["type"], details.get("ctx", {})
    if kind == "refused":
        key = ".".join([_dotted(location), context["key"]]).strip(".")
        return f"{key} = {context['value']}: {context['allowed']}"
    key = _dotted(location) or "(the whole file)"
    if kind == "extra_forbidden":
        nearest, keys = _nearest(model, location), _keys_at(model, location[:-1])
        hint = f"did you mean {nearest!r}?" if nearest else f"allowed here: {', '.join(sorted(keys))}"
        return f"{key} = {_shown(details['input'])}: unknown key; {hint}"
    if kind == "missing":
        return f"{key} = (missing): this key is required"
    message = details["msg"].removeprefix("Input ").removeprefix("Value error, ")
    return f"{key} = {_shown(details['input'])}: {message[:1].lower()}{message[1:]}"


def _is_union_tag(part: int | str) -> bool:
    """Config keys are lower case words; pydantic also puts model and type names into a location."""
    return isinstance(part, str) and (part in _TYPE_NAMES or part[:1].isupper() or "[" in part or "-" in part)


_TYPE_NAMES = {"float", "int", "str", "bool"}


def _dotted(location: list[int | str]) -> str:
    text = ""
    for part in location:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.strip(".")


def _shown(value: Any) -> str:
    text = json.dumps(value, default=str)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _nearest(model: type[Section], location: list[int | str]) -> str | None:
    keys = _keys_at(model, location[:-1])
    close = difflib.get_close_matches(str(location[-1]), sorted(keys), n=1, cutoff=0.6)
    return close[0] if close else None


def _keys_at(model: type[BaseModel], location: list[int | str]) -> set[str]:
    models = {model}
    for part in location:
        if isinstance(part, int):
            continue
        fields = [found.model_fields[part] for found in models if part in found.model_fields]
        models = {nested for field in fields for nested in _models_in(field.annotation)}
    return {key for found in models for key in found.model_fields}


def _models_in(annotation: Any) -> set[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return {annotation}
    return {nested for part in get_args(annotation) for nested in _models_in(part)}
