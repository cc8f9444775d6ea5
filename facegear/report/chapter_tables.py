"""Tables of single chapters of a report: rating, friction, jumps, bearing forces, errors."""

from collections.abc import Mapping

import pandas as pd

from facegear.report.case_texts import (
    DUTY_LOADS,
    EVERY_LOAD,
    JUMPS,
    NEAR_RESONANCE,
    OVER_SPEED,
    OVER_SPEED_SHOWN,
    RATING,
    REACTIONS,
    SAFETY,
    SAFETY_SHOWN,
)
from facegear.report.page import Chapter
from facegear.report.table import Table
from facegear.ties import first_largest_rows

BINS = {"0": "nominal", "-1": "all bins"}
"""Bins of a table of losses that are none of the duty cycle, in words."""


SOURCE = "allowed_contact_temperature_source"
"""Column of table `friction` whose text is the same at every torque."""


LOSSES = (
    "The machine at its nominal load and in every bin of its duty cycle. power through meshes: of all meshes "
    "together, over the power in"
)
"""Caption of the table of losses."""


def rating_and_safety_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the tables of the rating with loads of its bins.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name.

    Returns
    -------
    list of Table
        The tables in the order of the page.
    """
    safety_table = tables["safety"].dropna(axis="columns", how="all")
    report_tables = [
        Table(SAFETY, safety_table, main=SAFETY_SHOWN),
        Table(RATING, tables["rating"], is_folded=True),
    ]
    if "duty_loads" in tables:
        loads = tables["duty_loads"]
        hardest = first_largest_rows(loads, "largest_force_n", ["bin"], sort=True)
        report_tables += [Table(DUTY_LOADS, hardest), Table(EVERY_LOAD, loads, is_folded=True)]
    return report_tables


def friction_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the tables of friction and heat.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name.

    Returns
    -------
    list of Table
        The tables in the order of the page.
    """
    friction_table = tables["friction"].dropna(axis="columns", how="all")
    sources = friction_table.pop(SOURCE).dropna().unique() if SOURCE in friction_table else []
    title = ". Allowed contact temperature: ".join(["One mesh at the nominal speed, by torque", *sources])
    report_tables = [Table(title, friction_table)]
    if "machine_loss" in tables:
        whole, meshes = (
            bins_in_words(tables[name].dropna(axis="columns", how="all"))
            for name in ("machine_loss", "mesh_losses")
        )
        report_tables = [
            Table(LOSSES, whole),
            *report_tables,
            Table("Every loaded flank", meshes, is_folded=True),
            Table("Heat of every body", tables["body_heat"], is_folded=True),
        ]
    if "friction_studies" in tables:
        report_tables.append(Table("The studies' cases side by side", tables["friction_studies"]))
    limits = tables["limits"]
    return [
        *report_tables,
        Table(
            "Fraction of the loss that lies outside the limits of the friction model",
            limits,
            3,
            is_folded=True,
        ),
    ]


def bins_in_words(rows: pd.DataFrame) -> pd.DataFrame:
    """Return rows of losses with words for the nominal load and the whole duty cycle among the bins.

    Parameters
    ----------
    rows : DataFrame
        Table with the column `bin`: a bin of the duty cycle, 0 or -1.

    Returns
    -------
    DataFrame
        The table with text in this column.
    """
    return rows.assign(bin=rows["bin"].astype(int).astype(str).replace(BINS))


def stress_over_speed_tables(tables: Mapping[str, pd.DataFrame], speed_rpm: float) -> list[Table]:
    """Return the table of stress at the speed nearest to the nominal one, and where each motion
    is hardest.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name.
    speed_rpm : float
        Nominal speed, rpm.

    Returns
    -------
    list of Table
        The table, or none where the stress over speed is not known.
    """
    if "stress_over_speed" not in tables:
        return []
    table = tables["stress_over_speed"]
    nearest = table["speed_rpm"].iloc[(table["speed_rpm"] - speed_rpm).abs().argmin()]
    hardest = first_largest_rows(table, "largest_force_n", ["motion"])
    speed_rows = pd.concat([table[table["speed_rpm"] == nearest], hardest]).drop_duplicates()
    return [Table(OVER_SPEED, speed_rows, main=OVER_SPEED_SHOWN)]


def jump_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Jumps with the mode that moves most; a linear resonance beside it only where the jump is near it.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name.

    Returns
    -------
    list of Table
        The tables in the order of the page.
    """
    if "jumps" not in tables:
        return []
    jumps = tables["jumps"]
    linear = jumps["resonance_rpm"].astype(float)
    away = (jumps["speed_before_rpm"].astype(float) / linear - 1.0).abs()
    columns = ["direction", "kind", "speed_before_rpm", "error_rpm", "mesh", "class_before", "class_after"]
    jump_rows = jumps[columns].assign(
        moves_most=jumps["resonance"],
        energy_fraction=jumps["energy_fraction"],
        linear_resonance_rpm=linear.where(away <= NEAR_RESONANCE),
    )
    return [Table(JUMPS, jump_rows)]


def scorecard_chapter(frame: pd.DataFrame) -> Chapter:
    """Return the chapter on the paper's numbers beside ours.

    Parameters
    ----------
    frame : DataFrame
        Table `scorecard`: a row a number or statement of the paper.

    Returns
    -------
    Chapter
        The chapter.
    """
    text = (
        "Every number and statement of the paper beside ours; a row that differs says why. Numbers that the "
        "paper repeats and remarks on other studies are left out of the totals. Criteria, tolerances and "
        "what other sets of inputs give stand in scorecard.html."
    )
    counts = (
        frame.loc[frame["counted"], "verdict"]
        .value_counts(sort=False)
        .rename_axis("verdict")
        .reset_index(name="rows")
    )
    claims = frame[["where", "claim", "paper", "shown", "unit", "verdict", "reason"]]
    claims = claims.rename(columns={"shown": "ours"})
    return Chapter("Scorecard", text, (), [Table("Verdicts", counts), Table("Claims", claims)])


def bearing_reactions(bearings: pd.DataFrame) -> pd.DataFrame:
    """Return the forces on bearings with a row a bearing.

    Parameters
    ----------
    bearings : DataFrame
        Table `bearings` of stage dynamics_response: a row a body and direction, forces in N.

    Returns
    -------
    DataFrame
        Column `bearing`, and for each direction, the radial one first, the force at rest and the peak, N.
    """
    table = pd.DataFrame({"bearing": list(dict.fromkeys(bearings["body"]))})
    for direction in sorted(dict.fromkeys(bearings["direction"]), key=REACTIONS.index):
        forces = bearings[bearings["direction"] == direction].set_index("body").loc[table["bearing"]]
        for name in ("static", "peak"):
            table[f"{name}_{direction}_n"] = forces[f"{name}_n"].to_numpy()
    return table


def errors_chapter(tables: Mapping[str, pd.DataFrame]) -> Chapter:
    """Return the chapter on the numerical errors of the results.

    Its one table has a row for each of these that is there: the largest KKT residual and torque imbalance of
    the contacts, the stiffness that the truncated Fourier series leaves out, and the widest half-width of a
    load-sharing mean.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name; `ltca`, `harmonics` and `summary` are read, and may be missing.

    Returns
    -------
    Chapter
        The chapter, with an empty table if all three are missing.
    """
    rows = []
    if "ltca" in tables:
        rows.append(("largest KKT residual of all contacts, relative", tables["ltca"]["kkt_residual"].max()))
        rows.append(
            ("largest torque imbalance of all contacts, relative", tables["ltca"]["torque_residual"].max())
        )
    if "harmonics" in tables:
        last_order = tables["harmonics"].iloc[-1]
        left_out = 1e-6 * last_order["truncation_error_n_per_m"]
        rows.append(("stiffness left out by the truncated series (N/µm)", left_out))
    if "summary" in tables:
        rows.append(("widest 95 % half-width of a load-sharing mean", tables["summary"]["half_width"].max()))
    frame = pd.DataFrame(rows, columns=["quantity", "value"])
    return Chapter(
        "Numerical errors",
        "Estimates that the stages made of their own errors.",
        (),
        [Table("Estimates", frame, 3)],
    )
