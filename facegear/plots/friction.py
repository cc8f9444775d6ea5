"""Friction and heat: along the path of contact, over the flank, over torque and speed, in the machine."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.arrays import Array, Arrays, Mask
from facegear.contact.pattern import passage, pattern
from facegear.plots.style import NARROW, legend_above, styled

FLANK_COLOURS = {"drive": "tab:blue", "back": "tab:orange"}


def figures(local: Arrays, pressure: Arrays, map_table: pd.DataFrame) -> tuple[Figure, ...]:
    """Along the path, over the flank, and the efficiency map."""
    return along_path(local), over_flank(local, pressure), efficiency_map(map_table)


def along_path(local: Arrays) -> Figure:
    """At each place of a tooth's passage the largest sliding velocity and flash, and the thinnest film.

    Places beside an edge are left out of temperature and film, whose pressure there has no limit.
    """
    torques = np.unique(local["torque_n_m"])
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, torques.size))
    stage, inside = passage(local["position"], local["tooth"]), local["inside"] > 0
    with styled():
        figure, axes = plt.subplots(3, 1, figsize=(NARROW, 7.4), sharex=True)
        for torque, colour in zip(torques, colours, strict=True):
            on = local["torque_n_m"] == torque
            look = {"color": colour, "label": f"{torque:g} N m"}
            axes[0].plot(*_extreme(stage, local["sliding_m_per_s"], on, 1.0), **look)
            axes[1].plot(*_extreme(stage, local["flash_k"], on & inside, 1.0), **look)
            axes[2].plot(*_extreme(stage, local["film_ratio"], on & inside, -1.0), **look)
        axes[0].set(ylabel="Largest sliding\nvelocity (m/s)", ylim=(0, None))
        axes[1].set(ylabel="Largest flash\ntemperature (K)", ylim=(0, None))
        axes[2].set(ylabel="Smallest film over\nroughness λ", ylim=(0, None))
        axes[2].set_xlabel("Passage of a tooth (pitches)")
        legend_above(axes[0], 3)
    return figure


def over_flank(local: Arrays, pressure: Arrays) -> Figure:
    """Friction loss and flash temperature over the pinion's flank at the largest torque."""
    seen = pattern(pressure)
    torque = local["torque_n_m"].max()
    on = local["torque_n_m"] == torque
    width, radius = 1e3 * seen.points[..., 1], 1e3 * np.hypot(seen.points[..., 0], seen.points[..., 2])
    stages = np.unique(passage(pressure["contact_position"], pressure["contact_tooth"]))
    row = np.searchsorted(stages, passage(local["position"], local["tooth"])[on])
    cells = row, local["plane"][on].astype(int)
    nodes = 1e3 * pressure["point_m"]
    height = np.hypot(nodes[:, 0], nodes[:, 2])
    fields = (
        (1e-3 * local["loss_w_per_m"][on], "Friction loss (W/mm)", "viridis"),
        (np.where(local["inside"][on] > 0, local["flash_k"][on], np.nan), "Flash temperature (K)", "inferno"),
    )
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 5.4), sharex=True)
        for axis, (values, label, colours) in zip(axes, fields, strict=True):
            field = np.full(width.shape, np.nan)
            field[cells] = values
            axis.set_facecolor("0.92")
            axis.grid(visible=False)
            look = {"cmap": colours, "shading": "gouraud", "rasterized": True, "vmin": 0.0}
            drawn = axis.pcolormesh(width, radius, np.ma.masked_invalid(field), **look)
            figure.colorbar(drawn, ax=axis, label=label)
            axis.set(xlim=(nodes[:, 1].min(), nodes[:, 1].max()), ylim=(height.min(), height.max()))
            axis.set_ylabel("Pinion radius (mm)")
        axes[0].set_title(f"{torque:g} N m")
        axes[1].set_xlabel("Along the pinion's axis, from the gear's (mm)")
    return figure


def efficiency_map(table: pd.DataFrame) -> Figure:
    """Loss of a mesh in percent of its power, and contact temperature, over torque and speed.

    Left blank where a body would pass the flash point of the oil.
    """
    shown = table.assign(loss_percent=100 * (1 - table["efficiency"]))
    panels = (("loss_percent", "Loss (%)"), ("contact_temperature_c", "Contact temperature (°C)"))
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 5.8), sharex=True)
        for axis, (column, label) in zip(axes, panels, strict=True):
            grid = shown.pivot(index="torque_n_m", columns="speed_rpm", values=column)
            if min(grid.shape) < 2:
                _lines(axis, shown, column, label)
                continue
            look = {"cmap": "viridis", "levels": 12}
            drawn = axis.contourf(grid.columns, grid.index, np.ma.masked_invalid(grid.to_numpy()), **look)
            figure.colorbar(drawn, ax=axis, label=label)
            axis.set_ylabel("Torque on the pinion (N m)")
        axes[-1].set_xlabel("Speed of the pinion (rpm)")
    return figure


def machine_heat(meshes: pd.DataFrame, bodies: pd.DataFrame) -> Figure:
    """Loss of every mesh and heat of every body at the nominal load."""
    lost, heat = meshes[meshes["bin"] == 0], bodies[bodies["bin"] == 0]
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(NARROW, 5.6))
        for flank, colour in FLANK_COLOURS.items():
            rows = lost[lost["flank"] == flank]
            axes[0].barh(rows["mesh"], rows["loss_w"], color=colour, label=f"{flank} flank")
        axes[0].set_yticks(lost["mesh"])
        axes[0].set(xlabel="Friction loss of the mesh (W)")
        axes[0].invert_yaxis()
        legend_above(axes[0], 2)
        axes[1].barh(heat["body"], heat["heat_w"], color="tab:red")
        axes[1].set(xlabel="Heat that friction brings to the body (W)")
        axes[1].invert_yaxis()
    return figure


def _lines(axis: Axes, table: pd.DataFrame, column: str, label: str) -> None:
    """A map of one torque or one speed."""
    across = "speed_rpm" if table["torque_n_m"].nunique() == 1 else "torque_n_m"
    axis.plot(table[across], table[column], "o-")
    axis.set_ylabel(label)


def _extreme(stage: Array, values: Array, on: Mask, sign: float) -> tuple[Array, Array]:
    """Places of the passage and the largest (sign 1) or smallest (-1) value at each."""
    places, row = np.unique(stage[on], return_inverse=True)
    extreme = np.full(places.size, -np.inf)
    np.maximum.at(extreme, row, sign * values[on])
    return places, sign * extreme
