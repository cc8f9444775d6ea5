"""Verdicts of a report: what was asked of the machine, whether it holds, why, and caveats of the method."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from facegear.number_format import begin_with_capital, count_noun, format_number
from facegear.report.data_sheet import ROUNDING_OF_POWER
from facegear.ties import first_largest_row

GREEN, RED, GREY = "green", "red", "grey"
"""Colours of verdicts: fulfilled, violated, unknown."""
NOT_COMPUTED = "Not computed."
"""Reason of a verdict that is not known."""
BEYOND = "beyond torques solved"
"""Remark on loads beyond the torques solved."""
MARKS = {"tip edges": "edge contact", "fillets": "fillet contact", "not compared": "not in ISO 6336"}
"""First words of a rating's caveat, and the mark that stands for it."""
UNRATED = "Not rated: edges carry all load, where pressure has no limit."
"""Reason of the verdict on a failure that no method could rate."""
RATED_FAILURES = {"bending": "Bending", "pitting": "Pitting"}
"""Rated failures in words."""
OIL = {"scuffing": "Scuffing", "micropitting": "Micropitting"}
"""Failures of lubrication in words."""
SAFE = 1.0
"""Smallest safety against scuffing and micropitting that is green: the limits hold a test's own margin."""


@dataclass(frozen=True)
class Verdict:
    """Judgement of one subject.

    Attributes
    ----------
    subject : str
        What is judged.
    colour : str
        `green`, `red` (below what is required) or `grey` (not asked for).
    reason : str
        The numbers that decide.
    caveats : tuple of str
        Short marks of what the method leaves out; they never change the colour.
    failure : str
        Of a red verdict, what fails as the end of a sentence; empty otherwise.
    """

    subject: str
    colour: str
    reason: str
    caveats: tuple[str, ...] = ()
    failure: str = ""


def verdicts(
    values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame], pair: Mapping[str, Any] | None
) -> list[Verdict]:
    """Judge a case by its config and its results.

    Parameters
    ----------
    values : mapping
        Plain values of the config by section; a section that was left out is None.
    tables : mapping of str to DataFrame
        Tables of the report by name.
    pair : mapping or None
        Record of the tooth geometry (`geometry/pair.json`), None where it was not computed.

    Returns
    -------
    list of Verdict
        Red ones first, grey ones last, each colour in the order of computation.
    """
    judgements = [
        *_teeth(pair),
        *(_rating_verdict(values, tables, failure) for failure in RATED_FAILURES),
        *(_oil_verdict(values, tables, failure) for failure in OIL),
    ]
    if values["transmission"] is not None:
        judgements += [_load_sharing(values, tables), *_power(tables), *_at_rest(tables)]
    judgements += _range_solved(tables)
    return sorted(judgements, key=lambda verdict: (RED, GREEN, GREY).index(verdict.colour))


def _teeth(pair: Mapping[str, Any] | None) -> Iterator[Verdict]:
    """Yield the verdict on interference of the unloaded teeth: red with the depth, else green with the
    smallest gap, µm. `pair`: record of the tooth geometry with keys `interference` and `smallest_gap`;
    None yields none.
    """
    if pair is None:
        return
    gap = pair["interference"] or pair["smallest_gap"]
    location = (
        f"gear's {gap['gear_part']} to pinion's {gap['pinion_part']}, radius {gap['gear_radius_mm']:.1f} mm"
    )
    if pair["interference"]:
        depth = f"{format_number(abs(gap['gap_um']))} µm"
        reason = f"The bodies interfere by {depth} ({location})."
        yield Verdict("Teeth", RED, reason, failure=f"the teeth interfere by {depth}")
    else:
        gap_um = format_number(gap["gap_um"])
        yield Verdict("Teeth", GREEN, f"No interference; smallest gap {gap_um} µm ({location}).")


def flank_of(row: Any) -> str:
    """Return body and flank of a row of a rating in words.

    Parameters
    ----------
    row : namedtuple or Series
        A row of table `rating`.

    Returns
    -------
    str
        Such as `right input, drive flank`.
    """
    return f"{str(row.body).replace('_', ' ')}, {row.flank} flank"


def nearest_rating(rating: pd.DataFrame) -> Any:
    """Return the row with the smallest ratio of safety to required safety.

    Parameters
    ----------
    rating : DataFrame
        Table `rating` of stage rating, not empty; columns safety and required are read.

    Returns
    -------
    Series
        The first of rows that are equally near.
    """
    spare = -rating["safety"] / rating["required"]
    return first_largest_row(rating.assign(spare=spare), "spare")


def _rating_verdict(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame], failure: str) -> Verdict:
    """Judge bending or pitting (`failure`, a key of RATED_FAILURES) from table `rating`: red if any
    safety is below the required one, else grey if a flank has no rating. The reason names the row of the
    smallest safety over required safety.
    """
    rating = tables.get("rating", pd.DataFrame(columns=["failure"]))
    rows = rating[rating["failure"] == failure]
    if rows.empty:
        if len(rating):
            return Verdict(RATED_FAILURES[failure], GREY, UNRATED)
        section = values["strength"]
        rated_teeth = None if section is None else section["pinion"]
        return _without_result({"strength": rated_teeth}, "strength", RATED_FAILURES[failure])
    row = nearest_rating(rows)
    colour = RED if (rows["safety"] < rows["required"]).any() else GREEN
    same_flank = rows[
        (rows["body"] == row.body) & (rows["flank"] == row.flank) & (rows["method"] != row.method)
    ]
    other_ways = "".join(f"; {way.safety:.2f} by {way.method}" for way in same_flank.itertuples())
    reason = f"{flank_of(row)}: "
    if colour == RED and row.reason.startswith("damage"):
        reason += f"{row.reason}; "
    reason += f"safety {row.safety:.2f} of {row.required:g} by {row.method}{other_ways}."
    flanks = rating[["body", "flank"]].drop_duplicates()
    unrated_count = len(flanks) - len(rows[["body", "flank"]].drop_duplicates())
    failing = rows.loc[rows["safety"] < rows["required"], ["body", "flank"]].drop_duplicates()
    if len(failing) > 1:
        reason += f" {len(failing)} of {count_noun(len(flanks), 'flank')} are below what is required."
    if unrated_count:
        colour = GREY if colour == GREEN else colour
        reason += f" {unrated_count} of {count_noun(len(flanks), 'flank')} are not rated."
    marks = [mark for words, mark in MARKS.items() if rows["caveat"].str.contains(words).any()]
    if not rows["within_torques_solved"].all():
        marks.append(BEYOND)
    return Verdict(
        RATED_FAILURES[failure], colour, begin_with_capital(reason), tuple(marks), _failure(row, colour)
    )


def _without_result(values: Mapping[str, Any], section: str, subject: str) -> Verdict:
    """Return the grey verdict of a subject without results: not asked for if `values`, those of the config,
    hold None for `section`, otherwise not computed.
    """
    reason = f"Not asked for (section {section})." if values[section] is None else NOT_COMPUTED
    return Verdict(subject, GREY, reason)


def _failure(row: Any, colour: str) -> str:
    """Return the end of the status line's sentence for a rating that fails; empty unless `colour` is
    RED.

    row: row of table `rating`. With a damage above 1 it tells the life in hours and the required one,
    which is damage * life; otherwise the safety and the required one.
    """
    if colour != RED:
        return ""
    body = str(row.body).replace("_", " ")
    if row.damage > 1.0 and row.life_hours > 0.0:
        hours = row.damage * row.life_hours
        lasts = f"{format_number(row.life_hours)} h of the required {format_number(hours)} h"
        return f"the {body} fails by {row.failure} after {lasts}"
    return f"safety of the {body} against {row.failure} is {row.safety:.2f} of {row.required:g}"


def _oil_verdict(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame], failure: str) -> Verdict:
    """Judge scuffing or micropitting (`failure`, a key of OIL) by the smallest safety in table
    `mesh_losses`, over all flanks and bins (bin 0: nominal load); red below SAFE. Grey without the
    table or the oil's data.
    """
    if "mesh_losses" not in tables:
        return _without_result(values, "lubrication", OIL[failure])
    losses, column = tables["mesh_losses"], f"{failure}_safety"
    if not losses[column].notna().any():
        missing_data = (
            "an FZG stage or a scuffing temperature" if failure == "scuffing" else "allowed_film_ratio"
        )
        return Verdict(OIL[failure], GREY, f"Not judged: the oil's card does not give {missing_data}.")
    row = first_largest_row(losses.assign(spare=-losses[column]), "spare")
    at = f"in bin {row['bin']} of the duty cycle" if row["bin"] > 0 else "at the nominal load"
    margin = f", {_margin(row['scuffing_margin_k'])}" if failure == "scuffing" else ""
    safety = f"{row[column]:.2f}"
    reason = f"{row['mesh']}, {row['flank']} flank, {at}: safety {safety} of {SAFE:g}{margin}."
    red = row[column] < SAFE
    marks = () if row["within_torques_solved"] else (BEYOND,)
    status = f"safety of {row['mesh']} against {failure} is {safety} of {SAFE:g}" if red else ""
    return Verdict(OIL[failure], RED if red else GREEN, begin_with_capital(reason), marks, status)


def _margin(kelvin: float) -> str:
    """Return the distance from a limit of temperature in words; `kelvin` (K) is positive below the limit."""
    return f"{format_number(abs(kelvin))} K {'below' if kelvin >= 0.0 else 'above'} the limit"


def _load_sharing(values: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Verdict:
    """Judge the largest load sharing factor K_gamma of all groups of pinions: green up to
    `load_sharing.required_k_gamma`, red above it, grey where either is unknown.
    """
    subject, limit = "Load sharing", values["load_sharing"]["required_k_gamma"]
    groups = known_k_gamma(tables)
    if groups.empty:
        return Verdict(subject, GREY, NOT_COMPUTED if limit else _why_no_k_gamma(values))
    worst = first_largest_row(groups, "k_gamma")
    cycles = f" over {count_noun(int(worst['mesh_cycles']), 'mesh cycle')}" if "mesh_cycles" in worst else ""
    state = "running" if "k_v" in worst else "at rest"
    k_gamma_text = f"K_gamma {worst['k_gamma']:.2f} ({worst['group']}, {state}{cycles})"
    if limit is None:
        return Verdict(subject, GREY, f"{k_gamma_text}; no limit was given (load_sharing.required_k_gamma).")
    if worst["k_gamma"] <= limit:
        return Verdict(subject, GREEN, f"{k_gamma_text}, {limit:g} allowed.")
    failure = f"K_gamma is {worst['k_gamma']:.2f} of {limit:g} allowed"
    return Verdict(subject, RED, f"{k_gamma_text}, {limit:g} allowed.", failure=failure)


def _why_no_k_gamma(values: Mapping[str, Any]) -> str:
    """Return a sentence why K_gamma is not computed: no two pinions have one role, or the lever arms
    are not geometric. `values`: plain values of the config.
    """
    machine = values["transmission"]
    roles = [] if machine is None else [pinion["role"] for pinion in machine["pinions"]]
    if len(roles) == len(set(roles)):
        return "No pinions share a load."
    if machine["mesh_kinematics"] != "geometric":
        return "K_gamma is not defined for lever arms as printed (transmission.mesh_kinematics)."
    return "K_gamma was not computed."


def known_k_gamma(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Return the groups of pinions with K_gamma (column k_gamma) of the running machine, else of that
    at rest.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name.

    Returns
    -------
    DataFrame
        Table `following_groups` if it holds any k_gamma; else rows of `hunting_groups` at its largest
        torque_n_m that have one; else empty.
    """
    for name in ("following_groups", "hunting_groups"):
        groups = tables.get(name, pd.DataFrame())
        if len(groups) and groups["k_gamma"].notna().any():
            if name == "following_groups":
                return groups
            return groups[groups["torque_n_m"] == groups["torque_n_m"].max()].dropna(subset="k_gamma")
    return pd.DataFrame()


def _power(tables: Mapping[str, pd.DataFrame]) -> Iterator[Verdict]:
    """Yield the verdict on the power balance of table `ratings` (columns quantity, value): red if
    `power_imbalance`, relative to the larger power, exceeds ROUNDING_OF_POWER. Yield nothing without
    the table.
    """
    if "ratings" not in tables:
        return
    numbers = dict(tables["ratings"].itertuples(index=False))
    imbalance, power = numbers["power_imbalance"], numbers["power_in_kw"]
    if abs(imbalance) > ROUNDING_OF_POWER:
        apart = f"{format_number(100 * abs(imbalance))} %"
        powers = f"{format_number(power, 4)} kW in, {format_number(numbers['power_out_kw'], 4)} kW out"
        reason = f"{powers}, {apart} apart: lever arms as printed are not those of the teeth."
        failure = f"power in and power out differ by {apart} of the larger"
        yield Verdict("Power balance", RED, reason, failure=failure)
        return
    text = f"{format_number(power, 4)} kW in equals out"
    if "machine_loss" in tables:
        nominal = tables["machine_loss"].loc[lambda table: table["bin"] == 0, "loss_percent"]
        text += f" plus {format_number(power * float(nominal.iloc[0]) / 100.0)} kW of friction"
    yield Verdict("Power balance", GREEN, f"{text}.")


def _at_rest(tables: Mapping[str, pd.DataFrame]) -> Iterator[Verdict]:
    """Yield the verdict on table `meshes`, the meshes at rest: red if the flank of any is `open`, else
    green with the smallest force, kN. Undecided contacts of table `contacts` are a caveat.
    """
    if "meshes" not in tables:
        return
    meshes = tables["meshes"]
    idle = meshes.loc[meshes["flank"] == "open", "mesh"].to_list()
    contacts = tables.get("contacts", pd.DataFrame(columns=["contact", "state"]))
    undecided_contacts = contacts.loc[contacts["state"] == "undecided", "contact"].to_list()
    if idle:
        failure = f"{count_noun(len(idle), 'mesh carries', 'meshes carry')} no load at rest"
        yield Verdict("Contact at rest", RED, f"No load at {', '.join(idle)}.", failure=failure)
    else:
        marks = (f"{count_noun(len(undecided_contacts), 'contact')} undecided",) if undecided_contacts else ()
        forces = meshes["force_n"].abs()
        smallest = f"{format_number(1e-3 * forces.min())} kN ({meshes['mesh'][forces.idxmin()]})"
        yield Verdict("Contact at rest", GREEN, f"Every mesh carries load; the smallest {smallest}.", marks)


def _range_solved(tables: Mapping[str, pd.DataFrame]) -> Iterator[Verdict]:
    """Yield the verdict on loads beyond the largest torque (N m) in table `by_torque`, for which
    contact was solved: red if a table of `loads_beyond` or a mesh at rest exceeds it. Yield nothing
    without the table.
    """
    if "by_torque" not in tables:
        return
    largest_solved = tables["by_torque"]["torque_n_m"].max()
    torque = f"{format_number(largest_solved, 4)} N m"
    beyond = list(loads_beyond(tables))
    if "meshes" in tables:
        largest = tables["meshes"]["pinion_torque_n_m"].abs().max()
        if largest > largest_solved * (1.0 + ROUNDING_OF_POWER):
            beyond.insert(0, f"a mesh at rest carries {format_number(largest, 4)} N m")
    if beyond:
        reason = (
            f"Contact was solved up to {torque}; {'; '.join(beyond)}. Add torques to contact.torques_n_m."
        )
        failure = f"loads exceed the {torque} for which contact was solved"
        yield Verdict("Range solved", RED, reason, failure=failure)
    else:
        yield Verdict("Range solved", GREEN, f"All loads lie within the {torque} solved.")


def loads_beyond(tables: Mapping[str, pd.DataFrame]) -> Iterator[str]:
    """Yield for each table with loads beyond the torques of the contact analysis how many there are.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name: column within_torques_solved of `rating`, `mesh_losses` and
        `stress_over_speed`.

    Yields
    ------
    str
        Such as `3 of 24 ratings exceed it`.
    """
    for name, singular, plural in (
        ("rating", "rating", "ratings"),
        ("mesh_losses", "loss of a flank", "losses of flanks"),
        ("stress_over_speed", "motion over speed", "motions over speed"),
    ):
        table = tables.get(name, pd.DataFrame())
        if len(table) and not table["within_torques_solved"].all():
            outside = int((~table["within_torques_solved"].astype(bool)).sum())
            exceed = "exceeds" if outside == 1 else "exceed"
            yield f"{outside:,} of {count_noun(len(table), singular, plural)} {exceed} it"


def status_line(judgements: Sequence[Verdict], summary: str) -> tuple[str, str, str]:
    """Return colour, first words and the rest of the sentence that a page begins with.

    Parameters
    ----------
    judgements : sequence of Verdict
        The verdicts.
    summary : str
        A sentence that is appended, empty for none.

    Returns
    -------
    tuple of str
        RED, GREEN or GREY (also if green verdicts stand beside ones not computed); a few words that end
        in a colon; the sentences that follow them.
    """
    red = [verdict for verdict in judgements if verdict.colour == RED]
    green = sum(verdict.colour == GREEN for verdict in judgements)
    tail = f" {summary}" if summary else ""
    if red:
        left = len(red) - 1
        other_red = f", and {count_noun(left, 'other verdict is', 'other verdicts are')} red" if left else ""
        return RED, "Not as required:", f"{red[0].failure}{other_red}.{tail}"
    absent = sum(verdict.reason == NOT_COMPUTED for verdict in judgements)
    if green:
        reason = f"{count_noun(green, 'verdict is', 'verdicts are')} green"
        if absent:
            return GREY, "As required so far:", f"{reason}, {absent} not computed.{tail}"
        return GREEN, "As required:", f"{reason}.{tail}"
    return GREY, "Not judged:", f"no limit was given.{tail}"
