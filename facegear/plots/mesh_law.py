"""The load-dependent law of a mesh: force over phase and deflection, and the loads of the meshes in it."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from facegear.arrays import Arrays
from facegear.plots.style import NARROW, styled
from facegear.plots.sweep import select
from facegear.stiffness.load_dependent import forces_over_pitch

LINES = 8
POSITIONS = 96
DEPTHS = 60
LAW_COLOURS = ("tab:red", "tab:blue", "tab:green", "tab:purple")


def force_lines(law: Arrays) -> Figure:
    """Force over a pitch at even deflections up to the last level, with the deflection beside each line."""
    last = law["level_m"][0, -1]
    amounts = last * np.arange(1, LINES + 1) / LINES
    phases = np.linspace(0.0, 1.0, POSITIONS + 1)
    forces = 1e-3 * forces_over_pitch(law, 0, phases, amounts)
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 3.8))
        for n, (amount, line) in enumerate(zip(amounts, forces, strict=True)):
            axis.plot(phases, line, color=plt.get_cmap("viridis")(0.9 * (1.0 - n / LINES)), lw=1.3)
            text = f"{1e6 * amount:.3g} µm"
            axis.annotate(text, (1.0, line[-1]), (3, 0), textcoords="offset points", va="center")
        axis.set(xlabel="Mesh period", ylabel="Mesh force (kN)", xlim=(0, 1))
        axis.set_ylim(bottom=0)
        axis.set_title("Lines: deflection beyond first contact", fontsize=9, loc="left")
    return figure


def force_surface(law: Arrays) -> Figure:
    """Force over phase and deflection."""
    amounts = np.linspace(0.0, law["level_m"][0, -1], DEPTHS)
    phases = np.linspace(0.0, 1.0, POSITIONS + 1)
    forces = 1e-3 * forces_over_pitch(law, 0, phases, amounts)
    with styled():
        figure = plt.figure(figsize=(NARROW, 4.2))
        axis = figure.add_subplot(projection="3d")
        axis.plot_surface(
            *np.meshgrid(phases, 1e6 * amounts), forces, cmap="viridis", rcount=DEPTHS, ccount=POSITIONS // 2
        )
        axis.set(xlabel="Mesh period", ylabel="Deflection (µm)", zlabel="Mesh force (kN)", xlim=(0, 1))
        axis.set_box_aspect(None, zoom=0.85)
        axis.view_init(elev=24, azim=-128)
    return figure


def figures(law: Arrays) -> tuple[Figure, ...]:
    """Lines over a pitch and the surface, of the upper gear's drive flank."""
    return force_lines(law), force_surface(law)


def loads_in_table(loads: pd.DataFrame) -> Figure:
    """Forces of every mesh at the nominal speed and in the sweep beside the levels of its law."""
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 1.6 + 0.34 * len(loads)))
        rows = np.arange(len(loads))[::-1]
        nominal = loads[["smallest_n", "mean_n", "largest_n"]].to_numpy().T / 1e3
        axis.barh(rows, 1e-3 * loads["last_level_n"], 0.8, color="0.92", label="in the table")
        axis.plot(1e-3 * loads["sweep_largest_n"], rows, "k|", ms=9, mew=1.4, label="largest in the sweep")
        axis.hlines(rows, nominal[0], nominal[2], color="tab:blue", lw=4, label="range, nominal speed")
        axis.plot(nominal[1], rows, "o", color="tab:orange", ms=4, label="mean, nominal speed")
        for row, load in zip(rows, loads.itertuples(), strict=True):
            if (past := max(load.past_fraction, load.sweep_past_fraction)) > 0.0:
                end = 1e-3 * max(load.sweep_largest_n, load.last_level_n)
                text = f" {100 * past:.2g} % past"
                axis.annotate(text, (end, row), (3, 0), textcoords="offset points", va="center")
        axis.set_yticks(rows, loads["mesh"])
        axis.set(xlabel="Mesh force (kN)", xlim=(0, None))
        axis.grid(axis="y", visible=False)
        figure.legend(loc="outside upper center", ncols=2)
    return figure


def swept_laws(sweeps: Sequence[pd.DataFrame], labels: Sequence[str], meshes: Sequence[str]) -> Figure:
    """RMS of mesh deflections without their mean of the same machine with several laws laid over each
    other.
    """
    with styled():
        figure, axes = plt.subplots(
            len(meshes), 1, figsize=(NARROW, 1.2 + 1.6 * len(meshes)), sharex=True, squeeze=False
        )
        for axis, mesh in zip(axes[:, 0], meshes, strict=True):
            for sweep, label, colour in zip(sweeps, labels, LAW_COLOURS, strict=False):
                for direction, line in (("up", "-"), ("down", "--")):
                    curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                    axis.plot(
                        curve["speed_rpm"],
                        curve["value"],
                        line,
                        color=colour,
                        lw=1,
                        label=f"{label}, {direction}",
                    )
            axis.set_title(mesh, fontsize=9, loc="left")
            axis.set_ylabel("RMS of d (µm)")
            axis.set_ylim(bottom=0)
        axes[-1, 0].set_xlabel("input rotation speed (rpm)")
        axes[-1, 0].set_xlim(0, sweeps[0]["speed_rpm"].max())
        axes[-1, 0].xaxis.set_major_locator(MaxNLocator(5))
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def load_figures(
    loads: pd.DataFrame, sweep: pd.DataFrame, others: Sequence[pd.DataFrame], labels: Sequence[str]
) -> list[Figure]:
    """Loads in the table and, where studies have other laws, the sweeps of all of them.

    `labels`: of this machine's law and of the others'. Meshes are those of the first gear.
    """
    drawn = [loads_in_table(loads)]
    if others:
        side = loads["mesh"].str.rpartition("/")[2]
        drawn.append(swept_laws([sweep, *others], labels, loads["mesh"][side == side.iloc[-1]].tolist()))
    return drawn
