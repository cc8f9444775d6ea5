"""Figures of the machine in motion: response, sweep, Campbell diagram."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.motion.plan import JumpKind
from facegear.report.figures.colours import BLACK, BLUE, GREEN, ORANGE, RED, colour_of, grey
from facegear.report.figures.description import Axis, Figure, Panel, apart, stems
from facegear.report.figures.marks import ColourScale, Curve, Line, LineStyle, Look, Map, Text

DIRECTION_STYLES: Mapping[str, tuple[str, LineStyle]] = {"up": (RED, "solid"), "down": (BLUE, "dash")}
AXIS_STYLES: Mapping[str, tuple[str, LineStyle]] = {
    "x": (RED, "solid"),
    "y": (BLUE, "dash"),
    "z": (GREEN, "dot"),
}
RMS_HEIGHT = 1.3
"""Inches of a panel of RMS over speed."""


def select(sweep: pd.DataFrame, direction: str, quantity: str, item: str) -> pd.DataFrame:
    """Return the rows of one curve of a sweep, ordered by speed.

    Parameters
    ----------
    sweep : DataFrame
        Tidy table of a sweep.
    direction : str
        `up` or `down`.
    quantity : str
        Name of the quantity, such as `deflection_ac_rms_um`.
    item : str
        Name of the body or mesh.

    Returns
    -------
    DataFrame
        The rows.
    """
    rows = sweep[
        (sweep["direction"] == direction) & (sweep["quantity"] == quantity) & (sweep["body_or_mesh"] == item)
    ]
    return rows.sort_values("speed_rpm")


def speed_axis(sweep: pd.DataFrame) -> Axis:
    """Return the axis of the swept speeds.

    Parameters
    ----------
    sweep : DataFrame
        Tidy table of a sweep.

    Returns
    -------
    Axis
        The axis, rpm.
    """
    return Axis("Input speed", "rpm", low=0.0, high=float(sweep["speed_rpm"].max()))


def rms_axis() -> Axis:
    """Return the axis of the RMS without mean of a mesh deflection.

    Returns
    -------
    Axis
        The axis, µm.
    """
    return Axis("RMS of d", "µm", low=0.0)


def translations(sweep: pd.DataFrame, bodies: Sequence[str], letters: str) -> Figure:
    """Draw the RMS without mean of translations over speed, a panel for each body, of the first direction of
    the sweep.

    Parameters
    ----------
    sweep : DataFrame
        Tidy table of a sweep.
    bodies : sequence of str
        Names of the bodies.
    letters : str
        Axes to draw, such as `xy`.

    Returns
    -------
    Figure
        The figure.
    """
    direction = sweep["direction"].iloc[0]
    panels = []
    for body in bodies:
        curves = []
        for letter in letters:
            curve = select(sweep, direction, f"{letter}_ac_rms_um", body)
            colour, line = AXIS_STYLES[letter]
            curves.append(
                Curve(curve["speed_rpm"], curve["value"], f"{letter} direction", colour, line, width=1.0)
            )
        panels.append(
            Panel(speed_axis(sweep), Axis("RMS", "µm", low=0.0), curves, title=body, height=RMS_HEIGHT)
        )
    return Figure(panels, title=f"RMS of translations without their mean, sweep {direction}")


def mesh_sweeps(
    sweep: pd.DataFrame, jumps: pd.DataFrame, pinions: Sequence[str], sides: Sequence[str]
) -> Figure:
    """Draw the RMS without mean of mesh deflections over rising and falling speed, a panel for each mesh.

    Ticks mark jumps, dotted ticks where irregular motion begins or ends.

    Parameters
    ----------
    sweep : DataFrame
        Tidy table of a sweep.
    jumps : DataFrame
        Table of the jumps of the sweep.
    pinions : sequence of str
        Names of the pinions.
    sides : sequence of str
        Face gears, `upper` or `lower`.

    Returns
    -------
    Figure
        The figure.
    """
    panels = []
    for pinion, side in [(pinion, side) for side in sides for pinion in pinions]:
        marks: list[Curve | Line] = []
        for direction, (colour, line) in DIRECTION_STYLES.items():
            curve = select(sweep, direction, "deflection_ac_rms_um", f"{pinion}/{side}")
            marks.append(Curve(curve["speed_rpm"], curve["value"], direction, colour, line, width=1.0))
        marks += jump_ticks(jumps)
        title = f"{pinion} and {side} face gear"
        panels.append(Panel(speed_axis(sweep), rms_axis(), marks, title=title, height=RMS_HEIGHT))
    return Figure(
        panels,
        title="RMS of the deflection d along the line of action without its mean\n"
        "ticks: jumps; dotted: irregular motion begins or ends"
        if len(jumps)
        else "RMS of the deflection d along the line of action without its mean",
        legend_title="sweep",
    )


def jump_ticks(jumps: pd.DataFrame) -> Iterator[Line]:
    """Mark on the speed axis where the response jumps, in the colour of the direction.

    Parameters
    ----------
    jumps : DataFrame
        Table of the jumps of a sweep.

    Yields
    ------
    Line
        A short tick; a dotted one where irregular motion begins or ends.
    """
    for jump in jumps.itertuples():
        colour, _ = DIRECTION_STYLES[jump.direction]
        irregular = jump.kind == JumpKind.IRREGULAR
        line: LineStyle = "dot" if irregular else "solid"
        yield Line(
            jump.speed_after_rpm, colour=colour, line=line, width=1.2, part=0.12 if irregular else 0.04
        )


LINES: Mapping[str, LineStyle] = {"up": "solid", "down": "dash"}


def mesh_sweeps_beside(sweeps: Mapping[str, pd.DataFrame], meshes: Sequence[str]) -> Figure:
    """Draw the RMS without mean of mesh deflections over speed for several machines, a colour for each
    machine.

    A solid line is for rising speed, a dashed one for falling speed.

    Parameters
    ----------
    sweeps : mapping of str to DataFrame
        Tidy table of the sweep of each machine by its label.
    meshes : sequence of str
        Names of the meshes, a panel for each.

    Returns
    -------
    Figure
        The figure.
    """
    speeds = speed_axis(pd.concat([sweep[["speed_rpm"]] for sweep in sweeps.values()]))
    panels = []
    for mesh in meshes:
        curves = []
        for number, (label, sweep) in enumerate(sweeps.items()):
            for direction in dict.fromkeys(sweep["direction"]):
                curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                look: Look = {
                    "colour": colour_of(number),
                    "line": LINES[direction],
                    "width": 1.0,
                }
                curves.append(Curve(curve["speed_rpm"], curve["value"], f"{label}, {direction}", **look))
        panels.append(Panel(speeds, rms_axis(), curves, title=mesh, height=RMS_HEIGHT))
    return Figure(panels, title="RMS of the deflection d along the line of action without its mean")


ORDER_LINES = (1.0, 2.0, 3.0)
"""Multiples of the mesh frequency that are always drawn, beside those of the marks."""
CLASS_COLOURS = {"pinion": BLUE, "face gear": ORANGE, "pinion coupled face gear": GREEN}


def campbell(
    frequencies: pd.DataFrame, resonances: pd.DataFrame, jumps: pd.DataFrame, teeth: int, last_rpm: float
) -> Figure:
    """Draw natural frequencies and multiples of the mesh frequency over speed, with what the sweep found.

    Marks: peaks, jumps, and where irregular motion begins or ends.

    Parameters
    ----------
    frequencies : DataFrame
        Table `frequencies` of stage modal.
    resonances : DataFrame
        Table of the peaks of the sweep.
    jumps : DataFrame
        Table of the jumps of the sweep.
    teeth : int
        Number of teeth of a pinion.
    last_rpm : float
        Last speed of the axis, rpm.

    Returns
    -------
    Figure
        The figure.
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
    """Return which orders are multiples of half the mesh frequency; motion that is not locked to the mesh has
    others.
    """
    return (2.0 * orders - (2.0 * orders).round()).abs() < 1e-9


def _marks(rows: pd.DataFrame, speed: str, teeth: int, symbol: str, label: str) -> Iterator[Curve]:
    """Yield marks at each row's speed and the response frequency of its strongest mode; grey where on no
    line.
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
        Speeds, rpm, orders and amplitudes, m, as stage dynamics_sweep stores them in `waterfall`.
    mesh : int
        Index of the mesh in the arrays.
    mesh_name : str
        Name of the mesh.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    Figure
        The figure.
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


SIDE_STYLES: Mapping[str, tuple[str, LineStyle]] = {"upper": (RED, "solid"), "lower": (BLUE, "dash")}
SHOWN_CYCLES = 16
SHOWN_ORDERS = 4
APART = 0.04
"""Orders by which the lines of the two gears stand apart, so that neither hides the other."""
VISIBLE = 1e-3
"""Lines below this fraction of the largest amplitude are not drawn."""


def deflections(response: pd.DataFrame, spectrum: pd.DataFrame, pinions: Sequence[str]) -> Figure:
    """Draw the deflections of both meshes of each pinion, over time and as spectra without the mean.

    Parameters
    ----------
    response : DataFrame
        Deflections, µm, over mesh cycles, of which at most SHOWN_CYCLES are drawn.
    spectrum : DataFrame
        Amplitudes, µm, over orders, drawn up to SHOWN_ORDERS times the mesh frequency.
    pinions : sequence of str
        Names of the pinions.

    Returns
    -------
    Figure
        The figure.
    """
    last = float(min(SHOWN_CYCLES, response["mesh_cycle"].max()))
    cycles, orders = (
        Axis("Time", "mesh cycles", low=0.0, high=last),
        Axis("Times mesh frequency", "", low=0.0, high=SHOWN_ORDERS + 2 * APART),
    )
    panels = []
    for pinion in pinions:
        histories, lines = [], []
        for side, (colour, line) in SIDE_STYLES.items():
            history = response[response["mesh"] == f"{pinion}/{side}"]
            if not history.empty:
                at, values = history["mesh_cycle"], history["deflection_um"]
                histories.append(Curve(at, values, side, colour, line, width=0.9))
                lines.append(_lines(spectrum[spectrum["mesh"] == f"{pinion}/{side}"], side))
        panels += [
            Panel(cycles, Axis("d", "µm"), histories, title=pinion, height=1.15),
            Panel(orders, Axis("Amplitude", "µm", low=0.0), lines, height=1.15),
        ]
    title = "Deflection d along the line of action; it holds half the backlash"
    return Figure(panels, title=title, columns=2, legend_title="face gear")


def _lines(spectrum: pd.DataFrame, side: str) -> Curve:
    """Return amplitudes as vertical lines at their orders, without order 0, which is the mean."""
    colour, _ = SIDE_STYLES[side]
    rows = spectrum[(spectrum["order"] > 0.0) & (spectrum["order"] <= SHOWN_ORDERS)]
    rows = rows[rows["amplitude_um"] > VISIBLE * rows["amplitude_um"].max()]
    at = rows["order"] + (APART if side == "lower" else -APART)
    return Curve(*stems(at, rows["amplitude_um"]), side, colour)


@dataclass(frozen=True)
class DrawnMachine:
    """Names and number of teeth of a machine that its figures show.

    Attributes
    ----------
    pinions : tuple of str
        Names of all pinions.
    pinions_shown : tuple of str
        Names of the pinions that have a panel.
    sides : tuple of str
        Face gears, `upper` or `lower`.
    teeth : int
        Number of teeth of a pinion.
    """

    pinions: tuple[str, ...]
    pinions_shown: tuple[str, ...]
    sides: tuple[str, ...]
    teeth: int

    @property
    def gears(self) -> list[str]:
        """Names of the face gears, lower one first."""
        return [f"{side} face gear" for side in reversed(self.sides)]

    @property
    def meshes(self) -> list[str]:
        """Names of the meshes in the order of the arrays."""
        return [f"{name}/{side}" for side in reversed(self.sides) for name in self.pinions]


def drawn_machine(transmission: Mapping[str, Any], pinion_teeth: int) -> DrawnMachine:
    """Choose the pinions that figures show.

    Of pinions with the same role and torque only the first is shown; all are shown where parts differ singly.

    Parameters
    ----------
    transmission : mapping
        Plain values of the config's section `transmission`.
    pinion_teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    DrawnMachine
        The names and the number of teeth.
    """
    pinions, gears = transmission["pinions"], transmission["face_gears"]
    differ = any(transmission[key] for key in ("single_pinions", "single_meshes", "single_gears"))
    duties = [(pinion["role"], pinion["torque_n_m"]) for pinion in pinions]
    pinion_names = [
        pinion["name"] for i, pinion in enumerate(pinions) if differ or duties[i] not in duties[:i]
    ]
    sides = [side for side in ("upper", "lower") if side in gears]
    return DrawnMachine(
        tuple(pinion["name"] for pinion in pinions), tuple(pinion_names), tuple(sides), pinion_teeth
    )


def _waterfall(tables: Mapping[str, Any], machine: DrawnMachine) -> Figure:
    mesh_name = f"{machine.pinions_shown[-1]}/{machine.sides[0]}"
    return waterfall(tables["waterfall"], machine.meshes.index(mesh_name), mesh_name, machine.teeth)


def _campbell(tables: Mapping[str, Any], machine: DrawnMachine) -> Figure:
    last = tables["sweep"]["speed_rpm"].max()
    return campbell(tables["frequencies"], tables["resonances"], tables["jumps"], machine.teeth, last)


SWEEP_FIGURES: dict[str, Callable[[Mapping[str, Any], DrawnMachine], Figure]] = {
    "pinions": lambda tables, machine: translations(tables["sweep"], machine.pinions_shown, "xy"),
    "gears": lambda tables, machine: translations(tables["sweep"], machine.gears, "xyz"),
    "meshes": lambda tables, machine: mesh_sweeps(
        tables["sweep"], tables["jumps"], machine.pinions_shown, machine.sides
    ),
    "campbell": _campbell,
    "waterfall": _waterfall,
}
"""Figure by name: RMS of pinions, of face gears, of the meshes (with jumps), Campbell diagram, waterfall.

`tables` holds the tables sweep, jumps, resonances, frequencies and the arrays waterfall.
"""


def dynamics_figures(
    response: pd.DataFrame,
    spectrum: pd.DataFrame,
    transmission: Mapping[str, Any],
    pinion_teeth: int,
    **sweep_tables: Any,
) -> list[Figure]:
    """Draw the deflections at the nominal speed, and every figure of SWEEP_FIGURES.

    Parameters
    ----------
    response : DataFrame
        Table `response` of stage dynamics_response.
    spectrum : DataFrame
        Table `spectrum` of stage dynamics_response.
    transmission : mapping
        Plain values of the config's section `transmission`.
    pinion_teeth : int
        Number of teeth of a pinion.
    **sweep_tables : Any
        Tables and arrays of the sweep by the names that SWEEP_FIGURES uses.

    Returns
    -------
    list of Figure
        The figures.
    """
    machine = drawn_machine(transmission, pinion_teeth)
    nominal = deflections(response, spectrum, machine.pinions)
    return [nominal, *(draw(sweep_tables, machine) for draw in SWEEP_FIGURES.values())]
