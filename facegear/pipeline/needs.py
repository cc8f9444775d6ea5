"""What stages take from a config, and which cases share their files for that reason."""

import json
from collections.abc import Mapping
from typing import Any

from facegear.errors import ConfigError
from facegear.pipeline.stage import Case, Computed, Need, Needs, Values
from facegear.pipeline.table import STAGES


def stage_needs(name: str, values: Values) -> dict[str, Any]:
    """The arguments that a stage takes from the plain values of a whole config.

    Raises ConfigError for modes, dynamics and load sharing of a config of tooth contact alone.
    """
    return resolved_needs(STAGES[name].needs, Case(values))


def resolved_needs(needs: Needs, case: Case) -> dict[str, Any]:
    """Values of needs. Raises ConfigError where they name a machine that is not there."""
    if "transmission" in needs and case.values["transmission"] is None:
        raise ConfigError("transmission", None, "given for modes, dynamics and load sharing")
    return {name: _resolved(need, case) for name, need in needs.items()}


def require_section(name: str | None, values: Values) -> None:
    """Raises ConfigError where a config lacks the section that a stage is about."""
    section = STAGES[name].section if name else ""
    if section and values[section] is None:
        raise ConfigError(section, None, f"given, as rule {name} needs it")


def stages_before(name: str, values: Values) -> list[str]:
    """A stage and all whose results it uses, each once, with the plain values of a whole config."""
    before: dict[str, None] = {}
    todo, case = [name], Case(values)
    while todo:
        stage = todo.pop()
        if stage not in before:
            before[stage] = None
            upstream = STAGES[stage].upstream.values()
            todo += [source.stage for source in upstream if source.wanted(case)]
    return list(before)


def shared_sources(cases: Mapping[str, Values], stage: str) -> dict[str, str]:
    """Of each case the first whose config agrees with it in everything that `stage` depends on."""
    first: dict[str, str] = {}
    sources = {}
    for case, values in cases.items():
        before = stages_before(stage, values)
        needs = {name: resolved_needs(STAGES[name].needs, Case(values, cases)) for name in before}
        sources[case] = first.setdefault(json.dumps(needs, sort_keys=True), case)
    return sources


def _resolved(need: Need, case: Case) -> Any:
    if isinstance(need, Computed):
        return need.function(case)
    if isinstance(need, str):
        return value_at(case.values, need)
    return {key.rsplit(".", 1)[-1]: value_at(case.values, key) for key in need}


def value_at(values: Values, key: str) -> Any:
    """The value at a dotted key; None below a section that is not there."""
    value: Any = values
    for part in key.split("."):
        value = value[part] if value is not None else None
    return value
