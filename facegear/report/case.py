"""Report of a case, from the machine as configured to the record of each file."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.number_format import count_noun
from facegear.report.case_texts import (
    BEARINGS,
    BY_TORQUE,
    BY_TORQUE_SHOWN,
    DRAWINGS,
    DUTY_LOADS,
    DYNAMIC,
    DYNAMIC_SHOWN,
    EVERY_LOAD,
    FOLLOWING_SHOWN,
    JUMPS,
    LONG_TABLE,
    MODE_CONTACTS,
    NEAR_RESONANCE,
    OVER_SPEED,
    OVER_SPEED_SHOWN,
    RATING,
    REACTIONS,
    ROOT_STRESS,
    SAFETY,
    SAFETY_SHOWN,
    SHAFT_TABLES,
    STUDY_COLUMNS,
)
from facegear.report.contents import (
    CHAPTERS,
    FRICTION,
    POSES,
    SHAFTS,
    SHARING,
    SHARING_MAP,
    STUDIED_CONTACT,
    caption_of,
)
from facegear.report.first_screen import first_screen
from facegear.report.machine import Base, inputs_caption, machine_chapter
from facegear.report.page import Chapter, Picture, View, render
from facegear.report.poses import pose_tables, pose_text
from facegear.report.sharing_map import sharing_map_tables, sharing_map_text
from facegear.report.table import Table
from facegear.ties import first_largest_rows

FOLLOWING_TITLE = (
    "The running machine, followed while its runouts turn, beside the machine at rest. k_gamma: the largest "
    "mean of a mesh cycle over the nominal even share, running; k_v: the largest load over that "
    "mean; static: "
    "at rest over the same mesh cycles; static whole: at rest over the whole hunting cycle; cut: the "
    "change of "
    "the static factor from leaving out the other cycles; sampling: the change of the running "
    "k_gamma k_v with "
    "half of the samples; memory: difference between two starts after the lead, over the largest force"
)


BINS = {"0": "nominal", "-1": "all bins"}
"""Bins of a table of losses that are none of the duty cycle, in words."""
SOURCE = "allowed_contact_temperature_source"
"""Column of table `friction` whose text is the same at every torque."""
LOSSES = (
    "The machine at its nominal load and in every bin of its duty cycle. power through meshes: of all meshes "
    "together, over the power in"
)


def case_report(
    values: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    pictures: Mapping[str, Path],
    manifests: Sequence[Mapping[str, Any]],
    pair: Mapping[str, Any] | None = None,
    view: View | None = None,
    bodies: View | None = None,
    base: Base | None = None,
    notes: Sequence[str] = (),
    pressure: Arrays | None = None,
) -> str:
    """Return the page of a case; chapters without a picture or table are left out.

    Parameters
    ----------
    values : mapping
        Plain values of the case's config.
    tables : mapping of str to DataFrame
        Tables by the name of their file without its ending.
    pictures : mapping of str to Path
        Stored figures (svg) by name.
    manifests : sequence of mappings
        Manifests of all rules.
    pair : mapping or None
        Record of the tooth geometry, if it was computed.
    view : View or None
        The pair in mesh, if it was computed.
    bodies : View or None
        Modes of face gears that bend, if they were computed.
    base : Base or None
        Config file that the case's own extends.
    notes : sequence of str
        Remarks on the config that a run prints when it starts.
    pressure : mapping of (...) arrays or None
        Arrays `pressure` of stage contact, SI units.

    Returns
    -------
    str
        The page, as HTML.
    """
    tables = {name: table.reset_index(drop=True) for name, table in tables.items()}  # parts keep their rows
    listed_names = {name for _, _, names in CHAPTERS for name in names}
    other_names = [name for name in pictures if name not in listed_names and name not in DRAWINGS]
    contact_names = [name for name in other_names if name.startswith("contact_")]
    added_pictures = {
        STUDIED_CONTACT: contact_names,
        SHARING: [name for name in other_names if name not in contact_names],
    }
    drawing = next((name for name in DRAWINGS if name in pictures), None)
    chapter_drawings = () if drawing is None else (Picture(pictures[drawing], caption_of(drawing, values)),)
    chapters = [machine_chapter(values, tables, pair, chapter_drawings, base)]
    for title, text, names in CHAPTERS:
        picture_names = [*names, *added_pictures.get(title, ())]
        shown_pictures = [
            Picture(pictures[name], caption_of(name, values))
            for name in picture_names
            if name in pictures and name not in (drawing, "machine")
        ]
        chapter_tables = _tables(
            title, with_study_titles(tables, values["studies"]), values["dynamics"]["speed_rpm"]
        )
        chapter_view = {"Loaded contact": view, "Modes": bodies}.get(title)
        chapter_text = pose_text(tables) if title == POSES else ""
        if title == SHARING_MAP:
            chapter_text = sharing_map_text(tables)
        if title == SHARING and values["transmission"] is not None:
            published = any(study["figures"] is not None for study in values["studies"])
            chapter_text = f"{inputs_caption(values, published)}."
        if shown_pictures or chapter_tables or chapter_view:
            chapters.append(
                Chapter(title, f"{text}\n\n{chapter_text}", shown_pictures, chapter_tables, chapter_view)
            )
    if "scorecard" in tables:
        chapters.append(_scorecard(tables["scorecard"]))
    chapters.append(_errors(tables))
    chapters.append(_provenance(manifests))
    first = first_screen(values, tables, pair, pressure, notes)
    return render(str(values["case"]), lead(values, manifests), chapters, first)


def lead(values: Mapping[str, Any], manifests: Sequence[Mapping[str, Any]]) -> str:
    """Return the line below the title: what machine it is, and what computed it.

    Parameters
    ----------
    values : mapping
        Plain values of the config.
    manifests : sequence of mapping
        Records of the stages; of each its versions.

    Returns
    -------
    str
        One line.
    """
    transmission = values["transmission"]
    parts = ["Pinion and face gear"]
    if transmission is not None:
        roles = Counter(pinion["role"] for pinion in transmission["pinions"])
        counts = [count_noun(count, f"{role} pinion") for role, count in roles.items()]
        parts = [*counts, count_noun(len(transmission["face_gears"]), "face gear")]
    versions = {item for manifest in manifests for item in manifest["versions"].items()}
    program = sorted(f"{name} {version}" for name, version in versions if name == "facegear")
    return " · ".join([", ".join(parts), *program])


def mode_rows(frequencies: pd.DataFrame) -> pd.DataFrame:
    """Tabulate the modes by frequency.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.

    Returns
    -------
    pd.DataFrame
        A row for each frequency: modes (with how many share it), frequency_hz, what moves, class.
    """
    rows, first = [], 0
    while first < len(frequencies):
        mode = frequencies.iloc[first]
        count = int(mode["multiplicity"])
        order_text = str(mode["order"]) if count == 1 else f"{mode['order']} to {mode['order'] + count - 1}"
        times = "" if count == 1 else f"x {count}"
        rows.append((order_text, times, mode["frequency_hz"], mode["symbols"], mode["class"]))
        first += count
    return pd.DataFrame(rows, columns=["modes", "times", "frequency_hz", "what_moves", "class"])


def with_study_titles(
    tables: Mapping[str, pd.DataFrame], studies: Sequence[Mapping[str, Any]]
) -> dict[str, pd.DataFrame]:
    """Write the titles of studies into tables in place of their names.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name.
    studies : sequence of mapping
        The config's studies.

    Returns
    -------
    dict
        Tables whose column `study` reads as the captions of the studies' figures; the others unchanged.
    """
    titles = {study["name"]: study["title"] for study in studies}
    return {
        name: table.assign(study=table["study"].replace(titles)) if "study" in table else table
        for name, table in tables.items()
    }


def _tables(title: str, tables: Mapping[str, pd.DataFrame], speed_rpm: float) -> list[Table]:
    if title == "Loaded contact" and "by_torque" in tables:
        return [Table(BY_TORQUE, tables["by_torque"], main=BY_TORQUE_SHOWN)]
    if title == "Root stress" and "root_stress" in tables:
        return [Table(ROOT_STRESS, tables["root_stress"])]
    if title == FRICTION and "friction" in tables:
        return _friction(tables)
    if title == STUDIED_CONTACT and "studies" in tables:
        return [Table("Every case and torque", tables["studies"][STUDY_COLUMNS])]
    if title == "Strength" and "root_stress" in tables:
        rating_tables = _rating_tables(tables) if "rating" in tables else []
        running_tables = (
            [Table(DYNAMIC, tables["dynamic_stress"], main=DYNAMIC_SHOWN)]
            if "dynamic_stress" in tables
            else []
        )
        running_tables += _over_speed(tables, speed_rpm)
        return [*rating_tables, *running_tables, Table(ROOT_STRESS, tables["root_stress"])]
    if title == "Mesh stiffness" and "harmonics" in tables:
        return [Table("Harmonics kept", tables["harmonics"].iloc[:, :4])]
    if title == "Modes" and "frequencies" in tables:
        contact_tables = [Table(MODE_CONTACTS, tables["contacts"])] if "contacts" in tables else []
        rows = mode_rows(tables["frequencies"])
        words = "Natural frequencies; equal ones share a row"
        return [*contact_tables, Table(words, rows, is_folded=len(rows) > LONG_TABLE)]
    if title == POSES:
        return pose_tables(tables)
    if title == SHARING_MAP:
        return sharing_map_tables(tables)
    if title == SHAFTS:
        shaft_tables = [Table(words, tables[name]) for name, words in SHAFT_TABLES.items() if name in tables]
        return [table for table in shaft_tables if len(table.frame)]
    if title.startswith("Nominal"):
        bearings = [Table(BEARINGS, bearing_reactions(tables["bearings"]))] if "bearings" in tables else []
        return [*bearings, *_jumps(tables)]
    if title == "Load sharing at rest" and "following_groups" in tables:
        return [Table(FOLLOWING_TITLE, tables["following_groups"], main=FOLLOWING_SHOWN)]
    if title == "Tolerances" and "percentiles" in tables:
        limits = Table("Percentiles with their confidence intervals", tables["percentiles"])
        fractions = Table("Fraction of the samples for which each statement holds", tables["fractions"])
        sampling_table = Table(
            "Error from taking only some of the mesh cycles: relative; of fractions and temperatures "
            "the difference",
            tables["sampling"],
            2,
        )
        return [limits, fractions, *([] if tables["sampling"].empty else [sampling_table])]
    if title == SHARING and "summary" in tables:
        columns = [
            "study",
            "label",
            "group",
            "mean",
            "half_width",
            "minimum",
            "maximum",
            "lost_fraction",
            "motion",
        ]
        return [Table("Means over the cycle with their 95 % half-widths", tables["summary"][columns])]
    return []


def _rating_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
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


def _friction(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
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


def _over_speed(tables: Mapping[str, pd.DataFrame], speed_rpm: float) -> list[Table]:
    """Stress of every motion at the speed nearest to the nominal one, and where each is hardest."""
    if "stress_over_speed" not in tables:
        return []
    table = tables["stress_over_speed"]
    nearest = table["speed_rpm"].iloc[(table["speed_rpm"] - speed_rpm).abs().argmin()]
    hardest = first_largest_rows(table, "largest_force_n", ["motion"])
    speed_rows = pd.concat([table[table["speed_rpm"] == nearest], hardest]).drop_duplicates()
    return [Table(OVER_SPEED, speed_rows, main=OVER_SPEED_SHOWN)]


def _jumps(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Jumps with the mode that moves most; a linear resonance beside it only where the jump is near it."""
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


def _scorecard(frame: pd.DataFrame) -> Chapter:
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


def _errors(tables: Mapping[str, pd.DataFrame]) -> Chapter:
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


def _provenance(manifests: Sequence[Mapping[str, Any]]) -> Chapter:
    columns = ["rule", "summary", "seconds", "made_at", "code"]
    stage_manifests = [manifest for manifest in manifests if not manifest["rule"].endswith("_figures")]
    rows = [{name: manifest.get(name) for name in columns} for manifest in stage_manifests]
    frame = pd.DataFrame(rows, columns=columns)
    versions = dict(sorted({item for manifest in manifests for item in manifest["versions"].items()}))
    text = (
        "Each output has a manifest beside it with versions, config slice, code fingerprint and checksums. "
        "Figures are drawn from these outputs alone; their own manifests are not listed."
    )
    version_table = pd.DataFrame(list(versions.items()), columns=["library", "version"])
    return Chapter("Provenance", text, (), [Table("Rules", frame), Table("Versions", version_table)])
