"""First screen of a report: status line, key numbers, three pictures, verdicts and warnings."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import pandas as pd

from facegear.arrays import Arrays
from facegear.number_format import count_noun, format_number
from facegear.report.compact import Compact, error_picture, machine_picture, pattern_picture, sweep_picture
from facegear.report.data_sheet import machine_numbers
from facegear.report.verdicts import Verdict, flank_of, known_k_gamma, nearest_rating, status_line, verdicts
from facegear.report.warnings import grouped_warnings

MOST_KEYS = 8
"""Key numbers shown: two rows of four on 1280 px."""
IRREGULAR = "irregular"
"""Kind of the rows of table `jumps` at which irregular motion begins or ends."""


class Key(NamedTuple):
    """One key number: name, value with its unit, what belongs to it, definition, and whether it is red."""

    name: str
    value: str
    beside: str = ""
    definition: str = ""
    red: bool = False


@dataclass(frozen=True)
class FirstScreen:
    """Content of the first screen: all that a reader sees before the first chapter.

    Attributes
    ----------
    colour, status, sentence : str
        Colour of the worst verdict, first words, and the sentence after them.
    keys : sequence of Key
        Key numbers.
    pictures : sequence of Compact
        Drawings made for this place.
    verdicts : sequence of Verdict
        Judgements, red ones first.
    warnings : sequence of (str, list of str)
        Subject and lines.
    """

    colour: str
    status: str
    sentence: str
    keys: Sequence[Key]
    pictures: Sequence[Compact]
    verdicts: Sequence[Verdict]
    warnings: Sequence[tuple[str, list[str]]]


def first_screen(
    values: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    pair: Mapping[str, Any] | None,
    pressure: Arrays | None = None,
    notes: Sequence[str] = (),
) -> FirstScreen:
    """Collect the first screen of a case.

    Parameters
    ----------
    values : mapping
        Plain values of the config.
    tables : mapping of str to DataFrame
        Tables of the report by name.
    pair : mapping or None
        Record of the tooth geometry (`geometry/pair.json`), where it was computed.
    pressure : mapping or None
        Arrays of the contact analysis (PRESSURE_ARRAYS), where it was made.
    notes : sequence of str
        What a run says of its config when it starts, as `key: words`.

    Returns
    -------
    FirstScreen
        At most MOST_KEYS key numbers, three pictures, verdicts and warnings, as far as they are known.
    """
    judgements = verdicts(values, tables, pair)
    colour, status, sentence = status_line(judgements, found_in_words(tables))
    meshes = tables.get("meshes")
    torque = None if meshes is None else float(meshes["pinion_torque_n_m"].abs().max())
    sweep_drawing = sweep_picture(tables.get("sweep"), tables.get("jumps"), values["dynamics"]["speed_rpm"])
    pictures = [
        machine_picture(values, meshes),
        pattern_picture(pressure, torque),
        sweep_drawing or error_picture(tables.get("ltca")),
    ]
    return FirstScreen(
        colour,
        status,
        sentence,
        [*key_cards(values, tables, pair)][:MOST_KEYS],
        [picture for picture in pictures if picture is not None],
        judgements,
        grouped_warnings(values, tables, pair, notes),
    )


def found_in_words(tables: Mapping[str, pd.DataFrame]) -> str:
    """Return one sentence on load sharing and on contact at the nominal speed.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name; K_gamma of the inputs is that of `known_k_gamma`, lost contact is
        read from `summary`.

    Returns
    -------
    str
        The sentence; empty where neither is known.
    """
    clauses = []
    groups = known_k_gamma(tables)
    inputs = groups[groups["kind"] == "inputs"] if len(groups) else groups
    if len(inputs):
        clauses.append(f"the inputs share their torque with K_gamma {inputs['k_gamma'].max():.2f}")
    if "summary" in tables:
        nominal_groups = tables["summary"].loc[lambda table: table["study"] == "nominal"]
        lost_share = float(nominal_groups["lost_fraction"].max()) if len(nominal_groups) else 0.0
        share = f"{format_number(100 * lost_share, 2)} % of the time"
        clauses.append(
            f"a path is out of contact {share} at the nominal speed"
            if lost_share > 0.0
            else "every path keeps contact at the nominal speed"
        )
    text = ", and ".join(clauses)
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def key_cards(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None
) -> Iterator[Key]:
    """Yield the key numbers that are known, the most important ones first.

    Parameters
    ----------
    values : mapping
        Plain values of the config.
    tables : mapping of str to DataFrame
        Tables of the report by name.
    pair : mapping or None
        Record of the tooth geometry (`geometry/pair.json`), where it was computed.

    Yields
    ------
    Key
        One key number.
    """
    teeth = values["tooth_pair"]
    ratio = teeth["face_gear_teeth"] / teeth["pinion_teeth"]
    yield Key(
        "Teeth, module",
        f"{teeth['pinion_teeth']} / {teeth['face_gear_teeth']}",
        f"{teeth['module_mm']:g} mm, ratio {format_number(ratio, 4)}",
    )
    yield from _speed_and_torque(values)
    yield from _powers(tables)
    yield from _lowest_safety(tables)
    yield from _k_gamma(values, tables)
    yield from _first_resonance(values, tables)
    yield from _peak_force(values, tables)
    yield from _jumps(values, tables)
    if pair is not None:
        yield Key("Contact ratio", format_number(pair["contact_ratio"]), "unloaded")
        gap = pair["backlash_um"]["smallest"]
        yield Key("Backlash", f"{format_number(gap)} µm", "along the line of action")
    yield from _by_torque(tables)


def _speed_and_torque(values: Mapping[str, Any]) -> Iterator[Key]:
    """Yield the nominal pinion speed, rpm, with the torque of the inputs, N m (their number if torques
    differ); none without a transmission. A pinion's own torque_n_m goes before torque.per_input_n_m.
    """
    transmission = values["transmission"]
    if transmission is None:
        return
    given_torques = [
        pinion.get("torque_n_m") for pinion in transmission["pinions"] if pinion["role"] == "input"
    ]
    per_input = transmission["torque"]["per_input_n_m"]
    torques = [per_input if torque is None else torque for torque in given_torques]
    torque_texts = dict.fromkeys(format_number(torque, 4) for torque in torques)
    if len(torque_texts) == 1:
        times = f"{len(torques)} × " if len(torques) > 1 else ""
        beside = f"{times}{next(iter(torque_texts))} N m in"
    else:
        beside = f"{count_noun(len(torques), 'input')}"
    speed = format_number(values["dynamics"]["speed_rpm"], 4)
    yield Key("Pinion speed, torque", f"{speed} rpm", beside)


def _powers(tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield the power in and out, kW, of tables `ratings` and `bodies`; the latter less the friction
    loss at the nominal load (table `machine_loss`, bin 0) where that is known.
    """
    numbers = machine_numbers(tables)
    if "power_in_kw" not in numbers:
        return
    power, out = numbers["power_in_kw"], numbers["power_out_kw"]
    beside, definition = "without friction", "Friction was not asked for (section lubrication)."
    if "machine_loss" in tables:
        nominal = tables["machine_loss"].loc[lambda table: table["bin"] == 0, "loss_percent"]
        loss = float(nominal.iloc[0])
        out -= power * loss / 100.0
        beside = f"with friction, {format_number(100.0 * out / power, 4)} %"
        definition = f"Friction of the meshes takes {format_number(loss)} % of the power brought in."
    yield Key("Power in → out", f"{format_number(power, 4)} → {format_number(out, 4)} kW", beside, definition)


def _lowest_safety(tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield the smallest safety over required safety of table `rating`, with failure and flank; red
    below 1.
    """
    if "rating" not in tables or tables["rating"].empty:
        return
    row = nearest_rating(tables["rating"])
    yield Key(
        "Lowest safety",
        f"{row.safety:.2f} of {row.required:g}",
        f"{row.failure}, {flank_of(row)}",
        "Factor on all stresses at which Miner's sum is 1, of what is required, at the flank nearest to its "
        "limit.",
        row.safety < row.required,
    )


def _k_gamma(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield the largest load sharing factor K_gamma of each kind of group; red if any group exceeds
    `load_sharing.required_k_gamma`.
    """
    groups = known_k_gamma(tables)
    if groups.empty:
        return
    largest = groups.groupby("kind", sort=False)["k_gamma"].max()
    limit = values["load_sharing"]["required_k_gamma"]
    running = "k_v" in groups
    first = largest.index[0]
    other_kinds = [f"{kind} {factor:.2f}" for kind, factor in largest.items() if kind != first]
    yield Key(
        "Load sharing K_gamma",
        f"{largest.iloc[0]:.2f}",
        "; ".join([str(first), *other_kinds]),
        "Largest mean load of a mesh over its nominal even share, "
        f"{'running' if running else 'at rest'}, with all errors. Below 1, less load takes this path than an "
        "even split would send through it.",
        limit is not None and bool((groups["k_gamma"] > limit).any()),
    )


def _first_resonance(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield the lowest pinion speed in the sweep's range, rpm, at which the mesh frequency (teeth *
    speed / 60) is a natural frequency of table `frequencies`, with the mode; none if there is no such
    speed.
    """
    if "frequencies" not in tables:
        return
    sweep, teeth = values["dynamics"]["sweep"], values["tooth_pair"]["pinion_teeth"]
    modes = tables["frequencies"]
    speeds = 60.0 * modes["frequency_hz"] / teeth
    inside = speeds[(speeds >= sweep["from_rpm"]) & (speeds <= sweep["to_rpm"])]
    if inside.empty:
        return
    mode = modes.loc[inside.idxmin()]
    yield Key(
        "First resonance",
        f"{format_number(inside.min(), 4)} rpm",
        f"mode {int(mode['order'])}, {format_number(mode['frequency_hz'], 4)} Hz",
        f"Lowest pinion speed from {format_number(sweep['from_rpm'])} to {format_number(sweep['to_rpm'])} "
        "rpm at which the mesh frequency meets a natural frequency of the machine.",
    )


def _peak_force(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield the largest mesh force at the nominal speed, kN, with its mesh, from table
    `dynamic_stress`, else from `forces`; none without both.
    """
    for name in ("dynamic_stress", "forces"):
        table = tables.get(name, pd.DataFrame())
        column = next((force for force in ("largest_force_n", "largest_n") if force in table), None)
        if column is None or table.empty:
            continue
        row = table.loc[table[column].idxmax()]
        speed = format_number(values["dynamics"]["speed_rpm"], 4)
        force = f"{format_number(1e-3 * row[column])} kN"
        definition = f"Largest force along the line of action of any mesh at {speed} rpm."
        yield Key("Peak mesh force", force, str(row["mesh"]), definition)
        return


def _jumps(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield the speed after the jump of table `jumps` that is nearest to the nominal speed, with its
    distance in percent and the number of jumps, or that there is none. Irregular motion that begins or
    ends is no jump here.
    """
    if "jumps" not in tables:
        return
    jumps, speed = tables["jumps"], values["dynamics"]["speed_rpm"]
    jumps = jumps[jumps["kind"] != IRREGULAR] if "kind" in jumps else jumps
    definition = "Jumps of the sweep, speed rising and falling; the one nearest to the nominal speed."
    if jumps.empty:
        yield Key("Nearest jump", "none", "in the sweep", definition)
        return
    at = float(jumps.loc[(jumps["speed_after_rpm"] - speed).abs().idxmin(), "speed_after_rpm"])
    side = "above" if at >= speed else "below"
    beside = f"{abs(100.0 * (at / speed - 1.0)):.0f} % {side} nominal; {count_noun(len(jumps), 'jump')}"
    yield Key("Nearest jump", f"{format_number(at, 4)} rpm", beside, definition)


def _by_torque(tables: Mapping[str, pd.DataFrame]) -> Iterator[Key]:
    """Yield mean mesh stiffness (N/µm), peak-to-peak transmission error (µm) and pressure (MPa) at the
    largest torque of table `by_torque`.
    """
    if "by_torque" not in tables:
        return
    row = tables["by_torque"].iloc[tables["by_torque"]["torque_n_m"].argmax()]
    at = f"at {format_number(row['torque_n_m'], 4)} N m"
    if row["k_average_mean_n_per_m"] > 0.0:
        stiffness = format_number(1e-6 * row["k_average_mean_n_per_m"])
        yield Key(
            "Mean mesh stiffness", f"{stiffness} N/µm", at, "Mesh force over deflection, mean of a pitch."
        )
    error = format_number(row["ste_peak_to_peak_um"])
    yield Key("Transmission error", f"{error} µm", f"peak to peak {at}")
    if row.get("pressure_mpa", 0.0) > 0.0:
        yield Key("Flank pressure", f"{format_number(row['pressure_mpa'])} MPa", f"{at}, away from edges")
