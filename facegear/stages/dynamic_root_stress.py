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
    """`dynamic_stress` (table) from stage dynamics_response's tables and root_stress's arrays.

    by_flank: table of stage contact; every mesh has the stress of its own gear and flank, of `gears`.
    posed, posed_by_torque: parts of stage posed_stress, poses: arrays of stage pose_surface, where the
    machine's own forces put the teeth; the pose is that of its mean torques.
    """
    phases = stiffness_phases(transmission, teeth)
    forces, places, whole = {}, {}, shows_a_period(response, summary)
    for number, (mesh, rows) in enumerate(response.groupby("mesh", sort=False)):
        cycles, force = rows["mesh_cycle"].to_numpy(), rows["elastic_force_n"].to_numpy()
        force = finer(force, FINER, whole)
        between = (cycles[1] - cycles[0]) * np.arange(FINER) / FINER
        drive, back = flank_places(phases[[number]], (cycles[:, None] + between).ravel()).T
        forces[str(mesh)], places[str(mesh)] = force, np.where(force < 0.0, back, drive)
    contacts = flank_contacts(stress, by_flank)
    at_pose = posed_of(contacts, gears, posed, posed_by_torque, poses)
    own = mesh_contacts(forces, contacts, gears, at_pose)
    table = dynamic_stress_table(forces, places, pair(tooth_pair).design.pinion_base_radius, own)
    worst = first_largest_row(table, "face_gear_running_mpa")
    summary = f"{worst['mesh']}: face gear {worst['face_gear_running_mpa']:.0f} MPa"
    return Outcome({"dynamic_stress": table}, f"{summary}, pinion {worst['pinion_running_mpa']:.0f} MPa")
