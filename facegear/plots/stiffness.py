"""Mesh stiffness over a period and its harmonics; stiffness against load."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, legend_above, styled


def stiffness_curve(curve: pd.DataFrame) -> Figure:
    """k over one mesh period, as computed and as the kept harmonics give it."""
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 3.3))
        first = curve.iloc[[0]].assign(position=1.0)
        closed = pd.concat([curve, first], ignore_index=True)
        axis.plot(closed["position"], 1e-6 * closed["k_n_per_m"], "k-", lw=1.4, label="computed")
        axis.plot(closed["position"], 1e-6 * closed["k_series_n_per_m"], "r--", lw=1, label="harmonics kept")
        axis.set(xlabel="Mesh period t/T", ylabel="Mesh stiffness (N/µm)", xlim=(0, 1))
        legend_above(axis, 2)
    return figure


def harmonic_amplitudes(spectrum: pd.DataFrame, max_order: int = 15) -> Figure:
    """Absolute amplitudes of the orders of the stiffness variation."""
    rows = spectrum[(spectrum["order"] >= 1) & (spectrum["order"] <= max_order)]
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 3.3))
        axis.bar(rows["order"], 1e-6 * rows["amplitude_n_per_m"], width=0.5, color="tab:blue")
        errors = 1e-6 * rows["sampling_error_n_per_m"]
        if (errors > 0).any():
            axis.errorbar(
                rows["order"], 1e-6 * rows["amplitude_n_per_m"], errors, fmt="none", ecolor="k", capsize=2
            )
        axis.set(xlabel="Harmonic order of the mesh frequency", ylabel="Amplitude (N/µm)")
        axis.set_xticks(rows["order"])
        axis.grid(axis="x", visible=False)
    return figure


def stiffness_against_load(table: pd.DataFrame) -> Figure:
    """Mean of both stiffnesses with the range over a pitch, and the first harmonic, against torque."""
    with styled():
        figure, (top, bottom) = plt.subplots(2, 1, figsize=(NARROW, 5.2), sharex=True)
        for (definition, rows), colour in zip(
            table.groupby("definition", sort=False), ("tab:blue", "tab:orange"), strict=True
        ):
            torque = rows["torque_n_m"]
            label = "average F/δ" if definition == "average" else "local dF/dδ"
            top.plot(torque, 1e-6 * rows["mean_n_per_m"], "o-", color=colour, label=label)
            low, high = 1e-6 * rows["min_n_per_m"], 1e-6 * rows["max_n_per_m"]
            top.fill_between(torque, low, high, color=colour, alpha=0.2, lw=0)
            relative = 100 * rows["amplitude_1_n_per_m"] / rows["mean_n_per_m"]
            bottom.plot(torque, relative, "o-", color=colour, label=label)
        top.set(ylabel="Mesh stiffness (N/µm)\nmean and range over a pitch")
        top.set_ylim(bottom=0)
        bottom.set(xlabel="Pinion torque per mesh (N m)", ylabel="First harmonic (% of the mean)")
        bottom.set_ylim(bottom=0)
        bottom.set_xlim(left=0, right=float(np.max(table["torque_n_m"])) * 1.03)
        legend_above(top, 2)
    return figure


def figures(tvms: pd.DataFrame, spectrum: pd.DataFrame) -> tuple[Figure, ...]:
    """k(t) over a period, and its harmonics."""
    return stiffness_curve(tvms), harmonic_amplitudes(spectrum)


def load_figures(table: pd.DataFrame) -> tuple[Figure, ...]:
    """Mean stiffness against load."""
    return (stiffness_against_load(table),)
