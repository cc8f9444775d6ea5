"""Which teeth for which gearbox: `python -m validation.kinds_of_teeth`.

Spur, helical and tapered pairs of equal size and load: the pitch radius, tooth numbers, face, material and
torque are the same, only the kind of teeth differs. Each pair is loaded alone, moved by each error of
assembly, and put into the same small machine: two inputs and an idler between two face gears.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.gearbox import Gearbox, load

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "docs" / "measured" / "kinds_of_teeth.csv"
MODULE = 3.5
"""Transverse module of all pairs, mm, which gives them one pitch radius; helical teeth have a smaller normal
one."""
TORQUE = 500.0
"""Torque on the pinion for one mesh, N m."""
LINES: tuple[tuple[str, str, int], ...] = (
    ("contact_ratio", "contact ratio without load", 2),
    ("te_peak_to_peak_um", "transmission error, peak to peak, um", 1),
    ("finer_te_peak_to_peak_um", "the same on the finer mesh, um", 1),
    ("pressure_mpa", "largest pressure, MPa", 0),
    ("pinion_root_mpa", "root stress of the pinion, MPa", 0),
    ("gear_root_mpa", "root stress of the gear, MPa", 0),
    ("loss_percent", "loss of a mesh, %", 3),
    ("axial_input_n", "axial force of an input, N, + outwards", 0),
    ("axial_idler_n", "axial force of the idler, N", 0),
    ("k_gamma_inputs", "K_gamma of inputs", 2),
    ("te_mean_by_offset", "transmission error by dE, um/um", 2),
    ("te_mean_by_shaft_angle", "by dgamma, um in 0.01 deg", 2),
    ("te_mean_by_gear_axial", "by gear_axial, um/um", 2),
    ("te_mean_by_pinion_axial", "by pinion_axial, um/um", 2),
    ("backlash_by_shaft_angle", "backlash by dgamma, um in 0.01 deg", 2),
    ("backlash_by_gear_axial", "by gear_axial, um/um", 2),
    ("backlash_by_pinion_axial", "by pinion_axial, um/um", 3),
)
"""Column, words and decimals of each line of the page's table."""
KINDS: dict[str, tuple[float, float]] = {
    "spur": (0.0, 0.0),
    "helical, 15 deg": (15.0, 0.0),
    "helical, -15 deg": (-15.0, 0.0),
    "tapered, 4 deg": (0.0, 4.0),
}
"""Helix and taper angle of each pair by the words of the table, deg."""
COARSE = {"profile_mm": 1.5, "width_mm": 6.0, "thickness_mm": 4.0, "fillet_depth_mm": 0.4}
FINER = {"profile_mm": 1.0, "width_mm": 3.0, "thickness_mm": 3.0, "fillet_depth_mm": 0.3}
"""Sizes of elements, mm: those of the study, and those that show its error."""
ERRORS: dict[str, tuple[str, float]] = {
    "offset": ("offset_um", 50.0),
    "shaft_angle": ("shaft_angle_error_deg", 0.02),
    "gear_axial": ("gear_axial_um", 50.0),
    "pinion_axial": ("pinion_axial_um", 50.0),
}
"""Key of section `tooth_pair.assembly` and size of each error to either side, um or deg, by its name in the
columns."""
PAIR: dict[str, Any] = {
    "pinion_teeth": 25,
    "face_gear_teeth": 125,
    "pressure_angle_deg": 25,
    "material": {"young_modulus_gpa": 206, "poisson_ratio": 0.3},
    "pinion": {"width_mm": 28, "middle_mm": 221, "thinning_um": 100, "bore_radius_mm": 25},
    "face_gear": {
        "inner_radius_mm": 209.5,
        "outer_radius_mm": 232.5,
        "addendum_modules": 0.9,
        "rim_thickness_mm": 12,
    },
    "shaper": {"teeth": 27, "tip_rounding_modules": 0.1},
}
OIL: dict[str, Any] = {
    "oil": "polyol_ester_5_cst",
    "supply_temperature_c": 100,
    "pinion": {"ra_um": 0.3},
    "face_gear": {"ra_um": 0.3},
    "bulk": {"source": "given", "temperature_c": 110},
}
"""Section `lubrication`; friction by Schlenk's model."""
SPEED = 6000.0
"""Speed of the pinions, rpm."""
MACHINE: dict[str, Any] = {
    "pinions": [
        {"name": "engine A", "role": "input", "angle_deg": 0},
        {"name": "engine B", "role": "input", "angle_deg": 144},
        {"name": "idler", "role": "idler", "angle_deg": 252},
    ],
    "pinion": {
        "mass_kg": 1.2,
        "inertia_kg_m2": 0.002,
        "bearing_stiffness_n_per_m": {"x": 2e8, "y": 2e8, "z": 2e8},
    },
    "face_gear": {
        "mass_kg": 8,
        "inertia_kg_m2": 0.4,
        "bearing_stiffness_n_per_m": {"x": 2e9, "y": 2e9, "z": 2e9},
    },
    "damping": {
        "mesh_n_s_per_m": 1500,
        "mass_per_s": 50,
        "bearing_s": 2e-6,
        "open_flanks": "contact_only",
    },
    "mesh_kinematics": "geometric",
    "transmission_error": "from_contact",
    "torque": {"per_input_n_m": 2.0 * TORQUE, "tail_share": 0},
}
"""Section `transmission` of the small machine; its inputs bring what two meshes of TORQUE carry."""


def tooth_pair(kind: str) -> dict[str, Any]:
    """Return section `tooth_pair` of a kind of teeth.

    Parameters
    ----------
    kind : str
        A key of KINDS.

    Returns
    -------
    dict
        Values of the section.
    """
    helix, taper = KINDS[kind]
    module = MODULE * math.cos(math.radians(helix))
    return {**PAIR, "helix_angle_deg": helix, "taper_angle_deg": taper, "module_mm": module}


def pair_alone(kind: str, sizes: Mapping[str, float] = COARSE) -> Gearbox:
    """Return a pair without a machine.

    Parameters
    ----------
    kind : str
        A key of KINDS.
    sizes : mapping
        Sizes of elements, mm.

    Returns
    -------
    Gearbox
        The pair.
    """
    return load(
        {
            "case": "kinds_of_teeth",
            "tooth_pair": tooth_pair(kind),
            "mesh": {"resolution": dict(sizes)},
            "contact": {
                "torques_n_m": [TORQUE],
                "positions_per_pitch": 16,
                "refinement": {"profile": 3, "width": 1, "depth": 1},
            },
        },
        results=None,
    )


def loaded_values(pair: Gearbox) -> dict[str, float]:
    """Return what loaded contact of a pair says.

    Parameters
    ----------
    pair : Gearbox
        A pair without a machine.

    Returns
    -------
    dict of str to float
        Mean transmission error and its peak to peak, um; largest pressure, MPa; largest root stress of both
        gears, MPa.
    """
    contact = pair.contact().table()
    roots = pair.root_stress().table().groupby("body")["largest_mpa"].max()
    return {
        "te_mean_um": float(contact["ste_um"].mean()),
        "te_peak_to_peak_um": float(contact["ste_um"].max() - contact["ste_um"].min()),
        "pressure_mpa": float(contact["pressure_mpa"].max()),
        "pinion_root_mpa": float(roots["pinion"]),
        "gear_root_mpa": float(roots["face_gear"]),
    }


def friction_values(pair: Gearbox) -> dict[str, float]:
    """Return what the friction of a mesh takes.

    Parameters
    ----------
    pair : Gearbox
        A pair without a machine.

    Returns
    -------
    dict of str to float
        Loss in percent of the power, and the largest flash temperature, K.
    """
    table = pair.with_values({"lubrication": OIL}).friction(speed_rpm=SPEED).table().iloc[0]
    return {
        "loss_percent": 100.0 * (1.0 - float(table["efficiency"])),
        "flash_k": float(table["largest_flash_k"]),
    }


def backlash(pair: Gearbox) -> float:
    """Return the smallest backlash of an unloaded pair, um along the normal.

    Parameters
    ----------
    pair : Gearbox
        A pair without a machine.

    Returns
    -------
    float
        The backlash, um.
    """
    return float(pair.geometry().content["pair"]["backlash_um"]["smallest"])


def error_values(pair: Gearbox) -> dict[str, float]:
    """Return what each error of assembly changes, over the size of the error.

    Parameters
    ----------
    pair : Gearbox
        A pair without a machine.

    Returns
    -------
    dict of str to float
        Change of the backlash, of the mean transmission error and of its peak to peak by a unit of each
        error: um by um, for the shaft angle um by 0.01 deg.
    """
    values: dict[str, float] = {}
    for error, (key, size) in ERRORS.items():
        ends = [_moved_values(pair.with_values({f"tooth_pair.assembly.{key}": s})) for s in (-size, size)]
        units = 2.0 * (size / 0.01 if key.endswith("_deg") else size)
        for name, before in ends[0].items():
            values[f"{name}_by_{error}"] = (ends[1][name] - before) / units
    return values


def _moved_values(pair: Gearbox) -> dict[str, float]:
    """Return backlash, mean transmission error and its peak to peak of a pair, um."""
    ste = pair.contact().table()["ste_um"]
    return {
        "backlash": backlash(pair),
        "te_mean": float(ste.mean()),
        "te_peak_to_peak": float(ste.max() - ste.min()),
    }


def machine_values(kind: str) -> dict[str, float]:
    """Return how the small machine shares its load at rest, and what its axial bearings hold.

    Parameters
    ----------
    kind : str
        A key of KINDS.

    Returns
    -------
    dict of str to float
        Largest K_gamma of inputs; mean axial force on the bearings of the first input and of the idler, N,
        positive outwards.
    """
    config = {
        "case": "kinds_of_teeth_machine",
        "tooth_pair": tooth_pair(kind),
        "mesh": {"resolution": COARSE},
        "contact": {
            "torques_n_m": [250.0, TORQUE, 1000.0],
            "positions_per_pitch": 8,
            "refinement": {"profile": 3, "width": 1, "depth": 1},
        },
        "mesh_stiffness": {"torque_n_m": TORQUE, "harmonics_kept": 3},
        "transmission": MACHINE,
        "dynamics": {"speed_rpm": SPEED},
    }
    hunting = load(config, results=None).hunting()
    axial = hunting.bearings().set_index("body")["mean_z_n"]
    return {
        "k_gamma_inputs": float(hunting.table()["k_gamma"].max()),
        "axial_input_n": float(axial["engine A"]),
        "axial_idler_n": float(axial["idler"]),
    }


def teeth_row(kind: str) -> dict[str, Any]:
    """Return a row of the table.

    Parameters
    ----------
    kind : str
        A key of KINDS.

    Returns
    -------
    dict
        Values by column; `finer_` ones are from the finer mesh.
    """
    pair = pair_alone(kind)
    finer_pair = pair_alone(kind, FINER)
    finer = {**loaded_values(finer_pair), **friction_values(finer_pair)}
    return {
        "teeth": kind,
        "contact_ratio": float(pair.geometry().content["pair"]["contact_ratio"]),
        **loaded_values(pair),
        **friction_values(pair),
        **{f"finer_{name}": value for name, value in finer.items()},
        **machine_values(kind),
        **error_values(pair),
    }


def teeth_table() -> pd.DataFrame:
    """Compute all rows.

    Returns
    -------
    pd.DataFrame
        A row for each of KINDS; what is below 1e-9 is zero.
    """
    rows = pd.DataFrame([teeth_row(kind) for kind in KINDS])
    return (rows.set_index("teeth").round(9) + 0.0).reset_index()  # no zero keeps a sign


def page_table(table: pd.DataFrame) -> str:
    """Return the table as a page shows it.

    Parameters
    ----------
    table : pd.DataFrame
        Stored table.

    Returns
    -------
    str
        Markdown; a column for each kind of teeth.
    """
    lines = [f"| | {' | '.join(table['teeth'])} |", "|---" * (1 + len(table)) + "|"]
    for column, words, decimals in LINES:
        values = (round(float(value), decimals) + 0.0 for value in table[column])
        lines.append(f"| {words} | {' | '.join(f'{value:,.{decimals}f}' for value in values)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    teeth_table().to_csv(TABLE, index=False, float_format="%.7g", lineterminator="\n")
