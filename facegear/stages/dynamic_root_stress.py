"""Root stress of every mesh of the running machine at its nominal speed."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lumped_model import stiffness_phases
from facegear.config.machine_layout import ToothNumbers
from facegear.config.tooth_pair import ToothPair, pair
from facegear.config.transmission import Transmission
from facegear.dynamics.between_samples import finer
from facegear.dynamics.response_tables import shows_a_period
from facegear.stages.outcome import Outcome
from facegear.strength.dynamic_stress import dynamic_stress_table
from facegear.strength.flank_contacts import flank_contacts
from facegear.strength.posed_contacts import mesh_contacts, posed_of
from facegear.ties import first_largest_row
from facegear.transmission.flanks import flank_places

FINER = 8
"""Instants for each sample of the history at which force and stress are looked at."""


def dynamic_root_stress(
    response: pd.DataFrame,
    summary: pd.DataFrame,
    stress: Arrays,
    by_flank: pd.DataFrame,
    tooth_pair: ToothPair,
    transmission: Transmission,
    teeth: ToothNumbers,
    gears: Sequence[str],
    posed: Arrays | None = None,
    posed_by_torque: pd.DataFrame | None = None,
    poses: Arrays | None = None,
) -> Outcome:
    """Compute the root stress of every mesh at the nominal speed.

    Parameters
    ----------
    response : pd.DataFrame
        Table of stage dynamics_response.
    summary : pd.DataFrame
        Table of stage dynamics_response.
    stress : Arrays
        Arrays of stage root_stress.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Numbers of teeth.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`; a mesh has the stress of its own gear
        and flank.
    posed : Arrays or None
        Arrays `contacts` of stage posed_stress, None unless the machine's forces pose the teeth.
    posed_by_torque : pd.DataFrame or None
        Table `by_torque` of stage posed_stress, None unless the machine's forces pose the teeth.
    poses : Arrays or None
        Arrays of stage pose_surface at the pose of the machine's mean torques, None unless its forces pose
        the teeth.

    Returns
    -------
    Outcome
        Table `dynamic_stress`.
    """
    phases = stiffness_phases(transmission, teeth)
    forces, positions, whole = {}, {}, shows_a_period(response, summary)
    for number, (mesh, rows) in enumerate(response.groupby("mesh", sort=False)):
        cycles, force = rows["mesh_cycle"].to_numpy(), rows["elastic_force_n"].to_numpy()
        force = finer(force, FINER, whole)
        between = (cycles[1] - cycles[0]) * np.arange(FINER) / FINER
        drive, back = flank_places(phases[[number]], (cycles[:, None] + between).ravel()).T
        forces[str(mesh)], positions[str(mesh)] = force, np.where(force < 0.0, back, drive)
    contacts = flank_contacts(stress, by_flank)
    at_pose = posed_of(contacts, gears, posed, posed_by_torque, poses)
    contacts_by_mesh = mesh_contacts(forces, contacts, gears, at_pose)
    table = dynamic_stress_table(
        forces, positions, pair(tooth_pair).design.pinion_base_radius, contacts_by_mesh
    )
    worst = first_largest_row(table, "face_gear_running_mpa")
    summary = f"{worst['mesh']}: face gear {worst['face_gear_running_mpa']:.0f} MPa"
    return Outcome({"dynamic_stress": table}, f"{summary}, pinion {worst['pinion_running_mpa']:.0f} MPa")
