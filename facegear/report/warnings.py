"""Limits of the numbers of a report: notes by subject, most serious first."""

from collections.abc import Iterator, Mapping, Sequence
from math import nan
from typing import Any, NamedTuple

import pandas as pd

from facegear.contact.hertz import DENTED
from facegear.contact.pattern import FILLET_CONTACT
from facegear.number_format import count_noun, format_number
from facegear.report.data_sheet import nominal
from facegear.teeth.design import BACKLASH_DIFFERS_UM

POSITIONS_MATTER = 0.05
"""Relative change of a peak-to-peak value with half of the positions that is worth a warning."""
MOST_NAMED = 3
"""Meshes that a line names; of more it says how many."""
WRONG, WITHIN_LIMITS, GIVEN_INPUT = 0, 1, 2
"""Severity of a warning: numbers do not hold; they hold within limits; an input was given or chosen."""
SECTIONS = {
    "tooth_pair": "Teeth",
    "mesh": "Contact",
    "contact": "Contact",
    "mesh_stiffness": "Stiffness",
    "strength": "Strength",
    "lubrication": "Friction",
    "dynamics": "Motion",
    "load_sharing": "Load sharing",
    "tolerances": "Tolerances",
}
"""Subject of a note about a section of the config; any other section is about the machine."""


class ResultWarning(NamedTuple):
    """A note on the numbers of a report.

    Attributes
    ----------
    subject : str
        Subject under which the report lists the note, such as `Contact`.
    weight : int
        Severity: WRONG, WITHIN_LIMITS or GIVEN_INPUT.
    words : str
        The note, one line.
    """

    subject: str
    weight: int
    words: str


def grouped_warnings(
    values: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    pair: Mapping[str, Any] | None,
    notes: Sequence[str] = (),
) -> list[tuple[str, list[str]]]:
    """Collect the warnings of a case by subject.

    Parameters
    ----------
    values : mapping
        Plain values of the config.
    tables : mapping of str to DataFrame
        Tables of the report by name.
    pair : mapping or None
        Record of the tooth geometry (`geometry/pair.json`), where it was computed.
    notes : sequence of str
        What a run says of its config when it starts, as `key: words`.

    Returns
    -------
    list of (str, list of str)
        Subject and its lines, the subject with the most serious warning first, lines likewise.
    """
    by_weight = [*warnings(values, tables, pair), *map(_of_note, notes)]
    by_weight = sorted(by_weight, key=lambda warning: warning.weight)
    subjects = dict.fromkeys(warning.subject for warning in by_weight)
    return [
        (
            subject,
            [warning.words for warning in by_weight if warning.subject == subject],
        )
        for subject in subjects
    ]


def _of_note(note: str) -> ResultWarning:
    """Return the warning of a note `key: words` on the config. The first part of `key` is the section,
    which chooses the subject (SECTIONS); a key that is a section alone is left out of the text.
    """
    key, _, words = note.partition(": ")
    section = key.split(".")[0].split(" ")[0]
    if key == section:
        # The subject already says what a section without a key says.
        note = words[:1].upper() + words[1:]
    return ResultWarning(SECTIONS.get(section, "Machine"), GIVEN_INPUT, _line(note))


def _line(words: str) -> str:
    """Return a text with a full stop at its end, unless it ends in one or in an exclamation mark."""
    return words if words.endswith((".", "!")) else f"{words}."


def warnings(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None
) -> Iterator[ResultWarning]:
    """Yield the notes on a report's numbers, from the config and the results, in the order of computation.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config.
    tables : Mapping[str, pd.DataFrame]
        Tables of the report by name.
    pair : Mapping[str, Any] | None
        Record of the tooth geometry (`geometry/pair.json`), None where it was not computed.

    Yields
    ------
    ResultWarning
        A note.
    """
    if pair is not None and pair["interference"]:
        yield ResultWarning(
            "Teeth",
            WRONG,
            "The bodies interfere. Loaded contact counts the load in the fillets, but gives no pressure "
            "there and no mean stiffness; everything without contact leaves the interference out.",
        )
    yield from _contact_warnings(values, tables)
    yield from _friction_warnings(tables)
    transmission = values["transmission"]
    if transmission is None:
        return
    if pair is not None:
        config_backlash, teeth = transmission["backlash_um"], pair["backlash_um"]["smallest"]
        if config_backlash is not None and abs(config_backlash - teeth) > BACKLASH_DIFFERS_UM:
            dynamics_value = f"The dynamics take a backlash of {config_backlash:g} µm"
            yield ResultWarning(
                "Motion", WITHIN_LIMITS, f"{dynamics_value}; the teeth as assembled have {teeth:.1f} µm."
            )
    yield from _undecided_warnings(tables)
    yield from _casing_warnings(tables)
    yield from _sweep_warnings(tables)
    for row in nominal(tables).itertuples():
        if row.lost_fraction > 0.0:
            share = f"{100 * row.lost_fraction:.0f} % of the time"
            yield ResultWarning(
                "Load sharing", WITHIN_LIMITS, f"{row.group}: a path is out of contact {share}."
            )
        if not str(row.motion).startswith("period-"):
            words = f"{row.group}: the motion is {row.motion}, so numbers are averages."
            yield ResultWarning("Load sharing", WITHIN_LIMITS, words)


def _friction_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[ResultWarning]:
    """Yield a warning for each limit of a friction model beyond which some loss lies, from table
    `limits`: the largest percentage of the loss that lies outside, and its torque, N m.
    """
    limits = tables.get("limits", pd.DataFrame())
    if limits.empty:
        return
    outside = limits[limits["loss_outside_percent"] > 0.0]
    for (model, limit), rows in outside.groupby(["friction_model", "limit"], sort=False):
        worst = rows.loc[rows["loss_outside_percent"].idxmax()]
        share = (
            f"{format_number(worst['loss_outside_percent'], 2)} % of the loss at {worst['torque_n_m']:g} N m"
        )
        torques_left = len(rows) - 1
        elsewhere = f", and less at {count_noun(torques_left, 'other torque')}," if torques_left else ""
        words = f"{share}{elsewhere} lies outside the limits of {model}: {limit}."
        yield ResultWarning("Friction", WITHIN_LIMITS, words)


def _undecided_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[ResultWarning]:
    """Yield one warning that names the contacts of table `contacts` with state `undecided`: their load
    is too small to tell from rounding, and the modes take them as open.
    """
    contacts = tables.get("contacts", pd.DataFrame(columns=["contact", "state"]))
    names = contacts.loc[contacts["state"] == "undecided", "contact"]
    if len(names):
        words = f"Too little load to tell from rounding, taken as open: {', '.join(names)}."
        yield ResultWarning("Modes", WITHIN_LIMITS, words)


def _casing_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[ResultWarning]:
    """Yield warnings of modes and of vibration above half of the highest mode of the casing with seats and
    feet held, from tables `casing_modes`, `casing_machine_modes` and `casing_sensors`.
    """
    if "casing_modes" not in tables:
        return
    own_modes = tables["casing_modes"]
    highest = own_modes.loc[own_modes["held"] == "feet and seats", "frequency_hz"].max()
    reason = f"half of the highest mode kept with seats and feet held, {highest:.0f} Hz"
    for name, rows in (("casing_machine_modes", "modes of the machine"), ("casing_sensors", "sensor values")):
        if name not in tables:
            continue
        is_valid = tables[name]["is_valid"].astype(bool)
        if not is_valid.all():
            words = f"{(~is_valid).sum()} of {len(is_valid)} {rows} lie above {reason}"
            yield ResultWarning("Casing", WITHIN_LIMITS, f"{words}: raise transmission.casing.modes.")


def _sweep_warnings(tables: Mapping[str, pd.DataFrame]) -> Iterator[ResultWarning]:
    """Yield warnings from table `sweep`: the number of speeds without periodic motion, meshes open at
    every speed, and the largest fraction of time for which other meshes are open.
    """
    if "sweep" not in tables:
        return
    sweep = tables["sweep"]
    motions = sweep.drop_duplicates(["direction", "speed_rpm"])
    irregular = ~motions["periodic"].astype(bool)
    if irregular.any():
        share = f"{irregular.sum()} of {count_noun(len(motions), 'speed')} (up and down sweeps together)"
        words = f"Motion is not periodic at {share}. Values there are time averages."
        yield ResultWarning("Motion", WITHIN_LIMITS, words)
    gaps = sweep[sweep["quantity"] == "open_fraction"].groupby("body_or_mesh", sort=False)["value"]
    min_open, max_open = gaps.min(), gaps.max()
    if (always := min_open.index[min_open >= 1.0]).size:
        yield ResultWarning("Motion", WRONG, f"Open at every speed: {_mesh_list(always, len(min_open))}.")
    open_meshes = max_open.index[(max_open > 0.0) & (min_open < 1.0)]
    if open_meshes.size:
        time = f"up to {format_number(100 * max_open[open_meshes].max(), 2)} % of the time"
        yield ResultWarning(
            "Motion",
            WITHIN_LIMITS,
            f"Contact is lost at some speeds, {time}: {_mesh_list(open_meshes, len(min_open))}.",
        )


def _mesh_list(meshes: Sequence[str], of: int) -> str:
    """Return names of meshes joined by commas, or a count if there are more than MOST_NAMED.

    of: number of all meshes.
    """
    if len(meshes) <= MOST_NAMED:
        return ", ".join(meshes)
    return f"all {of} meshes" if len(meshes) == of else f"{len(meshes)} of {of} meshes"


def _contact_warnings(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]
) -> Iterator[ResultWarning]:
    """Yield warnings of the contact analysis, at most one of each kind: scaled stiffness, edge contact,
    tips in fillets, pressure above DENTED, too few positions. Tables `ltca` and `by_torque` are read.
    """
    if values["mesh_stiffness"]["source"] == "fem_scaled":
        words = "Only its shape is computed; its mean is given (mesh_stiffness.mean_n_per_m)."
        yield ResultWarning("Stiffness", GIVEN_INPUT, words)
    if "ltca" in tables:
        columns = ["tip_line_load_n_per_mm", "tip_length_mm"]
        tips = tables["ltca"].groupby("torque_n_m")[columns].max()
        edges = tips[tips["tip_length_mm"] > 0.0]
        if len(edges):
            load, length = edges.max()
            yield ResultWarning(
                "Contact",
                WITHIN_LIMITS,
                f"Edge contact: from {edges.index[0]:g} N m on tip edges carry up to {load:.0f} N/mm over "
                f"{length:.1f} mm, where pressure has no limit. Tip relief or a chamfer takes the load off "
                "the pinion's tip, root relief off the gear's.",
            )
    if "by_torque" not in tables:
        return
    by_torque = tables["by_torque"]
    fillets = by_torque[by_torque["fillet_share"] >= FILLET_CONTACT]
    if len(fillets):
        yield ResultWarning(
            "Contact",
            WITHIN_LIMITS,
            f"Tips press into fillets {_torques(fillets, by_torque)} and carry up to "
            f"{100 * fillets['fillet_share'].max():.2g} % of the torque there, which is kept out of pressure "
            "and root stress.",
        )
    pressure = by_torque.get("pressure_mpa", pd.Series(nan, by_torque.index))
    dented = by_torque[1e6 * pressure > DENTED]
    if len(dented):
        yield ResultWarning(
            "Contact",
            WRONG,
            f"Pressure {_torques(dented, by_torque)} is up to {format_number(dented['pressure_mpa'].max())} "
            f"MPa: from {format_number(1e-6 * DENTED)} MPa on even hardened steel yields (ISO 76), and "
            "elastic contact does not hold.",
        )
    change = 1.0 - by_torque["ste_peak_to_peak_half_um"] / by_torque["ste_peak_to_peak_um"]
    coarse = by_torque[change > POSITIONS_MATTER]
    if len(coarse):
        row = coarse.loc[change[coarse.index].idxmax()]
        yield ResultWarning(
            "Contact",
            WITHIN_LIMITS,
            f"Transmission error {_torques(coarse, by_torque)} changes with the number of positions: at "
            f"{row['torque_n_m']:g} N m {row['ste_peak_to_peak_um']:.2f} µm peak to peak, "
            f"{row['ste_peak_to_peak_half_um']:.2f} µm with half of them (contact.positions_per_pitch).",
        )


def _torques(rows: pd.DataFrame, every: pd.DataFrame) -> str:
    """Return at which torques `rows` of a table stand, such as `at 20 N m`, `at every torque`, `from 20
    N m on`.

    every: the whole table, in rising order of column torque_n_m.
    """
    torques = rows["torque_n_m"]
    if len(rows) == 1:
        return f"at {torques.iloc[0]:g} N m"
    if len(rows) == len(every):
        return "at every torque"
    if torques.to_list() == every["torque_n_m"].to_list()[-len(rows) :]:
        return f"from {torques.iloc[0]:g} N m on"
    return (
        f"at {len(rows)} of {count_noun(len(every), 'torque')}, {torques.min():g} to {torques.max():g} N m,"
    )
