"""Table of all config keys, for the docs, and JSON schema of the config, for editors.

Made by `python -m facegear.build.reference > docs/reference/config.md` and
`python -m facegear.build.reference --schema > facegear/schema/config.schema.json`.
"""

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from facegear.build.config import Config

NUMBERS = ("minimum", "maximum")
"""Words of a JSON schema for the bounds of a number."""
HEAD = """# All keys of a config

This page is for users who write or change a config: it lists every key with its default, limits and meaning.
Required keys are required where their section is given.
`[]` stands for each item of a list, `<name>` for a name of your own.
A file's name counts from the folder of the config that holds it.
The page is made from the models that check a config (`python -m facegear.build.reference`).
"""
"""Beginning of the page."""


def reference() -> str:
    """Return the text of the page that lists all config keys, made from the models that check a config.

    Returns
    -------
    str
        The page as Markdown.
    """
    schema = Config.model_json_schema()
    parts = [HEAD]
    for name, section in schema["properties"].items():
        parts.append(f"\n## {name}\n")
        parts.append(f"{meaning(schema, section)}\n")
        parts.append("\n| key | default | allowed | meaning |\n|---|---|---|---|\n")
        is_required = name in schema.get("required", ())
        parts.extend(_row(*row) for row in _rows(schema, name, section, is_required))
    return "".join(parts)


def _row(*cells: str) -> str:
    """Return a row of a Markdown table with a line end from the texts of its cells; bars in them are
    escaped.
    """
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |\n"


def _rows(
    schema: Mapping[str, Any], key: str, field: Mapping[str, Any], is_required: bool
) -> Iterator[tuple[str, str, str, str]]:
    """Yield a row for a key and then, recursively, for all keys inside it.

    A row is the key, its default, its allowed values and its meaning. `field` is the part of the JSON
    schema that describes the key. Keys inside a list begin with `key[]`, those under free names with
    `key.<name>`.
    """
    inside = [_plain(schema, option) for option in _options(field)]
    yield (f"`{key}`", _default(field, is_required), _allowed_values(schema, inside), meaning(schema, field))
    for option in inside:
        item, name = option, key
        if isinstance(item.get("additionalProperties"), dict):
            item, name = _plain(schema, item["additionalProperties"]), f"{name}.<name>"
        if item.get("type") == "array" and isinstance(item.get("items"), dict):
            item, name = _plain(schema, item["items"]), f"{name}[]"
        for inner, value in item.get("properties", {}).items():
            yield from _rows(schema, f"{name}.{inner}", value, inner in item.get("required", ()))


def meaning(schema: Mapping[str, Any], field: Mapping[str, Any]) -> str:
    """Return the meaning of a key: its own description, or that of the section which it holds.

    Parameters
    ----------
    schema : Mapping[str, Any]
        The config's JSON schema.
    field : Mapping[str, Any]
        The part of the schema that describes the key.

    Returns
    -------
    str
        The description in one line.
    """
    options = [_plain(schema, option) for option in _options(field)]
    texts = (
        option.get("description") or _plain(schema, option.get("items", {})).get("description", "")
        for option in options
    )
    return " ".join((field.get("description") or next(filter(None, texts), "")).split())


def _options(field: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the alternatives of a JSON schema's field (`anyOf` or `oneOf`), or the field itself as the
    only one.
    """
    return list(field.get("anyOf") or field.get("oneOf") or [field])


def _plain(schema: Mapping[str, Any], field: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the schema of a field, its reference to a definition replaced by the definition."""
    if "$ref" not in field:
        return field
    return schema["$defs"][field["$ref"].rsplit("/", 1)[-1]]


def _default(field: Mapping[str, Any], is_required: bool) -> str:
    """Return the default of a key as code in Markdown; `required`, or a remark for a section with
    defaults.
    """
    if is_required:
        return "required"
    value = field.get("default")
    return "each key's own" if isinstance(value, dict) and value else f"`{json.dumps(value)}`"


def _allowed_values(schema: Mapping[str, Any], options: list[Mapping[str, Any]]) -> str:
    """Return the allowed values of a key in words, its different forms joined by `or`."""
    return " or ".join(dict.fromkeys(_kind(schema, option) for option in options))


def _kind(schema: Mapping[str, Any], option: Mapping[str, Any]) -> str:
    """Return one allowed form of a value in words: type, bounds, choices."""
    if "enum" in option or "const" in option:
        return ", ".join(f"`{value}`" for value in option.get("enum", [option.get("const")]))
    kind = option.get("type", "any value")
    if kind == "array":
        items = option.get("items") or option.get("prefixItems", [{}])[0]
        numbers = f" of numbers{_bounds(items, NUMBERS)}" if items.get("type") == "number" else ""
        return f"list{_bounds(option, ('minItems', 'maxItems'))}{numbers}"
    inside = option.get("additionalProperties")
    if kind == "object" and isinstance(inside, Mapping) and inside.get("type") == "number":
        return f"names, each with a {_kind(schema, inside)}"
    words = {"integer": "whole number", "object": "section", "string": "text", "boolean": "true, false"}
    return words.get(kind, kind) + _bounds(option, NUMBERS)


def _bounds(option: Mapping[str, Any], names: tuple[str, str]) -> str:
    """Return the bounds of a number or a length in words."""
    limits = [
        f"{sign} {option[key]:g}"
        for key, sign in (
            (names[0], "from"),
            ("exclusiveMinimum", "above"),
            (names[1], "to"),
            ("exclusiveMaximum", "below"),
        )
        if key in option
    ]
    return f" {', '.join(limits)}" if limits else ""


SCHEMA = Path(__file__).parents[1] / "schema" / "config.schema.json"
"""The stored copy, which is installed with the package."""


def json_schema() -> str:
    """Return the JSON schema of a config file, made from the models that validate it.

    Returns
    -------
    str
        The schema as text.
    """
    return json.dumps(Config.model_json_schema(), indent=1, sort_keys=True) + "\n"


if __name__ == "__main__":
    print(json_schema() if "--schema" in sys.argv[1:] else reference(), end="")
