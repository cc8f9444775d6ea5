"""Root stress of both gears: over a tooth's passage through the mesh, and along the face."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, legend_above, styled

PART_SHOWN = 0.02
"""Of the largest stress: the passage is drawn where more is felt."""
BODIES = {"pinion": "Pinion", "face_gear": "Face gear"}


def passage(table: pd.DataFrame) -> Figure:
    """Largest tension below the loaded flank, and largest compression below the other, for each torque."""
    felt = table[["largest_mpa", "smallest_mpa"]].abs().max(axis=1)
    places = table.loc[felt > PART_SHOWN * felt.max(), "passage"]
    shown = table[table["passage"].between(places.min() - 0.25, places.max() + 0.25)]
    return _both(shown, "passage", "Passage of a tooth (pitches)")


def along_face(table: pd.DataFrame) -> Figure:
    """The same along the face: the largest over the passage."""
    return _both(table, "radius_mm", "Gear radius (mm)")


def _both(table: pd.DataFrame, place: str, label: str) -> Figure:
    torques = np.sort(table["torque_n_m"].unique())
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, torques.size))
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 6.2), sharex=place == "passage")
        for axis, (body, name) in zip(axes, BODIES.items(), strict=True):
            for torque, colour in zip(torques, colours, strict=True):
                rows = table[(table["torque_n_m"] == torque) & (table["body"] == body)]
                loaded, other = (
                    rows[rows["fillet"] == fillet].sort_values(place) for fillet in ("loaded", "other")
                )
                axis.plot(loaded[place], loaded["largest_mpa"], color=colour, label=f"{torque:g} N m")
                axis.plot(other[place], other["smallest_mpa"], "--", color=colour, lw=0.9)
            axis.set(ylabel=f"{name}: root stress (MPa)\ntension solid, compression dashed")
        legend_above(axes[0], 3)
        for axis in axes if place != "passage" else axes[1:]:
            axis.set_xlabel(label)
    return figure


def life(damage: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Stress and cycles of every bin of a duty cycle, and the stress that may be repeated so often."""
    colours = {"pinion": "tab:blue", "face_gear": "tab:orange"}
    lines = {"finite elements": "-", "ISO 6336-3": "--", "ISO 6336-2": "-"}
    marks = {"pinion": "o", "face_gear": "s"}
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 7.4))
        for axis, failure in zip(axes, ("bending", "pitting"), strict=True):
            for (body, method), curve in curves[curves["failure"] == failure].groupby(
                ["body", "method"], sort=False
            ):
                bins = damage[
                    (damage["failure"] == failure) & (damage["body"] == body) & (damage["method"] == method)
                ]
                bins = bins[bins["cycles"] > 0]
                look = {"color": colours[body]}
                axis.loglog(curve["cycles"], curve["allowed_mpa"], lines[method], lw=1.2, **look)
                label = f"{BODIES[body]}, {method}"
                axis.loglog(
                    bins["cycles"],
                    bins["stress_mpa"],
                    "x" if method == "ISO 6336-3" else marks[body],
                    ls="none",
                    label=label,
                    **look,
                )
            stress = "Root stress" if failure == "bending" else "Contact stress"
            axis.set(xlabel="Load cycles", ylabel=f"{stress} (MPa)\nlines: allowed, marks: bins")
            axis.yaxis.set_major_formatter("{x:g}")
            axis.yaxis.set_minor_formatter("{x:g}")
            axis.tick_params(axis="y", which="minor", labelsize=7)
            legend_above(axis, 1)
    return figure
