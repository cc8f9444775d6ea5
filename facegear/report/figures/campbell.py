"""Campbell diagram and waterfall of a sweep."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.motion.plan import JumpKind
from facegear.report.figures.colours import BLACK, BLUE, GREEN, ORANGE, PURPLE, grey
from facegear.report.figures.description import Axis, Figure, Panel, apart
from facegear.report.figures.marks import ColourScale, Curve, Look, Map, Text

ORDER_LINES = (1.0, 2.0, 3.0)
"""Multiples of the mesh frequency that are always drawn, beside those of the marks."""


CLASS_COLOURS = {
    "pinion": BLUE,
    "face gear": ORANGE,
    "pinion coupled face gear": GREEN,
    "casing": PURPLE,
}
"""Colour of each class of modes."""


def campbell(
    frequencies: pd.DataFrame, resonances: pd.DataFrame, jumps: pd.DataFrame, teeth: int, last_rpm: float
) -> Figure:
    """Draw natural frequencies and multiples of the mesh frequency over speed, with what the sweep found.

    Marks: peaks, jumps, and where irregular motion begins or ends.

    Parameters
    ----------
    frequencies : DataFrame
        Table `frequencies` of stage modal: class and frequency_hz; rigid body modes are left out.
    resonances : DataFrame
        Table `resonances` of stage dynamics_sweep: speed_rpm, order (multiple of the mesh frequency at
        which the strongest mode vibrates) and resonance (that mode).
    jumps : DataFrame
        Table `jumps` of stage dynamics_sweep: speed_after_rpm, kind, order and resonance.
    teeth : int
        Number of teeth of a pinion.
    last_rpm : float
        Last speed of the axis, rpm.

    Returns
    -------
    Figure
        One panel, frequency (kHz) over speed (rpm).
    """
    elastic = frequencies[frequencies["class"] != "rigid body"]
    top = 1.1 * elastic["frequency_hz"].max()
    marked_orders = pd.concat([resonances["order"], jumps["order"]]).astype(float)
    lines = sorted(set(ORDER_LINES) | set(marked_orders[_on_line(marked_orders)]))
    marks: list[Curve | Text] = []
    for name, modes in elastic.groupby("class", sort=False):
        values = 1e-3 * modes["frequency_hz"].drop_duplicates().to_numpy()
        across = apart(np.array([0.0, last_rpm]), np.stack([values, values], axis=1))
        marks.append(Curve(*across, str(name), CLASS_COLOURS[name], width=0.8))
    speeds = np.array([0.0, last_rpm])
    for order in lines:
        marks.append(Curve(speeds, 1e-3 * order * teeth * speeds / 60.0, colour=grey(0.5), width=0.8))
        end = min(last_rpm, 60.0 * top / (order * teeth))
        height = order * teeth * end / 60.0
        beyond: Look = (
            {"shift": (2.0, 0.0)} if height < 0.99 * top else {"shift": (0.0, 2.0), "upright": "bottom"}
        )
        marks.append(Text(end, 1e-3 * height, f"{order:g}x", colour=grey(0.3), **beyond))
    irregular = jumps["kind"] == JumpKind.IRREGULAR
    marks += _marks(resonances, "speed_rpm", teeth, "circle", "peaks")
    marks += _marks(jumps[~irregular], "speed_after_rpm", teeth, "x", "jumps")
    marks += _marks(jumps[irregular], "speed_after_rpm", teeth, "plus", "irregular motion")
    speed = Axis("Input speed", "rpm", low=0.0, high=last_rpm)
    panel = Panel(speed, Axis("Frequency", "kHz", low=0.0, high=1e-3 * top), marks, height=3.8)
    return Figure([panel], legend_title="modes by class, and what the sweep found")


def _on_line(orders: pd.Series) -> pd.Series:
    """Return a mask (rows,): which orders, multiples of the mesh frequency, are whole multiples of one
    half. Motion that is not locked to the mesh has other orders.
    """
    return (2.0 * orders - (2.0 * orders).round()).abs() < 1e-9


def _marks(rows: pd.DataFrame, speed: str, teeth: int, symbol: str, label: str) -> Iterator[Curve]:
    """Yield one curve of marks at (speed, order * mesh frequency), rpm and kHz, for rows whose order is
    a multiple of one half, and a grey one for the others.

    rows: table with columns order, resonance and the speed column named `speed`; teeth: of a pinion;
    symbol: marker; label: name in the legend.
    """
    unique = rows.drop_duplicates([speed, "resonance"])
    on = _on_line(unique["order"].astype(float))
    for mask, colour, text in ((on, BLACK, label), (~on, grey(0.6), f"{label}, off lines")):
        if mask.any():
            frequency = 1e-3 * unique["order"][mask] * teeth * unique[speed][mask] / 60.0
            look: Look = {"line": "none", "marker": symbol, "size": 4.0}
            yield Curve(unique[speed][mask], frequency, text, colour, **look)


def waterfall(spectra: Mapping[str, Array], mesh: int, mesh_name: str, teeth: int) -> Figure:
    """Draw the spectra of one mesh deflection over speed, a panel for each direction, in logarithmic colours.

    Parameters
    ----------
    spectra : mapping of (...) arrays
        Arrays `waterfall` of stage dynamics_sweep: `orders` (n,), multiples of the mesh frequency from
        0 on; for each direction up_speed_rpm (speeds,) and up_amplitude_m (speeds, meshes, n), or
        `down_...`.
    mesh : int
        Index of the mesh in the arrays.
    mesh_name : str
        Name of the mesh.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    Figure
        A panel for each direction; amplitudes below 1/1000 of the largest count as that.
    """
    directions = [name for name in ("up", "down") if f"{name}_speed_rpm" in spectra]
    orders = spectra["orders"][1:]
    amplitudes = {name: 1e6 * spectra[f"{name}_amplitude_m"][:, mesh, 1:] for name in directions}
    top = max(values.max() for values in amplitudes.values())
    scale = ColourScale("Amplitude, log₁₀ of µm", "", float(np.log10(1e-3 * top)), float(np.log10(top)))
    panels = []
    for name in directions:
        speeds = spectra[f"{name}_speed_rpm"]
        rank = np.argsort(speeds)
        log_amplitudes = np.log10(np.maximum(amplitudes[name][rank], 1e-3 * top))
        amplitude_map = Map(orders, speeds[rank], log_amplitudes, scale)
        across = Axis("Multiple of the mesh frequency", "", low=float(orders[0]), high=float(orders[-1]))
        up = Axis("Input speed", "rpm", low=float(speeds.min()), high=float(speeds.max()))
        panels.append(Panel(across, up, [amplitude_map], title=f"sweep {name}", height=3.0))
    return Figure(panels, title=f"Spectrum of the deflection, {mesh_name}")
