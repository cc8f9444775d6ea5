"""Flank charts as measuring rooms draw them: the nominal flank as a flat grid, deviations standing on it."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from facegear.plots.style import NARROW, styled

AXES = {
    "pinion": ("From the middle of the face (mm)", "Length of roll (mm)"),
    "face_gear": ("Gear radius (mm)", "Depth below the tip plane (mm)"),
}
ADDED, MISSING = "#D55E00", "#0072B2"
HEIGHT = 0.14
"""Height of the largest deviation, in parts of the profile."""


def topography_figure(points: pd.DataFrame, body: str) -> Figure:
    """Left and right flank of a gear, of `points` of stage topography; the mean of all teeth."""
    own = points[points["body"] == body]
    largest = float(own["deviation_um"].abs().max())
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 6.0), sharex=True)
        for axis, (side, flank) in zip(axes, own.groupby("flank", sort=False), strict=True):
            _chart(axis, flank, largest)
            axis.set_title(f"{body.replace('_', ' ')}, {side} flank: {_range(flank)}")
            axis.set_ylabel(AXES[body][1])
            if body == "face_gear":
                axis.invert_yaxis()
        axes[-1].set_xlabel(AXES[body][0])
        handles = [
            Line2D([], [], color="0.6", lw=0.8, label="nominal"),
            Patch(color=ADDED, alpha=0.4, label="material added"),
            Patch(color=MISSING, alpha=0.4, label="material missing"),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _chart(axis: Axes, flank: pd.DataFrame, largest: float) -> None:
    """Grid lines of one flank, lifted by what they deviate; dots where they stand on the nominal flank."""
    table = flank.pivot_table(index="profile_mm", columns="face_mm", values="deviation_um")
    face, profile, values = table.columns.to_numpy(), table.index.to_numpy(), table.to_numpy()
    up = HEIGHT * np.ptp(profile) * (-1.0 if flank["body"].iloc[0] == "face_gear" else 1.0)
    lifted = profile[:, None] + up * values / (largest or 1.0)
    for row, at in enumerate(profile):
        axis.plot(face, np.full(face.size, at), color="0.6", lw=0.8)
        axis.plot(face, lifted[row], color="0.25", lw=0.7)
        axis.fill_between(face, at, lifted[row], where=values[row] >= 0, color=ADDED, alpha=0.4, lw=0)
        axis.fill_between(face, at, lifted[row], where=values[row] <= 0, color=MISSING, alpha=0.4, lw=0)
    for column, at in enumerate(face):
        axis.plot(np.full(profile.size, at), lifted[:, column], color="0.25", lw=0.4)
    axis.grid(visible=False)
    bar = _round_below(largest or 1.0)
    beside = face.max() + 0.05 * np.ptp(face)
    foot = profile.mean() - 0.5 * up * bar / (largest or 1.0)
    axis.plot([beside] * 2, [foot, foot + up * bar / (largest or 1.0)], color="k", lw=2.0, clip_on=False)
    axis.annotate(f"{bar:g} µm", (beside, profile.mean()), (4, 0), textcoords="offset points", va="center")


def _round_below(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value))


def _range(flank: pd.DataFrame) -> str:
    values = flank["deviation_um"]
    return f"{values.min():+.1f} to {values.max():+.1f} µm"


def figures(points: pd.DataFrame) -> tuple[Figure, ...]:
    """Charts of the pinion and of the face gear."""
    return topography_figure(points, "pinion"), topography_figure(points, "face_gear")
