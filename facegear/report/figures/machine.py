"""Figures of the machine at rest: layout, modes, shafts."""

import textwrap
from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.build.machine_layout import ToothNumbers
from facegear.build.machine_layout import layout as layout_of
from facegear.machine.layout import Layout, Role, Side
from facegear.number_format import format_number
from facegear.report.figures.colours import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, WHITE, grey
from facegear.report.figures.description import Axis, Figure, Key, Panel
from facegear.report.figures.marks import Area, Arrow, Bars, Curve, Line, LineStyle, Look, Mark, Text
from facegear.report.figures.motion import CLASS_COLOURS
from facegear.schema.shafts import ShaftSection
from facegear.schema.transmission import Transmission

ROLE_COLOUR = {Role.INPUT: BLUE, Role.IDLER: grey(0.55), Role.TAIL: PURPLE}
OPACITY = 0.55
"""Opacity of a drawn pinion."""
MESH, BEARING = RED, GREEN
ON_BEARINGS = "force on bearings, same scale"
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
        Table `meshes` of stage ratings.
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
        Places and roles of pinions and gears.
    meshes : DataFrame
        Mean load, N, and fractions of the time on either flank of each mesh, as in table `meshes` of stage
        hunting.
    bearings : DataFrame or None
        Mean forces on bearings, N, as in table `bearings` of stage hunting.

    Returns
    -------
    Figure
        The figure.
    """
    loads = meshes.set_index("mesh")
    forces = None if bearings is None else bearings.set_index("body")
    max_tangential_force = loads["mean_n"].max() * np.cos(layout.pressure_angle)
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
    """Return the panel of face gear `g`: rim, pinions, forces and labels. `metres`: arrow length of one
    newton.
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
        drives = 1.0 if row["drive_fraction"] >= row["back_fraction"] else -1.0
        force = gear.sign * drives * row["mean_n"] * np.cos(layout.pressure_angle) * along
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
    """Return the text beside a pinion, outside the gear; it begins at the rim, whatever its length."""
    x, y = outwards
    look: Look = {
        "across": "center" if abs(x) < BESIDE else "left" if x > 0.0 else "right",
        "upright": "center" if abs(y) < BESIDE else "bottom" if y > 0.0 else "top",
    }
    at = LABEL * radius * outwards
    return Text(float(at[0]), float(at[1]), text, **look)


def _turn_arrow(radius: float, turns: float) -> Arrow:
    """Return a curved arrow at a radius (m) that shows in which sense (sign of `turns`) the gear turns."""
    ends = np.radians([200.0, 250.0]) if turns > 0.0 else np.radians([250.0, 200.0])
    start, stop = ((radius * np.cos(a), radius * np.sin(a)) for a in ends)
    return Arrow(start, stop, width=1.0, bend=0.25 * turns)


def _arrow(start: np.ndarray, vector: np.ndarray, colour: str) -> list[Arrow]:
    """Return the arrow of a force in a list; the list is empty for a force of zero."""
    end = start + vector
    return [Arrow(tuple(start), tuple(end), colour)] if np.hypot(*vector) > 0.0 else []


def _kilo(newtons: float) -> str:
    """Return a force in N as text in kN."""
    return format_number(newtons / 1e3)


def typical_modes(frequencies: pd.DataFrame) -> list[tuple[int, ...]]:
    """Return the orders of the first modes of each kind: one mode, or all modes of one frequency.

    A kind is a class with the same symbols; rigid modes are left out. A simple mode is taken if there is one,
    as a single vector out of several modes of one frequency is arbitrary.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.

    Returns
    -------
    list[tuple[int, ...]]
        Orders of the modes of each kind.
    """
    elastic = frequencies[frequencies["class"] != "rigid body"]
    modes = []
    for _, rows in elastic.groupby(["class", "symbols"], sort=False):
        first = rows.loc[rows["multiplicity"].idxmin()]
        modes.append(tuple(int(first["order"]) + i for i in range(int(first["multiplicity"]))))
    return sorted(modes)


def amplitudes(shapes: pd.DataFrame, orders: tuple[int, ...]) -> Array:
    """Return the amplitudes of all degrees of freedom in a mode, over the largest of them.

    Several modes of one frequency give their root sum of squares, which does not depend on the choice of
    their vectors.

    Parameters
    ----------
    shapes : DataFrame
        Table `shapes` of stage modal.
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
    """Draw bars over all DOF, relative to the largest in the mode (m and rad alike, as in the paper).

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.
    shapes : pd.DataFrame
        Table `shapes` of stage modal.

    Returns
    -------
    Figure
        The figure.
    """
    by_order = frequencies.set_index("order")
    dofs = shapes[shapes["order"] == shapes["order"].iloc[0]].reset_index(drop=True)
    bodies = dofs["body"].drop_duplicates()
    names = [(float(first) + 1.5, str(body)) for first, body in bodies.items()]
    across = Axis("Degrees of freedom: x, y, z, θ of each body", "", ticks=names)
    panels = []
    for orders in typical_modes(frequencies):
        mode = by_order.loc[orders[0]]
        heights = amplitudes(shapes, orders)
        marks: list[Bars | Line] = [
            *(Line(edge - 0.5, colour=grey(0.8), width=0.6) for edge in bodies.index[1:]),
            Line(0.0, "y", colour=BLACK, width=0.6),
            Bars(dofs.index.to_numpy(dtype=float), heights, colour=CLASS_COLOURS[mode["class"]]),
        ]
        up = Axis("", "", low=-1.1 if len(orders) == 1 else 0.0, high=1.1)
        panels.append(Panel(across, up, marks, title=_title(orders, mode), height=0.85))
    return Figure(panels, y_label="Amplitude relative to the largest")


def _title(orders: tuple[int, ...], mode: pd.Series) -> str:
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
        The figures.
    """
    return (mode_shapes(frequencies, shapes),)


SHAFT, BORE, PINION = grey(0.75), WHITE, ORANGE
CURVES: Mapping[str, tuple[str, str, LineStyle]] = {
    "x": ("tangential to the gear (x)", BLUE, "solid"),
    "y": ("along the gear's axis (y)", RED, "dash"),
}
MARGIN = 0.06
"""Room beside a shaft, in its length."""


def shafts_figures(
    bearings: pd.DataFrame,
    deflections: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    width_mm: float | None,
) -> list[Figure]:
    """Draw one figure with a pair of panels for each shaft; no figure for a machine without shafts.

    Parameters
    ----------
    bearings : DataFrame
        Forces on the bearings of the shafts, N.
    deflections : DataFrame
        Deflections along the shafts, µm over mm.
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Numbers of teeth and sizes of the pair.
    width_mm : float or None
        Face width of the pinions, mm, where it is known.

    Returns
    -------
    list of Figure
        No or one figure.
    """
    sections = {pinion.name: transmission.shaft_of(pinion) for pinion in transmission.pinions}
    shaft_sections = {name: section for name, section in sections.items() if section is not None}
    if not shaft_sections:
        return []
    radius = 1e3 * teeth.pinion_base_radius / np.cos(teeth.pressure_angle)
    return [shafts_figure(shaft_sections, bearings, deflections, float(radius), width_mm)]


def shafts_figure(
    sections: Mapping[str, ShaftSection],
    bearings: pd.DataFrame,
    deflections: pd.DataFrame,
    radius_mm: float,
    width_mm: float | None,
) -> Figure:
    """Draw a pair of panels for each shaft: above its bearings and the forces on them, below its deflections.

    Equal shafts with equal forces and deflections share a pair of panels.

    Parameters
    ----------
    sections : mapping of str to ShaftSection
        Shaft of each pinion by the pinion's name.
    bearings : DataFrame
        Forces on the bearings of the shafts, N.
    deflections : DataFrame
        Deflections along the shafts, µm over mm.
    radius_mm : float
        Pitch radius of the pinions, mm.
    width_mm : float or None
        Face width of the pinions, mm, where it is known.

    Returns
    -------
    Figure
        The figure.
    """
    panels = []
    for names in _group_equal_shafts(sections, bearings, deflections):
        section = sections[names[0]]
        margin = MARGIN * section.length_mm + 0.5 * (width_mm or 0.0)
        along = Axis(
            "Along the shaft, from its inner end outwards", "mm", low=-margin, high=section.length_mm + margin
        )
        positions = [
            Line(at, colour=grey(0.6), line="dot")
            for at in (section.pinion_mm, *(bearing.at_mm for bearing in section.bearings))
        ]
        forces = bearings[bearings["pinion"] == names[0]]
        side, reach = _side_view(section, forces, radius_mm, width_mm)
        height = Axis("", "", low=-1.1 * reach, high=1.1 * reach)
        shaft_deflections = deflections[deflections["pinion"] == names[0]]
        curves = [
            Curve(shaft_deflections["at_mm"], shaft_deflections[f"{key}_um"], words, colour, line)
            for key, (words, colour, line) in CURVES.items()
        ]
        panels += [
            Panel(along, height, [*positions, *side], title=", ".join(names), height=1.5, bare=True),
            Panel(along, Axis("Deflection", "µm"), [*positions, *curves], height=1.2),
        ]
    keys = [
        Key("pinion", PINION, area=True, opacity=0.7),
        Key("bearing and radial force on it", line="none", marker="triangle-up"),
    ]
    return Figure(panels, shared_x=False, keys=keys)


def _group_equal_shafts(
    sections: Mapping[str, ShaftSection], bearings: pd.DataFrame, deflections: pd.DataFrame
) -> list[list[str]]:
    """Group the names of the pinions whose shafts, bearing forces and deflections are equal."""
    groups: list[tuple[ShaftSection, Array, list[str]]] = []
    for name, section in sections.items():
        forces = bearings.loc[bearings["pinion"] == name, "radial_n"].to_numpy(dtype=float)
        displacements = deflections.loc[deflections["pinion"] == name, ["x_um", "y_um"]].to_numpy(dtype=float)
        numbers = np.concatenate([forces, displacements.ravel()])
        for group_section, group_shape, names in groups:
            if group_section == section and np.allclose(numbers, group_shape, rtol=1e-4, atol=1e-3):
                names.append(name)
                break
        else:
            groups.append((section, numbers, [name]))
    return [names for *_, names in groups]


def _side_view(
    section: ShaftSection,
    bearings: pd.DataFrame,
    radius_mm: float,
    width_mm: float | None,
) -> tuple[list[Area | Curve | Text], float]:
    """Return the marks of a shaft with its pinion, bearings and forces, and its largest radius (mm)."""
    marks: list[Area | Curve | Text] = []
    begin = 0.0
    for segment in section.segments:
        for diameter, colour in ((segment.diameter_mm, SHAFT), (segment.bore_mm, BORE)):
            if diameter > 0.0:
                box = _box(begin, segment.length_mm, 0.5 * diameter)
                marks.append(Area(*box, colour=colour, outline=grey(0.3)))
        begin += segment.length_mm
    width = width_mm or 0.0
    pinion = _box(section.pinion_mm - 0.5 * width, width, radius_mm)
    marks.append(Area(*pinion, colour=PINION, opacity=0.7, outline=PINION))
    outer = max(segment.diameter_mm for segment in section.segments) / 2.0
    forces = bearings.set_index("bearing")["radial_n"]
    for letter, bearing in zip(forces.index, section.bearings, strict=True):
        half = 0.5 * _diameter_at(section, bearing.at_mm)
        for height, marker in ((-half, "triangle-up"), (half, "triangle-down")):
            at = np.array([bearing.at_mm]), np.array([height])
            marks.append(Curve(*at, line="none", marker=marker, size=9.0))
        text = f"{letter}\n{format_number(1e-3 * forces[letter])} kN"
        look: Look = {"shift": (0.0, -12.0), "across": "center", "upright": "top", "paper": True}
        marks.append(Text(bearing.at_mm, -half, text, **look))
    return marks, max(outer, radius_mm)


def _box(begin: float, length: float, half: float) -> tuple[Array, Array]:
    """Return the corners x, y (5,) of a closed rectangle about the axis, from its begin, length and half
    height.
    """
    end = begin + length
    return np.array([begin, end, end, begin, begin]), half * np.array([-1.0, -1.0, 1.0, 1.0, -1.0])


def _diameter_at(section: ShaftSection, at: float) -> float:
    """Return the diameter (mm) of a shaft at a distance from its beginning (mm): the larger one at a step."""
    ends = np.cumsum([0.0, *(segment.length_mm for segment in section.segments)])
    diameters = [
        segment.diameter_mm
        for segment, begin, end in zip(section.segments, ends[:-1], ends[1:], strict=True)
        if begin <= at <= end
    ]
    return max(diameters or [section.segments[-1].diameter_mm])
