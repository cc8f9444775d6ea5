"""The lumped machine from plain config values: the one place that puts it together."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from facegear.config.lumped_model import lumped_sections, machine
from facegear.config.mesh_friction import with_friction
from facegear.harmonics.series import Harmonics
from facegear.stiffness.tables import series_of, unloaded_error
from facegear.transmission.machine import Machine


def wired_machine(
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    stiffness: Harmonics | pd.DataFrame,
    unloaded: Harmonics | None = None,
    friction: pd.DataFrame | None = None,
) -> Machine:
    """The machine of section `transmission`; the mesh stiffness as a series or as the table of its stage.

    A table from contact brings the pair's own e(t); with a series it is `unloaded`, in m. friction: table
    `excitation` of stage lubrication, where friction disturbs the motion.
    """
    section, numbers = lumped_sections(transmission, teeth)
    if isinstance(stiffness, Harmonics):
        built = machine(section, numbers, stiffness, unloaded)
    else:
        built = machine(section, numbers, series_of(stiffness), unloaded_error(stiffness))
    return built if friction is None else with_friction(built, friction)


def case_machine(values: Mapping[str, Any], stiffness: Harmonics | pd.DataFrame) -> Machine:
    """The machine of a whole config."""
    return wired_machine(values["transmission"], values["tooth_pair"], stiffness)
