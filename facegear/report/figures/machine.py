"""Figures of the machine at rest: layout, modes, shafts."""

import textwrap
from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.build.machine_layout import layout as layout_of
from facegear.build.tooth_numbers import ToothNumbers
from facegear.machine.layout import Layout, Role, Side
from facegear.number_format import format_number
from facegear.report.figures.campbell import CLASS_COLOURS
from facegear.report.figures.colours import BLACK, BLUE, GREEN, PURPLE, RED, grey
from facegear.report.figures.description import Axis, Figure, Key, Panel
from facegear.report.figures.marks import Area, Arrow, Bars, Curve, Line, LineStyle, Look, Mark, Text
from facegear.schema.transmission import Transmission

ROLE_COLOUR = {Role.INPUT: BLUE, Role.IDLER: grey(0.55), Role.TAIL: PURPLE}
"""Colour of the pinions of each role."""


OPACITY = 0.55
"""Opacity of a drawn pinion."""


MESH, BEARING = RED, GREEN
"""Colours of the forces of meshes and on bearings."""


ON_BEARINGS = "force on bearings, same scale"
"""Legend of the forces on bearings."""


LONGEST = 0.55
"""Longest arrow over the mesh radius."""


HALF_FACE = 0.06
"""Half of the drawn face width over the mesh radius."""


LABEL = 1.16
"""Distance from the gear's centre at which the pinions' labels begin, over the mesh radius."""


REACH, BELOW, TITLE = 2.0, 1.75, 1.8
"""Extent of a panel beside and below the gear's centre, and height of its title, over the mesh radius."""


LETTERS = 13
"""Letters of a pinion's name in one line."""


BESIDE = 0.4
"""Cosine of the direction to a pinion below which its label is centred."""


def gearbox_layout_figures(
    meshes: pd.DataFrame, transmission: Transmission, teeth: ToothNumbers
) -> tuple[Figure, ...]:
    """Draw the machine with its forces at rest.

    Parameters
    ----------
    meshes : DataFrame
        Table `meshes` of stage ratings: mesh, force_n and flank (`back` loads the other flank).
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Numbers of teeth and sizes of the pair.

    Returns
    -------
    tuple of Figure
        The figure.
    """
    drives = (meshes["flank"] != "back").astype(float)
    loads = pd.DataFrame({"mesh": meshes["mesh"], "mean_n": meshes["force_n"].abs()})
    loads = loads.assign(drive_fraction=drives, back_fraction=1.0 - drives)
    return (layout_figure(layout_of(transmission, teeth), loads),)


def layout_figure(layout: Layout, meshes: pd.DataFrame, bearings: pd.DataFrame | None = None) -> Figure:
    """Draw a layout seen from above: a panel for each face gear, the upper one on top.

    Red: mean tangential force of each pinion on the gear. Green, if bearings are given: mean force on the
    bearings, of the pinions (tangential) inside the upper gear, of the gear from its centre.

    Parameters
    ----------
    layout : Layout
        Angles, mesh radius (m) and roles of pinions and gears.
    meshes : DataFrame
        Mean load along the line of action, mean_n (N), and fractions of the time on either flank,
        drive_fraction and back_fraction, of each mesh, as in table `meshes` of stage hunting.
    bearings : DataFrame or None
        Mean forces on bearings, mean_x_n to mean_z_n (N), of each body, as in table `bearings` of stage
        hunting.

    Returns
    -------
    Figure
        The figure.
    """
    loads = meshes.set_index("mesh")
    forces = None if bearings is None else bearings.set_index("body")
    max_tangential_force = loads["mean_n"].max() * layout.pitch_slope
    largest = (
        max_tangential_force
        if forces is None
        else max(max_tangential_force, forces[["mean_x_n", "mean_y_n"]].abs().to_numpy().max())
    )
    order = sorted(range(len(layout.gears)), key=lambda g: -layout.gears[g].sign)
    metres = layout.mesh_radius * LONGEST / max(largest, 1e-300)
    roles = {pinion.role for pinion in layout.pinions}
    keys = [
        Key(f"tangential force on the gear, largest {_kilo(max_tangential_force)} kN", MESH, width=2.0),
        *([] if forces is None else [Key(ON_BEARINGS, BEARING, width=2.0)]),
        *(
            Key(f"{role.value} pinion", colour, area=True, opacity=OPACITY)
            for role, colour in ROLE_COLOUR.items()
            if role in roles
        ),
    ]
    return Figure([_panel(layout, g, loads, forces, metres) for g in order], shared_x=False, keys=keys)


def _panel(layout: Layout, g: int, loads: pd.DataFrame, forces: pd.DataFrame | None, metres: float) -> Panel:
    """Return the panel of the face gear with index `g`, seen from above: rim, pinions, forces and
    labels.

    loads: table `meshes` by mesh (mean_n, drive_fraction, back_fraction); forces: table `bearings` by
    body (mean_x_n, mean_y_n, mean_z_n), None for none; metres: length of the arrow of one newton, m.
    """
    gear, radius = layout.gears[g], layout.mesh_radius
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    marks: list[Mark] = [
        Curve(edge * radius * np.cos(turn), edge * radius * np.sin(turn), colour=grey(0.6), width=1.0)
        for edge in (1.0 - HALF_FACE, 1.0 + HALF_FACE)
    ]
    marks.append(_turn_arrow(0.55 * radius, gear.sign))
    half_width = 0.5 * layout.mesh_radius * layout.pinion_teeth / layout.gear_teeth
    for i, pinion in enumerate(layout.pinions):
        angle = layout.angles[i]
        along = np.array([np.cos(angle), np.sin(angle)])
        outwards = np.array([np.sin(angle), -np.cos(angle)])
        middle = radius * outwards
        corners = np.array(
            [
                middle + a * half_width * along + b * HALF_FACE * radius * outwards
                for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
            ]
        )
        marks.append(Area(corners[:, 0], corners[:, 1], colour=ROLE_COLOUR[pinion.role], opacity=OPACITY))
        row = loads.loc[layout.mesh_names[layout.mesh_index(i, gear.side)]]
        flank = layout.flank_frames[g][0 if row["drive_fraction"] >= row["back_fraction"] else 1]
        force = row["mean_n"] * flank.gear_normal[0] * along
        marks += _arrow(middle, metres * force, MESH)
        if forces is not None and (gear.side is Side.UPPER or len(layout.gears) == 1):
            inside = (1.0 - 2.5 * HALF_FACE) * radius * outwards
            marks += _arrow(inside, metres * forces.loc[pinion.name, "mean_x_n"] * along, BEARING)
        name = textwrap.fill(pinion.name, LETTERS)
        text = f"{name}\n{format_number(np.degrees(angle), 4)}°\n{_kilo(row['mean_n'])} kN"
        marks.append(_label(radius, outwards, text))
    title = f"{gear.name.capitalize()}, seen from above"
    if forces is not None:
        gear_forces = forces.loc[gear.name]
        marks += _arrow(np.zeros(2), metres * gear_forces[["mean_x_n", "mean_y_n"]].to_numpy(float), BEARING)
        title += f"\naxial on its bearing {_kilo(gear_forces['mean_z_n'])} kN"
    marks.append(Text(0.0, TITLE * radius, title, across="center", upright="bottom"))
    diameter = f"mesh diameter\n{format_number(2e3 * radius, 4)} mm"
    marks.append(Text(0.0, 0.3 * radius, diameter, across="center"))
    return Panel(
        Axis("x", "m", low=-REACH * radius, high=REACH * radius),
        Axis("y", "m", low=-BELOW * radius, high=(2.0 * REACH - BELOW) * radius),
        marks,
        height=4.5,
        equal=True,
        bare=True,
    )


def _label(radius: float, outwards: np.ndarray, text: str) -> Text:
    """Return the text beside a pinion, LABEL mesh radii from the centre; it begins at the rim and runs
    outwards.

    radius: mesh radius, m; outwards: unit vector (2,) from the gear's centre to the pinion.
    """
    x, y = outwards
    look: Look = {
        "across": "center" if abs(x) < BESIDE else "left" if x > 0.0 else "right",
        "upright": "center" if abs(y) < BESIDE else "bottom" if y > 0.0 else "top",
    }
    at = LABEL * radius * outwards
    return Text(float(at[0]), float(at[1]), text, **look)


def _turn_arrow(radius: float, turns: float) -> Arrow:
    """Return an arc with a head at a radius (m): the gear turns counterclockwise for `turns` > 0, else
    clockwise. `turns` is 1 or -1."""
    ends = np.radians([200.0, 250.0]) if turns > 0.0 else np.radians([250.0, 200.0])
    start, stop = ((radius * np.cos(a), radius * np.sin(a)) for a in ends)
    return Arrow(start, stop, width=1.0, bend=0.25 * turns)


def _arrow(start: np.ndarray, vector: np.ndarray, colour: str) -> list[Arrow]:
    """Return the arrow from `start` along `vector`, (2,) in m each, in a list; an empty list for a zero
    vector.
    """
    end = start + vector
    return [Arrow(tuple(start), tuple(end), colour)] if np.hypot(*vector) > 0.0 else []


def _kilo(newtons: float) -> str:
    """Return a force given in N as text in kN with three digits, without the unit."""
    return format_number(newtons / 1e3)


PLAIN_MOTIONS = ("x", "y", "z", "θ")
"""Motions of a body that neither tilts nor bends, in the order of the bars."""
MOST_BARS = 12
"""Motions of a body that have a bar each; of more, as those of a casing, the largest stands for all."""
MOST_SHAPES = 12
"""Kinds of modes that are drawn at most, a free choice: a casing has as many kinds as modes, whose 60 panels
nobody reads."""


def typical_modes(frequencies: pd.DataFrame) -> list[tuple[int, ...]]:
    """Return the orders of the first modes of each kind: one mode, or all modes of one frequency. Of more
    than MOST_SHAPES kinds the lowest are taken.

    A kind is a class with the same symbols; rigid modes are left out. A simple mode is taken if there is one,
    as a single vector out of several modes of one frequency is arbitrary.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal: order, class, symbols, multiplicity.

    Returns
    -------
    list[tuple[int, ...]]
        Orders (numbers from low to high frequency) of the modes of each kind, sorted.
    """
    elastic = frequencies[frequencies["class"] != "rigid body"]
    modes = []
    for _, rows in elastic.groupby(["class", "symbols"], sort=False):
        first = rows.loc[rows["multiplicity"].idxmin()]
        modes.append(tuple(int(first["order"]) + i for i in range(int(first["multiplicity"]))))
    return sorted(modes)[:MOST_SHAPES]


def amplitudes(shapes: pd.DataFrame, orders: tuple[int, ...]) -> Array:
    """Return the amplitudes of all degrees of freedom in a mode, over the largest of them.

    Several modes of one frequency give their root sum of squares, which does not depend on the choice of
    their vectors.

    Parameters
    ----------
    shapes : DataFrame
        Table `shapes` of stage modal: order and amplitude_m_or_rad, a row for each mode and degree of
        freedom.
    orders : tuple of int
        Numbers of the modes.

    Returns
    -------
    (dof,) array
        Amplitudes relative to the largest one; translations in m and rotations in rad are compared as
        numbers.
    """
    vectors = [shapes.loc[shapes["order"] == order, "amplitude_m_or_rad"].to_numpy() for order in orders]
    if len(vectors) == 1:
        return vectors[0] / vectors[0][np.abs(vectors[0]).argmax()]
    together = np.sqrt(np.sum(np.square(vectors), axis=0))
    return together / together.max()


def mode_shapes(frequencies: pd.DataFrame, shapes: pd.DataFrame) -> Figure:
    """Draw the modes of `typical_modes` as bars over all degrees of freedom, relative to the largest one.

    Metres and radians are compared as numbers, as in the paper.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal: order, frequency_hz, class, symbols, multiplicity.
    shapes : pd.DataFrame
        Table `shapes` of stage modal: order, body, amplitude_m_or_rad; x, y, z, rotation of each body.

    Returns
    -------
    Figure
        A panel for each kind of mode.
    """
    by_order = frequencies.set_index("order")
    dofs = shapes[shapes["order"] == shapes["order"].iloc[0]].reset_index(drop=True)
    # Tilts and elastic motions stand behind those of all bodies in the table.
    codes, bodies = pd.factorize(dofs["body"])
    groups = [np.flatnonzero(codes == code) for code in range(len(bodies))]
    counts = np.array([len(group) if len(group) <= MOST_BARS else 1 for group in groups])
    edges = np.concatenate([[0], np.cumsum(counts)])
    middles = 0.5 * (edges[:-1] + edges[1:] - 1.0)
    names = [(float(middle), str(body)) for middle, body in zip(middles, bodies, strict=True)]
    further = ", further motions" if counts.max() > len(PLAIN_MOTIONS) else ""
    across = Axis(f"{', '.join(PLAIN_MOTIONS)}{further} of each body", "", ticks=names)
    panels = []
    for orders in typical_modes(frequencies):
        mode = by_order.loc[orders[0]]
        every = amplitudes(shapes, orders)
        heights = np.concatenate([_bars(every[group]) for group in groups])
        marks: list[Bars | Line] = [
            *(Line(float(edge) - 0.5, colour=grey(0.8), width=0.6) for edge in edges[1:-1]),
            Line(0.0, "y", colour=BLACK, width=0.6),
            Bars(np.arange(edges[-1], dtype=float), heights, colour=CLASS_COLOURS[mode["class"]]),
        ]
        up = Axis("", "", low=-1.1 if len(orders) == 1 else 0.0, high=1.1)
        panels.append(Panel(across, up, marks, title=_title(orders, mode), height=0.85))
    return Figure(panels, y_label="Amplitude relative to the largest")


def _bars(amplitudes_of_body: Array) -> Array:
    """Return the heights of a body's bars (bars,): its amplitudes, or the largest of more than MOST_BARS."""
    if len(amplitudes_of_body) <= MOST_BARS:
        return amplitudes_of_body
    return amplitudes_of_body[[int(np.abs(amplitudes_of_body).argmax())]]


def _title(orders: tuple[int, ...], mode: pd.Series) -> str:
    """Return the title of a mode's panel: orders, frequency (Hz) and symbols. `mode`: its row of table
    `frequencies`; several orders share one frequency.
    """
    if len(orders) == 1:
        return f"Mode {orders[0]}, {format_number(mode['frequency_hz'], 4)} Hz\n{mode['symbols']}"
    order_text = (
        f"Modes {orders[0]} to {orders[-1]} (x {len(orders)}), {format_number(mode['frequency_hz'], 4)} Hz"
    )
    return f"{order_text}, root sum of squares\n{mode['symbols']}"


def modal_figures(frequencies: pd.DataFrame, shapes: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw typical mode shapes.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.
    shapes : pd.DataFrame
        Table `shapes` of stage modal.

    Returns
    -------
    tuple[Figure, ...]
        The figure of `mode_shapes`.
    """
    return (mode_shapes(frequencies, shapes),)


CURVES: Mapping[str, tuple[str, str, LineStyle]] = {
    "x": ("tangential to the gear (x)", BLUE, "solid"),
    "y": ("along the gear's axis (y)", RED, "dash"),
}
"""Legend, colour and line of the deflection in each direction."""


MARGIN = 0.06
"""Room beside a shaft, in its length."""
