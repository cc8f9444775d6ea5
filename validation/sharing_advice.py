"""Advice on load sharing repeated by configs: `python -m validation.sharing_advice`.

Each change that the load-sharing map tries is made in the config itself. The idlers' drawn errors are made in
the config, too: each machine of the sample has an error in both meshes of every idler and a place for every
idler, and is put at rest by `gearbox.statics()`.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.gearbox import Gearbox, example, load
from facegear.new_machine.first_machine import first_machine
from facegear.new_machine.wishes import MachineWishes

TABLE = Path(__file__).parents[1] / "docs" / "measured" / "sharing_advice.csv"
CONCENTRIC = Path(__file__).parents[1] / "config" / "concentric.yaml"
SAMPLES = 100
"""Machines in a sample, the least that the section allows: both sides have the same errors."""
FREE = 0.1
"""Radial stiffness of the bearing of a floating gear, N/m: nothing beside meshes of 1e8 N/m."""
JUDGED_LEVEL = 95.0
"""Percentile of the idlers' K_gamma, %."""
MESHES = "halve the deviations of the idlers' meshes"
"""Advice that halves the errors drawn for meshes, and no key of the machine."""
POSITIONS = "halve the deviations of the idlers' positions"
"""Advice that halves the places drawn for idlers, and no key of the machine."""
INPUTS, IDLERS = ("input",), ("idler", "tail")
"""Roles of the pinions of a group."""
SIDES = ("lower", "upper")


def repeat_advice(gearbox: Gearbox, words: list[str] | None = None) -> pd.DataFrame:
    """Repeat each advice of a machine by changing its config.

    Parameters
    ----------
    gearbox : Gearbox
        Split-torque machine with a section `sharing_map`.
    words : list of str or None
        Changes that are repeated; None for all.

    Returns
    -------
    pd.DataFrame
        One row a group and change, as in the table of `gearbox.sharing_map()`: predicted_gain in closed form,
        gain by the drawn paths of the map, found_gain by the statics of the changed configs.
    """
    advice = gearbox.sharing_map().table()
    if words is not None:
        advice = advice[advice["change"].isin(words)]
    before = config_factors(gearbox, {}, "")
    factors_after = {
        change: config_factors(gearbox, config_changes(gearbox, change), change)
        for change in advice["change"].unique()
    }
    gains = [before[row.group] - factors_after[row.change][row.group] for row in advice.itertuples()]
    columns = ["group", "kind", "change", "from_to", "k_gamma", "predicted_gain", "gain"]
    return advice[columns].assign(found_gain=gains).reset_index(drop=True)


def config_changes(gearbox: Gearbox, words: str) -> dict[str, Any]:
    """Return the keys of the config that an advice changes.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.
    words : str
        The advice.

    Returns
    -------
    dict of str to object
        Dotted keys and new values; empty for an advice on the drawn errors.
    """
    section = gearbox.values["transmission"]
    factor = 2.0 if words.startswith("double") else 0.5
    if "bearings of the" in words:
        return {"transmission.single_pinions": _scaled_bearings(section, words.endswith("inputs"), factor)}
    if words.endswith("float"):
        return {"transmission.single_gears": _floating_gears(section, words)}
    if words == "halve the backlash of all meshes":
        single = section["single_meshes"]
        meshes = {name: mesh | _scale_value(mesh, "backlash_um", factor) for name, mesh in single.items()}
        half = factor * section["backlash_um"]
        return {"transmission.backlash_um": half, "transmission.single_meshes": meshes}
    return {}


def config_factors(gearbox: Gearbox, changes: Mapping[str, Any], words: str) -> dict[str, float]:
    """Find K_gamma of every group by the statics of configs with drawn errors.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.
    changes : mapping of str to object
        Dotted keys and new values.
    words : str
        The advice; it decides which deviations are halved.

    Returns
    -------
    dict of str to float
        By group, dimensionless: the value of an input without drawn errors, P95 over the sample for idlers.
    """
    new_gearbox = gearbox.with_values(changes)
    section = new_gearbox.values["transmission"]
    names = {role: [p["name"] for p in section["pinions"] if p["role"] in role] for role in (INPUTS, IDLERS)}
    even = gearbox.hunting(positions=1).meshes().set_index("mesh")["even_share_n"].abs()
    forces = new_gearbox.statics().table().set_index("mesh")["force_n"].abs()
    factors = {
        name: max(forces[f"{name}/{side}"] / even[f"{name}/{side}"] for side in SIDES)
        for name in names[INPUTS]
    }
    lower = [f"{name}/lower" for name in names[IDLERS]]
    sample = [
        float((machine.statics().table().set_index("mesh")["force_n"].abs()[lower] / even[lower]).max())
        for machine in drawn_machines(new_gearbox, names[IDLERS], words)
    ]
    return factors | {"idlers": float(np.percentile(sample, JUDGED_LEVEL))}


def drawn_machines(gearbox: Gearbox, idlers: list[str], words: str) -> list[Gearbox]:
    """Draw machines whose idlers have errors in both meshes and a place beside the nominal one.

    Parameters
    ----------
    gearbox : Gearbox
        The machine.
    idlers : list of str
        Names of the idlers.
    words : str
        The advice; it decides which deviations are halved.

    Returns
    -------
    list of Gearbox
        Three independent normal errors for every idler, under the condition that together they make a path as
        late on the flank that works as the map draws it.
    """
    section, map_section = gearbox.values["transmission"], gearbox.values["sharing_map"]
    mesh = map_section["mesh_deviation_um"] * (0.5 if words == MESHES else 1.0)
    position_deviation = map_section["position_deviation_um"] * (0.5 if words == POSITIONS else 1.0)
    cosine = np.cos(np.radians(gearbox.values["tooth_pair"]["pressure_angle_deg"]))
    deviations = np.array([mesh, mesh, 2.0 * cosine * position_deviation])
    late = np.random.default_rng(map_section["seed"]).standard_normal((map_section["samples"], len(idlers)))
    flanks = gearbox.statics().table().set_index("mesh")["flank"]
    working = [-1.0 if flanks[f"{name}/upper"] == "back" else 1.0 for name in idlers]
    parts = np.array(working) * conditioned_parts(late * np.linalg.norm(deviations), deviations)
    machines = []
    for upper, lower, aside in parts:
        meshes, pinions = dict(section["single_meshes"]), dict(section["single_pinions"])
        for number, name in enumerate(idlers):
            for side, error in (("upper", upper[number]), ("lower", -lower[number])):
                entry = meshes.get(f"{name}/{side}", {})
                meshes[f"{name}/{side}"] = entry | {"error_um": entry.get("error_um", 0.0) + error}
            pinion = pinions.get(name, {})
            position = pinion.get("position_um", {"x": 0.0, "y": 0.0})
            new_position = position | {"x": position["x"] - aside[number] / (2.0 * cosine)}
            pinions[name] = pinion | {"position_um": new_position}
        changes = {"transmission.single_meshes": meshes, "transmission.single_pinions": pinions}
        machines.append(gearbox.with_values(changes))
    return machines


def conditioned_parts(total: Array, deviations: Array) -> Array:
    """Draw independent normal parts under the condition that their sum is given.

    Parameters
    ----------
    total : (samples, paths) array
        Sum of the parts, any unit.
    deviations : (parts,) array
        Standard deviation of each part, in the same unit.

    Returns
    -------
    (samples, parts, paths) array
        In the same unit.
    """
    free = np.random.default_rng(1).standard_normal((len(total), len(deviations), total.shape[1]))
    free *= deviations[:, None]
    shares = deviations**2 / (deviations**2).sum()
    remainder = total - free.sum(axis=1)
    return np.asarray(free + shares[:, None] * remainder[:, None, :])


def _scaled_bearings(section: Mapping[str, Any], are_inputs: bool, factor: float) -> dict[str, Any]:
    """All single pinions, with the radial bearing stiffness of one role scaled."""
    single = dict(section["single_pinions"])
    for pinion in section["pinions"]:
        if (pinion["role"] == "input") == are_inputs:
            entry = single.get(pinion["name"], {})
            stiffness = (
                entry.get("bearing_stiffness_n_per_m") or section["pinion"]["bearing_stiffness_n_per_m"]
            )
            radial = {key: factor * value for key, value in stiffness.items() if key != "z"}
            single[pinion["name"]] = entry | {"bearing_stiffness_n_per_m": stiffness | radial}
    return single


def _floating_gears(section: Mapping[str, Any], words: str) -> dict[str, Any]:
    """All single gears, with the radial bearing stiffness of those that float gone."""
    single = dict(section["single_gears"])
    for side in SIDES:
        if side in words or "both" in words:
            entry, key = single.get(side, {}), "bearing_stiffness_n_per_m"
            along = (entry.get(key) or section["face_gear"][key])["z"]
            single[side] = entry | {key: {"x": FREE, "y": FREE, "z": along}}
    return single


def _scale_value(values: Mapping[str, Any], key: str, factor: float) -> dict[str, float]:
    return {key: factor * values[key]} if values.get(key) is not None else {}


def concentric_machine() -> Gearbox:
    """Return config/concentric.yaml.

    Returns
    -------
    Gearbox
        With errors of its own, bearing clearance, a tail torque and load-dependent meshes.
    """
    return load(CONCENTRIC, None)


def starter_machine() -> Gearbox:
    """Return a split machine of `facegear new`.

    Returns
    -------
    Gearbox
        Two inputs and three idlers.
    """
    wishes = MachineWishes(
        case="starter_split",
        pinion_teeth=38,
        face_gear_teeth=115,
        module_mm=2.5,
        pressure_angle_deg=22.5,
        torque_n_m=181.0,
        speed_rpm=6870.0,
        pinions=2,
        idlers=3,
        coarse=True,
    )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "starter_split.yaml"
        path.write_text(first_machine(wishes).text, encoding="utf-8")
        return load(path, None)


def tail_machine() -> Gearbox:
    """Return the example machine with a fifth of its power taken off by the tail pinion.

    Returns
    -------
    Gearbox
        With geometric meshes of constant stiffness.
    """
    return example().with_values({"transmission.torque.tail_share": 0.2})


MACHINES: dict[str, Callable[[], Gearbox]] = {
    "concentric": concentric_machine,
    "starter": starter_machine,
    "tail torque": tail_machine,
}
"""Machines of the table, by the name that stands there."""


def advice_table(rows: pd.DataFrame) -> str:
    """Return the table of the page on load sharing: the idlers, and the first input of each machine.

    Parameters
    ----------
    rows : pd.DataFrame
        The stored table.

    Returns
    -------
    str
        Markdown. Rows without any effect are left out.
    """
    first = rows[rows["kind"] == "inputs"].groupby("machine", sort=False)["group"].first()
    is_shown = (rows["kind"] == "idlers") | (rows["group"] == rows["machine"].map(first))
    shown_rows = rows[is_shown & (rows["gain"] != 0.0)]
    lines = [
        "| machine | group | change | K_gamma | closed form | map | config |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in shown_rows.itertuples():
        closed_text = "-" if pd.isna(row.predicted_gain) else f"{row.predicted_gain:+.3f}"
        lines.append(
            f"| {row.machine} | {row.group} | {row.change} ({row.from_to}) "
            f"| {row.k_gamma:.3f} | {closed_text} | {row.gain:+.5f} | {row.found_gain:+.5f} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Write the table."""
    tables = []
    for name, make in MACHINES.items():
        machine = make().with_values({"sharing_map": {"samples": SAMPLES}})
        tables.append(repeat_advice(machine).assign(machine=name))
    table = pd.concat(tables, ignore_index=True)
    table.insert(0, "machine", table.pop("machine"))
    table.round(7).to_csv(TABLE, index=False)


if __name__ == "__main__":
    main()
