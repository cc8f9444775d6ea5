"""Root stress under the mesh forces of a running machine."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.strength.columns import DYNAMIC_STRESS_COLUMNS
from facegear.strength.root_stress import RootStress, down_the_fillet


def dynamic_stress_table(
    forces: Mapping[str, NDArray[np.float64]], base_radius: float, roots: Mapping[str, RootStress]
) -> pd.DataFrame:
    """One row a mesh, columns as DYNAMIC_STRESS_COLUMNS.

    forces (n,) N along the line of action by mesh, negative on the back flank, evenly in time; base_radius
    (m) of the pinion. The stress is the largest over the passage with the mesh's mean, and with its largest
    force all the way: a tooth is quasi-static, so the second bounds what it sees in that history.
    """
    rows = []
    for mesh, force in forces.items():
        mean, most = float(np.abs(force).mean()), float(np.abs(force).max())
        torques = [base_radius * value for value in (mean, most)]
        stresses = [_tension(root, torque) for root in roots.values() for torque in torques]
        largest_solved = float(next(iter(roots.values())).torques[-1])
        rows.append(
            (
                *(mesh, mean, most),
                most / mean if mean > 0.0 else np.nan,
                *(1e-6 * stress for stress in stresses),
                torques[1] <= largest_solved,
            )
        )
    return pd.DataFrame(rows, columns=list(DYNAMIC_STRESS_COLUMNS))


def _tension(root: RootStress, torque: float) -> float:
    return float(down_the_fillet(root.at_torque(torque)).max())
