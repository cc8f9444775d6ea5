"""The comparison as one self-contained HTML page: what moved, and why it may have."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.io import documents, tables
from facegear.io.atomic import MANIFEST_SUFFIX, atomic_path
from facegear.number_format import count_noun
from facegear.report.compare.judge import (
    CHANGES,
    NOT_STORED,
    Comparison,
    Verdict,
    answer_tables,
    tables_not_stored,
)
from facegear.report.compare.quantities import CURVES, Curve, declaration_of
from facegear.report.figures.comparison import curves_compared
from facegear.report.figures.draw_matplotlib import save
from facegear.report.page import Chapter, Picture, render
from facegear.report.table import Table, words

Manifest = Mapping[str, Any]


def causes(name: str, old: Path, new: Path) -> list[str]:
    """List the differences behind a table of two folders of results.

    That is a changed value of the config, with both values; changed code of a stage; another version of a
    library. A line says so where there is none, or where a folder does not say how a table was made.

    Parameters
    ----------
    name : str
        Path of the table inside the folders.
    old : Path
        Folder of the earlier results.
    new : Path
        Folder of the later results.

    Returns
    -------
    list[str]
        A line for each difference in the manifests of the table's stage and of all stages before it.
    """
    before, after = _history(old / name), _history(new / name)
    if not before or not after:
        return ["a manifest is missing: how the table was made is not known"]
    lines = list(dict.fromkeys([*_config(before, after), *_code(before, after), *_versions(before, after)]))
    return lines or ["config, code and versions are the same: the difference is in the run itself"]


def _history(path: Path) -> dict[str, Manifest]:
    """Return the manifests of a table's stage and of all stages before it, by rule (name of the stage).

    It follows the `inputs` of each manifest from the table's file on; files that the folder no longer
    holds are skipped.
    """
    folders: dict[Path, dict[str, tuple[Path, Manifest]]] = {}
    history: dict[str, Manifest] = {}
    visited, pending = set(), [path]
    while pending:
        near = pending.pop()
        if near.parent not in folders:
            folders[near.parent] = _manifests(near.parent)
        source, manifest = folders[near.parent].get(near.name, (None, {}))
        if source is None or source in visited:
            continue
        visited.add(source)
        history.setdefault(str(manifest["rule"]), manifest)
        before = [Path(os.path.normpath(near.parent / name)) for name in manifest.get("inputs", {})]
        pending += reversed(before)
    return history


def _manifests(folder: Path) -> dict[str, tuple[Path, Manifest]]:
    """Return for each file name in a folder the path and the content of the manifest that lists it in
    `files`; of several manifests the first by name.
    """
    manifests: dict[str, tuple[Path, Manifest]] = {}
    for path in sorted(folder.glob(f"*{MANIFEST_SUFFIX}")):
        manifest = documents.read(path, ("rule", "files", "params"))
        manifests = {**dict.fromkeys(manifest["files"], (path, manifest)), **manifests}
    return manifests


def _config(before: Mapping[str, Manifest], after: Mapping[str, Manifest]) -> Iterator[str]:
    """Yield a line `config KEY: old -> new` for each key of the config that a stage of both sides read
    and whose value differs. `before` and `after`: manifests by rule, see `_history`.
    """
    for rule in sorted(before.keys() & after.keys()):
        old, new = (dict(_leaves("", side[rule]["params"].get("needs") or {})) for side in (before, after))
        for key in sorted(old.keys() | new.keys()):
            if old.get(key) != new.get(key):
                yield f"config {key}: {_value_text(old, key)} -> {_value_text(new, key)}"


def _leaves(key: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield (dotted key, value) of everything below `key` in nested mappings.

    Lists of mappings are entered, too: an item's part of the key is its `name`, else its number from 0.
    Other lists are values.
    """
    if isinstance(value, Mapping):
        inside = list(value.items())
    elif isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
        inside = [
            (item.get("name", number) if isinstance(item, Mapping) else number, item)
            for number, item in enumerate(value)
        ]
    else:
        yield key, value
        return
    for name, item in inside:
        yield from _leaves(f"{key}.{name}" if key else str(name), item)


def _value_text(values: Mapping[str, Any], key: str) -> str:
    """Return the value of a key as Python text (`repr`), or `absent` if the key is missing."""
    return repr(values[key]) if key in values else "absent"


def _code(before: Mapping[str, Manifest], after: Mapping[str, Manifest]) -> Iterator[str]:
    """Yield a line for each stage (rule) whose code hash differs, and for each that only one side has.
    `before` and `after`: manifests by rule, see `_history`.
    """
    for rule in sorted(before.keys() & after.keys()):
        if before[rule].get("code") != after[rule].get("code"):
            yield f"code of stage {rule}"
    for rule in sorted(before.keys() ^ after.keys()):
        yield f"stage {rule} is behind one of them only"


def _versions(before: Mapping[str, Manifest], after: Mapping[str, Manifest]) -> Iterator[str]:
    """Yield a line `LIBRARY old -> new` for each library whose version differs in the manifests of a
    stage. `before` and `after`: manifests by rule, see `_history`.
    """
    for rule in sorted(before.keys() & after.keys()):
        old, new = before[rule].get("versions", {}), after[rule].get("versions", {})
        for library in sorted(old.keys() & new.keys()):
            if old[library] != new[library]:
                yield f"{library} {old[library]} -> {new[library]}"


LIMIT = 8
"""Most rows of one table that the page lists."""

MAX_FILES_NAMED = 3
"""Most tables that are named behind one cause."""


def write_page(path: Path, comparison: Comparison, reasons: pd.DataFrame, old: Path, new: Path) -> None:
    """Write the HTML page of a comparison: verdict, causes, curves over each other and the largest
    changes.

    Parameters
    ----------
    path : Path
        Path of the HTML file.
    comparison : Comparison
        The comparison.
    reasons : pd.DataFrame
        Table of `causes_table`, columns cause and table.
    old : Path
        Folder of the earlier results.
    new : Path
        Folder of the later results.
    """
    with TemporaryDirectory() as folder:
        pictures = list(_pictures(comparison, old, new, Path(folder)))
        chapters = [
            Chapter(
                "Verdict",
                verdict(comparison),
                tables=[
                    Table("Numbers and labels", _counts(comparison)),
                    Table("By table", by_table(comparison)),
                ],
            ),
            Chapter(
                "Why it may have moved",
                "One line for each difference behind a table.",
                tables=[Table("Config, code and versions", reasons)],
            ),
            Chapter("Curves over each other", "The series of each table that moved most.", pictures=pictures),
            Chapter(
                "What moved",
                f"The {LIMIT} largest changes of each table, relative to the largest number of their column.",
                tables=[Table("Changes", largest(comparison))],
            ),
        ]
        text = render("Two results compared", f"Old: {old}. New: {new}.", chapters)
    with atomic_path(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def verdict(comparison: Comparison) -> str:
    """Say whether both folders agree, and count changes that do not matter; else in how many tables
    they differ.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    str
        One to four sentences.
    """
    if comparison.equal:
        within = comparison.counts[Verdict.WITHIN_ERROR] + comparison.counts[Verdict.IRREGULAR]
        note = f" {within} numbers moved within their numerical error." if within else ""
        rounding = comparison.counts[Verdict.ROUNDING]
        note += f" {rounding} numbers, labels and rows that rounding decides differ." if rounding else ""
        images = comparison.counts[Verdict.MIRROR]
        note += f" {images} are of the mirror image of the same motion." if images else ""
        return f"Both folders say the same.{note}"
    files = comparison.rows.loc[comparison.rows["verdict"].isin(CHANGES), "file"].nunique()
    return f"The folders differ in {count_noun(files, 'table')}."


def stored_in_words(name: str, folder: Path) -> str:
    """Say how many tables a stored answer holds, and that nothing is compared with the others.

    Parameters
    ----------
    name : str
        Name of the answer, as `current/quick`.
    folder : Path
        Where it is unpacked.

    Returns
    -------
    str
        A sentence; empty for a folder of results, which holds all of its tables.
    """
    if not (folder / NOT_STORED).is_file():
        return ""
    stored_count = count_noun(len(answer_tables(folder)), "table")
    omitted_count = count_noun(len(tables_not_stored(folder)), "larger table")
    return f"{name} holds {stored_count}. Not stored, and not compared: {omitted_count}."


def largest(comparison: Comparison) -> pd.DataFrame:
    """Return the LIMIT largest relative changes of every table, those whose verdict is in CHANGES first.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    pd.DataFrame
        Rows of `comparison.rows` (columns COLUMNS of judge.py), in the order of their files.
    """
    rows = comparison.rows.assign(counts=comparison.rows["verdict"].isin(CHANGES))
    order = rows.sort_values(["counts", "relative_change"], ascending=False, kind="stable")
    return order.groupby("file").head(LIMIT).sort_values("file", kind="stable").drop(columns="counts")


def causes_table(comparison: Comparison, old: Path, new: Path) -> pd.DataFrame:
    """Tabulate what may have moved each table that stands in both folders.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    old : Path
        Folder of the earlier results.
    new : Path
        Folder of the later results.

    Returns
    -------
    pd.DataFrame
        Columns cause (a line of `causes`) and table (names of the tables behind which it stands).
    """
    files = [
        name for name in comparison.rows["file"].unique() if (old / name).exists() and (new / name).exists()
    ]
    rows = [(name, line) for name in files for line in causes(name, old, new)]
    tables_by_cause = pd.DataFrame(rows, columns=["table", "cause"]).groupby("cause", sort=False)["table"]
    return tables_by_cause.agg(_file_names).reset_index()


def by_table(comparison: Comparison) -> pd.DataFrame:
    """Count the values that differ by table and verdict.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    pd.DataFrame
        A row for each table and verdict: columns table, verdict, numbers (count), largest_change
        (relative).
    """
    changes_by_file = comparison.rows.groupby(["file", "verdict"], sort=True)["relative_change"]
    return (
        changes_by_file.agg(numbers="size", largest_change="max")
        .reset_index()
        .rename(columns={"file": "table"})
    )


def _file_names(files: pd.Series) -> str:
    """Join the first MAX_FILES_NAMED names of tables by commas and say how many more there are."""
    remainder = f" and {len(files) - MAX_FILES_NAMED} more" if len(files) > MAX_FILES_NAMED else ""
    return ", ".join(files[:MAX_FILES_NAMED]) + remainder


def _counts(comparison: Comparison) -> pd.DataFrame:
    """Return columns `verdict` and `numbers and labels` (count), a row for each verdict that occurs."""
    rows = [(verdict.value, count) for verdict, count in comparison.counts.items() if count]
    return pd.DataFrame(rows, columns=["verdict", "numbers and labels"])


def _pictures(comparison: Comparison, old: Path, new: Path, folder: Path) -> Iterator[Picture]:
    """Draw the declared curve (CURVES) of each table that differs and stands in both folders, as svg in
    `folder`; yield its path and caption.
    """
    for name in comparison.rows["file"].unique():
        curve = declaration_of(CURVES, name)
        if curve and (old / name).exists() and (new / name).exists():
            before, after, title = _worst_series(name, curve, old, new)
            path = folder / f"{name.replace('/', '_')}.svg"
            save(
                curves_compared(before, after, curve.x, curve.y, (words(curve.x), words(curve.y)), title),
                path,
            )
            yield Picture(path, f"{name}{f': {title}' if title else ''}")


def _worst_series(name: str, curve: Curve, old: Path, new: Path) -> tuple[pd.DataFrame, pd.DataFrame, str]:
    """Return the old and the new rows of the series whose curve.y changed most in absolute terms at
    one x, and the values that name the series, joined by commas.

    name: path of the table inside both folders. Tables without series are returned whole, with an empty
    name.
    """
    before, after = (tables.read(folder / name) for folder in (old, new))
    if curve.quantity:
        before, after = (frame[frame["quantity"] == curve.quantity] for frame in (before, after))
    if not curve.series:
        return before, after, ""
    keys = [*curve.series, curve.x]
    joined_curves = before[[*keys, curve.y]].merge(
        after[[*keys, curve.y]], on=keys, suffixes=("_old", "_new")
    )
    change = (joined_curves[f"{curve.y}_new"] - joined_curves[f"{curve.y}_old"]).abs().fillna(0.0)
    worst = joined_curves.loc[change.idxmax(), list(curve.series)] if len(joined_curves) else before.iloc[0]
    series = [
        frame[(frame[list(curve.series)] == worst[list(curve.series)].to_numpy()).all(axis=1)]
        for frame in (before, after)
    ]
    return series[0], series[1], ", ".join(str(worst[key]) for key in curve.series)
