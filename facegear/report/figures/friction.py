"""Friction and heat: along the path of contact, over the flank, over torque and speed, in the machine."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays, Mask
from facegear.contact.pattern import passage, pattern
from facegear.number_format import format_number
from facegear.report.figures.colours import BLUE, ORANGE, RED, round_levels, shades
from facegear.report.figures.contact import UNLOADED_COLOUR
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import Bars, ColourScale, Curve, Levels, Look, Map

FLANK_COLOURS = {"drive": BLUE, "back": ORANGE}
"""Colour of each flank."""


def figures(local: Arrays, pressure: Arrays, map_table: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw quantities along the path, over the flank, and the efficiency map.

    Parameters
    ----------
    local : Arrays
        Arrays `local` of stage lubrication.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    map_table : pd.DataFrame
        Table `map` of stage lubrication.

    Returns
    -------
    tuple[Figure, ...]
        Those of `along_path`, `over_flank` and `efficiency_map`.
    """
    return along_path(local), over_flank(local, pressure), efficiency_map(map_table)


def along_path(local: Arrays) -> Figure:
    """Draw, at each place of a tooth's passage, the largest sliding velocity and flash, and the thinnest
    film.

    Places beside an edge are left out of temperature and film, whose pressure there has no limit.

    Parameters
    ----------
    local : Arrays
        Arrays `local` of stage lubrication (LOCAL_ARRAYS), (points of contact lines,), SI units.

    Returns
    -------
    Figure
        Three panels over the passage (pitches), a curve for each torque.
    """
    torques = np.unique(local["torque_n_m"])
    stage, inside = passage(local["position"], local["tooth"]), local["inside"] > 0
    curves: tuple[list[Curve], ...] = ([], [], [])
    for torque, colour in zip(torques, shades(torques.size), strict=True):
        on = local["torque_n_m"] == torque
        name = f"{format_number(torque, 4)} N m"
        for number, (values, mask, sign) in enumerate(
            (
                (local["sliding_m_per_s"], on, 1.0),
                (local["flash_k"], on & inside, 1.0),
                (local["film_ratio"], on & inside, -1.0),
            )
        ):
            curves[number].append(Curve(*_extreme(stage, values, mask, sign), name, colour))
    along = Axis("Passage of a tooth", "pitches")
    axes = (
        Axis("Largest sliding\nvelocity", "m/s", low=0.0),
        Axis("Largest flash\ntemperature", "K", low=0.0),
        Axis("Smallest film over\nroughness λ", "", low=0.0),
    )
    return Figure(
        [
            Panel(along, axis, panel_curves, height=1.8)
            for axis, panel_curves in zip(axes, curves, strict=True)
        ]
    )


def over_flank(local: Arrays, pressure: Arrays) -> Figure:
    """Draw friction loss and flash temperature over the pinion's flank at the largest torque.

    Parameters
    ----------
    local : Arrays
        Arrays `local` of stage lubrication (LOCAL_ARRAYS), SI units.
    pressure : Arrays
        Arrays `pressure` of stage contact (PRESSURE_ARRAYS), which give the places on the flank.

    Returns
    -------
    Figure
        Two panels: loss per length, W/mm, and flash temperature, K.
    """
    contact_pattern = pattern(pressure)
    torque = local["torque_n_m"].max()
    on = local["torque_n_m"] == torque
    width, radius = (
        1e3 * contact_pattern.points[..., 1],
        1e3 * np.hypot(contact_pattern.points[..., 0], contact_pattern.points[..., 2]),
    )
    stages = np.unique(passage(pressure["contact_position"], pressure["contact_tooth"]))
    row = np.searchsorted(stages, passage(local["position"], local["tooth"])[on])
    cells = row, local["plane"][on].astype(int)
    nodes = 1e3 * pressure["point_m"]
    height = np.hypot(nodes[:, 0], nodes[:, 2])
    fields = (
        (1e-3 * local["loss_w_per_m"][on], "Friction loss", "W/mm", "viridis"),
        (
            np.where(local["inside"][on] > 0, local["flash_k"][on], np.nan),
            "Flash temperature",
            "K",
            "inferno",
        ),
    )
    along = Axis(
        "Along the pinion's axis, from the gear's",
        "mm",
        low=float(nodes[:, 1].min()),
        high=float(nodes[:, 1].max()),
    )
    up = Axis("Pinion radius", "mm", low=float(height.min()), high=float(height.max()))
    panels = []
    for values, name, unit, colours in fields:
        field = np.full(width.shape, np.nan)
        field[cells] = values
        scale = ColourScale(name, unit, 0.0, float(np.nanmax(field, initial=0.0)) or 1.0, colours)
        field_map = Map(width, radius, field, scale, smooth=True)
        panels.append(Panel(along, up, [field_map], height=1.9, ground=UNLOADED_COLOUR))
    panels[0] = replace(panels[0], title=f"{format_number(torque, 4)} N m")
    return Figure(panels)


def efficiency_map(table: pd.DataFrame) -> Figure:
    """Draw the loss of a mesh in percent of its power, and contact temperature, over torque and speed.

    Left blank where a body would pass the flash point of the oil.

    Parameters
    ----------
    table : pd.DataFrame
        Table `map` of stage lubrication: torque_n_m, speed_rpm, efficiency, contact_temperature_c.

    Returns
    -------
    Figure
        Two panels of contours; of curves where there is one torque or one speed.
    """
    field_map = table.assign(loss_percent=100 * (1 - table["efficiency"]))
    quantities = (("loss_percent", "Loss", "%"), ("contact_temperature_c", "Contact temperature", "°C"))
    speed, torque = Axis("Speed of the pinion", "rpm"), Axis("Torque on the pinion", "N m")
    panels = []
    for column, name, unit in quantities:
        grid = field_map.pivot(index="torque_n_m", columns="speed_rpm", values=column)
        if min(grid.shape) < 2:
            across, at = (
                (speed, "speed_rpm") if field_map["torque_n_m"].nunique() == 1 else (torque, "torque_n_m")
            )
            curve = Curve(field_map[at], field_map[column], colour=BLUE, marker="circle")
            panels.append(Panel(across, Axis(name, unit), [curve], height=2.0))
            continue
        values = grid.to_numpy(dtype=float)
        levels = round_levels(float(np.nanmin(values)), float(np.nanmax(values)))
        scale = ColourScale(name, unit, levels[0], levels[-1], levels=levels)
        x, y = np.meshgrid(grid.columns.to_numpy(float), grid.index.to_numpy(float))
        ends: Look = {"low": float(x.min()), "high": float(x.max())}
        over = replace(torque, low=float(y.min()), high=float(y.max()))
        panels.append(Panel(replace(speed, **ends), over, [Levels(x, y, values, scale)], height=2.0))
    return Figure(panels)


def machine_heat(meshes: pd.DataFrame, bodies: pd.DataFrame) -> Figure:
    """Draw loss of every mesh and heat of every body at the nominal load (bin 0).

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage machine_loss: bin, mesh, flank and loss_w.
    bodies : pd.DataFrame
        Table `bodies` of stage machine_loss: bin, body and heat_w.

    Returns
    -------
    Figure
        The figure.
    """
    mesh_losses, heat = meshes[meshes["bin"] == 0], bodies[bodies["bin"] == 0]
    positions = {mesh: float(number) for number, mesh in enumerate(dict.fromkeys(mesh_losses["mesh"]))}
    loss: list[Bars] = []
    for flank, colour in FLANK_COLOURS.items():
        rows = mesh_losses[mesh_losses["flank"] == flank]
        if len(rows):
            at, lengths = rows["mesh"].map(positions).to_numpy(float), rows["loss_w"].to_numpy(float)
            loss.append(Bars(at, lengths, f"{flank} flank", colour, flat=True))
    rows = np.arange(len(heat), dtype=float)
    warm = Bars(rows, heat["heat_w"].to_numpy(float), colour=RED, flat=True)
    return Figure(
        [
            Panel(
                Axis("Friction loss of the mesh", "W"),
                _names(positions),
                loss,
                height=0.4 + 0.2 * len(positions),
            ),
            Panel(
                Axis("Heat that friction brings to the body", "W"),
                _names(dict(zip(heat["body"], rows.tolist(), strict=True))),
                [warm],
                height=0.4 + 0.2 * len(heat),
            ),
        ],
        shared_x=False,
    )


def _names(positions: Mapping[str, float]) -> Axis:
    """Return an upright axis with a name at each position (the numbers 0, 1, ...), the first one at the
    top.
    """
    ticks = [(at, name) for name, at in positions.items()]
    return Axis("", "", low=-0.6, high=len(positions) - 0.4, is_falling=True, ticks=ticks)


def _extreme(stage: Array, values: Array, on: Mask, sign: float) -> tuple[Array, Array]:
    """Return the different stages of passage, (m,) in pitches, and at each the largest (sign 1) or
    smallest (sign -1) of the values there, (m,).

    stage, values, on: (points,); only points where `on` is true count.
    """
    positions, row = np.unique(stage[on], return_inverse=True)
    extreme = np.full(positions.size, -np.inf)
    np.maximum.at(extreme, row, sign * values[on])
    return positions, sign * extreme
