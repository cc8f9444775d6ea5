"""Report of a case, from the machine as configured to the record of each file."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.number_format import count_noun
from facegear.report.bearings import bearing_life_tables, bearing_tables
from facegear.report.chapter_tables import (
    BEARINGS,
    BY_TORQUE,
    BY_TORQUE_SHOWN,
    DRAWINGS,
    DYNAMIC,
    DYNAMIC_SHOWN,
    FOLLOWING_SHOWN,
    LONG_TABLE,
    MODE_CONTACTS,
    SHAFT_TABLES,
    STUDY_COLUMNS,
    bearing_reactions,
    casing_tables,
    errors_chapter,
    friction_tables,
    jump_tables,
    rating_and_safety_tables,
    root_stress_tables,
    scorecard_chapter,
    stress_over_speed_tables,
)
from facegear.report.contents import (
    CASING,
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
"""Caption of the table of the running machine."""


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
        Manifests of all stages (rules): rule, summary, seconds, made_at, code, versions.
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
        chapters.append(scorecard_chapter(tables["scorecard"]))
    chapters.append(errors_chapter(tables))
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
        Manifests of the stages; `versions` of each is read.

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
    """Tabulate the modes with a row for each frequency.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal, in the order of order, with multiplicity, frequency_hz,
        symbols and class.

    Returns
    -------
    pd.DataFrame
        A row for each frequency: modes (first to last), times (how many share it), frequency_hz,
        what_moves, class; all of a frequency are consecutive.
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
        The config's studies; name and title are read.

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
    """Return the tables of the chapter with a title of CHAPTERS, as far as they were computed; none for
    any other chapter. `tables`: tables of the case by name; `speed_rpm`: nominal speed of the pinions.
    """
    if title == "Loaded contact" and "by_torque" in tables:
        return [Table(BY_TORQUE, tables["by_torque"], main=BY_TORQUE_SHOWN)]
    if title == "Root stress" and "root_stress" in tables:
        return root_stress_tables(tables)
    if title == FRICTION and "friction" in tables:
        return friction_tables(tables)
    if title == STUDIED_CONTACT and "studies" in tables:
        return [Table("Every case and torque", tables["studies"][STUDY_COLUMNS])]
    if title == "Strength" and "root_stress" in tables:
        report_tables = rating_and_safety_tables(tables) if "rating" in tables else []
        report_tables += bearing_life_tables(tables)
        running_tables = (
            [Table(DYNAMIC, tables["dynamic_stress"], main=DYNAMIC_SHOWN)]
            if "dynamic_stress" in tables
            else []
        )
        running_tables += stress_over_speed_tables(tables, speed_rpm)
        return [*report_tables, *running_tables, *root_stress_tables(tables)]
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
        return [*[table for table in shaft_tables if len(table.frame)], *bearing_tables(tables)]
    if title == CASING:
        return casing_tables(tables)
    if title.startswith("Nominal"):
        bearings = [Table(BEARINGS, bearing_reactions(tables["bearings"]))] if "bearings" in tables else []
        return [*bearings, *jump_tables(tables)]
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


def _provenance(manifests: Sequence[Mapping[str, Any]]) -> Chapter:
    """Return the chapter with a table of all stages but those of figures (rule, summary, seconds,
    made_at, code), and one of the versions of libraries, both from the manifests.
    """
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
