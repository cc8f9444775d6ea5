"""Mesh stiffness over a period and its harmonics; stiffness against load."""

import numpy as np
import pandas as pd

from facegear.plots.colours import BLACK, BLUE, ORANGE, RED
from facegear.plots.description import Axis, Band, Bars, Curve, Figure, Look, Panel


def stiffness_curve(curve: pd.DataFrame) -> Figure:
    """Draw k over one mesh period, as computed and as the kept harmonics give it.

    Parameters
    ----------
    curve : pd.DataFrame
        Table `tvms` of stage stiffness.

    Returns
    -------
    Figure
        The figure.
    """
    first = curve.iloc[[0]].assign(position=1.0)
    whole = pd.concat([curve, first], ignore_index=True)
    curves = [
        Curve(whole["position"], 1e-6 * whole["k_n_per_m"], "computed", BLACK, width=1.4),
        Curve(whole["position"], 1e-6 * whole["k_series_n_per_m"], "harmonics kept", RED, "dash", width=1.0),
    ]
    across = Axis("Mesh period t/T", "", low=0.0, high=1.0)
    return Figure([Panel(across, Axis("Mesh stiffness", "N/µm"), curves, height=2.4)])


def harmonic_amplitudes(spectrum: pd.DataFrame, max_order: int = 15) -> Figure:
    """Draw absolute amplitudes of the orders of the stiffness variation.

    Parameters
    ----------
    spectrum : pd.DataFrame
        Table `spectrum` of stage stiffness.
    max_order : int
        Number of the last order.

    Returns
    -------
    Figure
        The figure.
    """
    rows = spectrum[(spectrum["order"] >= 1) & (spectrum["order"] <= max_order)]
    orders, heights = rows["order"].to_numpy(dtype=float), 1e-6 * rows["amplitude_n_per_m"].to_numpy()
    errors = 1e-6 * rows["sampling_error_n_per_m"].to_numpy()
    ends: Look = {"low": heights - errors, "high": heights + errors} if (errors > 0).any() else {}
    across = Axis(
        "Harmonic order of the mesh frequency", "", ticks=[(order, f"{order:g}") for order in orders]
    )
    bars = Bars(orders, heights, colour=BLUE, width=0.5, **ends)
    return Figure([Panel(across, Axis("Amplitude", "N/µm", low=0.0), [bars], height=2.4)])


def stiffness_against_load(table: pd.DataFrame) -> Figure:
    """Draw the mean of both stiffnesses with the range over a pitch, and the first harmonic, against torque.

    Parameters
    ----------
    table : pd.DataFrame
        Table of stage load_dependence.

    Returns
    -------
    Figure
        The figure.
    """
    above: list[Band | Curve] = []
    below = []
    for (definition, rows), colour in zip(
        table.groupby("definition", sort=False), (BLUE, ORANGE), strict=True
    ):
        torque = rows["torque_n_m"]
        label = "average F/δ" if definition == "average" else "local dF/dδ"
        low, high = 1e-6 * rows["min_n_per_m"], 1e-6 * rows["max_n_per_m"]
        above += [
            Band(torque, low, high, colour=colour),
            Curve(torque, 1e-6 * rows["mean_n_per_m"], label, colour, marker="circle"),
        ]
        relative = 100 * rows["amplitude_1_n_per_m"] / rows["mean_n_per_m"]
        below.append(Curve(torque, relative, label, colour, marker="circle"))
    torques = Axis("Pinion torque per mesh", "N m", low=0.0, high=1.03 * float(np.max(table["torque_n_m"])))
    note = "mean and range over a pitch"
    return Figure(
        [
            Panel(torques, Axis("Mesh stiffness", "N/µm", note, low=0.0), above, height=2.1),
            Panel(torques, Axis("First harmonic", "% of the mean", low=0.0), below, height=2.1),
        ]
    )


def figures(tvms: pd.DataFrame, spectrum: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw k(t) over a period, and its harmonics.

    Parameters
    ----------
    tvms : pd.DataFrame
        Table `tvms` of stage stiffness.
    spectrum : pd.DataFrame
        Table `spectrum` of stage stiffness.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return stiffness_curve(tvms), harmonic_amplitudes(spectrum)


def load_figures(table: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the mean stiffness against load.

    Parameters
    ----------
    table : pd.DataFrame
        Table of stage load_dependence.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return (stiffness_against_load(table),)
