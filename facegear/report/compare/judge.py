"""Every number and label of two folders of results, and whether it moved."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.errors import FacegearError
from facegear.io import documents, tables
from facegear.report.compare.quantities import (
    AFTER_IRREGULAR,
    OPEN_CLASSES,
    REGULAR,
    SYMMETRY_BROKEN,
    TABLES,
    Bracket,
    Table,
    declaration_of,
)

REPEATABLE = 1e-10
"""Difference that two runs of the same code on one input may show, relative to the largest of the column."""
LEFT_OUT = ("logs", "benchmarks", "figures", "chunks")
"""Folders that hold no answers."""
UNDETERMINED = ("shapes.csv",)
"""Tables whose numbers are known up to a sign, or to a choice among equals: mode shapes."""
NOT_STORED = "not_stored.json"
"""Record inside a stored answer: the tables that were too large for it."""
COLUMNS = ("file", "row", "quantity", "old", "new", "relative_change", "numerical_error", "verdict")
"""Columns of the rows of a comparison."""


class Verdict(StrEnum):
    """Verdict on a number or a label."""

    UNCHANGED = "same"
    WITHIN_ERROR = "within its numerical error"
    BEYOND_ERROR = "moved"
    NO_ERROR = "moved, its error is not stated"
    IRREGULAR = "irregular motion, a statistic"
    ROUNDING = "after irregular motion, decided by rounding"
    MIRROR = "mirror image of the same motion"
    LABEL = "label changed"
    ONLY_IN_OLD = "gone"
    ONLY_IN_NEW = "added"


CHANGES = (Verdict.BEYOND_ERROR, Verdict.NO_ERROR, Verdict.LABEL, Verdict.ONLY_IN_OLD, Verdict.ONLY_IN_NEW)
"""Verdicts that make two folders different."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Result of a comparison of two folders of results.

    Attributes
    ----------
    rows
        COLUMNS of all that is not the same: one row a number or label; for a table or row that stands in one
        folder only, one row.
    counts
        Numbers and labels of each verdict.
    """

    rows: pd.DataFrame
    counts: dict[Verdict, int]

    @property
    def equal(self) -> bool:
        """Whether no value has a verdict of CHANGES: nothing moved beyond its numerical error, no label
        changed, and nothing stands in one folder only.
        """
        return not any(self.counts[verdict] for verdict in CHANGES)


def compare(old: Path, new: Path) -> Comparison:
    """Compare all tables of two folders of results, but for those that a stored answer leaves out.

    Parameters
    ----------
    old : Path
        Folder of the earlier results.
    new : Path
        Folder of the later results.

    Returns
    -------
    Comparison
        Rows of all values that differ (columns COLUMNS), and the number of values of each verdict.

    Raises
    ------
    FacegearError
        For a folder without tables.
    CorruptFile
        For a table that was altered since its stage wrote it.
    """
    names = {side: answer_tables(side) for side in (old, new)}
    left_out = tables_not_stored(old) | tables_not_stored(new)
    judgements = [
        _judge_file(name, old if name in names[old] else None, new if name in names[new] else None)
        for name in sorted((names[old] | names[new]) - left_out)
    ]
    rows = pd.concat(judgements, ignore_index=True)
    counts = {verdict: int((rows["verdict"] == verdict).sum()) for verdict in Verdict}
    return Comparison(rows[rows["verdict"] != Verdict.UNCHANGED].reset_index(drop=True), counts)


def answer_tables(folder: Path) -> set[str]:
    """Return the tables of a folder of results.

    Parameters
    ----------
    folder : Path
        The folder.

    Returns
    -------
    set[str]
        Paths of all `*.csv` inside the folder, with `/`, but for LEFT_OUT and UNDETERMINED.

    Raises
    ------
    FacegearError
        For a folder without such tables.
    """
    paths = (path.relative_to(folder) for path in folder.rglob("*.csv"))
    table_paths = {path.as_posix() for path in paths if not set(path.parts) & {*LEFT_OUT, *UNDETERMINED}}
    if not table_paths:
        raise FacegearError(f"{folder}: must be a folder of results, with tables (*.csv) in it")
    return table_paths


def tables_not_stored(folder: Path) -> set[str]:
    """Return the tables that were too large for a stored answer; none for a folder of results.

    Parameters
    ----------
    folder : Path
        A folder of results, or an unpacked stored answer.

    Returns
    -------
    set of str
        Paths inside the folder of results, as NOT_STORED lists them.
    """
    path = folder / NOT_STORED
    return set(documents.read(path, ("tables",))["tables"]) if path.is_file() else set()


def _judge_file(name: str, old: Path | None, new: Path | None) -> pd.DataFrame:
    """Judge all values of a table by its path `name` inside the folders; `old` or `new` is None where
    the table is missing. Return one row of COLUMNS for each value of common rows and columns, and one
    for each row or column that stands on one side only.
    """
    if old is None or new is None:
        return _one_sided(name, ["whole table"], Verdict.ONLY_IN_NEW if old is None else Verdict.ONLY_IN_OLD)
    before, after = (tables.read(folder / name, allow_empty=True) for folder in (old, new))
    table = declaration_of(TABLES, name) or Table()
    speeds = _bracket_names(before, after, table)
    groups = pd.concat([_without_item(frame, table) for frame in (before, after)])
    before, after = (
        _by_row(frame, table, speed) for frame, speed in zip((before, after), speeds, strict=True)
    )
    groups = dict(zip([*before.index, *after.index], groups, strict=True))
    common_rows = before.index.intersection(after.index, sort=False)
    columns = [column for column in before.columns if column in after.columns]
    group = pd.Series([groups[row] for row in common_rows], index=common_rows, dtype=object)
    parts = [
        _judge_column(name, table, before.loc[common_rows], after.loc[common_rows], column, group)
        for column in columns
    ]
    for table_here, other_table, verdict in (
        (before, after, Verdict.ONLY_IN_OLD),
        (after, before, Verdict.ONLY_IN_NEW),
    ):
        lost_columns = [
            f"column {column}" for column in table_here.columns if column not in other_table.columns
        ]
        rows = table_here.loc[table_here.index.difference(other_table.index, sort=False)]
        frame = _one_sided(name, [*rows.index.astype(str), *lost_columns], verdict)
        elsewhere = other_table.loc[other_table.index.difference(table_here.index, sort=False)]
        mirrors = {groups[row] for row in elsewhere.index[_flagged(elsewhere, SYMMETRY_BROKEN)]}
        in_both = np.fromiter((groups[row] in mirrors for row in rows.index), dtype=bool, count=len(rows))
        not_rows = np.zeros(len(lost_columns), dtype=bool)
        open_rows = np.concatenate([_flagged(rows, AFTER_IRREGULAR), not_rows])
        images = np.concatenate([_flagged(rows, SYMMETRY_BROKEN) & in_both, not_rows])
        verdicts = frame["verdict"].mask(open_rows, Verdict.ROUNDING).mask(images, Verdict.MIRROR)
        parts.append(frame.assign(verdict=verdicts))
    return pd.concat([part for part in parts if len(part)] or parts[:1], ignore_index=True)


def _by_row(frame: pd.DataFrame, table: Table, speeds: pd.Series | None) -> pd.DataFrame:
    """Return a table without its key columns, with a text index that names its rows.

    A name joins the values of table.keys; repeated names end in #2, #3. Rows without keys are named
    by number.

    speeds: further part (rows,) of the names in tables with a bracket, see `_bracket_names`; None in
    others.
    """
    keys = [key for key in table.keys if key in frame.columns]
    if not keys:
        return frame.set_axis([f"row {number + 1}" for number in range(len(frame))])
    parts = [frame[key].map(_value_text) for key in keys]
    if speeds is not None:
        parts.append(speeds.map(_value_text))
    names = parts[0].str.cat(parts[1:], sep=", ") if len(parts) > 1 else parts[0]
    again = names.groupby(names).cumcount()
    names = names.where(again == 0, names + " #" + (again + 1).astype(str))
    columns = [column for column in frame.columns if column not in keys or column == table.quantity]
    return frame[columns].set_axis(pd.Index(names))


def _value_text(value: object) -> str:
    """Return a value as text: floats with at most ten significant digits, anything else by `str`."""
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _bracket_names(
    before: pd.DataFrame, after: pd.DataFrame, table: Table
) -> tuple[pd.Series | None, pd.Series | None]:
    """Return the speeds, in the unit of the bracket's columns, that name the rows of two tables (old,
    new); None and None for tables without a bracket.

    A row is named by its own `before` speed. A row of `after` takes the speed of the nearest unused row
    of `before` with the same keys instead, if their middles differ by at most the sum of both errors.
    """
    if table.bracket is None:
        return None, None
    names = after[table.bracket.before].astype(float)
    middles, errors = zip(*(_bracket_places(frame, table.bracket) for frame in (before, after)), strict=True)
    used_rows: set[int] = set()
    for old in range(len(before)):
        apart = np.abs(middles[1] - middles[0][old])
        like = (after[list(table.keys)] == before[list(table.keys)].iloc[old]).all(axis=1).to_numpy()
        near = [int(new) for new in np.flatnonzero(like & (apart <= errors[0][old] + errors[1]))]
        free = [new for new in near if new not in used_rows]
        if free:
            new = min(free, key=apart.__getitem__)
            used_rows.add(new)
            names.iloc[new] = before[table.bracket.before].iloc[old]
    return before[table.bracket.before], names


def _bracket_places(frame: pd.DataFrame, bracket: Bracket) -> tuple[np.ndarray, np.ndarray]:
    """Return the middle of each row's bracket, and the error of its speed, both (rows,) in the unit of
    the speeds.

    The error is the larger of the stated one and of the width of the bracket.
    """
    first, last = (frame[column].to_numpy(float) for column in (bracket.before, bracket.after))
    width = np.abs(last - first)
    stated_error = frame[bracket.error].to_numpy(float) if bracket.error in frame.columns else width
    return 0.5 * (first + last), np.maximum(stated_error, width)


def _without_item(frame: pd.DataFrame, table: Table) -> pd.Series:
    """Return the values of the keys of each row but for its mesh or body (table.item), joined to a
    text, shape (rows,). Rows with equal text form a group that mirror images may permute; without an
    item each row is alone.
    """
    keys = [key for key in table.keys if key in frame.columns and key != table.item]
    if not keys or table.item is None:
        return pd.Series(np.arange(len(frame)).astype(str), index=frame.index)
    parts = [frame[key].map(_value_text) for key in keys]
    return parts[0].str.cat(parts[1:], sep=", ") if len(parts) > 1 else parts[0]


def _judge_column(
    name: str, table: Table, before: pd.DataFrame, after: pd.DataFrame, column: str, group: pd.Series
) -> pd.DataFrame:
    """Judge one column of the common rows of two tables; return a row of COLUMNS for each row.

    Numbers within REPEATABLE are unchanged. Otherwise the first that fits counts: irregular motion,
    change within the numerical error, after irregular motion on both sides, mirror image, moved. Labels
    are compared as text.

    name: path of the table; before, after: tables of `_by_row` with equal index; group: text of
    `_without_item` of each row.
    """
    old, new = before[column], after[column]
    numeric = all(pd.api.types.is_numeric_dtype(side) and side.dtype != bool for side in (old, new))
    rows = pd.DataFrame({"file": name, "row": before.index, "quantity": column, "old": old, "new": new})
    open_rows = _flagged(before, AFTER_IRREGULAR) & _flagged(after, AFTER_IRREGULAR)
    has_image = _flagged(before, SYMMETRY_BROKEN) & _flagged(after, SYMMETRY_BROKEN)
    if not numeric:
        is_equal = (old.fillna("").astype(str) == new.fillna("").astype(str)).to_numpy()
        return rows.assign(
            relative_change=np.nan,
            numerical_error=np.nan,
            verdict=np.select(
                [
                    is_equal,
                    open_rows,
                    _both_irregular(old, new, table),
                    has_image & (column not in table.motion),
                ],
                [Verdict.UNCHANGED, Verdict.ROUNDING, Verdict.IRREGULAR, Verdict.MIRROR],
                Verdict.LABEL,
            ),
        )
    zero = _zero(table, before, column)
    before_zero, after_zero = (side.mask(side.abs() <= zero, 0.0) for side in (old, new))
    change, scale = _relative_change(before_zero, after_zero, before.get(table.quantity))
    errors = _errors(table, before, after, column, scale)
    irregular = _irregular(before, table) | _irregular(after, table)
    images = has_image & _same_but_for_items(
        before_zero, after_zero, before.get(table.quantity), group, errors
    )
    with np.errstate(invalid="ignore"):
        within = change <= errors
    verdict = np.select(
        [change <= REPEATABLE, irregular, within, open_rows, images],
        [Verdict.UNCHANGED, Verdict.IRREGULAR, Verdict.WITHIN_ERROR, Verdict.ROUNDING, Verdict.MIRROR],
        np.where(np.isnan(errors), Verdict.NO_ERROR, Verdict.BEYOND_ERROR),
    )
    return rows.assign(relative_change=change, numerical_error=errors, verdict=verdict)


def _zero(table: Table, rows: pd.DataFrame, column: str) -> pd.Series:
    """Return the magnitude, in the unit of the values, up to which a number of a column counts as zero,
    shape (rows,). In tables with one quantity a row it depends on the quantity of the row.
    """
    of_column = table.zero.get(column, 0.0)
    if table.quantity is None or column == table.quantity:
        return pd.Series(of_column, index=rows.index)
    return rows[table.quantity].map(table.zero).fillna(of_column)


def _errors(
    table: Table, before: pd.DataFrame, after: pd.DataFrame, column: str, scale: np.ndarray
) -> np.ndarray:
    """Return the numerical error of a column (rows,), relative to `scale`; NaN where none is stated.

    Speeds of a bracket have the sum of the errors of both tables, over `scale`. Other columns have
    `Table.error`, with `elsewhere` where the bracket of the row differs between the tables.

    scale: largest magnitude (rows,) to which changes of the column are relative, see
    `_relative_change`.
    """
    plain, elsewhere = table.error(column), table.error(column, elsewhere=True)
    errors = np.full(len(before), np.nan if plain is None else plain)
    bracket = table.bracket
    if bracket is None:
        return errors
    has_moved = (before[bracket.before] != after[bracket.before]).to_numpy()
    errors[has_moved] = np.nan if elsewhere is None else elsewhere
    if column in (bracket.before, bracket.after, bracket.error):
        speed_error = sum(_bracket_places(frame, bracket)[1] for frame in (before, after))
        return np.divide(speed_error, scale, out=np.zeros(len(before)), where=scale > 0.0)
    return errors


def _same_but_for_items(
    old: pd.Series, new: pd.Series, quantity: pd.Series | None, group: pd.Series, errors: np.ndarray
) -> np.ndarray:
    """Return for which rows (rows,) the old and new magnitudes of their group agree after sorting.

    Then meshes or bodies have exchanged their numbers and nothing else moved. Magnitudes of a group may
    differ by the relative `errors` (rows,), at least by REPEATABLE.

    quantity: name of each row's quantity, for tables with one quantity a row; group: text of
    `_without_item`.
    """
    sizes = pd.DataFrame(
        {"old": old.abs().to_numpy(), "new": new.abs().to_numpy(), "group": group.to_numpy()}
    )
    by_size = [sizes.sort_values(["group", side], kind="stable") for side in ("old", "new")]
    pair = [pd.Series(part[side].to_numpy()) for part, side in zip(by_size, ("old", "new"), strict=True)]
    change, _ = _relative_change(
        pair[0], pair[1], None if quantity is None else _by_group(by_size[0], quantity)
    )
    tolerance = np.nan_to_num(np.maximum(errors[by_size[0].index], REPEATABLE), nan=REPEATABLE)
    fits = pd.Series(change <= tolerance).groupby(by_size[0]["group"].to_numpy()).all()
    return group.map(fits).to_numpy(dtype=bool)


def _by_group(by_size: pd.DataFrame, quantity: pd.Series) -> pd.Series:
    """Return the values (rows,) of a column in the order of the rows of `by_size`, whose index holds
    their numbers.
    """
    return pd.Series(quantity.to_numpy()[by_size.index])


def _relative_change(
    old: pd.Series, new: pd.Series, quantity: pd.Series | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return abs(new - old) over a scale, and the scale, both (rows,).

    The scale is the largest finite magnitude of both columns, among rows of one `quantity` if that is
    given. Equal values and two NaN have change 0, a NaN on one side an infinite one. Where the scale is
    0 the change is absolute.
    """
    pair = np.stack([old.to_numpy(float), new.to_numpy(float)])
    with np.errstate(invalid="ignore"):
        change = np.where((pair[0] == pair[1]) | np.isnan(pair).all(axis=0), 0.0, np.abs(pair[1] - pair[0]))
    change = np.where(np.isnan(change), np.inf, change)
    finite = np.where(np.isfinite(pair), np.abs(pair), 0.0).max(axis=0)
    groups = np.zeros(len(finite)) if quantity is None else quantity.to_numpy()
    scale = pd.Series(finite).groupby(groups).transform("max").to_numpy() if len(finite) else finite
    return np.divide(change, scale, out=change.copy(), where=scale > 0.0), scale


def _irregular(frame: pd.DataFrame, table: Table) -> np.ndarray:
    """Return for which rows (rows,) a column of table.motion names a class that does not begin with
    REGULAR. Empty classes count as regular.
    """
    motions = [frame[column] for column in table.motion if column in frame.columns]
    rows = np.zeros(len(frame), dtype=bool)
    for motion in motions:
        has_motion = motion.notna().to_numpy()
        rows |= has_motion & ~motion.astype(str).str.startswith(REGULAR).to_numpy()
    return rows


def _both_irregular(old: pd.Series, new: pd.Series, table: Table) -> np.ndarray:
    """Return for which rows (rows,) both columns of classes name an irregular motion, and at least one
    leaves open which (OPEN_CLASSES). False in columns that hold no class of motion.
    """
    if old.name not in table.motion:
        return np.zeros(len(old), dtype=bool)
    sides = [side.fillna(REGULAR).astype(str) for side in (old, new)]
    regular = np.logical_or(*(side.str.startswith(REGULAR).to_numpy() for side in sides))
    return np.logical_or(*(side.isin(OPEN_CLASSES).to_numpy() for side in sides)) & ~regular


def _flagged(frame: pd.DataFrame, column: str) -> np.ndarray:
    """Return for which rows (rows,) a column of truth values is true. Missing values are false; without
    such a column all are false.
    """
    if column not in frame.columns:
        return np.zeros(len(frame), dtype=bool)
    return frame[column].fillna(False).astype(bool).to_numpy()


def _one_sided(name: str, rows: list[str], verdict: Verdict) -> pd.DataFrame:
    """Return one row of COLUMNS for each name of a row or column that stands in one folder only;
    values, change and error are empty.
    """
    frame = pd.DataFrame({"file": name, "row": rows}, columns=list(COLUMNS))
    return frame.assign(verdict=verdict)
