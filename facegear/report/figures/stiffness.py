"""Figures of mesh stiffness and of the load-dependent law of a mesh."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.meshing.fitted_law import forces_over_pitch
from facegear.number_format import format_number
from facegear.report.figures.colours import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, grey, shades
from facegear.report.figures.description import Axis, Figure, Panel, apart
from facegear.report.figures.marks import Band, Bars, Curve, Look, Surface, Text
from facegear.report.figures.motion import LINES as SWEEP_LINES
from facegear.report.figures.motion import rms_axis, select, speed_axis


def stiffness_curve(curve: pd.DataFrame) -> Figure:
    """Draw k over one mesh period, as computed and as the kept harmonics give it.

    Parameters
    ----------
    curve : pd.DataFrame
        Table `tvms` of stage stiffness: position (mesh periods), k_n_per_m, k_series_n_per_m (Fourier
        sum).

    Returns
    -------
    Figure
        One panel, N/µm over one period.
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
    """Draw the amplitudes of the mesh stiffness at orders 1 to `max_order`, with their sampling errors.

    Parameters
    ----------
    spectrum : pd.DataFrame
        Table `spectrum` of stage stiffness: order, amplitude_n_per_m, sampling_error_n_per_m.
    max_order : int
        Number of the last order.

    Returns
    -------
    Figure
        One panel, N/µm.
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
        Table of stage load_dependence: definition (`average` F / deflection or local slope), torque_n_m;
        mean, min and max over a pitch, and amplitude_1 (first harmonic), all _n_per_m.

    Returns
    -------
    Figure
        Two panels over torque per mesh, N m.
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


def stiffness_figures(tvms: pd.DataFrame, spectrum: pd.DataFrame) -> tuple[Figure, ...]:
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
        Those of `stiffness_curve` and `harmonic_amplitudes`.
    """
    return stiffness_curve(tvms), harmonic_amplitudes(spectrum)


def load_figures(table: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the mean stiffness against load.

    Parameters
    ----------
    table : pd.DataFrame
        Table of stage load_dependence, as `stiffness_against_load` reads it.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return (stiffness_against_load(table),)


LINES = 8
"""Number of curves of the law's force over the phase."""
POSITIONS = 96
"""Number of phases of a mesh cycle at which the law is drawn."""
DEPTHS = 60
"""Number of deflections at which the law is drawn."""
LAW_COLOURS = (RED, BLUE, GREEN, PURPLE)
"""Colours of the laws, in their order."""


def force_lines(law: Arrays) -> Figure:
    """Draw the force over a pitch at even deflections up to the last level, with the deflection beside each
    line.

    Parameters
    ----------
    law : Arrays
        Arrays `law` of stage mesh_law; `level_m` (laws, levels) holds the deflections of the levels, m.

    Returns
    -------
    Figure
        One panel, kN over the mesh period, for the first law.
    """
    last = law["level_m"][0, -1]
    amounts = last * np.arange(1, LINES + 1) / LINES
    phases = np.linspace(0.0, 1.0, POSITIONS + 1)
    forces = 1e-3 * forces_over_pitch(law, 0, phases, amounts)
    marks: list[Curve | Text] = []
    for amount, force, colour in zip(amounts, forces, reversed(shades(LINES)), strict=True):
        text = f"{format_number(1e6 * amount)} µm"
        marks += [
            Curve(phases, force, text, colour, width=1.3, in_legend=False),
            Text(1.0, float(force[-1]), text, shift=(3.0, 0.0)),
        ]
    panel = Panel(
        Axis("Mesh period", "", low=0.0, high=1.0),
        Axis("Mesh force", "kN", low=0.0),
        marks,
        title="Lines: deflection, counted from first contact",
        height=2.8,
    )
    return Figure([panel])


def force_surface(law: Arrays) -> Figure:
    """Draw the force (kN) over the phase of the mesh period and deflection (µm) up to the last level.

    Parameters
    ----------
    law : Arrays
        Arrays `law` of stage mesh_law, as for `force_lines`.

    Returns
    -------
    Figure
        The figure.
    """
    amounts = np.linspace(0.0, law["level_m"][0, -1], DEPTHS)
    phases = np.linspace(0.0, 1.0, POSITIONS + 1)
    forces = 1e-3 * forces_over_pitch(law, 0, phases, amounts)
    surface = Surface(*np.meshgrid(phases, 1e6 * amounts), forces)
    panel = Panel(
        Axis("Mesh period", "", low=0.0, high=1.0),
        Axis("Deflection", "µm"),
        [surface],
        title="Deflection: counted from first contact",
        height=3.5,
        z=Axis("Mesh force", "kN"),
        view=(24.0, -128.0),
    )
    return Figure([panel])


def mesh_law_figures(law: Arrays) -> tuple[Figure, ...]:
    """Draw lines over a pitch and the surface, of the upper gear's drive flank.

    Parameters
    ----------
    law : Arrays
        Arrays `law` of stage mesh_law.

    Returns
    -------
    tuple[Figure, ...]
        Those of `force_lines` and `force_surface`.
    """
    return force_lines(law), force_surface(law)


def loads_in_table(loads: pd.DataFrame) -> Figure:
    """Draw forces of every mesh at the nominal speed and in the sweep beside the levels of its law.

    Parameters
    ----------
    loads : pd.DataFrame
        Table `loads` of stage law_loads: mesh; smallest_n, mean_n, largest_n at the nominal speed;
        sweep_largest_n; last_level_n (mean force of the law's last level); past_fraction and
        sweep_past_fraction (of the time beyond it).

    Returns
    -------
    Figure
        One panel, kN, a row for each mesh.
    """
    rows = np.arange(len(loads))[::-1].astype(float)
    smallest, mean, largest = loads[["smallest_n", "mean_n", "largest_n"]].to_numpy().T / 1e3
    sweep_largest = 1e-3 * loads["sweep_largest_n"]
    ranges = apart(np.stack([smallest, largest], axis=1), np.stack([rows, rows], axis=1))
    marks: list[Bars | Curve | Text] = [
        Bars(rows, 1e-3 * loads["last_level_n"].to_numpy(), "in the table", grey(0.9), flat=True),
        Curve(sweep_largest, rows, "largest in the sweep", line="none", marker="line-ns", size=9.0),
        Curve(*ranges, "range, nominal speed", BLUE, width=4.0),
        Curve(mean, rows, "mean, nominal speed", ORANGE, line="none", marker="circle", size=4.0),
    ]
    for row, load in zip(rows, loads.itertuples(), strict=True):
        if (past := max(load.past_fraction, load.sweep_past_fraction)) > 0.0:
            end = 1e-3 * max(load.sweep_largest_n, load.last_level_n)
            text = f"{format_number(100 * past, 2)} % of the time past it"
            marks.append(Text(end, float(row), text, shift=(5.0, 0.0)))
    top = 1e-3 * loads[["last_level_n", "sweep_largest_n"]].to_numpy().max()
    margin = 1.6 if any(isinstance(mark, Text) for mark in marks) else 1.05
    names = list(zip(rows.tolist(), loads["mesh"], strict=True))
    panel = Panel(
        Axis("Mesh force", "kN", low=0.0, high=float(margin * top)),
        Axis("", "", low=-0.6, high=len(loads) - 0.4, ticks=names),
        marks,
        height=0.5 + 0.3 * len(loads),
    )
    return Figure([panel])


def swept_laws(sweeps: Sequence[pd.DataFrame], labels: Sequence[str], meshes: Sequence[str]) -> Figure:
    """Draw the RMS of mesh deflections without their mean, of the same machine with several laws, laid over
    each other.

    Parameters
    ----------
    sweeps : Sequence[pd.DataFrame]
        Tables `sweep` of stage dynamics_sweep, one for each law.
    labels : Sequence[str]
        Labels of the laws.
    meshes : Sequence[str]
        Names of the meshes.

    Returns
    -------
    Figure
        A panel for each mesh, µm over rpm; at most as many laws as LAW_COLOURS.
    """
    panels = []
    for mesh in meshes:
        curves = []
        for sweep, label, colour in zip(sweeps, labels, LAW_COLOURS, strict=False):
            for direction, line in SWEEP_LINES.items():
                curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                name = f"{label}, {direction}"
                curves.append(Curve(curve["speed_rpm"], curve["value"], name, colour, line, width=1.0))
        panels.append(Panel(speed_axis(sweeps[0]), rms_axis(), curves, title=mesh, height=1.2))
    return Figure(panels, title="RMS of the deflection d along the line of action without its mean")


def law_load_figures(
    loads: pd.DataFrame, sweep: pd.DataFrame, other_sweeps: Sequence[pd.DataFrame], labels: Sequence[str]
) -> list[Figure]:
    """Draw the loads in the table and, where studies have other laws, the sweeps of all of them.

    Sweeps are drawn for the meshes with the gear of the last mesh in `loads`.

    Parameters
    ----------
    loads : pd.DataFrame
        Table `loads` of stage law_loads.
    sweep : pd.DataFrame
        Table `sweep` of stage dynamics_sweep.
    other_sweeps : Sequence[pd.DataFrame]
        Tables `sweep` of the cases with other laws.
    labels : Sequence[str]
        Labels of this machine's law and of the others'.

    Returns
    -------
    list[Figure]
        The figures.
    """
    law_figures = [loads_in_table(loads)]
    if other_sweeps:
        side = loads["mesh"].str.rpartition("/")[2]
        law_figures.append(
            swept_laws([sweep, *other_sweeps], labels, loads["mesh"][side == side.iloc[-1]].tolist())
        )
    return law_figures
