"""Contact patterns as the machine runs and as assembled, and paths over the load."""

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.number_format import format_number
from facegear.plots.colours import mesh_looks
from facegear.plots.contact import pattern_panels
from facegear.plots.description import Axis, Curve, Figure, Line, LineStyle, Look, Panel

NEAR = 8.0
"""Distance (mm) of a path from an end of the face below which that is drawn."""


def figures(
    meshes: pd.DataFrame, loads: pd.DataFrame, as_assembled: Arrays, running: Arrays
) -> tuple[Figure, ...]:
    """Draw the pattern of the mesh that its pose changes most, and unloaded paths of all meshes over the
    load.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage operating_pose.
    loads : pd.DataFrame
        Table `loads` of stage operating_pose.
    as_assembled : Arrays
        Arrays `as_assembled` of stage operating_pose.
    running : Arrays
        Arrays `running` of stage operating_pose.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return pose_pattern(meshes, as_assembled, running), pose_paths(meshes, loads)


def pose_pattern(meshes: pd.DataFrame, as_assembled: Arrays, running: Arrays) -> Figure:
    """Draw two panels of the contact pattern: as assembled, and at the pose under the machine's forces.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage operating_pose.
    as_assembled : Arrays
        Arrays `as_assembled` of stage operating_pose.
    running : Arrays
        Arrays `running` of stage operating_pose.

    Returns
    -------
    Figure
        The figure.
    """
    torque = float(np.unique(running["line_torque_n_m"])[0])
    name = meshes["mesh"].iloc[int(np.argmin(np.abs(meshes["torque_n_m"] - torque)))]
    row = meshes[meshes["mesh"] == name].iloc[0]
    panels = {
        _title("as assembled", row["path_as_assembled_mm"], as_assembled): (as_assembled, torque),
        _title("as the machine runs", row["path_mm"], running): (running, torque),
    }
    return pattern_panels(panels, title=f"{name} at {format_number(torque)} N m")


def _title(words: str, path_mm: float, arrays: Arrays) -> str:
    pressure = 1e-6 * float(np.nanmax(arrays["line_pressure_pa"], initial=0.0))
    return f"{words}: path at {format_number(path_mm, 4)} mm, {format_number(pressure)} MPa"


def pose_paths(meshes: pd.DataFrame, loads: pd.DataFrame) -> Figure:
    """Draw the unloaded contact of every mesh along the pinion, and the ends of the face.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage operating_pose.
    loads : pd.DataFrame
        Table `loads` of stage operating_pose.

    Returns
    -------
    Figure
        The figure.
    """
    row = meshes.iloc[0]
    ends: Look = {
        "inner end of the face": row["unloaded_path_mm"] - row["to_inner_end_mm"],
        "outer end of the face": row["unloaded_path_mm"] + row["to_outer_end_mm"],
    }
    marks: list[Curve | Line] = []
    for name, look in mesh_looks(dict.fromkeys(loads["mesh"])).items():
        rows = loads[loads["mesh"] == name]
        marks.append(Curve(100.0 * rows["load_fraction"], rows["unloaded_path_mm"], name, **look))
    paths = loads["unloaded_path_mm"]
    styles: tuple[LineStyle, ...] = ("dot", "dashdot")
    for (name, radius), line in zip(ends.items(), styles, strict=True):
        if paths.min() - NEAR < radius < paths.max() + NEAR:
            marks.append(Line(radius, "y", name, line=line, width=2.0))
    across = Axis("Mean torques over the machine's own", "%")
    up = Axis("Unloaded contact,\nfrom the gear's axis", "mm")
    return Figure([Panel(across, up, marks, height=2.9)])
