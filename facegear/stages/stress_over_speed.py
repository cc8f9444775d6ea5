"""Root stress and pressure over the speed range, and the worst of all motions known at a speed."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.machines import MachineInputs
from facegear.config.tooth_pair import ToothPair, pair
from facegear.stages.outcome import Outcome
from facegear.strength.flank_contacts import flank_contacts
from facegear.strength.posed_contacts import mesh_contacts, posed_of
from facegear.strength.stress_over_speed import branch_forces, stress_table, swept_forces
from facegear.ties import first_largest_row
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import static_equilibrium


def stress_over_speed(
    sweep: pd.DataFrame,
    stress: Arrays,
    by_flank: pd.DataFrame,
    inputs: MachineInputs,
    tooth_pair: ToothPair,
    gears: Sequence[str],
    branches: pd.DataFrame | None = None,
    posed: Arrays | None = None,
    posed_by_torque: pd.DataFrame | None = None,
) -> Outcome:
    """Compute root stress and pressure over the sweep and, where there are any, the branches.

    Parameters
    ----------
    sweep : pd.DataFrame
        Table of stage dynamics_sweep.
    stress : Arrays
        Arrays of stage root_stress.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact.
    inputs : MachineInputs
        What the machine is built from.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`; a mesh has the stress of its own
        gear, on the flank where it is more.
    branches : pd.DataFrame or None
        Table of stage branches, None if there is none.
    posed : Arrays or None
        Arrays `contacts` of stage posed_stress, None unless the machine's forces pose the teeth.
    posed_by_torque : pd.DataFrame or None
        Table `by_torque` of stage posed_stress, None unless the machine's forces pose the teeth.

    Returns
    -------
    Outcome
        Table `stress_over_speed`.

    Raises
    ------
    NotConverged
        Where the equilibrium at standstill does not converge.
    """
    machine = inputs.build()
    at_standstill = float(np.abs(static_equilibrium(at_rest(machine)).forces).max())
    forces = swept_forces(sweep)
    if branches is not None:
        forces_of_branches = branch_forces(branches, np.unique(forces["speed_rpm"]))
        forces = pd.concat([forces, forces_of_branches], ignore_index=True)
    contacts = flank_contacts(stress, by_flank)
    at_pose = posed_of(contacts, gears, posed, posed_by_torque, inputs.poses)
    by_mesh = mesh_contacts(forces["mesh"].unique(), contacts, gears, at_pose)
    contacts_by_mesh = {mesh: by_flank.values() for mesh, by_flank in by_mesh.items()}
    radius = pair(tooth_pair).design.pinion_base_radius
    table = stress_table(forces, at_standstill, radius, contacts_by_mesh)
    worst = first_largest_row(table, "largest_force_n")
    position = f"{worst['speed_rpm']:.0f} rpm ({worst['motion']}, {worst['class']})"
    stresses = f"face gear {worst['face_gear_mpa']:.0f} MPa, pinion {worst['pinion_mpa']:.0f} MPa"
    summary = f"largest dynamic factor {worst['dynamic_factor']:.2f} at {position}: {stresses}"
    return Outcome({"stress_over_speed": table}, summary)
