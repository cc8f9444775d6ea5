"""Contact patterns as the machine runs and as assembled, and paths over the load."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.arrays import Arrays
from facegear.plots.contact import pattern_panels
from facegear.plots.style import NARROW, mesh_looks, styled

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
    row = meshes[meshes["mesh"] == name].iloc[0]
    panels = {
        _title("as assembled", row["path_as_assembled_mm"], as_assembled): (as_assembled, torque),
        _title("as the machine runs", row["path_mm"], running): (running, torque),
    }
    figure = pattern_panels(panels)
    figure.suptitle(f"{name} at {torque:.0f} N m", fontsize=9)
    return figure


def _title(words: str, path_mm: float, arrays: Arrays) -> str:
    pressure = 1e-6 * float(np.nanmax(arrays["line_pressure_pa"], initial=0.0))
    return f"{words}: path at {path_mm:.1f} mm, {pressure:.0f} MPa"


def pose_paths(meshes: pd.DataFrame, loads: pd.DataFrame) -> Figure:
    """Where the unloaded contact of every mesh stands along the pinion, and the ends of the face."""
    row = meshes.iloc[0]
    ends = {
        "inner end of the face": row["unloaded_path_mm"] - row["to_inner_end_mm"],
        "outer end of the face": row["unloaded_path_mm"] + row["to_outer_end_mm"],
    }
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 4.6))
        for name, look in mesh_looks(dict.fromkeys(loads["mesh"])).items():
            rows = loads[loads["mesh"] == name]
            axis.plot(100.0 * rows["load_fraction"], rows["unloaded_path_mm"], label=name, **look)
        paths = loads["unloaded_path_mm"]
        for (name, radius), style in zip(ends.items(), (":", "-."), strict=True):
            if paths.min() - NEAR < radius < paths.max() + NEAR:
                axis.axhline(radius, color="0.5", linestyle=style, linewidth=2.0, label=name)
        axis.set_xlabel("Mean torques over the machine's own (%)")
        axis.set_ylabel("Unloaded contact,\nfrom the gear's axis (mm)")
        figure.legend(loc="outside lower center", ncols=2)
    return figure
