"""Face gears that bend: mode shapes on the section, and frequencies over nodal diameters."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from facegear.arrays import AnyArray, Array
from facegear.plots.gear_waves import COLOURS, MARKERS, PAPER, WORDS, frame, mark_crossings
from facegear.plots.style import NARROW, legend_above, styled

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
    first = np.flatnonzero(labels[:, 1] == 1)
    rows = -(-max(first.size, 1) // COLUMNS)
    with styled():
        figure, axes = plt.subplots(
            rows, COLUMNS, figsize=(NARROW, 0.8 + 1.25 * rows), sharex=True, sharey=True, squeeze=False
        )
        for axis in axes.ravel()[first.size :]:
            axis.set_visible(False)
        for axis, number in zip(axes.ravel(), first, strict=False):
            order = int(labels[number, 0])
            row = modes[(modes["gear"] == gear) & (modes["nodal_diameters"] == order) & (modes["mode"] == 1)]
            _draw(axis, nodes, quads, shapes[f"{gear}_shapes"][number])
            axis.set_title(f"n = {order}, {row['frequency_hz'].iloc[0]:.1f} Hz", fontsize=9, loc="left")
        if first.size % COLUMNS and rows > 1:
            axes[-2, -1].tick_params(labelbottom=True)
        figure.supxlabel("Distance from the axis (mm)", fontsize=9)
        figure.supylabel("Height (mm)", fontsize=9)
        figure.suptitle(f"{gear} face gear, hub held", fontsize=9)
    return figure


def _draw(axis: Axes, nodes: Array, quads: AnyArray, shape: Array) -> None:
    """The section at rest in outline and displaced, exaggerated."""
    in_plane = shape[:, [0, 2]]
    swing = SWING * np.ptp(nodes[:, 0]) / np.abs(shape).max()
    moved = nodes + swing * in_plane
    size = np.linalg.norm(shape, axis=1)[quads].mean(axis=1)
    axis.add_collection(PolyCollection(nodes[quads], facecolors="0.85", edgecolors="0.85", linewidths=0.3))
    axis.add_collection(
        PolyCollection(moved[quads], array=size, cmap="viridis", edgecolors="face", linewidths=0.3)
    )
    axis.set_xlim(nodes[:, 0].min() - 12.0, nodes[:, 0].max() + 12.0)
    low, high = nodes[:, 1].min(), nodes[:, 1].max()
    axis.set_ylim(low - 0.12 * np.ptp(nodes[:, 0]), high + 0.12 * np.ptp(nodes[:, 0]))
    axis.set_aspect("equal")


def body_waves(modes: pd.DataFrame) -> Figure:
    """Frequencies at rest and of both waves in space over nodal diameters, a panel for each gear."""
    gears = list(modes["gear"].drop_duplicates())
    with styled():
        figure, axes = plt.subplots(
            max(len(gears), 1),
            1,
            figsize=(NARROW, 0.5 + 3.1 * max(len(gears), 1)),
            sharex=True,
            squeeze=False,
        )
        for axis, gear in zip(axes[:, 0], gears, strict=False):
            own = modes[modes["gear"] == gear]
            waves = own[own["nodal_diameters"] > 0]
            order = own["nodal_diameters"]
            axis.plot(order, 1e-3 * own["frequency_hz"], "_", color="black", ms=9, label="at rest")
            for name, marker, colour in (("forward", "^", "#D55E00"), ("backward", "v", "#0072B2")):
                values = 1e-3 * waves[f"{name}_hz"]
                axis.plot(waves["nodal_diameters"], values, marker, color=colour, ms=3.5, label=name)
            axis.set_ylabel("Frequency (kHz)")
            axis.set_title(f"{gear} face gear", fontsize=9, loc="right")
            axis.set_ylim(bottom=0.0)
            legend_above(axis, 3)
        axes[-1, 0].set_xlabel("Nodal diameters")
        axes[-1, 0].xaxis.set_major_locator(MaxNLocator(integer=True))
    return figure


def body_campbell(modes: pd.DataFrame, crossings: pd.DataFrame, last_rpm: float, teeth: int) -> Figure:
    """Waves over pinion speed as meshes meet them, with mesh harmonics; one gear, as most are alike.

    Marks: crossings with a mesh harmonic, larger where the phases of the meshes add up.
    """
    gear = modes["gear"].iloc[0] if len(modes) else ""
    own, met = modes[modes["gear"] == gear], crossings[crossings["gear"] == gear]
    top = 1.02 * own["frequency_hz"].max() if len(own) else 1.0
    speeds = np.linspace(0.0, last_rpm, 60)
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 5.0))
        for row in own.itertuples():
            shift = (row.forward_hz - row.backward_hz) / 2.0
            colours = ("#D55E00", "#0072B2") if row.nodal_diameters else ("0.3",)
            for sign, colour in zip((1.0, -1.0), colours, strict=False):
                bend = (row.forward_hz + row.backward_hz) / 2.0
                curve = _wave(row.frequency_hz, bend, sign * shift, row.speed_rpm, speeds)
                axis.plot(speeds, 1e-3 * curve, color=colour, lw=0.6, alpha=0.7)
        for number, harmonic in enumerate(sorted(set(met["harmonic"]) | {1})):
            axis.plot(speeds, 1e-3 * harmonic * teeth * speeds / 60.0, color="0.6", lw=0.8)
            end = min(0.82 * last_rpm, 60.0 * (0.5 + 0.1 * number) * top / (harmonic * teeth))
            height = 1e-3 * harmonic * teeth * end / 60.0
            axis.annotate(
                f"{harmonic} x mesh", (end, height), (4, -7), textcoords="offset points", bbox=PAPER
            )
        mark_crossings(axis, met)
        frame(axis, last_rpm, top)
        for wave, colour in COLOURS.items():
            axis.add_line(Line2D([], [], color=colour, marker=MARKERS[wave], ms=5, label=WORDS[wave]))
        figure.suptitle(f"{gear} face gear, hub held", fontsize=9)
        legend_above(axis, 2)
    return figure


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
    """Mode shapes on the section, waves over nodal diameters, and over speed."""
    campbell = body_campbell(modes, crossings, last_rpm, teeth)
    return body_shapes(modes, shapes), body_waves(modes), campbell
