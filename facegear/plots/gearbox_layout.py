"""The machine seen from above, to scale: where pinions stand, which way bodies turn, what meshes carry."""

import textwrap

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, Polygon

from facegear.config.machine_layout import ToothNumbers
from facegear.config.machine_layout import layout as layout_of
from facegear.config.transmission import Transmission
from facegear.plots.style import NARROW, styled
from facegear.transmission.layout import Layout, Role, Side

ROLE_COLOUR = {Role.INPUT: "tab:blue", Role.IDLER: "0.55", Role.TAIL: "tab:purple"}
MESH, BEARING = "tab:red", "tab:green"
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
    cosine = np.cos(layout.pressure_angle)
    pushed = loads["mean_n"].max() * cosine
    largest = (
        pushed if forces is None else max(pushed, forces[["mean_x_n", "mean_y_n"]].abs().to_numpy().max())
    )
    order = sorted(range(len(layout.gears)), key=lambda g: -layout.gears[g].sign)
    with styled():
        figure, axes = plt.subplots(len(order), 1, figsize=(NARROW, 4.7 * len(order) + 1.0), squeeze=False)
        for axis, g in zip(axes[:, 0], order, strict=True):
            _panel(axis, layout, g, loads, forces, layout.mesh_radius * LONGEST / max(largest, 1e-300))
        roles = {pinion.role for pinion in layout.pinions}
        handles = [
            plt.Line2D(
                [], [], color=MESH, lw=2, label=f"tangential force on the gear, largest {_kilo(pushed)} kN"
            ),
            *([] if forces is None else [plt.Line2D([], [], color=BEARING, lw=2, label=ON_BEARINGS)]),
            *(
                plt.Line2D([], [], color=colour, lw=6, label=f"{role.value} pinion")
                for role, colour in ROLE_COLOUR.items()
                if role in roles
            ),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=1)
    return figure


def _panel(
    axis: Axes, layout: Layout, g: int, loads: pd.DataFrame, forces: pd.DataFrame | None, metres: float
) -> None:
    gear, radius = layout.gears[g], layout.mesh_radius
    turns = gear.sign
    for edge in (1.0 - HALF_FACE, 1.0 + HALF_FACE):
        axis.add_patch(Circle((0.0, 0.0), edge * radius, fill=False, color="0.6", lw=1.0))
    _turn_arrow(axis, 0.55 * radius, turns)
    half_width = 0.5 * layout.mesh_radius * layout.pinion_teeth / layout.gear_teeth
    for i, pinion in enumerate(layout.pinions):
        angle = layout.angles[i]
        along = np.array([np.cos(angle), np.sin(angle)])
        outwards = np.array([np.sin(angle), -np.cos(angle)])
        middle = radius * outwards
        corners = [
            middle + a * half_width * along + b * HALF_FACE * radius * outwards
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        axis.add_patch(Polygon(corners, color=ROLE_COLOUR[pinion.role], alpha=0.55, lw=0))
        row = loads.loc[layout.mesh_names[layout.mesh_index(i, gear.side)]]
        drives = 1.0 if row["drive_fraction"] >= row["back_fraction"] else -1.0
        force = turns * drives * row["mean_n"] * np.cos(layout.pressure_angle) * along
        _arrow(axis, middle, metres * force, MESH)
        if forces is not None and (gear.side is Side.UPPER or len(layout.gears) == 1):
            inside = (1.0 - 2.5 * HALF_FACE) * radius * outwards
            _arrow(axis, inside, metres * forces.loc[pinion.name, "mean_x_n"] * along, BEARING)
        name = textwrap.fill(pinion.name, LETTERS)
        _label(axis, radius, outwards, f"{name}\n{np.degrees(angle):.2f} deg\n{_kilo(row['mean_n'])} kN")
    title = f"{gear.name.capitalize()}, seen from above"
    if forces is not None:
        own = forces.loc[gear.name]
        _arrow(axis, np.zeros(2), metres * own[["mean_x_n", "mean_y_n"]].to_numpy(float), BEARING)
        title += f"\naxial on its bearing {own['mean_z_n'] / 1e3:+.1f} kN"
    axis.text(0.0, TITLE * radius, title, ha="center", va="bottom", fontsize=10)
    axis.set(xlim=(-REACH * radius, REACH * radius), aspect="equal")
    axis.set_ylim(-BELOW * radius, (2.0 * REACH - BELOW) * radius)
    axis.text(0.0, 0.3 * radius, f"mesh radius\n{1e3 * radius:.1f} mm", ha="center", va="center", fontsize=9)
    axis.set_axis_off()


def _label(axis: Axes, radius: float, outwards: np.ndarray, text: str) -> None:
    """Text beside a pinion, outside the gear: it begins at the rim, whatever its length."""
    x, y = outwards
    across = "center" if abs(x) < BESIDE else "left" if x > 0.0 else "right"
    along = "center" if abs(y) < BESIDE else "bottom" if y > 0.0 else "top"
    axis.text(*(LABEL * radius * outwards), text, ha=across, va=along, multialignment="center", fontsize=9)


def _turn_arrow(axis: Axes, radius: float, turns: float) -> None:
    ends = np.radians([200.0, 250.0]) if turns > 0.0 else np.radians([250.0, 200.0])
    start, stop = ((radius * np.cos(a), radius * np.sin(a)) for a in ends)
    bend = f"arc3,rad={0.25 * turns}"
    arrow = FancyArrowPatch(start, stop, connectionstyle=bend, arrowstyle="-|>", mutation_scale=18, color="k")
    axis.add_patch(arrow)


def _arrow(axis: Axes, start: np.ndarray, vector: np.ndarray, colour: str) -> None:
    if np.hypot(*vector) > 0.0:
        arrow = FancyArrowPatch(
            start, start + vector, arrowstyle="-|>", mutation_scale=12, color=colour, lw=2
        )
        axis.add_patch(arrow)


def _kilo(newtons: float) -> str:
    return f"{newtons / 1e3:.1f}"
