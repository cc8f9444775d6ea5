"""Flank charts as measuring rooms draw them: the nominal flank as a flat grid, deviations standing on it."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.number_format import format_number
from facegear.plots.colours import BLUE, RED, grey
from facegear.plots.description import Area, Axis, Curve, Figure, Panel, Text, apart

AXES = {
    "pinion": (("From the middle of the face", "mm"), ("Length of roll", "mm")),
    "face_gear": (("Gear radius", "mm"), ("Depth below the tip plane", "mm")),
}
EXCESS_COLOUR, LACK_COLOUR = RED, BLUE
HEIGHT = 0.14
"""Height of the largest deviation, in parts of the profile."""


def topography_figure(points: pd.DataFrame, body: str) -> Figure:
    """Draw left and right flank of a gear, with the mean of all teeth.

    Parameters
    ----------
    points : pd.DataFrame
        Table `points` of stage topography.
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    Figure
        The figure.
    """
    body_points = points[points["body"] == body]
    largest = float(body_points["deviation_um"].abs().max())
    (across, width_unit), (up, unit) = AXES[body]
    face = body_points["face_mm"]
    margin = 0.2 * np.ptp(face)
    panels = []
    for side, flank in body_points.groupby("flank", sort=False):
        title = f"{body.replace('_', ' ')}, {side} flank: {_range(flank)}"
        panels.append(
            Panel(
                Axis(across, width_unit, low=face.min() - 0.25 * margin, high=face.max() + margin),
                Axis(up, unit, is_falling=body == "face_gear"),
                _chart(flank, largest),
                title=title,
                height=2.1,
            )
        )
    return Figure(panels)


def _chart(flank: pd.DataFrame, largest: float) -> list[Area | Curve | Text]:
    """Grid lines of one flank, lifted by what they deviate."""
    table = flank.pivot_table(index="profile_mm", columns="face_mm", values="deviation_um")
    face, profile, values = table.columns.to_numpy(float), table.index.to_numpy(float), table.to_numpy()
    up = HEIGHT * np.ptp(profile) * (-1.0 if flank["body"].iloc[0] == "face_gear" else 1.0) / (largest or 1.0)
    lifted = profile[:, None] + up * values
    flat = np.broadcast_to(profile[:, None], lifted.shape)
    marks: list[Area | Curve | Text] = [
        Area(*_between(face, flat, flat + up * part), name, colour, opacity=0.4)
        for part, name, colour in (
            (np.maximum(values, 0.0), "material added", EXCESS_COLOUR),
            (np.minimum(values, 0.0), "material missing", LACK_COLOUR),
        )
        if np.nanmax(np.abs(part)) > 0.0
    ]
    bar = _round_below(largest or 1.0)
    beside = face.max() + 0.05 * np.ptp(face)
    ends = profile.mean() + up * bar * np.array([-0.5, 0.5])
    return [
        *marks,
        Curve(*apart(face, flat), "nominal", grey(0.6), width=0.8),
        Curve(*apart(face, lifted), "flank with its deviations", grey(0.25), width=0.7),
        Curve(*apart(np.broadcast_to(face[:, None], lifted.T.shape), lifted.T), colour=grey(0.25), width=0.4),
        Curve(np.array([beside, beside]), ends, width=2.0),
        Text(beside, float(profile.mean()), f"{format_number(bar)} µm", shift=(4.0, 0.0)),
    ]


def _between(face: Array, flat: Array, lifted: Array) -> tuple[Array, Array]:
    """Rings between each flat line and the lifted one, parted by nan."""
    across = np.concatenate([face, face[::-1]])
    return apart(across, np.concatenate([flat, lifted[:, ::-1]], axis=1))


def _round_below(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value))


def _range(flank: pd.DataFrame) -> str:
    values = flank["deviation_um"]
    return f"{format_number(values.min())} to {format_number(values.max())} µm"


def figures(points: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw charts of the pinion and of the face gear.

    Parameters
    ----------
    points : pd.DataFrame
        Table `points` of stage topography.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return topography_figure(points, "pinion"), topography_figure(points, "face_gear")
