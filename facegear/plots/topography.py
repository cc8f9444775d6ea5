"""Flank charts as measuring rooms draw them: the nominal flank as a flat grid, deviations standing on it."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, styled

AXES = {
    "pinion": ("From the middle of the face (mm)", "Length of roll (mm)"),
    "face_gear": ("Gear radius (mm)", "Depth below the tip plane (mm)"),
}
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
        axes[0].plot([], [], color="0.6", lw=0.8, label="nominal")
        axes[0].plot([], [], color="C3", lw=1.0, label="material added")
        axes[0].plot([], [], color="C0", lw=1.0, label="material missing")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
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
        axis.fill_between(face, at, lifted[row], where=values[row] >= 0, color="C3", alpha=0.35, lw=0)
        axis.fill_between(face, at, lifted[row], where=values[row] <= 0, color="C0", alpha=0.35, lw=0)
    for column, at in enumerate(face):
        axis.plot(np.full(profile.size, at), lifted[:, column], color="0.25", lw=0.4)
    axis.grid(visible=False)


def _range(flank: pd.DataFrame) -> str:
    values = flank["deviation_um"]
    return f"{values.min():+.1f} to {values.max():+.1f} um"


def figures(points: pd.DataFrame) -> tuple[Figure, ...]:
    """Charts of the pinion and of the face gear."""
    return topography_figure(points, "pinion"), topography_figure(points, "face_gear")
