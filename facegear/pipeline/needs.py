"""Needs of stages from a config, and the cases that share files because their needs agree."""

import json
from collections.abc import Mapping
from typing import Any

from facegear.errors import ConfigError
from facegear.pipeline.stage import Case, ComputedValue, Need, Needs, Values
from facegear.pipeline.table import STAGES


def stage_needs(name: str, values: Values) -> dict[str, Any]:
    """Return the arguments that a stage takes from a config.

    Parameters
    ----------
    name : str
        Name of the stage.
    values : Values
        Plain values of a whole config.

    Returns
    -------
    dict[str, Any]
        Argument values by name.

    Raises
    ------
    ConfigError
        For modes, dynamics and load sharing of a config of tooth contact alone.
    """
    return resolved_needs(STAGES[name].needs, Case(values))


def resolved_needs(needs: Needs, case: Case) -> dict[str, Any]:
    """Return the values of needs.

    Parameters
    ----------
    needs : Needs
        Needs by name of the argument.
    case : Case
        The case.

    Returns
    -------
    dict[str, Any]
        Values by name of the argument.

    Raises
    ------
    ConfigError
        Where they name a machine that is not there.
    """
    if "transmission" in needs and case.values["transmission"] is None:
        raise ConfigError("transmission", None, "given for modes, dynamics and load sharing")
    return {name: _resolve_need(need, case) for name, need in needs.items()}


def require_section(name: str | None, values: Values) -> None:
    """Refuse a config without the section that a stage is about.

    Parameters
    ----------
    name : str or None
        Name of the stage, None for no stage.
    values : Values
        Plain values of a whole config.

    Raises
    ------
    ConfigError
        Where the section is missing.
    """
    section = STAGES[name].section if name else ""
    if section and values[section] is None:
        raise ConfigError(section, None, f"given, as rule {name} needs it")


def stages_before(name: str, values: Values) -> list[str]:
    """Return a stage and all stages whose results it uses, each once.

    Parameters
    ----------
    name : str
        Name of the stage.
    values : Values
        Plain values of a whole config.

    Returns
    -------
    list[str]
        Names of the stages.
    """
    before: dict[str, None] = {}
    todo, case = [name], Case(values)
    while todo:
        stage = todo.pop()
        if stage not in before:
            before[stage] = None
            upstream = STAGES[stage].upstream.values()
            todo += [source.stage for source in upstream if source.is_needed(case)]
    return list(before)


def shared_sources(cases: Mapping[str, Values], stage: str) -> dict[str, str]:
    """Return, for each case, the first case whose config agrees with it in everything that a stage depends
    on.

    Parameters
    ----------
    cases : Mapping[str, Values]
        Plain values of each config by case.
    stage : str
        Name of the stage.

    Returns
    -------
    dict[str, str]
        Source by case.
    """
    first: dict[str, str] = {}
    sources = {}
    for case, values in cases.items():
        before = stages_before(stage, values)
        needs = {name: resolved_needs(STAGES[name].needs, Case(values, cases)) for name in before}
        sources[case] = first.setdefault(json.dumps(needs, sort_keys=True), case)
    return sources


def _resolve_need(need: Need, case: Case) -> Any:
    if isinstance(need, ComputedValue):
        return need.function(case)
    if isinstance(need, str):
        return value_at(case.values, need)
    return {key.rsplit(".", 1)[-1]: value_at(case.values, key) for key in need}


def value_at(values: Values, key: str) -> Any:
    """Return the value at a dotted key.

    Parameters
    ----------
    values : Values
        Plain values of a whole config.
    key : str
        Dotted key.

    Returns
    -------
    Any
        The value; None below a section that is missing.
    """
    value: Any = values
    for part in key.split("."):
        value = value[part] if value is not None else None
    return value
