"""Loaded contact: transmission error and load share over a pitch, and the pressure pattern on the flank."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from facegear.arrays import Array, Arrays, Integers
from facegear.contact.columns import EDGES, SHARES
from facegear.contact.pattern import Pattern, pattern
from facegear.plots.style import NARROW, legend_above, styled

PAIR_NAMES = ("-2", "-1", "0", "1", "2")

MARKS = (
    (("pinion tip", "gear tip"), "s", "#0072b2", "tip edge: line load only"),
    (("end",), "D", "#009e73", "end of the face: the same"),
)
"""Kinds of edges, marker, colour and legend: where a flank carries load and no pressure is known."""
LEGEND_HEIGHT = 0.25
"""Inches of the legend's one line of 9 pt with its gap, which a pattern without marks does not need."""


def contact_curves(ltca: pd.DataFrame) -> Figure:
    """Static transmission error and both stiffnesses for each torque, load shares at the smallest and
    largest.
    """
    torques = np.sort(ltca["torque_n_m"].unique())
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, torques.size))
    with styled():
        figure, axes = plt.subplots(4, 1, figsize=(NARROW, 11), sharex=True)
        error, stiffness = axes[:2]
        for torque, colour in zip(torques, colours, strict=True):
            rows = closed(ltca[ltca["torque_n_m"] == torque])
            error.plot(rows["position"], rows["ste_um"], color=colour, label=f"{torque:g} N m")
            stiffness.plot(rows["position"], 1e-6 * rows["k_average_n_per_m"], color=colour)
            stiffness.plot(rows["position"], 1e-6 * rows["k_local_n_per_m"], "--", color=colour, lw=0.9)
        unloaded = closed(ltca[ltca["torque_n_m"] == torques[0]])
        error.plot(unloaded["position"], unloaded["unloaded_ste_um"], "k:", label="unloaded")
        error.set(ylabel="Static transmission error (µm)")
        legend_above(error, 3)
        stiffness.set(ylabel="Stiffness (N/µm)\naverage solid, local dashed")
        for axis, torque in zip(axes[2:], torques[[0, -1]], strict=True):
            rows = closed(ltca[ltca["torque_n_m"] == torque])
            for column, name in zip(SHARES, PAIR_NAMES, strict=True):
                if (rows[column] > 0).any():
                    axis.plot(rows["position"], rows[column], label=f"pair {name}")
            axis.set(ylabel=f"Load share at {torque:g} N m", ylim=(-0.02, 1.05))
            legend_above(axis, 5)
        axes[-1].set(xlabel="Position (pitches)", xlim=(0, 1))
    return figure


def closed(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows of one torque with the end of the pitch: its beginning, each pair in the next one's place."""
    rows = rows.sort_values("position")
    last = rows.iloc[[0]].copy()
    last["position"] = rows["position"].iloc[0] + 1.0
    last[list(SHARES)] = np.append(last[list(SHARES)].to_numpy()[0, 1:], 0.0)
    return pd.concat([rows, last], ignore_index=True)


def contact_pattern(arrays: Arrays) -> Figure:
    """Pressure each point of the pinion's flank sees as it passes through the mesh, one panel a torque."""
    torques = np.unique(arrays["line_torque_n_m"])
    return pattern_panels({_title(arrays, torque): (arrays, torque) for torque in torques})


def pattern_panels(panels: Mapping[str, tuple[Arrays, float]]) -> Figure:
    """`contact_pattern` with panels by title: the arrays and the torque (N m) that each shows.

    All have one scale, which ends at their largest pressure; marks stand where only a line load is known.
    """
    patterns = {title: (pattern(arrays), float(torque)) for title, (arrays, torque) in panels.items()}
    top = max(np.nanmax(seen.pressure[torque], initial=0.0) for seen, torque in patterns.values())
    rows = len(patterns)
    with styled():
        figure, axes = plt.subplots(
            rows, 1, figsize=(NARROW, 1.3 + 1.7 * rows), sharex=True, sharey=True, squeeze=False
        )
        for axis, (title, (seen, torque)), (arrays, _) in zip(
            axes.flat, patterns.items(), panels.values(), strict=True
        ):
            drawn = _panel(axis, seen, torque, 1e-6 * top or 1.0)
            nodes = 1e3 * arrays["point_m"]
            height = np.hypot(nodes[:, 0], nodes[:, 2])
            axis.set(xlim=(nodes[:, 1].min(), nodes[:, 1].max()), ylim=(height.min(), height.max()))
            axis.set_title(title)
            axis.set_ylabel("Pinion\nradius (mm)")
        axes[-1, 0].set_xlabel("Along the pinion's axis, from the gear's (mm)")
        figure.colorbar(drawn, ax=axes, location="top", aspect=40, label="Pressure (MPa)")
        marks = {
            label: handle
            for axis in axes.flat
            for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)
        }
        if marks:
            figure.legend(marks.values(), marks.keys(), loc="outside lower center", ncols=2)
        else:
            figure.set_figheight(figure.get_figheight() - LEGEND_HEIGHT)
    return figure


def _panel(axis: Axes, seen: Pattern, torque: float, top: float) -> QuadMesh:
    """Pressures (MPa) up to `top` on the surface that the contact lines sweep, and marks at edges."""
    width = 1e3 * seen.points[..., 1]
    radius = 1e3 * np.hypot(seen.points[..., 0], seen.points[..., 2])
    where = seen.where[torque]
    field = np.ma.masked_invalid(1e-6 * _faded(seen.pressure[torque], where))
    axis.set_facecolor("0.92")
    axis.grid(visible=False)
    for edges, marker, colour, name in MARKS:
        on = np.isin(where, [EDGES.index(kind) for kind in edges])
        if on.any():
            axis.plot(width[on], radius[on], marker, color=colour, ms=2.5, label=name, rasterized=True)
    look = {"cmap": "inferno", "shading": "gouraud", "rasterized": True}
    return axis.pcolormesh(width, radius, field, vmin=0, vmax=top, **look)


def _faded(field: Array, where: Integers) -> Array:
    """The pressures, with zeros in unloaded planes next to them, where the loaded length ends."""
    known = np.isfinite(field)
    beside = np.zeros_like(known)
    beside[:, 1:] |= known[:, :-1]
    beside[:, :-1] |= known[:, 1:]
    return np.where(beside & (where < 0), 0.0, field)


def _title(arrays: Arrays, torque: float) -> str:
    """Title of a panel: torque, largest pressure with its error, largest line load of a tip edge."""
    on = arrays["line_torque_n_m"] == torque
    at = np.argmax(arrays["line_pressure_pa"][on])
    pressure, error = (1e-6 * arrays[f"line_{name}_pa"][on][at] for name in ("pressure", "error"))
    tips = np.isin(arrays["line_where"][on], [EDGES.index("pinion tip"), EDGES.index("gear tip")])
    tip = 1e-3 * arrays["line_load_n_per_m"][on][tips].max(initial=0.0)
    edge = f"; tip edges up to {tip:.0f} N/mm" if tip > 0 else ""
    return f"{torque:g} N m: {pressure:.0f} ± {error:.0f} MPa{edge}"


def figures(ltca: pd.DataFrame, pressure: Arrays) -> tuple[Figure, ...]:
    """Curves over a pitch, and the contact pattern."""
    return contact_curves(ltca), contact_pattern(pressure)
