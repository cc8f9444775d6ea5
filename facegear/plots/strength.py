"""Root stress over a tooth's passage and along the face; stress, cycles and damage of a duty cycle."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from facegear.plots.style import NARROW, legend_above, styled

PART_SHOWN = 0.02
"""Of the largest stress: the passage is drawn where more is felt."""
BODIES = {"pinion": "Pinion", "face_gear": "Face gear"}
COLOURS = {"pinion": "tab:blue", "face_gear": "tab:orange"}
LINES = {"finite elements": "-", "ISO 6336-3": "--", "contact analysis": "-", "ISO 6336-2": "--"}
MARKS = {"finite elements": "o", "ISO 6336-3": "x", "contact analysis": "s", "ISO 6336-2": "^"}


def passage_figure(table: pd.DataFrame) -> Figure:
    """Largest tension below the loaded flank, and largest compression below the other, for each torque."""
    felt = table[["largest_mpa", "smallest_mpa"]].abs().max(axis=1)
    places = table.loc[felt > PART_SHOWN * felt.max(), "passage"]
    shown = table[table["passage"].between(places.min() - 0.25, places.max() + 0.25)]
    return _both(shown, "passage", "Passage of a tooth (pitches)")


def along_face_figure(table: pd.DataFrame) -> Figure:
    """The same along the face: the largest over the passage."""
    return _both(table, "radius_mm", "Gear radius (mm)")


def _both(table: pd.DataFrame, coordinate: str, label: str) -> Figure:
    torques = np.sort(table["torque_n_m"].unique())
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, torques.size))
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 6.2), sharex=coordinate == "passage")
        for axis, (body, name) in zip(axes, BODIES.items(), strict=True):
            for torque, colour in zip(torques, colours, strict=True):
                rows = table[(table["torque_n_m"] == torque) & (table["body"] == body)]
                loaded, other = (
                    rows[rows["fillet"] == fillet].sort_values(coordinate) for fillet in ("loaded", "other")
                )
                axis.plot(loaded[coordinate], loaded["largest_mpa"], color=colour, label=f"{torque:g} N m")
                axis.plot(other[coordinate], other["smallest_mpa"], "--", color=colour, lw=0.9)
            axis.set(ylabel=f"{name}: root stress (MPa)\ntension solid, compression dashed")
        legend_above(axes[0], 3)
        for axis in axes if coordinate != "passage" else axes[1:]:
            axis.set_xlabel(label)
    return figure


def life(rating: pd.DataFrame, damage: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Stress and cycles of every bin of a duty cycle, and the stress that may be repeated so often.

    Of all pinions, and of all face gears, the flank nearest to its limit.
    """
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 7.4))
        for axis, failure in zip(axes, ("bending", "pitting"), strict=True):
            for row in _nearest(rating[rating["failure"] == failure]).itertuples():
                curve, bins = (_of(table, row) for table in (curves, damage[damage["cycles"] > 0]))
                look = {"color": COLOURS[row.gear]}
                axis.loglog(curve["cycles"], curve["allowed_mpa"], LINES[row.method], lw=1.2, **look)
                look |= {"ls": "none", "label": _subject(row)}
                axis.loglog(bins["cycles"], bins["stress_mpa"], MARKS[row.method], **look)
            stress = "Root stress" if failure == "bending" else "Contact stress"
            axis.set(xlabel="Load cycles", ylabel=f"{stress} (MPa)\nlines: allowed, marks: bins")
            axis.yaxis.set_major_formatter("{x:g}")
            axis.yaxis.set_minor_formatter("{x:g}")
            axis.tick_params(axis="y", which="minor", labelsize=7)
            legend_above(axis, 1)
    return figure


def damage_by_bin(rating: pd.DataFrame, damage: pd.DataFrame) -> Figure:
    """Damage of every bin of a duty cycle to the flanks that `life` shows; Miner's sum is 1 at the end."""
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 3.9))
        rows = list(_nearest(rating).itertuples())
        for number, row in enumerate(rows):
            bins = _of(damage[damage["damage"] > 0], row)
            at = bins["bin"] + 0.12 * (number - 0.5 * (len(rows) - 1))
            look = {"color": COLOURS[row.gear], "markersize": 5}
            axis.semilogy(at, bins["damage"], MARKS[row.method], ls="none", label=_label(row, bins), **look)
        axis.axhline(1.0, color="0.5", lw=0.8)
        first, last = int(damage["bin"].min()), int(damage["bin"].max())
        axis.set(xlim=(first - 0.6, last + 0.6), xlabel="Bin of the duty cycle", ylabel="Damage")
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
        low, high = axis.get_ylim()
        axis.set_ylim(min(low, 1e-3), max(high, 3.0))
        legend_above(axis, 1)
    return figure


def _nearest(rating: pd.DataFrame) -> pd.DataFrame:
    """The flank of all pinions, and of all face gears, that is nearest to each limit."""
    spare = rating["safety"] / rating["required"]
    return rating.loc[
        spare.groupby([rating["gear"], rating["failure"], rating["method"]], sort=False).idxmin()
    ]


def _of(table: pd.DataFrame, row: Any) -> pd.DataFrame:
    """Rows about the same body, flank, failure and method."""
    keys = ("body", "flank", "failure", "method")
    return table[np.logical_and.reduce([table[key] == getattr(row, key) for key in keys])]


def _subject(row: Any) -> str:
    body = BODIES.get(row.body, row.body.capitalize())
    return f"{body}, {row.flank} flank, {row.method}"


def _label(row: Any, bins: pd.DataFrame) -> str:
    return f"{_subject(row)} ({row.failure}){'' if len(bins) else ': none'}"


def root_figures(passage: pd.DataFrame, along_face: pd.DataFrame) -> tuple[Figure, ...]:
    """Root stress over a passage, and along the face."""
    return passage_figure(passage), along_face_figure(along_face)


def rating_figures(rating: pd.DataFrame, damage: pd.DataFrame, curves: pd.DataFrame) -> tuple[Figure, ...]:
    """Bins of the duty cycle beside the stress that may be repeated so often, and their damage."""
    return life(rating, damage, curves), damage_by_bin(rating, damage)
