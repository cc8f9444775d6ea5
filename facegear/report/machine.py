"""The chapter on the machine as configured: what it is, its key numbers, torques and powers of every path."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.report.page import Chapter, Table

KINEMATICS = {
    "geometric": "geometric, lever arms and signs as gears have them",
    "printed": "printed, equation (13) of the source paper to the letter (docs/theory.md)",
}
BALANCED = 1e-9
"""Relative difference of power in and out that is rounding."""
NUMBERS = {
    "gear_ratio": ("Gear ratio (gear teeth over pinion teeth)", "", 5),
    "pinion_speed_rpm": ("Speed of the pinions", "rpm", 6),
    "gear_speed_rpm": ("Speed of the output gear", "rpm", 6),
    "output_torque_n_m": ("Torque of the output gear", "N m", 5),
    "mesh_frequency_hz": ("Mesh frequency", "Hz", 6),
    "power_in_kw": ("Power brought in", "kW", 5),
    "power_out_kw": ("Power taken out", "kW", 5),
    "contact_ratio": ("Contact ratio, unloaded", "", 4),
    "face_width_mm": ("Face width of the gear", "mm", 5),
    "face_limits_mm": ("Radii without undercut and pointed teeth", "mm", 6),
    "backlash_um": ("Backlash along the line of action, smallest", "um", 4),
    "nominal_path_mm": ("Radius of the contact path, nominal", "mm", 6),
    "unloaded_path_mm": ("Radius of the contact path, unloaded as assembled", "mm", 6),
    "path_shift_mm": ("Shift of the unloaded contact path, positive outwards", "mm", 3),
}
"""Key numbers in their order: words, unit, significant digits."""


def machine_chapter(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Chapter:
    """Config, torques and powers; `tables` may hold ratings, bodies, meshes."""
    found = []
    if "bodies" in tables:
        found = [
            Table("Torque and power of every body; positive: brought in", tables["bodies"], 5),
            Table(
                "Every mesh at rest with mean stiffness; the force is along the line of action",
                tables["meshes"],
                5,
            ),
        ]
    return Chapter("The machine as configured", _text(values, tables), (), [*found, *_config_tables(values)])


def key_numbers(tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None) -> pd.DataFrame:
    """Columns quantity, value, unit, as text; only what is known."""
    known = rated(tables) | ({} if pair is None else _teeth(pair))
    rows = []
    for name, (words, unit, digits) in NUMBERS.items():
        if name in known:
            value = known[name]
            parts = value if isinstance(value, tuple) else (value,)
            rows.append((words, " to ".join(f"{part:.{digits}g}" for part in parts), unit))
    return pd.DataFrame(rows, columns=["quantity", "value", "unit"])


def rated(tables: Mapping[str, pd.DataFrame]) -> dict[str, float]:
    """Numbers of the ratings by quantity, and the torque of the output gear; empty without a machine."""
    if "ratings" not in tables:
        return {}
    bodies = tables["bodies"]
    gears = bodies.loc[bodies["role"] == "face gear", "torque_n_m"]
    output = gears.iloc[int(gears.abs().to_numpy().argmax())]
    return dict(tables["ratings"].itertuples(index=False)) | {"output_torque_n_m": abs(output)}


def _teeth(pair: Mapping[str, Any]) -> dict[str, Any]:
    radii, limits = pair["radii_mm"], pair["limits_mm"]
    path = pair["unloaded"]["drive"]["path_pinion_y_mm"]
    unloaded, nominal = sum(path) / len(path), radii["gear_contact_path_nominal"]
    shift = unloaded - nominal
    return {
        "contact_ratio": pair["contact_ratio"],
        "face_width_mm": radii["gear_outer"] - radii["gear_inner"],
        "face_limits_mm": (limits["inner_undercut"], limits["outer_pointing"]),
        "backlash_um": pair["backlash_um"]["smallest"],
        "nominal_path_mm": nominal,
        "unloaded_path_mm": unloaded,
        "path_shift_mm": shift if abs(shift) > 1e-3 else 0.0,
    }


def _text(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> str:
    pair, transmission = values["tooth_pair"], values["transmission"]
    teeth = f"module {pair['module_mm']:g} mm, pressure angle {pair['pressure_angle_deg']:g} deg. "
    source = values["mesh_stiffness"]["source"]
    if transmission is None:
        return (
            f"A pinion of {pair['pinion_teeth']} teeth and a face gear of {pair['face_gear_teeth']} teeth, "
            f"{teeth}Mesh stiffness: {source}. "
            "No transmission is configured: teeth, contact and stiffness alone."
        )
    torque = transmission["torque"]
    return (
        f"{_count(transmission['pinions'], 'pinion')} of {pair['pinion_teeth']} teeth and "
        f"{_count(transmission['face_gears'], 'face gear')} of {pair['face_gear_teeth']} teeth, {teeth}"
        f"Each input brings {torque['per_input_n_m']:g} N m unless the table gives its own torque; "
        f"{100 * torque['tail_share']:.3g} % of the power leaves at the tail. Mesh stiffness: {source}. "
        f"{_error(transmission['transmission_error'], tables)}"
        f"Mesh kinematics: {KINEMATICS[transmission['mesh_kinematics']]}.{_balance(tables)}"
    )


def _error(section: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> str:
    """What e(t) from contact came to."""
    if section["source"] == "given" or "harmonics" not in tables:
        return ""
    table = tables["harmonics"]
    if "e_peak_to_peak_um" not in table:
        return ""
    size, cut = (float(table[name].iloc[0]) for name in ("e_peak_to_peak_um", "e_truncation_error_um"))
    words = (
        f"{size:.3g} um peak to peak, the {len(table) - 1} orders kept within {cut:.2g} um of it"
        if size > 0.0
        else "constant, so e(t) from contact is zero"
    )
    return f"Transmission error from contact, unloaded: {words}. "


def _balance(tables: Mapping[str, pd.DataFrame]) -> str:
    """What the powers say: in balance, or by how much equation (13) as printed misses it."""
    numbers = rated(tables)
    if "power_imbalance" not in numbers:
        return ""
    missing = numbers["power_imbalance"]
    if abs(missing) <= BALANCED:
        return "\n\nPower in equals power out: bearings and meshes of the statics take none."
    return (
        f"\n\nPower in less power out is {100 * missing:.3g} % of the larger. Bodies turn as their teeth "
        "say, but the lever arms of equation (13) as printed are not those of the teeth; geometric meshes "
        "are in balance."
    )


def _count(items: Sequence[Any], name: str) -> str:
    return f"{len(items)} {name}" + ("" if len(items) == 1 else "s")


def _config_tables(values: Mapping[str, Any]) -> list[Table]:
    sections = ("tooth_pair", "transmission", "mesh", "contact", "mesh_stiffness", "dynamics")
    rows = [
        row for section in sections for row in _flat(section, values[section]) if row[1] not in (None, "")
    ]
    keys = pd.DataFrame([row for row in rows if ".pinions" not in row[0]], columns=["key", "value"])
    config = Table("Config, defaults included", keys, folded=True)
    if values["transmission"] is None:
        return [config]
    pinions = pd.DataFrame(values["transmission"]["pinions"]).dropna(axis=1, how="all")
    return [Table("Pinions", pinions), config]


def _flat(key: str, value: Any) -> list[tuple[str, Any]]:
    if isinstance(value, Mapping):
        return [row for name, inside in value.items() for row in _flat(f"{key}.{name}", inside)]
    if isinstance(value, list):
        return [(key, ", ".join(str(item) for item in value))]
    return [(key, value)]
