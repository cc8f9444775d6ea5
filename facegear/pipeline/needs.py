"""Parts of a config that stages take from a config, which cases share files, and keys that no stage reads."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from facegear.errors import ConfigError
from facegear.pipeline.stage import Case, ComputedValue, Need, Needs, Values
from facegear.pipeline.table import STAGES


def stage_needs(name: str, values: Values) -> dict[str, Any]:
    """Return the arguments that a stage takes from a config; with those of earlier stages they decide
    its results.

    Parameters
    ----------
    name : str
        Name of the stage.
    values : Values
        Plain values of a whole config, with defaults.

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
    """Return the values of needs for a case: at a dotted key, at several keys as a section, or by a
    function of the case.

    Parameters
    ----------
    needs : Needs
        Needs by name of the argument, as rows of the table of stages give them.
    case : Case
        The case whose config is read.

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
    """Raise ConfigError for a config without the section that a stage is about, such as `search`.

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
    if section and value_at(values, section) is None:
        raise ConfigError(section, None, f"given, as rule {name} needs it")


def stages_before(name: str, values: Values) -> list[str]:
    """Return a stage and all stages from which it takes files, directly or through others, each once.

    Parameters
    ----------
    name : str
        Name of the stage.
    values : Values
        Plain values of a whole config.

    Returns
    -------
    list[str]
        Names of the stages, the given one first.
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
    """Find which cases may share files of a stage.

    A case takes them from the first case with the same needs of the stage and of all stages before it.

    Parameters
    ----------
    cases : Mapping[str, Values]
        Plain values of each config by case id; the order decides which case is the source.
    stage : str
        Name of the stage.

    Returns
    -------
    dict[str, str]
        For each case the id of the case whose files it uses, which may be itself.
    """
    first: dict[str, str] = {}
    sources = {}
    for case, values in cases.items():
        before = stages_before(stage, values)
        needs = {name: resolved_needs(STAGES[name].needs, Case(values, cases)) for name in before}
        sources[case] = first.setdefault(json.dumps(needs, sort_keys=True), case)
    return sources


def _resolve_need(need: Need, case: Case) -> Any:
    """Return the value of one need; several keys give a mapping by the last part of each key."""
    if isinstance(need, ComputedValue):
        return need.function(case)
    if isinstance(need, str):
        return value_at(case.values, need)
    return {key.rsplit(".", 1)[-1]: value_at(case.values, key) for key in need}


def value_at(values: Values, key: str) -> Any:
    """Return the value of a config at a dotted key, such as `dynamics.speed_rpm`.

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


ALWAYS_READ = ("case", "extends", "studies", "reproduction", "transmission.backlash_um")
"""Keys that are read before any stage runs, or that complete a section."""
HARMONICS_GIVEN = ("torque_n_m", "definition")
"""Keys of mesh_stiffness that belong to a computed stiffness."""


def idle_keys(file_values: Mapping[str, Any], cases: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """List keys that are given in a config file and have no effect, one line each with the reason.

    Parameters
    ----------
    file_values : mapping
        Values as they stand in the file, without those of a file that it extends.
    cases : mapping
        Plain values of all cases of the config by case id, with defaults (`expand_cases`); a key that any of
        them reads has an effect.

    Returns
    -------
    list of str
        Keys with reasons, in the order of the file.
    """
    read = set(ALWAYS_READ)
    for values in cases.values():
        read |= set(_keys_read(Case(values, cases)))
    unread = list(_unread(file_values, read))
    reasons = [dict(_switched_off(values)) for values in cases.values()]
    off = {
        key: reason
        for key, reason in reasons[0].items()
        if all(key in of_case for of_case in reasons)
        and _is_given(file_values, key)
        and not _is_below(key, unread)
    }
    return [f"{key}: no stage that this config asks for reads it" for key in unread] + [
        f"{key}: {reason}" for key, reason in off.items()
    ]


def _keys_read(case: Case) -> Iterator[str]:
    """Yield the dotted keys or sections that count for a plain run: needs of its stages and of those
    before them.
    """
    run = [name for name, stage in STAGES.items() if stage.condition is not None and stage.condition(case)]
    for name in dict.fromkeys(before for stage in run for before in stages_before(stage, case.values)):
        for need in STAGES[name].needs.values():
            yield from _keys(need)


def _is_below(key: str, sections: list[str]) -> bool:
    """Whether a dotted config key is one of `sections` or lies inside one."""
    return any(f"{key}.".startswith(f"{section}.") for section in sections)


def _keys(need: Need) -> tuple[str, ...]:
    """Return the dotted keys, or whole sections, of the config that a need reads."""
    if isinstance(need, ComputedValue):
        return need.sections
    return (need,) if isinstance(need, str) else need


def _unread(section: Mapping[str, Any], read: set[str], above: str = "") -> Iterator[str]:
    """Yield the dotted keys of a file that no stage reads; a section that is not read at all counts as
    one key.

    `read` holds the keys that are read, `above` is the dotted prefix of `section`. Keys with value None
    are passed over.
    """
    for name, value in section.items():
        key = f"{above}{name}"
        parts = key.split(".")
        if any(".".join(parts[:depth]) in read for depth in range(1, len(parts) + 1)):
            continue
        holds_read = any(longer.startswith(f"{key}.") for longer in read)
        if holds_read and isinstance(value, Mapping):
            yield from _unread(value, read, f"{key}.")
        elif not holds_read and value is not None:
            yield key


def _is_given(file_values: Mapping[str, Any], key: str) -> bool:
    """Whether the config file itself gives a value other than None at a dotted key."""
    inside: Any = file_values
    for part in key.split("."):
        if not isinstance(inside, Mapping) or part not in inside:
            return False
        inside = inside[part]
    return inside is not None


def _switched_off(values: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield each dotted key that a stage reads but that has no effect because of another key, with the
    reason in words.
    """
    stiffness, contact, sweep = values["mesh_stiffness"], values["contact"], values["dynamics"]["sweep"]
    if stiffness["source"] == "harmonics":
        for key in HARMONICS_GIVEN:
            yield f"mesh_stiffness.{key}", "mesh_stiffness.source is harmonics, which has no load"
    sector = contact["sector"]
    if sector["pinion_teeth"] == sector["face_gear_teeth"] == "full":
        yield "contact.sector.cut_faces", "both gears are modelled in full, so that nothing is cut"
    if sweep["chunks"] == 1:
        yield "dynamics.sweep.overlap_points", "the sweep has one chunk"
    machine = values["transmission"]
    if machine is None:
        return
    error = machine["transmission_error"]
    if error["source"] == "given" and not error["amplitude_um"]:
        for key in ("phase_deg", "meaning"):
            yield f"transmission.transmission_error.{key}", "amplitude_um is 0"
    inputs = [pinion for pinion in machine["pinions"] if pinion["role"] == "input"]
    has_no_reader = all(pinion["torque_n_m"] is not None for pinion in inputs)
    if has_no_reader and machine["torque"]["per_input_n_m"] != 0.0:
        reason = "every input has a torque_n_m of its own" if inputs else "no pinion has the role input"
        yield "transmission.torque.per_input_n_m", reason
    for role in machine["shafts"]:
        of_role = [pinion["name"] for pinion in machine["pinions"] if pinion["role"] == role]
        if of_role and role not in of_role and all(name in machine["shafts"] for name in of_role):
            yield f"transmission.shafts.{role}", f"every {role} has a shaft under its own name"
