"""Root stress, pressure and dynamic factor over speed, of every motion known at a speed."""

import pandas as pd

from facegear.plots.colours import grey
from facegear.plots.description import Axis, Curve, Figure, Line, Look, Panel, Span
from facegear.plots.sweep import DIRECTION_STYLES

PANELS = {
    "face_gear_mpa": ("Face gear:\nroot stress", "MPa"),
    "pinion_mpa": ("Pinion:\nroot stress", "MPa"),
    "pressure_mpa": ("Pressure", "MPa"),
    "dynamic_factor": ("Dynamic factor", ""),
}
BRANCH: Look = {"colour": grey(0.6), "line": "none", "marker": "dot", "size": 3.0}
BEYOND = "beyond the torques of the contact analysis"


def stress_over_speed(table: pd.DataFrame, speed_rpm: float) -> Figure:
    """Largest values of all meshes: the sweep's as lines, stable branches as dots beneath.

    The operating speed is a line; what lies beyond the torques of the contact analysis is shaded.
    """
    branch_rows = table[table["motion"].str.startswith("branch ")]
    rows_within_torques = table[table["within_torques_solved"]]
    speed = Axis("Input speed", "rpm")
    panels = []
    for column, (name, unit) in PANELS.items():
        marks: list[Curve | Line | Span] = []
        if len(branch_rows):
            marks.append(Curve(branch_rows["speed_rpm"], branch_rows[column], "stable branch", **BRANCH))
        for direction, (colour, line) in DIRECTION_STYLES.items():
            rows = table[table["motion"] == f"sweep {direction}"]
            if len(rows):
                name_of = f"sweep {direction}"
                marks.append(Curve(rows["speed_rpm"], rows[column], name_of, colour, line, width=1.0))
        marks.append(Line(speed_rpm, name="nominal speed", colour=grey(0.3), line="dot"))
        top = 1.05 * float(table[column].max())
        if len(rows_within_torques) < len(table):
            first = float(rows_within_torques[column].max()) if len(rows_within_torques) else 0.0
            marks.append(Span(first, top, "y", name=BEYOND, opacity=0.12))
        panels.append(Panel(speed, Axis(name, unit, low=0.0, high=top), marks, height=1.5))
    return Figure(panels)


def figures(table: pd.DataFrame, speed_rpm: float) -> tuple[Figure, ...]:
    """Root stress, pressure and dynamic factor over speed."""
    return (stress_over_speed(table, speed_rpm),)
