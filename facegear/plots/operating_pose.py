"""Contact patterns as the machine runs and as assembled, and paths over the load."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.arrays import Arrays
from facegear.plots.contact import pattern_panels
from facegear.plots.style import NARROW, styled

NEAR = 8.0
"""Distance (mm) of a path from an end of the face below which that is drawn."""


def figures(
    meshes: pd.DataFrame, loads: pd.DataFrame, as_assembled: Arrays, running: Arrays
) -> tuple[Figure, ...]:
    """The pattern of the mesh that its pose changes most, and unloaded paths of all meshes over the load."""
    return pose_pattern(meshes, as_assembled, running), pose_paths(meshes, loads)


def pose_pattern(meshes: pd.DataFrame, as_assembled: Arrays, running: Arrays) -> Figure:
    """Two panels: as assembled, and where the machine's forces put the teeth."""
    torque = float(np.unique(running["line_torque_n_m"])[0])
    name = meshes["mesh"].iloc[int(np.argmin(np.abs(meshes["torque_n_m"] - torque)))]
    panels = {
        f"{name} at {torque:.0f} N m, as assembled": (as_assembled, torque),
        f"{name} at {torque:.0f} N m, as the machine runs": (running, torque),
    }
    return pattern_panels(panels)


def pose_paths(meshes: pd.DataFrame, loads: pd.DataFrame) -> Figure:
    """Where the unloaded contact of every mesh stands along the pinion, and the ends of the face."""
    row = meshes.iloc[0]
    ends = {
        "inner end of the face": row["unloaded_path_mm"] - row["to_inner_end_mm"],
        "outer end of the face": row["unloaded_path_mm"] + row["to_outer_end_mm"],
    }
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 4.6))
        for name, rows in loads.groupby("mesh", sort=False):
            axis.plot(100.0 * rows["load_fraction"], rows["unloaded_path_mm"], label=str(name))
        paths = loads["unloaded_path_mm"]
        for (name, radius), style in zip(ends.items(), (":", "--"), strict=True):
            if paths.min() - NEAR < radius < paths.max() + NEAR:
                axis.axhline(radius, color="0.4", linestyle=style, linewidth=1.0, label=name)
        axis.set_xlabel("Mean torques over the machine's own (%)")
        axis.set_ylabel("Unloaded contact, from the gear's axis (mm)")
        figure.legend(loc="outside lower center", ncols=2)
    return figure
