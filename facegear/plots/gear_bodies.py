"""Face gears that bend: mode shapes on the section, and frequencies over nodal diameters."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array
from facegear.number_format import format_number
from facegear.plots.colours import grey
from facegear.plots.description import NARROW, Area, Axis, Curve, Faces, Figure, Look, Mark, Panel, apart
from facegear.plots.gear_waves import COLOURS, MARKERS, crossing_marks, frame, mesh_harmonics, wave_key

SWING = 0.08
"""Largest displacement drawn, in the section's radial width."""
COLUMNS = 2


def body_shapes(modes: pd.DataFrame, shapes: Mapping[str, AnyArray]) -> Figure:
    """The first mode of every order up to the last stored, drawn on the section; one gear, as most are alike.

    Grey: at rest; colour: at a crest of the wave, exaggerated; the brighter, the larger the motion, that
    round the axis included.
    """
    gear = str(modes["gear"].iloc[0]) if len(modes) else next(iter(shapes)).rpartition("_")[0]
    nodes, quads = 1e3 * shapes[f"{gear}_nodes"], shapes[f"{gear}_quads"]
    labels = shapes[f"{gear}_labels"]
    wide = np.ptp(nodes[:, 0])
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    left, right = low[0] - 12.0, high[0] + 12.0
    bottom, top = low[1] - 0.12 * wide, high[1] + 0.12 * wide
    across = Axis("From the axis", "mm", low=left, high=right)
    up = Axis("Height", "mm", low=bottom, high=top)
    margin = 0.5 * NARROW - 0.75
    height = margin * (top - bottom) / (right - left)
    panels = []
    for number in np.flatnonzero(labels[:, 1] == 1):
        order = int(labels[number, 0])
        row = modes[(modes["gear"] == gear) & (modes["nodal_diameters"] == order) & (modes["mode"] == 1)]
        marks = _section(nodes, quads, shapes[f"{gear}_shapes"][number])
        title = f"n = {order}, {format_number(row['frequency_hz'].iloc[0], 4)} Hz"
        panels.append(Panel(across, up, marks, title=title, equal=True, height=max(height, 0.7)))
    return Figure(panels, title=f"{gear} face gear, hub held", columns=COLUMNS, shared_y=True)


def _section(nodes: Array, quads: AnyArray, shape: Array) -> list[Area | Faces]:
    """The section at rest, and displaced, exaggerated."""
    swing = SWING * np.ptp(nodes[:, 0]) / np.abs(shape).max()
    displaced_nodes = nodes + swing * shape[:, [0, 2]]
    size = np.linalg.norm(shape, axis=1)[quads].mean(axis=1)
    rings = np.concatenate([nodes[quads], nodes[quads[:, :1]]], axis=1)
    return [
        Area(*apart(rings[..., 0], rings[..., 1]), colour=grey(0.85)),
        Faces(displaced_nodes[quads], size),
    ]


def body_waves(modes: pd.DataFrame) -> Figure:
    """Draw frequencies at rest and of both waves in space over nodal diameters, a panel for each gear.

    Parameters
    ----------
    modes : pd.DataFrame
        Table `modes` of stage gear_bodies.

    Returns
    -------
    Figure
        The figure.
    """
    orders = Axis("Nodal diameters", "", integer=True)
    panels = []
    for gear in modes["gear"].drop_duplicates():
        gear_modes = modes[modes["gear"] == gear]
        waves = gear_modes[gear_modes["nodal_diameters"] > 0]
        rest: Look = {"line": "none", "marker": "line-ew", "size": 9.0}
        marks = [Curve(gear_modes["nodal_diameters"], 1e-3 * gear_modes["frequency_hz"], "at rest", **rest)]
        for name in ("forward", "backward"):
            look: Look = {"line": "none", "marker": MARKERS[name], "size": 3.5}
            values = 1e-3 * waves[f"{name}_hz"]
            marks.append(Curve(waves["nodal_diameters"], values, name, COLOURS[name], **look))
        frequency = Axis("Frequency", "kHz", low=0.0)
        panels.append(Panel(orders, frequency, marks, title=f"{gear} face gear", height=2.3))
    return Figure(panels or [Panel(orders, Axis("Frequency", "kHz"), [])])


def body_campbell(modes: pd.DataFrame, crossings: pd.DataFrame, last_rpm: float, teeth: int) -> Figure:
    """Draw waves over pinion speed as meshes meet them, with mesh harmonics; one gear, as most are alike.

    Marks: crossings with a mesh harmonic, larger where the phases of the meshes add up.

    Parameters
    ----------
    modes : pd.DataFrame
        Table `modes` of stage gear_bodies.
    crossings : pd.DataFrame
        Table `crossings` of stage gear_bodies.
    last_rpm : float
        Last speed of the pinions, rpm.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    Figure
        The figure.
    """
    gear = modes["gear"].iloc[0] if len(modes) else ""
    gear_modes, gear_crossings = modes[modes["gear"] == gear], crossings[crossings["gear"] == gear]
    top = 1.02 * gear_modes["frequency_hz"].max() if len(gear_modes) else 1.0
    speeds = np.linspace(0.0, last_rpm, 60)
    marks: list[Mark] = []
    kinds = set()
    for row in gear_modes.itertuples():
        shift = (row.forward_hz - row.backward_hz) / 2.0
        for sign, kind in (
            ((1.0, "forward"), (-1.0, "backward")) if row.nodal_diameters else ((1.0, "standing"),)
        ):
            bend = (row.forward_hz + row.backward_hz) / 2.0
            curve = _wave(row.frequency_hz, bend, sign * shift, row.speed_rpm, speeds)
            marks.append(Curve(speeds, 1e-3 * curve, colour=COLOURS[kind], width=0.6, opacity=0.7))
            kinds.add(kind)
    marks += mesh_harmonics(gear_crossings["harmonic"], last_rpm, top, teeth)
    marks += crossing_marks(gear_crossings)
    keys = [wave_key(kind) for kind in COLOURS if kind in kinds]
    return Figure([frame(marks, last_rpm, top)], title=f"{gear} face gear, hub held", keys=keys)


def _wave(frequency: float, middle: float, shift: float, at: float, speeds: Array) -> Array:
    """A wave's frequency over speed: its middle's square and its shift grow with the speed squared and with
    the speed, from their values at the speed `at`.
    """
    over = speeds / at
    return np.asarray(
        np.sqrt(np.maximum(frequency**2 + (middle**2 - frequency**2) * over**2, 0.0)) + shift * over
    )


def figures(
    modes: pd.DataFrame,
    crossings: pd.DataFrame,
    shapes: Mapping[str, AnyArray],
    last_rpm: float,
    teeth: int,
) -> tuple[Figure, ...]:
    """Draw mode shapes on the section, waves over nodal diameters, and over speed.

    Parameters
    ----------
    modes : pd.DataFrame
        Table `modes` of stage gear_bodies.
    crossings : pd.DataFrame
        Table `crossings` of stage gear_bodies.
    shapes : Mapping[str, AnyArray]
        Arrays of stage gear_bodies (see `facegear.gear_body.tables.shape_arrays`).
    last_rpm : float
        Last speed of the pinions, rpm.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    campbell = body_campbell(modes, crossings, last_rpm, teeth)
    return body_shapes(modes, shapes), body_waves(modes), campbell
