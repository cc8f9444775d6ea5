"""RMS over speed."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.dynamics.sweeps.jump_kinds import JumpKind
from facegear.plots.style import NARROW, styled

DIRECTION_STYLES = {"up": ("tab:red", "-"), "down": ("tab:blue", "--")}
AXIS_STYLES = {"x": ("tab:red", "-"), "y": ("tab:blue", "--"), "z": ("tab:green", ":")}


def select(sweep: pd.DataFrame, direction: str, quantity: str, item: str) -> pd.DataFrame:
    """Rows of one curve, ordered by speed."""
    rows = sweep[
        (sweep["direction"] == direction) & (sweep["quantity"] == quantity) & (sweep["body_or_mesh"] == item)
    ]
    return rows.sort_values("speed_rpm")


def translations(sweep: pd.DataFrame, bodies: Sequence[str], letters: str) -> Figure:
    """RMS (without mean) of translations, one panel for each body, first direction
    only.
    """
    direction = sweep["direction"].iloc[0]
    with styled():
        figure, axes = plt.subplots(
            len(bodies), 1, figsize=(NARROW, 1.0 + 1.9 * len(bodies)), sharex=True, squeeze=False
        )
        for axis, body in zip(axes[:, 0], bodies, strict=True):
            for letter in letters:
                curve = select(sweep, direction, f"{letter}_ac_rms_um", body)
                colour, line = AXIS_STYLES[letter]
                axis.plot(
                    curve["speed_rpm"], curve["value"], line, color=colour, lw=1, label=f"{letter} direction"
                )
            axis.set_title(body, fontsize=9, loc="left")
            axis.set_ylabel("RMS (µm)")
            axis.set_ylim(bottom=0)
        handles = axes[0, 0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside lower center", ncols=3)
        axes[-1, 0].set_xlabel("input rotation speed (rpm)")
        figure.suptitle(f"RMS of translations without their mean, sweep {direction}", fontsize=9)
    return figure


def mesh_sweeps(
    sweep: pd.DataFrame, jumps: pd.DataFrame, pinions: Sequence[str], sides: Sequence[str]
) -> Figure:
    """RMS (without mean) of mesh deflections up and down, a panel for each mesh; jumps are marked, and where
    irregular motion begins or ends.
    """
    with styled():
        rows = [(pinion, side) for side in sides for pinion in pinions]
        figure, axes = plt.subplots(
            len(rows), 1, figsize=(NARROW, 1.2 + 1.7 * len(rows)), sharex=True, squeeze=False
        )
        for axis, (pinion, side) in zip(axes[:, 0], rows, strict=True):
            for direction, (colour, line) in DIRECTION_STYLES.items():
                curve = select(sweep, direction, "deflection_ac_rms_um", f"{pinion}/{side}")
                axis.plot(curve["speed_rpm"], curve["value"], line, color=colour, lw=1, label=direction)
            mark_jumps(axis, jumps)
            axis.set_title(f"{pinion} and {side} face gear", fontsize=9, loc="left")
            axis.set_ylim(bottom=0)
            axis.set_ylabel("RMS of d (µm)")
        axes[-1, 0].set_xlabel("input rotation speed (rpm)")
        handles = axes[0, 0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside lower center", ncols=2, title="sweep")
        figure.suptitle(
            "RMS of the displacement along the line of action without its mean\n"
            "ticks: jumps; dotted: irregular motion begins or ends",
            fontsize=9,
        )
    return figure


def mark_jumps(axis: Axes, jumps: pd.DataFrame) -> None:
    """Short ticks on the speed axis where the response jumps, in the direction's colour; dotted ones where
    irregular motion begins or ends.
    """
    for jump in jumps.itertuples():
        colour, _ = DIRECTION_STYLES[jump.direction]
        irregular = jump.kind == JumpKind.IRREGULAR
        style = {"ymax": 0.12, "lw": 1.2, "ls": ":"} if irregular else {"ymax": 0.04, "lw": 1.2}
        axis.axvline(jump.speed_after_rpm, color=colour, **style)
