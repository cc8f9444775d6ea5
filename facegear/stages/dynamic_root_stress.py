"""Root stress of every mesh of the running machine at its nominal speed."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from numpy.typing import NDArray

from facegear.config.tooth_pair import pair
from facegear.stages.outcome import Outcome
from facegear.strength.dynamic_stress import dynamic_stress_table
from facegear.strength.root_tables import root_from_arrays


def dynamic_root_stress(
    response: pd.DataFrame, stress: Mapping[str, NDArray], tooth_pair: Mapping[str, Any]
) -> Outcome:
    """`dynamic_stress` (table) from stage dynamics_response's history and root_stress's arrays."""
    forces = {
        str(mesh): rows["elastic_force_n"].to_numpy() for mesh, rows in response.groupby("mesh", sort=False)
    }
    roots = {body: root_from_arrays(stress, body) for body in ("pinion", "face_gear")}
    table = dynamic_stress_table(forces, pair(tooth_pair).design.pinion_base_radius, roots)
    worst = table.loc[table["face_gear_largest_mpa"].idxmax()]
    told = f"{worst['mesh']}: face gear {worst['face_gear_largest_mpa']:.0f} MPa"
    return Outcome({"dynamic_stress": table}, f"{told}, pinion {worst['pinion_largest_mpa']:.0f} MPa")
