"""The machine seen from above, to scale: where pinions stand, which way bodies turn, what meshes carry."""

import textwrap

import numpy as np
import pandas as pd

from facegear.config.machine_layout import ToothNumbers
from facegear.config.machine_layout import layout as layout_of
from facegear.config.transmission import Transmission
from facegear.number_format import format_number
from facegear.plots.colours import BLUE, GREEN, PURPLE, RED, grey
from facegear.plots.description import Area, Arrow, Axis, Curve, Figure, Key, Look, Mark, Panel, Text
from facegear.transmission.layout import Layout, Role, Side

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
"""Where the pinions' labels begin, over the mesh radius."""
REACH, BELOW, TITLE = 2.0, 1.75, 1.8
"""What a panel shows beside and below the gear, and where its title stands, over the mesh radius."""
LETTERS = 13
"""Letters of a pinion's name in one line."""
BESIDE = 0.4
"""Cosine of the direction to a pinion below which its label is centred."""


def figures(meshes: pd.DataFrame, transmission: Transmission, teeth: ToothNumbers) -> tuple[Figure, ...]:
    """The machine with the forces at rest of the table `meshes` of stage ratings."""
    drives = (meshes["flank"] != "back").astype(float)
    loads = pd.DataFrame({"mesh": meshes["mesh"], "mean_n": meshes["force_n"].abs()})
    loads = loads.assign(drive_fraction=drives, back_fraction=1.0 - drives)
    return (layout_figure(layout_of(transmission, teeth), loads),)


def layout_figure(layout: Layout, meshes: pd.DataFrame, bearings: pd.DataFrame | None = None) -> Figure:
    """One panel a face gear, upper on top; tables as the hunting cycle's.

    Red: mean tangential force of each pinion on the gear; green: mean force on bearings, of the pinions
    (tangential) inside the upper gear, of the gear from its centre, where they are given.
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
    """Text beside a pinion, outside the gear: it begins at the rim, whatever its length."""
    x, y = outwards
    look: Look = {
        "across": "center" if abs(x) < BESIDE else "left" if x > 0.0 else "right",
        "upright": "center" if abs(y) < BESIDE else "bottom" if y > 0.0 else "top",
    }
    at = LABEL * radius * outwards
    return Text(float(at[0]), float(at[1]), text, **look)


def _turn_arrow(radius: float, turns: float) -> Arrow:
    ends = np.radians([200.0, 250.0]) if turns > 0.0 else np.radians([250.0, 200.0])
    start, stop = ((radius * np.cos(a), radius * np.sin(a)) for a in ends)
    return Arrow(start, stop, width=1.0, bend=0.25 * turns)


def _arrow(start: np.ndarray, vector: np.ndarray, colour: str) -> list[Arrow]:
    """An arrow; none for a force of zero."""
    end = start + vector
    return [Arrow(tuple(start), tuple(end), colour)] if np.hypot(*vector) > 0.0 else []


def _kilo(newtons: float) -> str:
    return format_number(newtons / 1e3)
