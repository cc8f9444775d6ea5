"""Fraction of its group's load that each mesh of a running machine carries, and its largest force."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.load_sharing.groups import load_groups
from facegear.transmission.layout import Layout


def force_table(layout: Layout, mean: Array, largest: Array, motion: str) -> pd.DataFrame:
    """Return mean and largest force of each mesh.

    Parameters
    ----------
    layout : Layout
        Bodies and meshes.
    mean : (M,) array
        Mean magnitude over time of each mesh force, N.
    largest : (M,) array
        Largest magnitude of each mesh force, N.
    motion : str
        Class of the motion.

    Returns
    -------
    pd.DataFrame
        One row a mesh: columns mesh, group, fraction, mean_n, largest_n, motion. fraction is the mean over
        the sum of its group's, empty with the group where the mesh shares its load with none.
    """
    group, total = np.full(mean.size, "", dtype=object), np.full(mean.size, np.nan)
    for load_group in load_groups(layout):
        meshes = list(load_group.meshes)
        group[meshes], total[meshes] = load_group.name, mean[meshes].sum()
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
