"""The lumped machine with its mesh stiffness: the one place that puts it together."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lumped_model import ToothNumbers, lumped_sections, machine
from facegear.config.mesh_law import flank_tables
from facegear.config.transmission import Transmission
from facegear.harmonics.series import Harmonics
from facegear.stiffness.tables import series_of, unloaded_error
from facegear.transmission.machine import Machine


def wired_machine(
    section: Transmission,
    teeth: ToothNumbers,
    stiffness: Harmonics | pd.DataFrame,
    unloaded: Harmonics | None = None,
    friction: pd.DataFrame | None = None,
    law: Arrays | None = None,
) -> Machine:
    """The machine of section `transmission`; the mesh stiffness as a series or as the table of its stage.

    A table from contact brings the pair's own e(t); with a series it is `unloaded`, in m. friction: table
    `excitation` of stage lubrication, where friction disturbs the motion. law: arrays of stage mesh_law,
    where forces depend on the load.
    """
    if isinstance(stiffness, Harmonics):
        built = machine(section, teeth, stiffness, unloaded)
    else:
        built = machine(section, teeth, series_of(stiffness), unloaded_error(stiffness))
    if law is not None:
        built = replace(built, tables=flank_tables(law, built.layout))
    if friction is None:
        return built
    from facegear.config.mesh_friction import with_friction  # only friction needs compiled statics

    return with_friction(built, friction)


def case_machine(values: Mapping[str, Any], stiffness: Harmonics | pd.DataFrame) -> Machine:
    """The machine of the plain values of a whole config."""
    return wired_machine(*lumped_sections(values["transmission"], values["tooth_pair"]), stiffness)
