"""Every number of a config has bounds, and any number is used or refused in one line for each mistake."""

from functools import cache
from math import inf, nan
from pathlib import Path

import pytest

from facegear.build.config import Config, resolved_values
from facegear.build.load import load_config
from facegear.build.reference import reference
from facegear.errors import ConfigErrors
from facegear.schema.base import parse

SCHEMA = Config.model_json_schema()
CONFIGS = sorted((Path(__file__).parents[3] / "config").glob("*.yaml"))
ABSURD = (1e-300, 1e300, inf, nan, -1)


def plain(schema):
    """Return a part of the schema with its reference followed."""
    return SCHEMA["$defs"][schema["$ref"].rsplit("/", 1)[-1]] if "$ref" in schema else schema


def forms(schema):
    """Return all forms that a value may have."""
    schema = plain(schema)
    given = schema.get("anyOf") or schema.get("oneOf")
    return [form for option in given for form in forms(option)] if given else [schema]


def numbers(values, schema, path=()):
    """Yield (path, form) of every number that values of this schema may hold; of lists the first item."""
    options = forms(schema)
    yield from ((path, form) for form in options if form.get("type") in ("number", "integer"))
    for form in options:
        if isinstance(values, dict):
            for key, value in values.items():
                inside = form.get("properties", {}).get(key) or form.get("additionalProperties")
                if isinstance(inside, dict):
                    yield from numbers(value, inside, (*path, key))
        elif isinstance(values, list) and values and form.get("type") == "array":
            inside = form.get("items") or form["prefixItems"][0]
            yield from numbers(values[0], inside, (*path, 0))


def name(path):
    """Return a dotted key; names that users choose and list positions are left open."""
    known = ("shafts", "torsion", "single_meshes", "single_pinions", "single_gears", "phasing", "moves")
    parts = ["*" if before in known else str(part) for before, part in zip(("", *path), path, strict=False)]
    return ".".join(parts)


@cache
def places():
    """Return name -> values of a shipped config, path and form of the number there; quick configs first."""
    found = {}
    for config in map(load_config, CONFIGS):
        values = {**config.model_dump(mode="json"), "studies": [], "reproduction": None}
        for path, form in numbers(values, SCHEMA):
            found.setdefault((name(path), form["type"]), (values, path, form))
    return found


def changed(values, path, number):
    """Return a copy of nested values with another number at a path."""
    copied = dict(values) if isinstance(values, dict) else list(values)
    first, *rest = path
    copied[first] = changed(values[first], rest, number) if rest else number
    return copied


def test_shipped_configs_hold_nearly_every_number_that_there_is():
    assert len(places()) > 300


@pytest.mark.parametrize("number", ABSURD)
def test_an_absurd_number_is_used_or_refused_in_clear_lines_wherever_it_stands(number):
    """Sizes of 1e300 ended in an OverflowError."""
    for values, path, _ in places().values():
        try:
            resolved_values(parse(Config, changed(values, path, number)))
        except ConfigErrors as error:
            assert error.lines and all("\n" not in line for line in error.lines), path


@pytest.mark.parametrize("end", ["minimum", "maximum"])
def test_a_number_at_its_bound_is_used_or_refused_in_clear_lines(end):
    for values, path, form in places().values():
        bound = form.get(end, form.get(f"exclusive{end.title()}"))
        try:
            resolved_values(parse(Config, changed(values, path, bound)))
        except ConfigErrors as error:
            assert error.lines and all("\n" not in line for line in error.lines), path


def open_ended(schema, path=""):
    """Yield the places of numbers without a lower or an upper bound."""
    if isinstance(schema, dict):
        if schema.get("type") in ("number", "integer"):
            ends = ({"minimum", "exclusiveMinimum"}, {"maximum", "exclusiveMaximum"})
            if not all(end & schema.keys() for end in ends):
                yield path
        for key, inside in schema.items():
            yield from open_ended(inside, f"{path}/{key}")
    elif isinstance(schema, list):
        for inside in schema:
            yield from open_ended(inside, path)


def test_every_number_of_a_config_has_a_lower_and_an_upper_bound():
    assert list(open_ended(SCHEMA)) == []


def test_every_key_of_a_config_has_a_meaning():
    rows = [line for line in reference().splitlines() if line.startswith("| `")]
    assert len(rows) > 500
    assert [row for row in rows if not row.removesuffix(" |").rpartition(" | ")[2].strip()] == []


def test_every_property_of_the_schema_has_a_description():
    """Editors show it while a config is written."""
    silent = [
        f"{section}.{key}"
        for section, definition in (*SCHEMA["$defs"].items(), ("Config", SCHEMA))
        for key, form in definition.get("properties", {}).items()
        if "description" not in form and not any(option.get("description") for option in forms(form))
    ]
    assert silent == []
