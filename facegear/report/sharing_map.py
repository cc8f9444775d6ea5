"""Chapter on the load-sharing map: curves, the machine's place, and advice with its gain."""

from collections.abc import Mapping

import pandas as pd

from facegear.number_format import format_number
from facegear.report.table import Table

CLOSE = 1e-3
"""Relative difference between statics and closed form that counts as agreement."""
ALL_CARRY = 1.0 - 1e-9
"""Fraction of samples in which every path carries, from which the closed form may hold."""
POINTS = (
    "The machine on the map at each of its torques. number: k_e sigma / W of idlers, 2 b k / W of inputs; W: "
    "load of all meshes of the group; p50, p95, p99: percentiles over the drawn errors of the idlers. An "
    "input has one value"
)
"""Caption of the table of the machine's points."""
ADVICE = (
    "Each change of the machine by itself, at its nominal torque, and what it does to {group}: K_gamma is "
    "{now:.3f} before. found: by the statics of the changed machine; gain: what K_gamma falls by; predicted "
    "gain: by the closed forms alone{note}. worst, worst found: the largest of all groups before and after"
)
"""Caption of the first table of advice."""
MORE_ADVICE = "Changes and {group}: K_gamma is {now:.3f} before{note}"
"""Caption of the tables of advice below it."""
PERCENTILE_NOTE = ". Idlers are judged by the 95th percentile over their drawn errors"
"""Note on the percentile of idlers, behind a caption."""
CURVES = (
    "Curves of the idlers. all carry: fraction of the drawn machines in which every path carries, where the "
    "closed form may hold"
)
"""Caption of the table of the idlers' curves."""
INPUTS = "Curves of the inputs, for each stiffness of their bearings; closed: the loop formula"
"""Caption of the table of the inputs' curves."""
VISIBLE = 1e-3
"""Fall of K_gamma below which a change is not named: three digits stand in the text."""
BEST = 3
"""Changes that are named for the machine as a whole."""
MAIN_COLUMNS = ("change", "from_to", "found", "gain", "predicted_gain")
"""Columns of the advice that are not folded."""


def sharing_map_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """List the tables of the chapter.

    Parameters
    ----------
    tables : mapping of str to pd.DataFrame
        Tables of the case by name: sharing_map_advice, _points, _curves and _inputs.

    Returns
    -------
    list of Table
        Advice for each group, points and curves; empty without a map.
    """
    if "sharing_map_advice" not in tables:
        return []
    return [
        *advice_tables(tables["sharing_map_advice"]),
        Table(POINTS, tables["sharing_map_points"], 4),
        *(
            Table(caption, tables[name], 4, is_folded=True)
            for caption, name in ((CURVES, "sharing_map_curves"), (INPUTS, "sharing_map_inputs"))
            if len(tables[name])
        ),
    ]


def advice_tables(advice: pd.DataFrame) -> list[Table]:
    """List a table of each group, without the changes that do nothing to it.

    Parameters
    ----------
    advice : pd.DataFrame
        Table `advice` of stage sharing_map: a row for each change and group, with kind, k_gamma (before),
        found (after), gain (their difference) and MAIN_COLUMNS.

    Returns
    -------
    list of Table
        One for each group that a change affects; the first caption explains the columns.
    """
    group_tables: list[Table] = []
    for group, rows in advice[advice["gain"] != 0.0].groupby("group", sort=False):
        note = PERCENTILE_NOTE if rows["kind"].iloc[0] == "idlers" else ""
        words = MORE_ADVICE if group_tables else ADVICE
        caption = words.format(group=f"the {group}", now=rows["k_gamma"].iloc[0], note=note)
        group_tables.append(Table(caption, rows.reset_index(drop=True), 4, main=MAIN_COLUMNS))
    return group_tables


def sharing_map_text(tables: Mapping[str, pd.DataFrame]) -> str:
    """Say what to change, and whether the closed form holds.

    Parameters
    ----------
    tables : mapping of str to pd.DataFrame
        Tables of the case by name: sharing_map_advice, _curves and _reasons.

    Returns
    -------
    str
        Paragraphs; empty without a map.
    """
    if "sharing_map_advice" not in tables:
        return ""
    parts = [*advice_lines(tables["sharing_map_advice"])]
    if sentence := closed_form_line(tables["sharing_map_curves"], tables["sharing_map_reasons"]):
        parts.append(sentence)
    return "\n\n".join(parts)


def advice_lines(advice: pd.DataFrame) -> list[str]:
    """Say what helps the machine as a whole, then for each group what gains and what costs most.

    Parameters
    ----------
    advice : pd.DataFrame
        Table `advice` of stage sharing_map: group, kind, change, from_to, k_gamma, found, gain,
        predicted_gain, worst, worst_found.

    Returns
    -------
    list of str
        One line for the machine, then one a group.
    """
    lines = _whole_machine(advice)
    for group, rows in advice.groupby("group", sort=False):
        if (highest := rows["k_gamma"].iloc[0]) <= 1.0:
            lines.append(f"{_capital(group)}: below the even share, K_gamma {highest:.3f}.")
            continue
        best, worst = rows.loc[rows["gain"].idxmax()], rows.loc[rows["gain"].idxmin()]
        if best["gain"] <= 0.0:
            lines.append(f"{_capital(group)}: no change that was tried lowers K_gamma.")
            continue
        line = f"{_capital(group)}: {_change(best)}{_prediction(best)}."
        if worst["gain"] < 0.0:
            line += f" Do not {worst['change']}: {_from_to(worst)}."
        lines.append(line)
    return lines


def _whole_machine(advice: pd.DataFrame) -> list[str]:
    """Return one line on the largest K_gamma of all groups: its value, and the BEST changes that lower
    it by more than VISIBLE. Empty without advice. Columns worst and worst_found: largest factor before
    and after a change.
    """
    if advice.empty:
        return []
    changes = advice.drop_duplicates("change").sort_values("worst_found", kind="stable")
    helping = changes[changes["worst"] - changes["worst_found"] > VISIBLE].head(BEST)
    now = float(advice["worst"].iloc[0])
    if helping.empty:
        return [f"Largest K_gamma of all groups: {now:.3f}; no change that was tried lowers it."]
    words = "; ".join(
        f"{row['change']} ({row['from_to']}), {row['worst_found']:.3f}" for _, row in helping.iterrows()
    )
    return [f"Largest K_gamma of all groups: {now:.3f}. What lowers it most, each by itself: {words}."]


def closed_form_line(curves: pd.DataFrame, reasons: pd.DataFrame) -> str:
    """Say how far statics and the closed form of idlers agree, and why they do not.

    Parameters
    ----------
    curves, reasons : pd.DataFrame
        Tables of stage sharing_map: floating, all_carry, k_gamma_p95, closed_p95; and reason.

    Returns
    -------
    str
        A sentence or two; empty without idlers.
    """
    if curves.empty:
        return ""
    valid = curves[curves["all_carry"] >= ALL_CARRY]
    off = (valid["k_gamma_p95"] / valid["closed_p95"] - 1.0).abs()
    by_curve = off.groupby(valid["floating"], sort=False).max()
    differences = ", ".join(f"{name} {format_number(100.0 * part, 2)} %" for name, part in by_curve.items())
    text = (
        "Largest difference of P95 of the idlers from the closed form of equal paths, as long as every path "
        f"carries, by which gear floats: {differences}."
    )
    if (off > CLOSE).any() and len(reasons):
        text += f" The closed form is of equal paths between two gears; here {'; '.join(reasons['reason'])}."
    return text


def _change(row: pd.Series) -> str:
    """Return a change in words with its values, and the factor before and after it. `row`: row of table
    `advice`.
    """
    return f"{row['change']} ({row['from_to']}): {_from_to(row)}"


def _from_to(row: pd.Series) -> str:
    """Return `K_gamma from A to B`, before and after a change; of idlers it is the 95th percentile over
    drawn errors.
    """
    measure = "P95 of K_gamma" if row["kind"] == "idlers" else "K_gamma"
    return f"{measure} from {row['k_gamma']:.3f} to {row['found']:.3f}"


def _prediction(row: pd.Series) -> str:
    """Return the gain (fall of K_gamma) of a change and that of the closed form in words; empty if the
    closed form gives none. `row`: row of table `advice`.
    """
    if pd.isna(row["predicted_gain"]):
        return ""
    return f", a gain of {row['gain']:.3f} (closed form {row['predicted_gain']:.3f})"


def _capital(words: object) -> str:
    """Return words as text with a capital at the beginning."""
    text = str(words)
    return text[:1].upper() + text[1:]
