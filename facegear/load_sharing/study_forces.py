"""What each mesh of a running machine carries of its group's load, and its largest force."""

import numpy as np
import pandas as pd

from facegear.load_sharing.groups import load_groups
from facegear.transmission.layout import Layout


def force_rows(layout: Layout, summary: pd.DataFrame) -> pd.DataFrame:
    """One row a mesh: columns mesh, group, fraction, mean_n, largest_n, motion.

    summary: quantities of a response by mesh, of `summary_of_response`. mean_n is the mean magnitude over
    time, fraction that over the sum of its group's, empty with the group where the mesh shares with nobody.
    """
    forces = summary.pivot(index="body_or_mesh", columns="quantity", values="value").loc[
        list(layout.mesh_names)
    ]
    mean = forces["mean_elastic_force_magnitude_n"].to_numpy(dtype=float)
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
            "largest_n": forces["largest_elastic_force_n"].to_numpy(dtype=float),
            "motion": summary["class"].iloc[0],
        }
    )
