"""The pair in mesh in three dimensions, for the report's viewer: teeth, and what they carry."""

import base64
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.contact.columns import SHARES
from facegear.geometry.design import PairDesign
from facegear.geometry.solids import BODIES, Body, solid, teeth_of
from facegear.report.page import View

COLOURS = (
    *("#0d0887", "#4c02a1", "#7e03a8", "#a92395", "#cc4778"),
    *("#e56b5d", "#f89540", "#fdc527", "#f0f921"),
)
"""Matplotlib's plasma at nine even places."""
PROFILE, WIDTH = 17, 7
"""Points of each drawn patch."""
SHOWN_GEAR_TEETH = 13
QUANTITY = "Load per millimetre of face width (N/mm)"


def pair_view(design: PairDesign, loads: Mapping[str, NDArray], ltca: pd.DataFrame) -> View:
    """The pair at every solved position and torque; `loads` as PRESSURE_ARRAYS, `ltca` as LTCA_COLUMNS.

    Lengths in mm. Colours show the load of every loaded node's column of the flank over the column's width:
    unlike the pressure it has a limit as the mesh is refined, edges included.
    """
    torques = np.unique(loads["torque_n_m"])
    positions = np.unique(loads["position"])
    data = {
        "bodies": [_body(design, name) for name in BODIES],
        "centre": [0.0, 1e3 * design.mean_radius, -1e3 * design.pinion_pitch_radius],
        "size": 1e3 * (design.pinion_tip_radius + design.pinion.width),
        "lattice": {
            "shape": [int(n) for n in loads["shape"]],
            "points": _encoded(1e3 * loads["point_m"], np.float32),
        },
        "positions": positions.tolist(),
        "colours": COLOURS,
        "quantity": QUANTITY,
        "torques": [_torque(float(torque), loads, ltca, positions) for torque in torques],
    }
    return View(
        data,
        "The pair in mesh, turning through a pitch: drag to look around. Colours: load along each line of "
        "contact, drawn wider than it is, at the positions that were solved.",
    )


def _body(design: PairDesign, name: Body) -> dict[str, Any]:
    teeth = teeth_of(design, name)
    shown = teeth if name == "pinion" else min(teeth, SHOWN_GEAR_TEETH)
    return {
        "name": name,
        "teeth": teeth,
        "first": -(shown // 2),
        "shown": shown,
        "turn": -0.5 if name == "pinion" else 0.0,
        "patches": [
            {"shape": list(patch.shape[:2]), "points": _encoded(1e3 * patch, np.float32)}
            for patch in solid(design, name, 1, PROFILE, WIDTH)
        ],
    }


def _torque(
    torque: float, loads: Mapping[str, NDArray], ltca: pd.DataFrame, positions: NDArray
) -> dict[str, Any]:
    on = loads["torque_n_m"] == torque
    row = np.searchsorted(positions, loads["position"][on])
    order = np.argsort(row, kind="stable")
    load = line_load(loads, on)[order]
    rows = ltca[ltca["torque_n_m"] == torque].sort_values("position")
    top = float(load.max())
    return {
        "torque_n_m": torque,
        "largest": top,
        "start": np.searchsorted(row[order], np.arange(positions.size + 1)).tolist(),
        "node": _encoded(loads["node"][on][order], np.uint16),
        "tooth": _encoded(loads["tooth"][on][order], np.int8),
        "load": _encoded(np.ceil(255 * load / top), np.uint8),
        "error_um": rows["ste_um"].round(3).tolist(),
        "share": rows[list(SHARES)].round(4).to_numpy().tolist(),
    }


def line_load(loads: Mapping[str, NDArray], on: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Load (N/mm) at each chosen node: all force on its column of the flank, at its position, over the
    column's width.
    """
    rows, columns = (int(n) for n in loads["shape"])
    y = 1e3 * loads["point_m"].reshape(rows, columns, 3)[0, :, 1]
    width = np.abs(np.gradient(y))
    width[[0, -1]] /= 2.0
    column = loads["node"][on] % columns
    frame = pd.DataFrame({name: loads[name][on] for name in ("position", "tooth", "force_n")})
    total = frame.groupby(["position", "tooth", column])["force_n"].transform("sum").to_numpy()
    return total / width[column]


def _encoded(values: NDArray, kind: type) -> str:
    return base64.b64encode(values.astype(np.dtype(kind).newbyteorder("<")).tobytes()).decode()
