"""Machines of idlers alone between two face gears, one of which is driven: every path is like the others."""

from typing import Any

import numpy as np

import facegear
from facegear.gearbox import Gearbox

STIFFNESS, BEARING, ANGLE, TORQUE = 4.1e8, 6.5e8, np.radians(25.0), 6000.0
"""Mesh and bearing stiffness (N/m), pressure angle (rad) and torque of the lower gear (N m) of the public
numbers.
"""
ARM = 0.5 * 3.75e-3 * 120 * np.cos(ANGLE)
"""Base radius of their face gears, m."""
FLOATING, HELD = 0.1, 1e14
"""Radial stiffness of the upper gear's bearing, N/m."""


def make_idlers(
    idlers: int,
    upper: float = HELD,
    *,
    late_um: float = 0.0,
    stiffness: float = STIFFNESS,
    bearing: float = BEARING,
    torque: float = TORQUE,
    backlash_um: float = 0.0,
) -> Gearbox:
    """Build a machine whose first upper mesh is late.

    `upper`: radial stiffness of the upper gear's bearing, N/m; the lower gear is held. `stiffness` of every
    mesh and `bearing` of every idler in N/m, `torque` of the lower gear in N m.
    """
    values: dict[str, Any] = {
        "case": "idlers",
        "tooth_pair": {
            "pinion_teeth": 23,
            "face_gear_teeth": 120,
            "module_mm": 3.75,
            "pressure_angle_deg": 25,
        },
        "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": stiffness}]},
        "transmission": {
            "pinions": [
                {"name": f"idler {number + 1}", "role": "idler", "angle_deg": 360.0 * number / idlers}
                for number in range(idlers)
            ],
            "pinion": {"mass_kg": 1, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": _round(bearing)},
            "face_gear": {"mass_kg": 8, "inertia_kg_m2": 0.5, "bearing_stiffness_n_per_m": _round(HELD)},
            "single_gears": {
                "lower": {"torque_n_m": torque},
                "upper": {"bearing_stiffness_n_per_m": _round(upper)},
            },
            "single_meshes": {"idler 1/upper": {"error_um": late_um}},
            "damping": {"mesh_n_s_per_m": 1000, "mass_per_s": 0, "bearing_s": 2e-6},
            "backlash_um": backlash_um,
            "transmission_error": {"amplitude_um": 0},
            "torque": {"per_input_n_m": 0, "tail_share": 0},
        },
    }
    return facegear.load(values, None)


def upper_shares(gearbox: Gearbox, total: float) -> np.ndarray:
    """Return the forces of the upper meshes at rest over `total` (N), shape (idlers,)."""
    table = gearbox.statics().table()
    return table.loc[table["mesh"].str.endswith("/upper"), "force_n"].to_numpy(float) / total


def _round(stiffness: float) -> dict[str, float]:
    return {"x": stiffness, "y": stiffness, "z": 1e14}
