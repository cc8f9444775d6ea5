"""Figures of the turning machine: gears that bend and their waves, orders of the turns."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array
from facegear.number_format import format_number
from facegear.report.figures.colours import BLUE, RED, grey
from facegear.report.figures.description import NARROW, Axis, Figure, Key, Panel, apart, stems
from facegear.report.figures.marks import Area, Curve, Faces, LineStyle, Look, Mark, Scatter, Text

OTHER_MODES = "other"
"""Kind of a mode that is no wave of a gear."""
WORDS = {
    "standing": "standing waves",
    "forward": "forward waves",
    "backward": "backward waves",
    OTHER_MODES: "other modes",
}
"""Kinds of modes in words."""
IN_WAVES = 0.25
"""Part of the kinetic energy in the waves of one gear above which a mode is coloured and marked as theirs;
two equal gears may share a mode in halves."""
COLOURS = {"standing": grey(0.3), "forward": RED, "backward": BLUE, OTHER_MODES: grey(0.75)}
"""Colour of each kind of mode."""
MARKERS = {"standing": "circle", "forward": "triangle-up", "backward": "triangle-down"}
"""Marker of a crossing by its kind of wave; its area grows with the square of the phase factor."""
MARK_SIZE = 6.0
"""Size of a crossing's marker where all phases add up, points."""


def machine_campbell(campbell: pd.DataFrame, crossings: pd.DataFrame, last_rpm: float, teeth: int) -> Figure:
    """Draw the frequencies of the machine's modes over pinion speed, with mesh harmonics.

    Marks: crossings with a mode whose energy is in the waves of a gear, larger where the phases of the meshes
    add up. Crossings that no phase excites have no mark.

    Parameters
    ----------
    campbell : DataFrame
        Modes over speed: line (number of a mode's curve), speed_rpm, frequency_hz, energy_fraction (in
        the waves of one gear), nodal_diameters, forward_fraction.
    crossings : DataFrame
        Crossings with mesh harmonics: harmonic, wave (key of MARKERS), speed_rpm, frequency_hz,
        energy_fraction, phase_factor (magnitude 1: all phases add up).
    last_rpm : float
        Last speed of the pinions, rpm.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    Figure
        One panel, kHz over rpm.
    """
    waves = crossings[crossings["energy_fraction"] >= IN_WAVES]
    bending = campbell[campbell["energy_fraction"] >= IN_WAVES]
    top = 1.02 * float((bending if len(bending) else campbell)["frequency_hz"].max())
    marks: list[Mark] = []
    kinds: dict[str, str] = {}
    for _, line in campbell.groupby("line"):
        kind = _wave(line) if line["energy_fraction"].mean() >= IN_WAVES else OTHER_MODES
        kinds[kind] = COLOURS[kind]
        look: Look = {"colour": COLOURS[kind], "width": 0.6, "opacity": 0.7}
        marks.append(Curve(line["speed_rpm"], 1e-3 * line["frequency_hz"], **look))
    marks += mesh_harmonics(crossings["harmonic"], last_rpm, top, teeth)
    marks += crossing_marks(waves)
    keys = [wave_key(kind) for kind in COLOURS if kind in kinds]
    return Figure([frame(marks, last_rpm, top)], title="Modes of the whole machine", keys=keys)


def mesh_harmonics(
    harmonics: pd.Series, last_rpm: float, top_hz: float, teeth: int
) -> Iterator[Curve | Text]:
    """Draw harmonics of the mesh frequency over speed, each with its name.

    Parameters
    ----------
    harmonics : Series
        Orders of the mesh frequency, dimensionless; the first is always drawn.
    last_rpm, top_hz : float
        Ends of the axes, rpm and Hz.
    teeth : int
        Teeth of the pinions, dimensionless.

    Yields
    ------
    Curve or Text
        The marks.
    """
    for number, harmonic in enumerate(sorted(set(harmonics) | {1})):
        mesh = harmonic * teeth / 60.0
        speeds = np.array([0.0, last_rpm])
        yield Curve(speeds, 1e-3 * mesh * speeds, colour=grey(0.5), line="dash", width=0.8)
        end = min(0.82 * last_rpm, (0.6 + 0.12 * number) * top_hz / mesh)
        yield Text(end, 1e-3 * mesh * end, f"{harmonic} x mesh", shift=(4.0, -7.0), paper=True)


def crossing_marks(crossings: pd.DataFrame) -> Iterator[Scatter]:
    """Mark every crossing in its wave's colour, larger where the phases of the meshes add up.

    Parameters
    ----------
    crossings : DataFrame
        Crossings with mesh harmonics: wave, speed_rpm, frequency_hz, phase_factor.

    Yields
    ------
    Scatter
        The marks of one kind of wave.
    """
    for wave in MARKERS:
        rows = crossings[crossings["wave"] == wave]
        if len(rows):
            sizes = np.sqrt(MARK_SIZE) * rows["phase_factor"].abs().to_numpy()
            at = rows["speed_rpm"], 1e-3 * rows["frequency_hz"]
            yield Scatter(*at, sizes, colour=COLOURS[wave], marker=MARKERS[wave])


def wave_key(kind: str) -> Key:
    """Return the entry of the legend of a kind of mode.

    Parameters
    ----------
    kind : str
        One of COLOURS.

    Returns
    -------
    Key
        The entry.
    """
    return Key(WORDS[kind], COLOURS[kind], marker=MARKERS.get(kind, ""))


def frame(marks: Sequence[Mark], last_rpm: float, top: float) -> Panel:
    """Return the panel of frequencies over speed.

    Parameters
    ----------
    marks : sequence of Mark
        Content of the panel, kHz over rpm.
    last_rpm : float
        Last speed of the axis, rpm.
    top : float
        Largest frequency of the axis, Hz.

    Returns
    -------
    Panel
        The panel.
    """
    speed = Axis("Speed of the inputs", "rpm", low=0.0, high=last_rpm)
    return Panel(speed, Axis("Frequency", "kHz", low=0.0, high=1e-3 * top), marks, height=3.7)


def _wave(line: pd.DataFrame) -> str:
    """Return the kind of wave of a mode's line over speed: `standing` if most rows have 0 nodal
    diameters, else `forward` (median forward_fraction from 0.5 on) or `backward`. `line`: its rows of
    the Campbell table.
    """
    if not line["nodal_diameters"].mode().iloc[0]:
        return "standing"
    return "forward" if np.median(line["forward_fraction"]) >= 0.5 else "backward"


def gear_waves_figures(
    campbell: pd.DataFrame, campbell_crossings: pd.DataFrame, last_rpm: float, teeth: int
) -> tuple[Figure, ...]:
    """Draw the modes of the whole machine over speed.

    Parameters
    ----------
    campbell : DataFrame
        Modes over speed, as `machine_campbell` reads them.
    campbell_crossings : DataFrame
        Crossings with mesh harmonics, as `machine_campbell` reads them.
    last_rpm : float
        Last speed of the pinions, rpm.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    tuple of Figure
        The figure.
    """
    return (machine_campbell(campbell, campbell_crossings, last_rpm, teeth),)


SWING = 0.08
"""Largest displacement drawn, in the section's radial width."""
COLUMNS = 2
"""Number of columns of panels of mode shapes."""


def body_shapes(modes: pd.DataFrame, shapes: Mapping[str, AnyArray]) -> Figure:
    """Draw the first mode of every nodal diameter on the gear's section; one gear, as most machines have
    equal gears.

    Grey: at rest. Colour: at a crest of the wave, exaggerated; the brighter, the larger the motion, rotation
    about the axis included.

    Parameters
    ----------
    modes : DataFrame
        Table `modes` of stage gear_bodies: gear, nodal_diameters, mode, frequency_hz.
    shapes : mapping of (...) arrays
        Arrays of stage gear_bodies (see `facegear.parts.body_tables.shape_arrays`); nodes in m.

    Returns
    -------
    Figure
        A panel for each nodal diameter, mm: radius across, height up.
    """
    gear = str(modes["gear"].iloc[0]) if len(modes) else next(iter(shapes)).rpartition("_")[0]
    nodes, quads = 1e3 * shapes[f"{gear}_nodes"], shapes[f"{gear}_quads"]
    labels = shapes[f"{gear}_labels"]
    wide = np.ptp(nodes[:, 0])
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    left, right = low[0] - 12.0, high[0] + 12.0
    bottom, top = low[1] - 0.12 * wide, high[1] + 0.12 * wide
    across = Axis("From the axis", "mm", low=left, high=right)
    up = Axis("Height", "mm", low=bottom, high=top)
    margin = 0.5 * NARROW - 0.75
    height = margin * (top - bottom) / (right - left)
    panels = []
    for number in np.flatnonzero(labels[:, 1] == 1):
        order = int(labels[number, 0])
        row = modes[(modes["gear"] == gear) & (modes["nodal_diameters"] == order) & (modes["mode"] == 1)]
        marks = _section(nodes, quads, shapes[f"{gear}_shapes"][number])
        title = f"n = {order}, {format_number(row['frequency_hz'].iloc[0], 4)} Hz"
        panels.append(Panel(across, up, marks, title=title, equal=True, height=max(height, 0.7)))
    return Figure(panels, title=f"{gear} face gear, hub held", columns=COLUMNS, shared_y=True)


def _section(nodes: Array, quads: AnyArray, shape: Array) -> list[Area | Faces]:
    """Return the section at rest, and displaced by the exaggerated mode shape, coloured by its
    magnitude.

    nodes: (n, 2) radius and height, mm; quads: (cells, 4) node indices; shape: (n, 3) radial,
    tangential and axial displacement in any unit.
    """
    swing = SWING * np.ptp(nodes[:, 0]) / np.abs(shape).max()
    displaced_nodes = nodes + swing * shape[:, [0, 2]]
    size = np.linalg.norm(shape, axis=1)[quads].mean(axis=1)
    rings = np.concatenate([nodes[quads], nodes[quads[:, :1]]], axis=1)
    return [
        Area(*apart(rings[..., 0], rings[..., 1]), colour=grey(0.85)),
        Faces(displaced_nodes[quads], size),
    ]


def body_waves(modes: pd.DataFrame) -> Figure:
    """Draw frequencies at rest and of both waves in space over nodal diameters, a panel for each gear.

    Parameters
    ----------
    modes : pd.DataFrame
        Table `modes` of stage gear_bodies: gear, nodal_diameters, frequency_hz (at rest), forward_hz and
        backward_hz (in space).

    Returns
    -------
    Figure
        A panel for each gear, kHz.
    """
    orders = Axis("Nodal diameters", "", integer=True)
    panels = []
    for gear in modes["gear"].drop_duplicates():
        gear_modes = modes[modes["gear"] == gear]
        waves = gear_modes[gear_modes["nodal_diameters"] > 0]
        rest: Look = {"line": "none", "marker": "line-ew", "size": 9.0}
        marks = [Curve(gear_modes["nodal_diameters"], 1e-3 * gear_modes["frequency_hz"], "at rest", **rest)]
        for name in ("forward", "backward"):
            look: Look = {"line": "none", "marker": MARKERS[name], "size": 3.5}
            values = 1e-3 * waves[f"{name}_hz"]
            marks.append(Curve(waves["nodal_diameters"], values, name, COLOURS[name], **look))
        frequency = Axis("Frequency", "kHz", low=0.0)
        panels.append(Panel(orders, frequency, marks, title=f"{gear} face gear", height=2.3))
    return Figure(panels or [Panel(orders, Axis("Frequency", "kHz"), [])])


def body_campbell(modes: pd.DataFrame, crossings: pd.DataFrame, last_rpm: float, teeth: int) -> Figure:
    """Draw waves over pinion speed as meshes meet them, with mesh harmonics; one gear, as most are alike.

    Marks: crossings with a mesh harmonic, larger where the phases of the meshes add up.

    Parameters
    ----------
    modes : pd.DataFrame
        Table `modes` of stage gear_bodies, as for `body_waves`, with speed_rpm, at which waves are given.
    crossings : pd.DataFrame
        Table `crossings` of stage gear_bodies: gear and the columns of `crossing_marks`, and harmonic.
    last_rpm : float
        Last speed of the pinions, rpm.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    Figure
        One panel, kHz over rpm.
    """
    gear = modes["gear"].iloc[0] if len(modes) else ""
    gear_modes, gear_crossings = modes[modes["gear"] == gear], crossings[crossings["gear"] == gear]
    top = 1.02 * gear_modes["frequency_hz"].max() if len(gear_modes) else 1.0
    speeds = np.linspace(0.0, last_rpm, 60)
    marks: list[Mark] = []
    kinds = set()
    for row in gear_modes.itertuples():
        shift = (row.forward_hz - row.backward_hz) / 2.0
        for sign, kind in (
            ((1.0, "forward"), (-1.0, "backward")) if row.nodal_diameters else ((1.0, "standing"),)
        ):
            bend = (row.forward_hz + row.backward_hz) / 2.0
            curve = _gear_bodies_wave(row.frequency_hz, bend, sign * shift, row.speed_rpm, speeds)
            marks.append(Curve(speeds, 1e-3 * curve, colour=COLOURS[kind], width=0.6, opacity=0.7))
            kinds.add(kind)
    marks += mesh_harmonics(gear_crossings["harmonic"], last_rpm, top, teeth)
    marks += crossing_marks(gear_crossings)
    keys = [wave_key(kind) for kind in COLOURS if kind in kinds]
    return Figure([frame(marks, last_rpm, top)], title=f"{gear} face gear, hub held", keys=keys)


def _gear_bodies_wave(frequency: float, middle: float, shift: float, at: float, speeds: Array) -> Array:
    """Return a wave's frequency, Hz, over `speeds` (n,), rpm: with x = speeds / at it is
    sqrt(frequency² + (middle² - frequency²) x²) + shift x.

    frequency: at rest, Hz; middle: mean of forward and backward wave, Hz, and shift: half of their
    difference, Hz, negative for the backward wave, both at the speed `at`, rpm.
    """
    over = speeds / at
    return np.asarray(
        np.sqrt(np.maximum(frequency**2 + (middle**2 - frequency**2) * over**2, 0.0)) + shift * over
    )


def gear_bodies_figures(
    modes: pd.DataFrame,
    crossings: pd.DataFrame,
    shapes: Mapping[str, AnyArray],
    last_rpm: float,
    teeth: int,
) -> tuple[Figure, ...]:
    """Draw mode shapes on the section, waves over nodal diameters, and over speed.

    Parameters
    ----------
    modes : pd.DataFrame
        Table `modes` of stage gear_bodies.
    crossings : pd.DataFrame
        Table `crossings` of stage gear_bodies.
    shapes : Mapping[str, AnyArray]
        Arrays of stage gear_bodies (see `facegear.parts.body_tables.shape_arrays`).
    last_rpm : float
        Last speed of the pinions, rpm.
    teeth : int
        Number of teeth of a pinion.

    Returns
    -------
    tuple[Figure, ...]
        Those of `body_shapes`, `body_waves` and `body_campbell`.
    """
    campbell = body_campbell(modes, crossings, last_rpm, teeth)
    return body_shapes(modes, shapes), body_waves(modes), campbell


GEARS = {"pinion": BLUE, "face_gear": RED}
"""Colour of the orders of each gear's turns."""
LINES: tuple[LineStyle, ...] = ("solid", "dash", "dot", "dashdot")
"""Lines of the largest orders."""
ORDERS_SHOWN = 3
"""Orders of each gear that are drawn over speed."""


def shaft_orders_figures(orders: pd.DataFrame, over_speed: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the figure of the orders.

    Parameters
    ----------
    orders : pd.DataFrame
        Table `orders` of stage shaft_orders, as `shaft_order_figure` reads it.
    over_speed : pd.DataFrame
        Table `over_speed` of stage shaft_orders.

    Returns
    -------
    tuple[Figure, ...]
        The figure.
    """
    return (shaft_order_figure(orders, over_speed),)


def shaft_order_figure(orders: pd.DataFrame, over_speed: pd.DataFrame) -> Figure:
    """Draw above the largest force of all meshes at each order, below the largest orders over speed.

    Parameters
    ----------
    orders : pd.DataFrame
        Table `orders` of stage shaft_orders: turning (key of GEARS), of_mesh (frequency over the mesh
        frequency), force_n.
    over_speed : pd.DataFrame
        Table `over_speed` of stage shaft_orders: turning, order (of the turns), speed_rpm, force_n.

    Returns
    -------
    Figure
        Two panels, N.
    """
    above: list[Curve] = []
    below: list[Curve] = []
    for gear, colour in GEARS.items():
        rows = orders[orders["turning"] == gear]
        largest = rows.groupby("of_mesh")["force_n"].max()
        name = gear.replace("_", " ")
        if len(largest):
            above.append(Curve(*stems(largest.index, largest), f"turns of the {name}", colour))
        below += _over_speed(over_speed[over_speed["turning"] == gear], colour, name)
    frequency = Axis("Frequency over the mesh frequency", "")
    return Figure(
        [
            Panel(
                frequency,
                Axis("Force at the\nnominal speed", "N", low=0.0),
                above,
                height=2.0,
                own_legend=True,
            ),
            Panel(
                Axis("Speed of the pinions", "rpm"),
                Axis("Largest force\nof all meshes", "N", low=0.0),
                below,
                height=2.0,
            ),
        ],
        shared_x=False,
    )


def _over_speed(rows: pd.DataFrame, colour: str, name: str) -> Iterator[Curve]:
    """Yield force (N) over speed (rpm) of the ORDERS_SHOWN orders with the largest forces, lowest first."""
    peaks = rows.groupby("order")["force_n"].max().nlargest(ORDERS_SHOWN)
    for line, order in zip(LINES, np.sort(peaks.index), strict=False):
        order_rows = rows[rows["order"] == order]
        yield Curve(order_rows["speed_rpm"], order_rows["force_n"], f"{name}, order {order}", colour, line)
