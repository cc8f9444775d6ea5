"""Figures of the machine in motion: response, sweep, Campbell diagram."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from facegear.motion.plan import JumpKind
from facegear.report.figures.campbell import campbell, waterfall
from facegear.report.figures.colours import BLUE, GREEN, RED, colour_of
from facegear.report.figures.description import Axis, Figure, Panel, stems
from facegear.report.figures.marks import Curve, Line, LineStyle, Look

DIRECTION_STYLES: Mapping[str, tuple[str, LineStyle]] = {"up": (RED, "solid"), "down": (BLUE, "dash")}
"""Colour and line of each direction of a sweep."""


AXIS_STYLES: Mapping[str, tuple[str, LineStyle]] = {
    "x": (RED, "solid"),
    "y": (BLUE, "dash"),
    "z": (GREEN, "dot"),
}
"""Colour and line of each translation."""


RMS_HEIGHT = 1.3
"""Inches of a panel of RMS over speed."""


def select(sweep: pd.DataFrame, direction: str, quantity: str, item: str) -> pd.DataFrame:
    """Return the rows of one curve of a sweep, ordered by speed.

    Parameters
    ----------
    sweep : DataFrame
        Table `sweep` of stage dynamics_sweep: direction, speed_rpm, quantity, body_or_mesh, value.
    direction : str
        `up` or `down`.
    quantity : str
        Name of the quantity, such as `deflection_ac_rms_um`.
    item : str
        Name of the body or mesh.

    Returns
    -------
    DataFrame
        Rows of this direction, quantity and item, with all columns.
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
        Table `sweep` of stage dynamics_sweep; column speed_rpm is read.

    Returns
    -------
    Axis
        The axis, rpm, from 0 to the largest speed.
    """
    return Axis("Input speed", "rpm", low=0.0, high=float(sweep["speed_rpm"].max()))


def rms_axis() -> Axis:
    """Return the axis of the RMS of a mesh deflection d along the line of action, without its mean.

    Returns
    -------
    Axis
        The axis, µm, from 0.
    """
    return Axis("RMS of d", "µm", low=0.0)


def translations(sweep: pd.DataFrame, bodies: Sequence[str], letters: str) -> Figure:
    """Draw the RMS without mean of translations over speed, a panel for each body, of the first direction of
    the sweep.

    Parameters
    ----------
    sweep : DataFrame
        Table `sweep` of stage dynamics_sweep, as `select` reads it.
    bodies : sequence of str
        Names of the bodies.
    letters : str
        Axes to draw, such as `xy`.

    Returns
    -------
    Figure
        A panel for each body, RMS in µm over rpm.
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
        Table `sweep` of stage dynamics_sweep, as `select` reads it.
    jumps : DataFrame
        Table `jumps` of stage dynamics_sweep: direction, kind, speed_after_rpm.
    pinions : sequence of str
        Names of the pinions.
    sides : sequence of str
        Face gears, `upper` or `lower`.

    Returns
    -------
    Figure
        A panel for each side and pinion, RMS in µm over rpm.
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
        Table `jumps` of stage dynamics_sweep: direction, kind, speed_after_rpm.

    Yields
    ------
    Line
        A short tick at the speed after the jump; a dotted one where irregular motion begins or ends.
    """
    for jump in jumps.itertuples():
        colour, _ = DIRECTION_STYLES[jump.direction]
        irregular = jump.kind == JumpKind.IRREGULAR
        line: LineStyle = "dot" if irregular else "solid"
        yield Line(
            jump.speed_after_rpm, colour=colour, line=line, width=1.2, part=0.12 if irregular else 0.04
        )


LINES: Mapping[str, LineStyle] = {"up": "solid", "down": "dash"}
"""Line of each direction of a sweep, where colours tell machines apart."""


def mesh_sweeps_beside(sweeps: Mapping[str, pd.DataFrame], meshes: Sequence[str]) -> Figure:
    """Draw the RMS without mean of mesh deflections over speed for several machines, a colour for each
    machine.

    A solid line is for rising speed, a dashed one for falling speed.

    Parameters
    ----------
    sweeps : mapping of str to DataFrame
        Table `sweep` of stage dynamics_sweep of each machine by its label.
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


SIDE_STYLES: Mapping[str, tuple[str, LineStyle]] = {"upper": (RED, "solid"), "lower": (BLUE, "dash")}
"""Colour and line of the meshes of each face gear."""


SHOWN_CYCLES = 16
"""Largest number of mesh cycles drawn; more would hide the curve's shape."""


SHOWN_ORDERS = 4
"""Largest multiple of the mesh frequency drawn."""


APART = 0.04
"""Orders by which the lines of the two gears stand apart, so that neither hides the other."""


VISIBLE = 1e-3
"""Lines below this fraction of the largest amplitude are not drawn."""


def deflections(response: pd.DataFrame, spectrum: pd.DataFrame, pinions: Sequence[str]) -> Figure:
    """Draw the deflections of both meshes of each pinion, over time and as spectra without the mean.

    Parameters
    ----------
    response : DataFrame
        Table `response` of stage dynamics_response: mesh, mesh_cycle, deflection_um; at most SHOWN_CYCLES
        cycles are drawn.
    spectrum : DataFrame
        Table `spectrum` of that stage: mesh, order (multiple of the mesh frequency), amplitude_um;
        drawn up to SHOWN_ORDERS.
    pinions : sequence of str
        Names of the pinions.

    Returns
    -------
    Figure
        Two panels beside each other for each pinion: history and spectrum.
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
    """Return the amplitudes (µm) of one mesh as vertical lines at their orders (multiples of the mesh
    frequency), above order 0, the mean, up to SHOWN_ORDERS. Lines of both gears stand APART beside
    their order.

    spectrum: rows of table `spectrum` of one mesh; side: `upper` or `lower`.
    """
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
        """Names `lower face gear` and `upper face gear`, the lower one first, as far as `sides` holds
        them.
        """
        return [f"{side} face gear" for side in reversed(self.sides)]

    @property
    def meshes(self) -> list[str]:
        """Names `pinion/side` of all meshes in the order of the arrays: all pinions with the lower gear
        first.
        """
        return [f"{name}/{side}" for side in reversed(self.sides) for name in self.pinions]


def drawn_machine(transmission: Mapping[str, Any], pinion_teeth: int) -> DrawnMachine:
    """Choose the pinions that figures show.

    Of pinions with the same role and torque only the first is shown. All are shown if the config gives
    values of single pinions, meshes or gears.

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
    """Draw the waterfall of the last shown pinion's mesh with the first of the sides. `tables`: arrays
    `waterfall` of stage dynamics_sweep by that name.
    """
    mesh_name = f"{machine.pinions_shown[-1]}/{machine.sides[0]}"
    return waterfall(tables["waterfall"], machine.meshes.index(mesh_name), mesh_name, machine.teeth)


def _campbell(tables: Mapping[str, Any], machine: DrawnMachine) -> Figure:
    """Draw the Campbell diagram up to the largest speed of the sweep. `tables`: tables frequencies,
    resonances, jumps and sweep by name.
    """
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
        Deflections of all pinions, then the figures in the order of SWEEP_FIGURES.
    """
    machine = drawn_machine(transmission, pinion_teeth)
    nominal = deflections(response, spectrum, machine.pinions)
    return [nominal, *(draw(sweep_tables, machine) for draw in SWEEP_FIGURES.values())]
