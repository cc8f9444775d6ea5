"""Quasi-static load sharing: over the hunting cycle, against bearing stiffness, and error by error."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.config.machine_layout import ToothNumbers, layout
from facegear.config.transmission import Transmission
from facegear.plots.colours import BLACK, colour_of
from facegear.plots.description import Axis, Bars, Curve, Figure, Line, LineStyle, Panel
from facegear.plots.gearbox_layout import layout_figure

LINES: Mapping[str, LineStyle] = {"geometric": "solid", "printed": "dash"}
MAX_BARS = 20
"""Bars of the sensitivity chart."""


def hunting_figure(cycles: pd.DataFrame, meshes: pd.DataFrame) -> Figure:
    """Share of its group's load that each mesh carries, mean of each mesh cycle, one panel a group."""
    panels = []
    for group in [name for name in meshes["group"].dropna().unique() if name]:
        names = meshes.loc[meshes["group"] == group, "mesh"]
        loads = cycles[[f"{name} (N)" for name in names]].to_numpy()
        total = loads.sum(axis=1)
        shares = 100.0 * loads / np.where(total > 0.0, total, np.nan)[:, None]
        has_several = len(shares) > 1
        at = cycles["cycle"].to_numpy() if has_several else np.array([0, 1])
        marks: list[Curve | Line] = [
            Curve(at, share if has_several else np.repeat(share, 2), name, colour_of(number + 1), width=0.9)
            for number, (share, name) in enumerate(zip(shares.T, names, strict=True))
        ]
        marks.append(Line(100.0 / len(names), "y", line="dot"))
        cycle = Axis("Mesh cycle", "", low=float(at.min()), high=float(at.max()))
        share_axis = Axis("Share", "%")
        title = f"Group: {group}"
        panels.append(Panel(cycle, share_axis, marks, title=title, height=1.4, own_legend=True))
    return Figure(panels, title="Load of each mesh over the hunting cycle, quasi-static")


def bearing_figure(scan: pd.DataFrame) -> Figure:
    """K_gamma against bearing stiffness of the inputs (top) and of the idlers (below), both kinematics."""
    panels = []
    for role in ("inputs", "idlers"):
        curves = []
        for number, kind in enumerate(scan["kind"].unique()):
            for kinematics, line in LINES.items():
                mask = (scan["varied"] == role) & (scan["kind"] == kind)
                rows = scan[mask & (scan["kinematics"] == kinematics)]
                name = f"Kᵧ of the {kind}, {kinematics}"
                stiffness = 1e-6 * rows["stiffness_n_per_m"]
                curves.append(Curve(stiffness, rows["k_gamma"], name, colour_of(number + 1), line))
        across = Axis(f"Bearing stiffness of the {role}", "N/µm", logarithmic=True)
        panels.append(Panel(across, Axis("Largest Kᵧ of the paths", ""), curves, height=2.2))
    return Figure(panels, title="Static load sharing against bearing stiffness", shared_x=False)


def sensitivity_figure(table: pd.DataFrame) -> Figure:
    """The largest sensitivities dK/d(um), one bar an error: that of the group which answers most."""
    largest = table.loc[table.groupby("error")["per_um"].apply(lambda rows: rows.abs().idxmax())]
    rows = largest.sort_values("per_um", key=np.abs, ascending=False).head(MAX_BARS)[::-1]
    positions = np.arange(len(rows), dtype=float)
    marks: list[Bars | Line] = [Line(0.0, colour=BLACK, width=0.6)]
    for number, group in enumerate(table["group"].unique()):
        in_group = (rows["group"] == group).to_numpy()
        if in_group.any():
            lengths = 1e3 * rows["per_um"].to_numpy()[in_group]
            marks.append(
                Bars(positions[in_group], lengths, f"Kᵧ of {group}", colour_of(number + 1), flat=True)
            )
    errors = [(position, str(name)) for position, name in zip(positions, rows["error"], strict=True)]
    panel = Panel(
        Axis("Change of Kᵧ", "10⁻³/µm"),
        Axis("", "", low=-0.6, high=len(rows) - 0.4, ticks=errors),
        marks,
        height=0.5 + 0.22 * len(rows),
    )
    return Figure([panel], title="Which errors matter: largest first")


def figures(
    meshes: pd.DataFrame,
    bearings: pd.DataFrame,
    cycles: pd.DataFrame,
    scan: pd.DataFrame,
    sensitivity: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
) -> tuple[Figure, ...]:
    """Layout of the machine with its mean forces, loads over the hunting cycle, bearings, single errors."""
    return (
        layout_figure(layout(transmission, teeth), meshes, bearings),
        hunting_figure(cycles, meshes),
        bearing_figure(scan),
        sensitivity_figure(sensitivity),
    )
