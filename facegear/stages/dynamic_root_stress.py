"""Root stress of every mesh of the running machine at its nominal speed."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.config.lumped_model import stiffness_phases
from facegear.config.tooth_pair import pair
from facegear.stages.outcome import Outcome
from facegear.strength.contact_pressure import contact_pressure
from facegear.strength.dynamic_stress import dynamic_stress_table
from facegear.strength.root_tables import root_from_arrays
from facegear.transmission.flanks import flank_places


def dynamic_root_stress(
    response: pd.DataFrame,
    stress: Mapping[str, NDArray],
    by_torque: pd.DataFrame,
    tooth_pair: Mapping[str, Any],
    transmission: Mapping[str, Any],
) -> Outcome:
    """`dynamic_stress` (table) from stage dynamics_response's history and root_stress's arrays.

    by_torque: table of stage contact.
    """
    phases = stiffness_phases(transmission, tooth_pair)
    forces, places = {}, {}
    for number, (mesh, rows) in enumerate(response.groupby("mesh", sort=False)):
        force = rows["elastic_force_n"].to_numpy()
        drive, back = flank_places(phases[[number]], rows["mesh_cycle"].to_numpy()).T
        forces[str(mesh)], places[str(mesh)] = force, np.where(force < 0.0, back, drive)
    roots = {body: root_from_arrays(stress, body) for body in ("pinion", "face_gear")}
    radius, pressure = pair(tooth_pair).design.pinion_base_radius, contact_pressure(by_torque).at
    table = dynamic_stress_table(forces, places, radius, roots, pressure)
    worst = table.loc[table["face_gear_running_mpa"].idxmax()]
    told = f"{worst['mesh']}: face gear {worst['face_gear_running_mpa']:.0f} MPa"
    return Outcome({"dynamic_stress": table}, f"{told}, pinion {worst['pinion_running_mpa']:.0f} MPa")
