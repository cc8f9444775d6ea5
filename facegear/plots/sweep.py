"""Figures 10 to 12: RMS over speed."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.style import styled

DIRECTION_STYLES = {"up": ("tab:red", "-"), "down": ("tab:blue", "--")}
AXIS_STYLES = {"x": ("tab:red", "-"), "y": ("tab:blue", "--"), "z": ("tab:green", ":")}


def select(sweep: pd.DataFrame, direction: str, quantity: str, item: str) -> pd.DataFrame:
    """Rows of one curve, ordered by speed."""
    rows = sweep[
        (sweep["direction"] == direction) & (sweep["quantity"] == quantity) & (sweep["body_or_mesh"] == item)
    ]
    return rows.sort_values("speed_rpm")


def translations(sweep: pd.DataFrame, bodies: Sequence[str], letters: str) -> Figure:
    """Figures 10 and 11: RMS (without mean) of translations, one panel for each body, first direction
    only.
    """
    direction = sweep["direction"].iloc[0]
    with styled():
        figure, axes = plt.subplots(
            len(bodies), 1, figsize=(7, 2.5 * len(bodies)), sharex=True, squeeze=False
        )
        for axis, body in zip(axes[:, 0], bodies, strict=True):
            for letter in letters:
                curve = select(sweep, direction, f"{letter}_ac_rms_um", body)
                colour, line = AXIS_STYLES[letter]
                axis.plot(
                    curve["speed_rpm"], curve["value"], line, color=colour, lw=1, label=f"{letter} direction"
                )
            axis.set_title(body, fontsize=9)
            axis.set_ylabel("RMS (µm)")
            axis.set_ylim(bottom=0)
        axes[0, 0].legend(fontsize=8)
        axes[-1, 0].set_xlabel("input rotation speed (rpm)")
        figure.suptitle(f"RMS of translational displacements without their mean, sweep {direction}")
    return figure


def mesh_sweeps(
    sweep: pd.DataFrame, jumps: pd.DataFrame, pinions: Sequence[str], sides: Sequence[str]
) -> Figure:
    """Figure 12: RMS (without mean) of mesh deflections up and down, a row for each gear; jumps marked."""
    with styled():
        figure, axes = plt.subplots(
            len(sides),
            len(pinions),
            figsize=(max(6.8, 3.8 * len(pinions)), 3.0 * len(sides)),
            sharex=True,
            squeeze=False,
        )
        for row, side in zip(axes, sides, strict=True):
            for axis, pinion in zip(row, pinions, strict=True):
                mesh = f"{pinion}/{side}"
                for direction, (colour, line) in DIRECTION_STYLES.items():
                    curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                    axis.plot(curve["speed_rpm"], curve["value"], line, color=colour, lw=1, label=direction)
                mark_jumps(axis, jumps)
                axis.set_title(f"{pinion} and {side} face gear", fontsize=9)
                axis.set_ylim(bottom=0)
            row[0].set_ylabel("RMS of d (µm)")
        for axis in axes[-1]:
            axis.set_xlabel("input rotation speed (rpm)")
        axes[0, 0].legend(fontsize=8, title="sweep", title_fontsize=8)
        figure.suptitle("RMS of the displacement along the line of action without its mean; ticks: jumps")
    return figure


def mark_jumps(axis: Axes, jumps: pd.DataFrame) -> None:
    """Short ticks on the speed axis where the response jumps, in the direction's colour."""
    for jump in jumps.itertuples():
        colour, _ = DIRECTION_STYLES[jump.direction]
        axis.axvline(jump.speed_after_rpm, ymax=0.04, color=colour, lw=1.2)
