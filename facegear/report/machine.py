"""The chapter on the machine as configured: inputs, key numbers, torques and powers."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd

from facegear.number_format import count_noun, format_number
from facegear.report.data_sheet import (
    DATA_SHEET,
    ROUNDING_OF_POWER,
    data_sheet_table,
    has_spur_teeth,
    machine_numbers,
    teeth_in_words,
)
from facegear.report.page import Chapter, Picture
from facegear.report.table import Table

SOURCES = {
    "fem": "computed by finite elements",
    "fem_scaled": "computed by finite elements and scaled to a given mean",
    "harmonics": "given as harmonics",
}
"""Source of the mesh stiffness in words, by the value of `mesh_stiffness.source`."""


def inputs_in_words(values: Mapping[str, Any]) -> list[str]:
    """Describe the inputs that a publication may leave out: torques, errors, stiffness, kinematics,
    teeth.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config, with section `transmission`.

    Returns
    -------
    list[str]
        A phrase for each input.
    """
    transmission, pair = values["transmission"], values["tooth_pair"]
    torque, error = transmission["torque"], transmission["transmission_error"]
    gear, pinion, shaper = pair["face_gear"], pair["pinion"], pair["shaper"]
    stiffness = values["mesh_stiffness"]
    further_text = "; ".join(
        f"harmonic {term['order']}: {term['amplitude_um']:.3g} µm" for term in error["more_harmonics"]
    )
    mean = "" if stiffness["source"] == "fem" else f", mean {1e-6 * stiffness['mean_n_per_m']:.3g} N/µm"
    phasing = _phasing(error["phasing"])
    teeth = (
        []
        if pinion is None
        else [
            f"face width {gear['inner_radius_mm']:g} to {gear['outer_radius_mm']:g} mm, "
            f"rim {gear['rim_thickness_mm']:g} mm, bore {pinion['bore_radius_mm']:g} mm, "
            f"shaper teeth {shaper['teeth']}"
        ]
    )
    pinions_with_torque = [
        pinion for pinion in transmission["pinions"] if pinion.get("torque_n_m") is not None
    ]
    torque_text = "".join(
        f", {pinion['name']} {pinion['torque_n_m']:g} N m" for pinion in pinions_with_torque
    )
    return [
        f"torque per engine {torque['per_input_n_m']:g} N m{torque_text}",
        f"power at the tail {100 * torque['tail_share']:.3g} %",
        "e(t) from contact"
        if error["source"] == "from_contact"
        else f"e(t): {error['amplitude_um']:.4g} µm read as its {error['meaning']}, cosine, "
        f"phase {error['phase_deg']:g} deg, {phasing}" + (f", {further_text}" if further_text else ""),
        f"phases of the lower meshes {transmission['phase_convention']}",
        f"mesh stiffness {SOURCES[stiffness['source']]}" + mean + _variation(stiffness["variation"]),
        _kinematics(transmission),
        *teeth,
    ]


def inputs_caption(values: Mapping[str, Any], of_publication: bool) -> str:
    """Write the line of inputs (`inputs_in_words`) below a figure.

    For a figure of a publication it begins with the remark that these inputs were not disclosed.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config.
    of_publication : bool
        Whether the figure belongs to a publication.

    Returns
    -------
    str
        The line.
    """
    lead = "Not disclosed by the paper, chosen here: " if of_publication else "Inputs of the base case: "
    return lead + "; ".join(inputs_in_words(values))


def _phasing(phasing: str | Mapping[str, float]) -> str:
    """Say in words how the transmission errors of the meshes lag: `in_step`, `mesh`, or lags in mesh
    periods by mesh.
    """
    if isinstance(phasing, str):
        return {"in_step": "in step at all meshes", "mesh": "shifted like the mesh stiffness"}[phasing]
    lags = ", ".join(f"{mesh} {lag:g}" for mesh, lag in phasing.items())
    return f"in step but for lags in mesh periods: {lags}"


def _variation(factor: float) -> str:
    """Say by which factor the variation of the stiffness about its mean is multiplied; empty for 1."""
    return "" if factor == 1.0 else f", {factor:.3g} times its variation"


def _kinematics(transmission: Mapping[str, Any]) -> str:
    """Say whether meshes are geometric or as printed, with the given mesh radius (mm). `transmission`:
    that section of the config.
    """
    radius = transmission["face_gear"]["mesh_radius_mm"]
    return "meshes geometric" if radius is None else f"meshes as printed, mesh radius {radius:g} mm"


KINEMATICS = {
    "geometric": "geometric, lever arms and signs as gears have them",
    "printed": "printed, equation (13) of the source paper to the letter (docs/explanation/theory.md)",
}
"""Mesh kinematics in words."""
NAMES = ("case", "reproduction")
"""Keys that say nothing of the machine."""


class Base(NamedTuple):
    """The config file that a case's own file extends: its name and its values."""

    name: str
    values: Mapping[str, Any]


NUMBERS = {
    "bending_safety": ("Smallest safety against bending", "", 3),
    "pitting_safety": ("Smallest safety against pitting", "", 3),
    "k_gamma": ("Mesh load factor K_gamma, largest, running", "", 4),
    "k_v": ("Dynamic factor K_v, largest, running", "", 4),
    "loss_percent": ("Friction loss of all meshes at the nominal load", "%", 3),
    "gear_ratio": ("Gear ratio (gear teeth over pinion teeth)", "", 4),
    "speed_ratio": ("Ratio of speeds, input over output pinion", "", 4),
    "pinion_speed_rpm": ("Speed of the pinions", "rpm", 4),
    "gear_speed_rpm": ("Speed of the face gears", "rpm", 4),
    "output_torque_n_m": ("Torque of the output gear", "N m", 4),
    "output_pinions_n_m": ("Torque of the output pinions", "N m", 4),
    "mesh_frequency_hz": ("Mesh frequency", "Hz", 4),
    "power_in_kw": ("Power brought in", "kW", 4),
    "power_out_kw": ("Power taken out", "kW", 4),
    "power_out_without_friction_kw": ("Power taken out, without friction", "kW", 4),
    "power_out_with_friction_kw": ("Power taken out, less the friction loss of the meshes", "kW", 4),
    "contact_ratio": ("Contact ratio, unloaded", "", 4),
    "face_width_mm": ("Face width of the gear", "mm", 4),
    "face_limits_mm": ("Radii without undercut and pointed teeth", "mm", 4),
    "inner_limit_mm": ("Smallest radius that the face may have; it has no largest", "mm", 4),
    "outer_limit_mm": ("Largest radius that the face may have; it has no smallest", "mm", 4),
    "backlash_um": ("Backlash along the line of action, smallest", "µm", 4),
    "nominal_path_mm": ("Radius of the contact path, nominal", "mm", 4),
    "unloaded_path_mm": ("Radius of the contact path, unloaded as assembled", "mm", 4),
    "path_place_mm": ("Middle of the contact path along the pinion's axis, unloaded as assembled", "mm", 4),
    "path_shift_mm": ("Shift of the unloaded contact path, positive outwards", "mm", 3),
}
"""Key numbers in their order: words, unit, significant digits."""


def machine_chapter(
    values: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    pair: Mapping[str, Any] | None = None,
    pictures: Sequence[Picture] = (),
    base: Base | None = None,
) -> Chapter:
    """Write the chapter on the machine.

    Parameters
    ----------
    values : mapping
        Plain values of the config.
    tables : mapping of str to DataFrame
        Tables of the report by name; may hold ratings, bodies, meshes.
    pair : mapping or None
        Record of the tooth geometry (`geometry/pair.json`), where it was computed.
    pictures : sequence of Picture
        Drawings of the machine.
    base : Base or None
        The config file that the case's own extends; the table of the config marks what differs from it.

    Returns
    -------
    Chapter
        Key numbers, data of both gears, torques, powers and config.
    """
    numbers = key_numbers(tables, pair)
    chapter_tables = [Table("Key numbers", numbers)] if len(numbers) else []
    if pair is not None:
        chapter_tables.append(Table(DATA_SHEET, data_sheet_table(pair)))
    if "bodies" in tables:
        chapter_tables += [
            Table("Torque and power of every body; positive values are brought in", tables["bodies"]),
            Table(
                "Every mesh at rest, with mean stiffness; the force acts along the line of action",
                tables["meshes"],
            ),
        ]
    config = _config_tables(values, base)
    return Chapter("The machine as configured", _text(values, tables), pictures, [*chapter_tables, *config])


def key_numbers(tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None) -> pd.DataFrame:
    """Return the key numbers of a machine as text, as far as they were computed.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name.
    pair : mapping or None
        Record of the tooth geometry (`geometry/pair.json`), where it was computed.

    Returns
    -------
    DataFrame
        Columns quantity, value and unit, in the order of NUMBERS.
    """
    numbers_by_name = _less_friction(_signed_numbers(tables) | machine_numbers(tables)) | (
        {} if pair is None else _teeth(pair)
    )
    rows = []
    for name, (words, unit, digits) in NUMBERS.items():
        if name in numbers_by_name:
            value = numbers_by_name[name]
            parts = value if isinstance(value, tuple) else (value,)
            rows.append((words, " to ".join(format_number(part, digits) for part in parts), unit))
    return pd.DataFrame(rows, columns=["quantity", "value", "unit"])


def _less_friction(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """Return numbers by name with power_out_kw replaced by the power out without friction and less the
    friction loss (power in * loss_percent / 100), kW, if power in, power out and loss are known; else
    unchanged.
    """
    if not {"loss_percent", "power_in_kw", "power_out_kw"} <= numbers.keys():
        return dict(numbers)
    without = numbers["power_out_kw"]
    loss = numbers["power_in_kw"] * numbers["loss_percent"] / 100.0
    return {
        **{name: value for name, value in numbers.items() if name != "power_out_kw"},
        "power_out_without_friction_kw": without,
        "power_out_with_friction_kw": without - loss,
    }


def _signed_numbers(tables: Mapping[str, pd.DataFrame]) -> dict[str, float]:
    """Return by name, as far as computed: bending_safety and pitting_safety (smallest), k_gamma and k_v
    (largest of the running machine) and loss_percent (at the nominal load, bin 0).
    """
    numbers: dict[str, float] = {}
    if "rating" in tables:
        smallest = tables["rating"].groupby("failure")["safety"].min()
        numbers |= {f"{failure}_safety": float(safety) for failure, safety in smallest.items()}
    if "following_groups" in tables:
        largest = tables["following_groups"][["k_gamma", "k_v"]].max()
        numbers |= {name: float(largest[name]) for name in largest.index}
    if "machine_loss" in tables:
        nominal = tables["machine_loss"].loc[lambda table: table["bin"] == 0, "loss_percent"]
        numbers["loss_percent"] = float(nominal.iloc[0])
    return numbers


def _teeth(pair: Mapping[str, Any]) -> dict[str, Any]:
    """Return the key numbers of the teeth by name, in the units of the names, from the record of their
    geometry. path_shift_mm is the mean radius of the unloaded contact path less the nominal one, 0
    within 0.001 mm.
    """
    radii, limits = pair["radii_mm"], pair["limits_mm"]
    path = pair["unloaded"]["drive"]["path_pinion_y_mm"]
    path_radius, nominal = sum(path) / len(path), radii["gear_contact_path_nominal"]
    shift = path_radius - nominal
    inner, outer = limits["inner_undercut"], limits["outer_pointing"]
    numbers = {
        "contact_ratio": pair["contact_ratio"],
        "face_width_mm": radii["gear_outer"] - radii["gear_inner"],
        **_face_limits(inner, outer),
        "backlash_um": pair["backlash_um"]["smallest"],
    }
    if not has_spur_teeth(pair["design_si"]):
        # along the pinion's axis, which is no radius of the gear where axes are offset or not square
        return numbers | {"path_place_mm": path_radius}
    return numbers | {
        "nominal_path_mm": nominal,
        "unloaded_path_mm": path_radius,
        "path_shift_mm": shift if abs(shift) > 1e-3 else 0.0,
    }


def _face_limits(inner: float | None, outer: float | None) -> dict[str, Any]:
    """Return the limits of the face radii, mm, by the names of their key numbers; None for no limit."""
    if inner is not None and outer is not None:
        return {"face_limits_mm": (inner, outer)}
    limits = {"inner_limit_mm": inner, "outer_limit_mm": outer}
    return {name: limit for name, limit in limits.items() if limit is not None}


def _text(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> str:
    """Return the chapter's text: teeth, torque per input, source of stiffness and errors, kinematics,
    power balance; for a config without a transmission only the teeth.
    """
    pair, transmission = values["tooth_pair"], values["transmission"]
    teeth = teeth_in_words(pair)
    source = SOURCES[values["mesh_stiffness"]["source"]]
    if transmission is None:
        return (
            f"A pinion of {pair['pinion_teeth']} teeth and a face gear of {pair['face_gear_teeth']} teeth, "
            f"{teeth}Mesh stiffness: {source}. {_materials(values)}"
            "No transmission is configured: teeth, contact and stiffness alone."
        )
    torque = transmission["torque"]
    pinions = count_noun(len(transmission["pinions"]), "pinion")
    gears = count_noun(len(transmission["face_gears"]), "face gear")
    return (
        f"{pinions} of {pair['pinion_teeth']} teeth and {gears} of {pair['face_gear_teeth']} teeth, {teeth}"
        f"Each input brings {torque['per_input_n_m']:g} N m unless the table gives its own torque; "
        f"{100 * torque['tail_share']:.3g} % of the power leaves at the tail. Mesh stiffness: {source}. "
        f"{_materials(values)}{_error(transmission['transmission_error'], tables)}"
        f"Mesh kinematics: {KINEMATICS[transmission['mesh_kinematics']]}.{_balance(tables)}"
    )


def _materials(values: Mapping[str, Any]) -> str:
    """State the material cards by which the pair is rated; empty where teeth are not rated."""
    strength = values["strength"]
    if strength is None or strength["pinion"] is None:
        return ""
    pinion, gear = (strength[body]["card"]["name"] for body in ("pinion", "face_gear"))
    return f"Rated as {pinion}. " if pinion == gear else f"Rated as {pinion} (pinion) and {gear} (gear). "


def _error(section: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> str:
    """State the peak-to-peak value of the unloaded transmission error e(t) from contact, µm, and what
    its kept harmonics leave out (table `harmonics`); empty if e(t) is given. `section`:
    transmission.transmission_error.
    """
    if section["source"] == "given" or "harmonics" not in tables:
        return ""
    table = tables["harmonics"]
    if "e_peak_to_peak_um" not in table:
        return ""
    size, cut = (float(table[name].iloc[0]) for name in ("e_peak_to_peak_um", "e_truncation_error_um"))
    orders = count_noun(len(table) - 1, "order")
    words = (
        f"{size:.3g} µm peak to peak, the {orders} kept within {cut:.2g} µm of it"
        if size > 0.0
        else "constant, so e(t) from contact is zero"
    )
    return f"Transmission error from contact, unloaded: {words}. "


def _balance(tables: Mapping[str, pd.DataFrame]) -> str:
    """State whether power in equals power out within ROUNDING_OF_POWER, and the friction loss, or by
    how many percent of the larger they differ with equation (13) as printed; empty without table
    `ratings`.
    """
    numbers = machine_numbers(tables)
    if "power_imbalance" not in numbers:
        return ""
    excess = numbers["power_imbalance"]
    if abs(excess) <= ROUNDING_OF_POWER:
        text = "\n\nThe power brought in equals the power taken out: at rest, bearings and meshes lose none."
        loss = _signed_numbers(tables).get("loss_percent")
        if loss is None:
            return text
        return (
            f"{text} Friction is not in these torques and powers. It takes {loss:.3g} % of the power brought "
            "in at the nominal load, so that the output gives this much less."
        )
    relation = "larger" if excess < 0.0 else "smaller"
    return (
        f"\n\nThe power taken out is {relation} than the power brought in, by {100 * abs(excess):.3g} % of "
        "the larger of both. Bodies turn as their teeth say, but the lever arms of equation (13) as printed "
        "are not those of the teeth; geometric meshes are in balance."
    )


def _config_tables(values: Mapping[str, Any], base: Base | None) -> list[Table]:
    """Return the table of the pinions, if there is a transmission, and one of every key of the config
    that holds something (key, value). With a `base` it marks changes and gives the base's values,
    removed keys included.
    """
    rows = _keys(values)
    frame = pd.DataFrame(list(rows.items()), columns=["key", "value"], dtype=object)
    caption = "The whole config, with its defaults"
    if base is not None:
        before = _keys(base.values)
        removed_rows = [(key, "") for key in before if key not in rows]
        frame = pd.DataFrame([*rows.items(), *removed_rows], columns=["key", "value"], dtype=object)
        is_changed = [rows.get(key) != before.get(key) for key in frame["key"]]
        change_marks = ["changed" if differs else "" for differs in is_changed]
        base_values = [
            before.get(key, "") if rows.get(key) != before.get(key) else "" for key in frame["key"]
        ]
        frame = frame.assign(**{f"against {base.name}": change_marks, f"in {base.name}": base_values})
        differ = count_noun(sum(is_changed), "key differs", "keys differ")
        caption += f"; {differ} from {base.name}, which it extends"
    config = Table(caption, frame, is_folded=True, exact=True)
    if values["transmission"] is None:
        return [config]
    pinions = pd.DataFrame(values["transmission"]["pinions"]).dropna(axis=1, how="all")
    return [Table("Pinions", pinions), config]


def _keys(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of a config by dotted key, without NAMES and without keys that hold None or an
    empty text.
    """
    rows = [row for section in values for row in _flat(section, values[section])]
    return {key: value for key, value in rows if key not in NAMES and value not in (None, "")}


def _flat(key: str, value: Any) -> list[tuple[str, Any]]:
    """Return dotted keys and values below a key. A list of sections has numbered keys (`[0]`); any
    other list is one value, joined by commas.
    """
    if isinstance(value, Mapping):
        return [row for name, inside in value.items() for row in _flat(f"{key}.{name}", inside)]
    if isinstance(value, list | tuple):
        if any(isinstance(item, Mapping) for item in value):
            return [row for i, item in enumerate(value) for row in _flat(f"{key}[{i}]", item)]
        return [(key, ", ".join(str(item) for item in value))]
    return [(key, value)]
