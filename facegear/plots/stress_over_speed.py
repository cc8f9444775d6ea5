"""Root stress, pressure and dynamic factor over speed, of every motion known at a speed."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from facegear.plots.style import NARROW, styled
from facegear.plots.sweep import DIRECTION_STYLES

PANELS = {
    "face_gear_mpa": "Face gear:\nroot stress (MPa)",
    "pinion_mpa": "Pinion:\nroot stress (MPa)",
    "pressure_mpa": "Pressure (MPa)",
    "dynamic_factor": "Dynamic factor",
}


def stress_over_speed(table: pd.DataFrame, speed_rpm: float) -> Figure:
    """Largest values of all meshes: the sweep's as lines, stable branches as dots beneath.

    The operating speed is a line; what lies beyond the torques of the contact analysis is shaded.
    """
    followed = table[table["motion"].str.startswith("branch ")]
    solved = table[table["within_torques_solved"]]
    with styled():
        figure, axes = plt.subplots(len(PANELS), 1, figsize=(NARROW, 7.6), sharex=True)
        for axis, (column, label) in zip(axes, PANELS.items(), strict=True):
            if len(followed):
                axis.plot(
                    followed["speed_rpm"], followed[column], ".", color="0.6", ms=3, label="stable branch"
                )
            for direction, (colour, line) in DIRECTION_STYLES.items():
                rows = table[table["motion"] == f"sweep {direction}"]
                axis.plot(
                    rows["speed_rpm"], rows[column], line, color=colour, lw=1, label=f"sweep {direction}"
                )
            axis.axvline(speed_rpm, color="0.3", lw=0.8, ls=":")
            axis.set_ylabel(label)
            axis.set_ylim(bottom=0)
            if len(solved) < len(table):
                first = solved[column].max() if len(solved) else 0.0
                axis.axhspan(first, axis.get_ylim()[1], color="0.5", alpha=0.12, lw=0)
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
        axes[-1].xaxis.set_major_locator(MaxNLocator(5))
        axes[-1].set_xlabel("Input rotation speed (rpm)")
    return figure


def figures(table: pd.DataFrame, speed_rpm: float) -> tuple[Figure, ...]:
    """Root stress, pressure and dynamic factor over speed."""
    return (stress_over_speed(table, speed_rpm),)
