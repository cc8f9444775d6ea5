"""Speed sweeps of several machines in the same axes."""

from collections.abc import Mapping, Sequence

import pandas as pd

from facegear.plots.colours import colour_of
from facegear.plots.description import Curve, Figure, LineStyle, Look, Panel
from facegear.plots.sweep import RMS_HEIGHT, rms_axis, select, speed_axis

LINES: Mapping[str, LineStyle] = {"up": "solid", "down": "dash"}


def mesh_sweeps_beside(sweeps: Mapping[str, pd.DataFrame], meshes: Sequence[str]) -> Figure:
    """RMS (without mean) of the deflections of some meshes over speed, a panel for each, a colour a machine.

    `sweeps`: tidy tables of sweeps by label; drawn through: speed rising, dashed: falling.
    """
    speeds = speed_axis(pd.concat([sweep[["speed_rpm"]] for sweep in sweeps.values()]))
    panels = []
    for mesh in meshes:
        curves = []
        for number, (label, sweep) in enumerate(sweeps.items()):
            for direction in dict.fromkeys(sweep["direction"]):
                curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                look: Look = {
                    "colour": colour_of(number),
                    "line": LINES[direction],
                    "width": 1.0,
                }
                curves.append(Curve(curve["speed_rpm"], curve["value"], f"{label}, {direction}", **look))
        panels.append(Panel(speeds, rms_axis(), curves, title=mesh, height=RMS_HEIGHT))
    return Figure(panels, title="RMS of the deflection d along the line of action without its mean")
