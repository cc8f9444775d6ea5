"""What each mesh of a running machine carries of its group's load, and its largest force."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.load_sharing.groups import load_groups
from facegear.transmission.layout import Layout


def force_table(layout: Layout, mean: Array, largest: Array, motion: str) -> pd.DataFrame:
    """One row a mesh: columns mesh, group, fraction, mean_n, largest_n, motion.

    `mean` and `largest` (M,): mean magnitude over time of each mesh force and its largest, N. fraction
    is the mean over the sum of its group's, empty with the group where the mesh shares with nobody. `motion`:
    class of the motion.
    """
    group, total = np.full(mean.size, "", dtype=object), np.full(mean.size, np.nan)
    for shared in load_groups(layout):
        meshes = list(shared.meshes)
        group[meshes], total[meshes] = shared.name, mean[meshes].sum()
    return pd.DataFrame(
        {
            "mesh": layout.mesh_names,
            "group": group,
            "fraction": np.where(total > 0.0, mean / np.where(total > 0.0, total, 1.0), np.nan),
            "mean_n": mean,
            "largest_n": largest,
            "motion": motion,
        }
    )
