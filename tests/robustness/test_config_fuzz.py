"""No config, however broken, ends in a traceback."""

import copy
import json
import random
from pathlib import Path

import pytest

from facegear.build.cases import expand_cases
from facegear.build.load import load_config
from facegear.errors import FacegearError
from facegear.schema.yaml_file import read_yaml

CONFIGS = sorted((Path(__file__).parents[2] / "config").glob("*.yaml"))
STRANGE = [
    *(None, True, "", "soft", "1e400", -1, 0, 1e-300, 1e300, float("nan"), float("inf"), -0.0, 3.5, 10**30),
    *([], {}, [1, "a", None], {"a": {"b": []}}, "../../etc/passwd", "/tmp/x", "é\u0000", "x" * 300, [[[]]]),
]


def places(value, path=()):
    """Paths of all values inside a config."""
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


def mutate(values, chance):
    """The config with one to three values changed, removed, renamed, doubled or added."""
    changed = copy.deepcopy(values)
    for _ in range(chance.randint(1, 3)):
        path = chance.choice([place for place in places(changed) if place])
        inside = changed
        for key in path[:-1]:
            inside = inside[key]
        key = path[-1]
        action = chance.choice(["strange", "remove", "rename", "add", "scale"])
        if action == "strange":
            inside[key] = copy.deepcopy(chance.choice(STRANGE))
        elif action == "remove":
            del inside[key]
        elif action == "rename" and isinstance(inside, dict):
            inside[f"{key}x"] = inside.pop(key)
        elif action == "add" and isinstance(inside, dict):
            inside[chance.choice(["teth", "case", "unknown"])] = chance.choice(STRANGE)
        elif action == "scale" and isinstance(inside[key], int | float):
            inside[key] = inside[key] * chance.choice([-1, 0, 1e-6, 0.5, 2, 1e6])
    return changed


def as_yaml(values):
    """JSON, which is YAML too, but for what is no number; written a hundred times sooner."""
    return json.dumps(values).replace("NaN", ".nan").replace("Infinity", ".inf")


@pytest.mark.parametrize("config", CONFIGS, ids=lambda path: path.stem)
def test_every_config_in_the_project_is_accepted(config):
    assert expand_cases(load_config(config))


@pytest.mark.parametrize("config", CONFIGS, ids=lambda path: path.stem)
def test_mutated_configs_are_accepted_or_refused_in_clear_lines(config, tmp_path):
    chance = random.Random(f"facegear {config.stem}")
    original = read_yaml(config)
    refused = 0
    for other in CONFIGS:
        (tmp_path / other.name).write_bytes(other.read_bytes())
    path = tmp_path / "mutated.yaml"
    tries = 520 // len(CONFIGS)
    for _ in range(tries):
        path.write_text(as_yaml(mutate(original, chance)), encoding="utf-8")
        try:
            expand_cases(load_config(path))
        except FacegearError as error:
            refused += 1
            for line in str(error).splitlines():
                assert len(line) < 600, line
                assert " = " in line or "line " in line or "mapping" in line or "studies" in line, line
    assert refused > tries // 2
