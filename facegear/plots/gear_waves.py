"""Damped modes of a machine whose face gears bend, over speed."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from facegear.plots.style import NARROW, legend_above, styled

WORDS = {"standing": "standing waves", "forward": "forward waves", "backward": "backward waves"}
IN_WAVES = 0.25
"""Part of the kinetic energy in the waves of one gear above which a mode is coloured and marked as theirs;
two equal gears may share a mode in halves."""
COLOURS = {"standing": "0.3", "forward": "#D55E00", "backward": "#0072B2"}
MARKERS = {"standing": "o", "forward": "^", "backward": "v"}
"""Of crossings: their area grows with the square of how far the phases of the meshes add up."""
MARK_SIZE = 6.0
PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}


def machine_campbell(campbell: pd.DataFrame, crossings: pd.DataFrame, last_rpm: float, teeth: int) -> Figure:
    """Frequencies of the machine's modes over pinion speed with mesh harmonics.

    Marks: crossings with a mode whose energy is in the waves of a gear, larger where the phases of the meshes
    add up; those that no phase drives have no mark.
    """
    waves = crossings[crossings["energy_fraction"] >= IN_WAVES]
    bending = campbell[campbell["energy_fraction"] >= IN_WAVES]
    top = 1.02 * float((bending if len(bending) else campbell)["frequency_hz"].max())
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 5.0))
        for _, line in campbell.groupby("line"):
            colour = COLOURS[_wave(line)] if line["energy_fraction"].mean() >= IN_WAVES else "0.75"
            axis.plot(line["speed_rpm"], 1e-3 * line["frequency_hz"], color=colour, lw=0.6, alpha=0.7)
        for number, harmonic in enumerate(sorted(set(crossings["harmonic"]) | {1})):
            mesh = harmonic * teeth / 60.0
            axis.plot([0.0, last_rpm], [0.0, 1e-3 * mesh * last_rpm], color="0.5", lw=0.8, ls="--")
            end = min(0.82 * last_rpm, (0.6 + 0.12 * number) * top / mesh)
            axis.annotate(
                f"{harmonic} x mesh",
                (end, 1e-3 * mesh * end),
                (4, -7),
                textcoords="offset points",
                bbox=PAPER,
            )
        mark_crossings(axis, waves)
        frame(axis, last_rpm, top)
        figure.suptitle("Modes of the whole machine", fontsize=9)
        shown = {**COLOURS, "other modes": "0.75"}
        for name, colour in shown.items():
            marker = MARKERS.get(name, "")
            axis.add_line(Line2D([], [], color=colour, marker=marker, ms=5, label=WORDS.get(name, name)))
        legend_above(axis, 2)
    return figure


def mark_crossings(axis: Axes, crossings: pd.DataFrame) -> None:
    """A mark of its wave's colour at every crossing, larger where the phases of the meshes add up."""
    for wave, colour in COLOURS.items():
        marks = crossings[crossings["wave"] == wave]
        size = MARK_SIZE * marks["phase_factor"] ** 2
        look = {"color": colour, "marker": MARKERS[wave], "edgecolor": "white", "linewidths": 0.5}
        axis.scatter(marks["speed_rpm"], 1e-3 * marks["frequency_hz"], size, zorder=3, **look)


def frame(axis: Axes, last_rpm: float, top: float) -> None:
    """Axes of frequencies up to `top` (Hz) over speed."""
    axis.set_xlim(0.0, last_rpm)
    axis.set_ylim(0.0, 1e-3 * top)
    axis.set_xlabel("Speed of the inputs (rpm)")
    axis.set_ylabel("Frequency (kHz)")


def _wave(line: pd.DataFrame) -> str:
    if not line["nodal_diameters"].mode().iloc[0]:
        return "standing"
    return "forward" if np.median(line["forward_fraction"]) >= 0.5 else "backward"


def figures(
    campbell: pd.DataFrame, campbell_crossings: pd.DataFrame, last_rpm: float, teeth: int
) -> tuple[Figure, ...]:
    """Modes of the whole machine over speed."""
    return (machine_campbell(campbell, campbell_crossings, last_rpm, teeth),)
