"""Tables of single chapters of a report, and the texts above these and its other tables.

Functions make those of rating, friction, jumps, bearing forces and errors; of the widest tables the columns
that show at once are named here.
"""

from collections.abc import Mapping

import pandas as pd

from facegear.report.page import Chapter
from facegear.report.table import Table
from facegear.ties import first_largest_rows

BY_TORQUE = (
    "One row for each torque on the pinion, over a pitch. ste peak to peak: the largest transmission error "
    "less the smallest of the positions solved, which is never more than the true value; half: the same with "
    "every second position only. pressure: the largest away from edges, with the error that the mesh leaves. "
    "tip line load: the largest at a tip edge, where pressure has no limit; tip length: the greatest length "
    "of a tip edge that carries load. path radius: distance of the contact forces' centroid from the gear's "
    "axis"
)
"""Caption of the table of contact by torque."""
BEARINGS = (
    "Reactions of the bearing of every body at the nominal speed. static: at rest under the mean torques; "
    "peak: the largest magnitude in each direction. x of a pinion is tangential and y is along the gears' "
    "axis; the axis of a face gear is z"
)
"""Caption of the table of bearing forces."""
ROOT_STRESS = (
    "Largest and smallest stress of each fillet over a passage. loaded: the fillet below the flank that "
    "carries the load; radius: distance from the gear's axis, of a pinion the place along its own; tangent: "
    "angle between the fillet and the tooth's middle line"
)
"""Caption of the table of root stress."""
EVERY_FLANK = "Root stress of every flank that differs: drive and coast flanks of each gear"
"""Caption of the table of root stress by flank."""
SHAFT_TABLES = {
    "shafts_seats": "Stiffness of what each pinion sits on, without moments, and where it stands under the "
    "mean torques",
    "shafts_bearings": "Loads of the shafts on their bearings under the mean torques",
    "shafts_torsion": "Masses behind torsional springs: twist of the spring, of all before it as well "
    "(windup), and natural frequencies of the chain with its gear free",
}
"""Captions of the tables of shafts."""


STUDY_COLUMNS = [
    *("study", "label", "torque_n_m", "k_average_mean_n_per_m", "ste_peak_to_peak_um"),
    *("path_radius_mm", "path_shift_mm", "unloaded_path_shift_mm", "backlash_um"),
]
"""Columns of studied contact that the report shows."""
SAFETY = (
    "Safety and life of every flank under the duty cycle. drive: the flank with which a pinion drives. "
    "Safety is the factor on all stresses at which Miner's sum is 1. Bending is judged by the root stress of "
    "the finite elements, and for pinions after ISO 6336-3 (standard) as well; no standard exists for face "
    "gears, which are judged by the same limits. Pitting is judged by the pressure of the contact analysis "
    "away from edges, and after ISO 6336-2 (standard) with the gear's flank as that of a rack. edge: "
    "what tip "
    "edges carry under the largest torque, where pressure has no limit. life: the shortest of all; inf: no "
    "load does damage. reliability: at the end of the duty cycle, where the material card gives a Weibull "
    "shape and a load does damage. green: as safe as required; red: less safe, for the reason given; "
    "undecided: no method could rate it. caveat: "
    "what the method does not know; it never changes the colour"
)
"""Caption of the table of safety."""
RATING = "Every kind of failure with its limits; the stress is that of the hardest load"
"""Caption of the table of ratings."""
DUTY_LOADS = (
    "Loads of the running machine in every bin of the duty cycle: the flank with the largest force. "
    "mesh load factor (K_gamma): the largest mean of a mesh cycle over the mesh's nominal even "
    "share; dynamic "
    "factor (K_v): the largest force over that mean; followed: computed through the hunting cycle while "
    "runouts turn"
)
"""Caption of the table of loads in the bins of the duty cycle."""


EVERY_LOAD = "Loads of every flank in every bin"
"""Caption of the table of loads of every flank."""
DYNAMIC = (
    "Largest root stress of every mesh at the nominal speed. mean: with the mean force of the mesh; running: "
    "the largest of the history, in which every tooth carries its share of the force of that moment; bound: "
    "with the largest force throughout the passage. Pressure is that away from edges. Beyond the torques of "
    "the contact analysis (contact.torques_n_m) stress is taken in proportion"
)
"""Caption of the table of root stress in motion."""
OVER_SPEED = (
    "Hardest loads over the speed range: at the nominal speed, and the worst of each motion. dynamic factor: "
    "the largest mesh force over the largest at rest; stress and pressure are those with that force "
    "throughout "
    "the passage; worst: whether the motion is the hardest of all that are known at that speed"
)
"""Caption of the table of stress over speed."""
MODE_CONTACTS = (
    "Contacts that are closed in the modes, because the mean torques press them together, with the mesh "
    "stiffness used. local: the slope dF / d deflection, which small vibrations feel; average: F / "
    "deflection; "
    "given: a number of the config. An undecided contact carries too little load to tell it from "
    "rounding, and "
    "counts as open"
)
"""Caption of the table of contacts in the modes."""
NEAR_RESONANCE = 0.3
"""Largest relative distance of a jump from the linear resonance that it may belong to."""
JUMPS = (
    "Abrupt changes of the motion. kind: a jump from one periodic motion, which ends or loses its "
    "stability, to another; a step of the sweep that left a stable motion because it was too large; or "
    "irregular motion that begins or ends. error: how far the speed may lie from that of the change. "
    "moves most: the linear mode with the largest fraction of the energy just "
    "beside the "
    "jump, and the multiple of the mesh frequency at which it moves most. linear resonance: the "
    "speed at which "
    "that multiple meets the mode's frequency; blank where the jump is more than "
    f"{100 * NEAR_RESONANCE:.0f} % away from it, and so belongs to no linear resonance of that mode"
)
"""Caption of the table of jumps."""
SAFETY_SHOWN = (
    *("body", "flank", "verdict", "bending_safety", "standard_bending_safety"),
    *("pitting_safety", "life_hours", "reason"),
)
"""Columns of safety that are not folded."""
DYNAMIC_SHOWN = (
    *("mesh", "mean_force_n", "largest_force_n", "dynamic_factor"),
    *("pinion_running_mpa", "face_gear_running_mpa", "pressure_bound_mpa", "within_torques_solved"),
)
"""Columns of root stress in motion that are not folded."""
FOLLOWING_SHOWN = (
    *("group", "speed_rpm", "torque_n_m", "mesh_cycles", "mean", "k_gamma", "k_v", "k_gamma_static"),
)
"""Columns of the running machine that are not folded."""
BY_TORQUE_SHOWN = (
    *("torque_n_m", "k_average_mean_n_per_m", "k_local_mean_n_per_m", "ste_peak_to_peak_um"),
    *("pressure_mpa", "pressure_error_mpa", "tip_line_load_n_per_mm", "fillet_share"),
)
"""Columns of contact by torque that are not folded."""
OVER_SPEED_SHOWN = (
    *("motion", "speed_rpm", "mesh", "largest_force_n", "dynamic_factor"),
    *("pinion_mpa", "face_gear_mpa", "pressure_mpa"),
)
"""Columns of the widest tables that are shown at once."""
REACTIONS = ("radial", "x", "y", "z")
"""Directions of a bearing's reactions, in the order of columns."""
DRAWINGS = ("layout", "machine", "tooth_pair")
"""Figures that show the machine; the first that exists stands in the chapter on the machine."""
LONG_TABLE = 40
"""Rows of natural frequencies above which their table is folded."""

BINS = {"0": "nominal", "-1": "all bins"}
"""Bins of a table of losses that are none of the duty cycle, in words."""


SOURCE = "allowed_contact_temperature_source"
"""Column of table `friction` whose text is the same at every torque."""


LOSSES = (
    "The machine at its nominal load and in every bin of its duty cycle. power through meshes: of all meshes "
    "together, over the power in"
)
"""Caption of the table of losses."""


def root_stress_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the tables of root stress: of the upper gear's drive flank, and of all flanks where they differ.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name: `root_stress`, and `root_stress_by_flank` if it is there.

    Returns
    -------
    list of Table
        One table, or two where teeth or errors of assembly make flanks differ; the second one is folded.
    """
    report_tables = [Table(ROOT_STRESS, tables["root_stress"])]
    by_flank = tables.get("root_stress_by_flank", pd.DataFrame())
    columns = [name for name in by_flank if name not in ("gear", "flank")]
    different = by_flank.drop_duplicates(columns)
    if len(different) > len(tables["root_stress"]):
        report_tables.append(Table(EVERY_FLANK, different, is_folded=True))
    return report_tables


def rating_and_safety_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the tables of the rating with loads of its bins.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name; `safety` and `rating` are read, and `duty_loads` if it is there.

    Returns
    -------
    list of Table
        Safety, ratings, and for each bin the load of the largest force and all loads.
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
        Tables of the case by name: `friction` and `limits`; if there, `machine_loss` with `mesh_losses`
        and `body_heat`, and `friction_studies`.

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
        Table with the column `bin`: a bin of the duty cycle from 1, 0 (nominal load) or -1 (all bins).

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
        Tables of the case by name; of `stress_over_speed` the columns speed_rpm, motion and
        largest_force_n are read.
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
    """Return the table of jumps, each with the mode that moves most, and the linear resonance if it is
    near.

    Near: the speed before the jump is within NEAR_RESONANCE of `resonance_rpm`, relative to that.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name; `jumps` of stage dynamics_sweep is read.

    Returns
    -------
    list of Table
        One table; none without `jumps`.
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
        Table `scorecard`: a row a number or statement of the paper, with counted, where, claim, paper,
        shown, unit, verdict and reason.

    Returns
    -------
    Chapter
        The number of counted rows by verdict, and all rows.
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
        Table `bearings` of stage dynamics_response: body, direction (REACTIONS), static_n, peak_n.

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


CASING_TABLES = {
    "casing_load_sharing": "Forces of the meshes under the mean torques, on the casing and on fixed seats",
    "casing_seat_motions": "Motions of the seats under the mean torques, along and about the casing's axes",
    "casing_feet": "What the casing presses on its feet, in sum and beside what is applied; on ground: "
    "bearings without a seat",
    "casing_machine_modes": "Modes of the machine on its casing, by the part of their kinetic energy in the "
    "casing",
}
"""Captions of the tables of the casing."""


def casing_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return the tables of the machine on its casing.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the case by name; those of CASING_TABLES and `casing_sensors` are read, and may be missing.

    Returns
    -------
    list of Table
        The tables, and the largest acceleration of every sensor by orders of the mesh.
    """
    report_tables = [
        Table(words, tables[name], is_folded=len(tables[name]) > LONG_TABLE)
        for name, words in CASING_TABLES.items()
        if name in tables
    ]
    if "casing_sensors" in tables:
        loudest = first_largest_rows(tables["casing_sensors"], "acceleration_m_per_s2", ["sensor", "order"])
        columns = ["sensor", "order", "acceleration_m_per_s2", "speed_rpm", "frequency_hz"]
        words = "Largest acceleration of every sensor by orders of the mesh"
        report_tables.append(Table(words, loudest[columns], is_folded=len(loudest) > LONG_TABLE))
    return report_tables


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
