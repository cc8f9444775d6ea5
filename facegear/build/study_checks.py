"""Checks of studies, tolerances and searches against the rest of a config."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from facegear.build.checks import CONTACT_ASKED, pair_teeth
from facegear.build.machine_layout import layout
from facegear.build.tooth_pair import ToothPair
from facegear.errors import ConfigError, ConfigErrors
from facegear.number_format import count_noun
from facegear.quantities import matching_names
from facegear.schema.base import parse
from facegear.schema.changes import (
    LUBRICATION,
    MACHINE,
    PAIR,
    SPEED,
    WITHOUT_MESHING,
    movable,
    moves_pair,
    variable_part,
)
from facegear.schema.lubrication import LubricationSection
from facegear.schema.studies import Search, Study
from facegear.schema.tolerances import Tolerances
from facegear.schema.transmission import Transmission
from facegear.sharing.groups import quantity_names

MAX_POINTS = 200
"""Points of all studies of a config together: each is a case of its own with some five jobs."""


TAKEN_NAMES = ("nominal", "nominal_summary", "summary", "reference", "speed_range", "study_forces")
"""Files that load sharing writes beside those of the studies."""


def check_studies(studies: Sequence[Study]) -> None:
    """Require that studies have different names and figures, and are few enough.

    Parameters
    ----------
    studies : Sequence[Study]
        Studies of the config.

    Raises
    ------
    ConfigError
        For a repeated or reserved name, a repeated figure, or more than MAX_POINTS points.
    """
    names = [study.name for study in studies]
    figures = [number for study in studies for number in study.figures or ()]
    for number, name in enumerate(names):
        if name in names[:number]:
            raise ConfigError(f"studies[{number}].name", name, "a name of its own for each study")
        if name in TAKEN_NAMES:
            raise ConfigError(
                f"studies[{number}].name", name, "another name: load sharing writes a file of this one"
            )
    if len(set(figures)) < len(figures):
        raise ConfigError("studies.figures", figures, "each number once")
    points = sum(int(np.prod([len(axis.study_points()) for axis in study.axes])) for study in studies)
    if points > MAX_POINTS:
        requirement = f"at most {MAX_POINTS} in all: fewer values, several configs, or a loop in Python"
        raise ConfigError("studies", count_noun(points, "point"), requirement)


def check_tolerances(
    section: Tolerances,
    pair: ToothPair,
    machine: Transmission,
    lubrication: LubricationSection | None,
    has_contact: bool,
) -> None:
    """Require that every cause moves numbers that this machine has.

    Causes may move the teeth only where contact is solved.

    Parameters
    ----------
    section : Tolerances
        Section `tolerances` of the config.
    pair : ToothPair
        Section `tooth_pair` of the config.
    machine : Transmission
        Section `transmission` of the config, with its backlash.
    lubrication : LubricationSection or None
        Section `lubrication` of the config.
    has_contact : bool
        Whether the mesh stiffness comes from the contact analysis.

    Raises
    ------
    ConfigError
        For a key that the machine does not have or that may not move.
    """
    keys = [key for cause in section.causes for key in cause.moves]
    if lubrication is None and any(key.startswith(LUBRICATION) for key in keys):
        raise ConfigError("lubrication", None, "given, as required by tolerances.causes that move it")
    prefixes = (MACHINE, SPEED, *([LUBRICATION] if lubrication else []), *WITHOUT_MESHING)
    start = movable(_variable(pair, machine, lubrication), keys, prefixes)
    if not has_contact and (section.tooth_contact or moves_pair(keys)):
        raise ConfigError("mesh_stiffness.source", "harmonics", f"fem or fem_scaled, {CONTACT_ASKED}")
    try:
        parse(Transmission, start["transmission"])
    except ConfigErrors as error:
        reason = error.lines[0]
        raise ConfigError(
            "tolerances.causes.moves", keys, f"keys that this machine can have; {reason}"
        ) from None


def check_search(
    section: Search, tolerances: Tolerances | None, pair: ToothPair, machine: Transmission, contact: str
) -> None:
    """Require that variables are numbers of this machine, and goals quantities that it has.

    Parameters
    ----------
    section : Search
        Section `search` of the config.
    tolerances : Tolerances or None
        Section `tolerances` of the config.
    pair : ToothPair
        Section `tooth_pair` of the config.
    machine : Transmission
        Section `transmission` of the config, with its backlash.
    contact : str
        Results of the contact analysis that the config has: `none`, `pressure`, or `root stress` (both).

    Raises
    ------
    ConfigError
        For the first key or goal that the machine does not have.
    """
    keys = [key for variable in section.variables for key in variable.sets]
    causes = tolerances.causes if section.robust and tolerances is not None else ()
    oiled = [key for cause in causes for key in cause.moves if key.startswith(LUBRICATION)]
    if oiled:
        raise ConfigError(
            "tolerances.causes.moves", oiled, "without lubrication where search asks for percentiles"
        )
    movable(_variable(pair, machine), keys, (MACHINE, PAIR), "search.variables.sets")
    if contact == "none" and moves_pair(keys):
        raise ConfigError("mesh_stiffness.source", "harmonics", f"fem or fem_scaled, {CONTACT_ASKED}")
    machine_layout = layout(machine, pair_teeth(pair))
    dynamic, gauges = section.model == "dynamic", contact == "root stress"
    names = quantity_names(machine_layout, dynamic, contact != "none", gauges, jumps=True)
    for goal in (*section.objectives, *section.constraints):
        for start in goal.quantities:
            if not matching_names(start, names):
                requirement = f"the beginning of one of: {', '.join(names)}"
                key = "smallest_of" if goal.large else "largest_of"
                raise ConfigError(f"search: {goal.name}.{key}", start, requirement)
    if section.robust and tolerances is None:
        raise ConfigError("tolerances", None, "given, as required by percentiles in search")


def _variable(
    pair: ToothPair, machine: Transmission, lubrication: LubricationSection | None = None
) -> dict[str, Any]:
    """Return the config values that samples and designs may change, as `variable_part`, at a speed of 0
    rpm.

    They serve to check keys, so that the speed does not matter.
    """
    oil = lubrication.model_dump(mode="json") if lubrication is not None else None
    return variable_part(machine.model_dump(mode="json"), pair.model_dump(mode="json"), 0.0, oil)
