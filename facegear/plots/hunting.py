"""Quasi-static load sharing: over the hunting cycle, against bearing stiffness, and error by error."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.config.machine_layout import ToothNumbers, layout
from facegear.config.transmission import Transmission
from facegear.plots.gearbox_layout import layout_figure
from facegear.plots.style import NARROW, styled

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
LINES = {"geometric": "-", "printed": "--"}
SHOWN = 20
"""Bars of the sensitivity chart."""


def hunting_figure(cycles: pd.DataFrame, meshes: pd.DataFrame, torque: float) -> Figure:
    """Share of its group's load that each mesh carries, mean of each mesh cycle, one panel a group."""
    groups = [name for name in meshes["group"].dropna().unique() if name]
    with styled():
        figure, axes = plt.subplots(
            len(groups), 1, figsize=(NARROW, 1.0 + 2.0 * len(groups)), sharex=True, squeeze=False
        )
        for axis, group in zip(axes[:, 0], groups, strict=True):
            names = meshes.loc[meshes["group"] == group, "mesh"]
            loads = cycles[[f"{name} (N)" for name in names]].to_numpy()
            total = loads.sum(axis=1)
            shares = 100.0 * loads / np.where(total > 0.0, total, np.nan)[:, None]
            several = len(shares) > 1
            at = cycles["cycle"].to_numpy() if several else np.array([0, 1])
            for load_share, name, colour in zip(shares.T, names, COLOURS, strict=False):
                axis.plot(
                    at, load_share if several else np.repeat(load_share, 2), lw=0.9, color=colour, label=name
                )
            axis.axhline(100.0 / len(names), color="0.5", lw=0.8, ls=":")
            axis.set_ylabel("Share (%)")
            axis.legend(
                loc="lower left",
                bbox_to_anchor=(0.0, 1.0),
                ncols=2,
                title=f"Group: {group}",
                alignment="left",
                borderaxespad=0.2,
            )
            axis.set_xlim(at.min(), at.max())
        axes[-1, 0].set_xlabel("Mesh cycle")
        figure.suptitle(
            f"Load of each mesh over the hunting cycle,\nquasi-static, input torque {torque:g} N m"
        )
    return figure


def bearing_figure(scan: pd.DataFrame, torque: float) -> Figure:
    """K_gamma against bearing stiffness of the inputs (top) and of the idlers (below), both kinematics."""
    quantities = list(scan["kind"].unique())
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 6.6), sharey=True)
        for axis, varied in zip(axes, ("inputs", "idlers"), strict=True):
            for kind, colour in zip(quantities, COLOURS, strict=False):
                for kinematics, line in LINES.items():
                    mask = (scan["varied"] == varied) & (scan["kind"] == kind)
                    rows = scan[mask & (scan["kinematics"] == kinematics)]
                    label = f"K of the {kind}, {kinematics}"
                    axis.semilogx(rows["stiffness_n_per_m"], rows["k_gamma"], line, color=colour, label=label)
            axis.set_xlabel(f"Bearing stiffness of the {varied} (N/m)")
            axis.set_ylabel(r"Largest $K_\gamma$ of the paths")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        figure.suptitle(f"Static load sharing against bearing stiffness,\ninput torque {torque:g} N m")
    return figure


def sensitivity_figure(table: pd.DataFrame, torque: float) -> Figure:
    """The largest sensitivities dK/d(um), one bar an error: that of the group which answers most."""
    largest = table.loc[table.groupby("error")["per_um"].apply(lambda rows: rows.abs().idxmax())]
    rows = largest.sort_values("per_um", key=np.abs, ascending=False).head(SHOWN)[::-1]
    colours = dict(zip(table["group"].unique(), COLOURS, strict=False))
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 1.6 + 0.24 * len(rows)))
        axis.barh(rows["error"], 1e3 * rows["per_um"], color=[colours[group] for group in rows["group"]])
        axis.axvline(0.0, color="black", lw=0.6)
        axis.set_xlabel(r"Change of $K_\gamma$ per $\mu$m ($10^{-3}/\mu$m)")
        axis.grid(axis="y", visible=False)
        handles = [plt.Line2D([], [], color=c, lw=6, label=f"K of {g}") for g, c in colours.items()]
        figure.legend(handles=handles, loc="outside lower center", ncols=2)
        figure.suptitle(f"Which errors matter: largest first,\ninput torque {torque:g} N m")
    return figure


def figures(
    meshes: pd.DataFrame,
    groups: pd.DataFrame,
    bearings: pd.DataFrame,
    cycles: pd.DataFrame,
    scan: pd.DataFrame,
    sensitivity: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
) -> tuple[Figure, ...]:
    """Layout of the machine with its mean forces, loads over the hunting cycle, bearings, single errors."""
    torque = float(groups["torque_n_m"].iloc[0])
    return (
        layout_figure(layout(transmission, teeth), meshes, bearings),
        hunting_figure(cycles, meshes, torque),
        bearing_figure(scan, torque),
        sensitivity_figure(sensitivity, torque),
    )
