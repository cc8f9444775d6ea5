"""Speed sweeps of several machines in the same axes."""

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.load_sharing import COLOURS
from facegear.plots.style import NARROW, styled
from facegear.plots.sweep import select

LINES = {"up": "-", "down": "--"}


def mesh_sweeps_beside(sweeps: Mapping[str, pd.DataFrame], meshes: Sequence[str]) -> Figure:
    """RMS (without mean) of the deflections of some meshes over speed, a panel for each, a colour a machine.

    `sweeps`: tidy tables of sweeps by label; drawn through: speed rising, dashed: falling.
    """
    with styled():
        size = (NARROW, 1.2 + 1.7 * len(meshes) + 0.2 * len(sweeps))
        figure, axes = plt.subplots(len(meshes), 1, figsize=size, sharex=True, squeeze=False)
        for axis, mesh in zip(axes[:, 0], meshes, strict=True):
            for number, (label, sweep) in enumerate(sweeps.items()):
                for direction in dict.fromkeys(sweep["direction"]):
                    curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                    style = {"color": COLOURS[number % len(COLOURS)], "ls": LINES[direction], "lw": 1}
                    axis.plot(curve["speed_rpm"], curve["value"], label=f"{label}, {direction}", **style)
            axis.set_title(mesh, fontsize=9, loc="left")
            axis.set_ylim(bottom=0)
            axis.set_ylabel("RMS of d (µm)")
        axes[-1, 0].set_xlabel("input rotation speed (rpm)")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=1)
        figure.suptitle("RMS of the displacement along the line of action\nwithout its mean")
    return figure
