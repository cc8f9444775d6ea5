"""The lumped machine with its mesh stiffness: the one place that puts it together."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lumped_model import machine
from facegear.config.machine_layout import ToothNumbers, lumped_sections
from facegear.config.mesh_law import flank_tables
from facegear.config.transmission import Transmission
from facegear.gear_body.reduced import ReducedBody
from facegear.harmonics.series import Harmonics
from facegear.stiffness.tables import series_of, unloaded_error
from facegear.transmission.elastic_gears import ElasticGears
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine
from facegear.transmission.tooth_errors import from_arrays


def wired_machine(
    section: Transmission,
    teeth: ToothNumbers,
    stiffness: Harmonics | pd.DataFrame,
    unloaded: Harmonics | None = None,
    friction: pd.DataFrame | None = None,
    law: Arrays | None = None,
    poses: Arrays | None = None,
    bodies: Arrays | None = None,
    tooth_errors: Arrays | None = None,
) -> Machine:
    """The machine of section `transmission`; the mesh stiffness as a series or as the table of its stage.

    A table from contact brings the pair's own e(t); with a series it is `unloaded`, in m. friction: table
    `excitation` of stage lubrication, where friction disturbs the motion. law: arrays of stage mesh_law,
    where forces depend on the load. poses: arrays `surface` of stage pose_surface, where the meshes stand as
    the machine's own forces put them. bodies: arrays `reduced` of stage gear_bodies, where face gears bend.
    tooth_errors: arrays `curves` of that stage, where single teeth deviate from the others.
    """
    if isinstance(stiffness, Harmonics):
        built = machine(section, teeth, stiffness, unloaded)
    else:
        built = machine(section, teeth, series_of(stiffness), unloaded_error(stiffness))
    if law is not None:
        built = replace(built, tables=flank_tables(law, built.layout))
    if bodies is not None:
        elastic = elastic_gears(bodies, built.layout)
        built = replace(built, bodies=elastic, softening=elastic.softening())
    if tooth_errors is not None:
        own = replace(built.imperfections, teeth=from_arrays(tooth_errors))
        built = replace(built, imperfections=own)
    if poses is not None:
        from facegear.poses.fixed_point import posed_machine  # only poses need compiled statics
        from facegear.poses.surface import PoseSurface

        built = posed_machine(built, PoseSurface.of_arrays(poses))
    if friction is None:
        return built
    from facegear.config.mesh_friction import with_friction  # only friction needs compiled statics

    return with_friction(built, friction)


def elastic_gears(bodies: Arrays, layout: Layout) -> ElasticGears:
    """The gears of a layout that bend, from the arrays `reduced` of stage gear_bodies."""
    numbered = {gear.side.value: number for number, gear in enumerate(layout.gears)}
    return ElasticGears(
        layout,
        {
            number: ReducedBody.of_arrays(bodies, side)
            for side, number in numbered.items()
            if f"{side}_order" in bodies
        },
    )


def case_machine(values: Mapping[str, Any], stiffness: Harmonics | pd.DataFrame) -> Machine:
    """The machine of the plain values of a whole config."""
    return wired_machine(*lumped_sections(values["transmission"], values["tooth_pair"]), stiffness)
