"""Reading of the csv files that a user gives: comma separated, one line of column names, values below."""

import csv
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from facegear.errors import plain_reason
from facegear.number_format import count_noun
from facegear.schema.base import NEW_KEYS, suggestion

LARGEST_FILE = 2_000_000
"""Bytes that are read at most."""


class CsvRow(NamedTuple):
    """One line of the file, counted from 1, and its numbers by column."""

    line: int
    values: dict[str, float]


class CsvTable(NamedTuple):
    """Remarks and rows of a file.

    `remarks` are the lines that begin with # before the column names. Each of the `rows` holds the numbers
    and the texts of a line by column.
    """

    remarks: list[str]
    rows: list[tuple[CsvRow, dict[str, str]]]


class CsvFault(Exception):
    """Reason why a file cannot be used, with the line where there is one; the text is one line."""


def read_numbers(path: str | Path, columns: Sequence[str], unread: Sequence[str] = ()) -> list[CsvRow]:
    """Return the finite numbers of the named columns, row by row.

    Parameters
    ----------
    path : str or Path
        The file.
    columns : Sequence[str]
        Names of the columns of numbers.
    unread : Sequence[str]
        Names of columns that may stand beside them and are not read.

    Returns
    -------
    list[CsvRow]
        Line number and finite numbers by column of each row.

    Raises
    ------
    CsvFault
        For a file that cannot be read, a column that is missing or unknown, or a value that is no finite
        number.
    """
    return [row for row, _ in read_table(path, columns, unread=unread).rows]


def read_table(
    path: str | Path,
    columns: Sequence[str],
    texts: Sequence[str] = (),
    optional: Sequence[str] = (),
    unread: Sequence[str] = (),
) -> CsvTable:
    """Read finite numbers and texts of named columns from a csv file, row by row.

    Lines that begin with # before the column names are remarks.

    Parameters
    ----------
    path : str or Path
        The file.
    columns : Sequence[str]
        Names of columns of numbers.
    texts : Sequence[str]
        Names of columns of texts.
    optional : Sequence[str]
        Names of columns of numbers of which all or none must be given.
    unread : Sequence[str]
        Names of columns that may stand beside them and are not read.

    Returns
    -------
    CsvTable
        Texts of the remarks, and for each row its line number with numbers and its texts, by column.

    Raises
    ------
    CsvFault
        For a file that cannot be read, a column that is missing or unknown, or a value that is no finite
        number.
    """
    content = _text(Path(path)).splitlines()
    first = next((number for number, line in enumerate(content) if not line.startswith("#")), len(content))
    lines = csv.reader(content[first:])
    try:
        header = [name.strip() for name in next(lines, [])]
        optional_present = set(optional) & set(header)
        required_columns = [*texts, *columns, *(optional if optional_present else ())]
        _check_header(header, required_columns, [*texts, *columns, *optional], unread)
        numbers = [*columns, *(optional if optional_present else ())]
        rows = []
        for cells in lines:
            if any(cell.strip() for cell in cells):
                rows.append(_row(first + lines.line_num, header, cells, numbers, texts))
    except csv.Error as error:
        raise CsvFault(f"line {first + lines.line_num}: {error}") from None
    if not rows:
        raise CsvFault("it holds no numbers")
    return CsvTable([line.lstrip("# ").strip() for line in content[:first]], rows)


def column_names(path: str | Path) -> list[str]:
    """Return the column names of a csv file: the first line that does not begin with #.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    list[str]
        The names; none where the file is empty.

    Raises
    ------
    CsvFault
        If the file or this line cannot be read.
    """
    lines = (line for line in _text(Path(path)).splitlines() if not line.startswith("#"))
    try:
        return [name.strip() for name in next(csv.reader(lines), [])]
    except csv.Error as error:
        raise CsvFault(f"its column names cannot be read: {error}") from None


def _check_header(
    header: Sequence[str],
    required_columns: Sequence[str],
    known_columns: Sequence[str],
    unread: Sequence[str],
) -> None:
    """Raise CsvFault for a column that is missing, stands twice, is unknown or has another name today."""
    old_names = [name for name in header if NEW_KEYS.get(name) in known_columns]
    if old_names:
        raise CsvFault("columns: " + ", ".join(f"`{name}` is now `{NEW_KEYS[name]}`" for name in old_names))
    absent_columns = [name for name in required_columns if header.count(name) != 1]
    if absent_columns:
        message = f"column {absent_columns[0]} must stand once in its first line, separated by commas"
        raise CsvFault(f"{message}; it has {', '.join(header)[:200] or 'none'}")
    for number, name in enumerate(header, start=1):
        if not name:
            raise CsvFault(f"column {number} has no name; pandas writes such an index without index=False")
        if name not in (*known_columns, *unread):
            raise CsvFault(f"column {name[:40]!r} is unknown; {suggestion(name, known_columns)}")


def _row(
    line: int, header: Sequence[str], cells: Sequence[str], columns: Sequence[str], texts: Sequence[str]
) -> tuple[CsvRow, dict[str, str]]:
    """Return the line number with its finite numbers, and its texts, both by column; CsvFault for a bad
    line.
    """
    if len(cells) != len(header):
        raise CsvFault(
            f"line {line}: {count_noun(len(cells), 'value')} under {count_noun(len(header), 'column name')}"
        )
    by_column = dict(zip(header, cells, strict=True))
    numbers = {name: _number(line, name, by_column[name]) for name in columns}
    return CsvRow(line, numbers), {name: by_column[name].strip() for name in texts}


def _number(line: int, name: str, text: str) -> float:
    """Return the text of a cell as a finite number; CsvFault, with line and column, if it is none."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or "_" in text:
        raise CsvFault(f"line {line}: {name} = {text.strip()[:40]!r} is not a finite number")
    return value


def _text(path: Path) -> str:
    """Return the text of a file; refuse directories, long files and other encodings."""
    try:
        if path.is_dir():
            raise CsvFault("it is a directory, not a csv file")
        with open(path, "rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise CsvFault("no such file") from None
    except (OSError, ValueError) as error:
        raise CsvFault(f"it cannot be read ({plain_reason(error)})") from None
    if len(content) > LARGEST_FILE:
        raise CsvFault(f"it is longer than {LARGEST_FILE} bytes")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise CsvFault(f"line {line}: byte {content[error.start]:#04x} is not UTF-8") from None


NUMBERS = ("face_mm", "profile_mm", "deviation_um")
"""Columns of numbers of a csv of flanks."""
TEXTS = ("body", "tooth", "flank")
"""Columns of texts of a csv of flanks."""
NOMINAL = ("x_mm", "y_mm", "z_mm", "nx", "ny", "nz")
"""Columns that may stand beside the others: the nominal point and its outward normal."""
BODIES = ("pinion", "face_gear")
"""Texts allowed in column `body`."""
SIDES = ("right", "left")
"""Texts allowed in column `flank`."""
HEADER = "pitch and thickness"
"""Name of the remark that says whether pitch and thickness are included."""
PITCH_REMARKS = {"included": "included", "left out": "left_out"}
"""Values of the remark `pitch and thickness`, each with the value of the config's key."""
LARGEST = 300.0
"""Largest deviation (um) of a gear that could run."""
SMALLEST = 0.05
"""Largest deviation (um) of a whole file, not all zero, that no measuring machine sees."""


class _Point(NamedTuple):
    line: int
    deviation: float
    nominal: tuple[float, ...]


def read_flanks(path: str | Path, body: str) -> dict[str, Any]:
    """Read the measured flanks of one body from a csv file, for section `flanks`.

    Rows of the other body are passed over. Places of a flank must fill a grid, in any order.

    Parameters
    ----------
    path : str or Path
        The csv file.
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    dict[str, Any]
        Key `pitch_and_thickness`, from the remark of the file, and key `grids`, a list with one grid for
        each tooth and flank.

    Raises
    ------
    CsvFault
        With the line where there is one.
    """
    table = read_table(path, NUMBERS, TEXTS, NOMINAL)
    pitch_and_thickness = _header(table.remarks)
    grids: dict[tuple[int | None, str], dict[tuple[float, float], _Point]] = {}
    for row, texts in table.rows:
        _check_texts(row.line, texts)
        if texts["body"] != body:
            continue
        values = row.values
        if abs(values["deviation_um"]) > LARGEST:
            requirement = f"must be from -{LARGEST:g} to {LARGEST:g} um"
            raise CsvFault(f"line {row.line}: deviation_um = {values['deviation_um']:g} {requirement}")
        grid = grids.setdefault((_tooth(row.line, texts["tooth"]), texts["flank"]), {})
        at = round(values["face_mm"], 6), round(values["profile_mm"], 6)
        if at in grid:
            raise CsvFault(f"line {row.line}: the same place stands in line {grid[at].line}")
        nominal = tuple(values[name] for name in NOMINAL if name in values)
        grid[at] = _Point(row.line, values["deviation_um"], nominal)
    if not grids:
        raise CsvFault(f"it has no rows with body {body}")
    _check_unit(grids)
    return {
        "pitch_and_thickness": pitch_and_thickness,
        "grids": [_grid(*key, grid) for key, grid in grids.items()],
    }


def _header(remarks: Iterable[str]) -> str:
    """Return what the remarks of a flank file say of pitch and thickness, as the config's key has it."""
    for remark in remarks:
        name, _, remark_value = remark.partition(":")
        if name.strip() == HEADER:
            if remark_value.strip() in PITCH_REMARKS:
                return PITCH_REMARKS[remark_value.strip()]
            raise CsvFault(f"{HEADER} = {remark_value.strip()!r} must be {' or '.join(PITCH_REMARKS)}")
    raise CsvFault(f"before its column names it must have the line '# {HEADER}: included' or '...: left out'")


def _check_texts(line: int, texts: Mapping[str, str]) -> None:
    """Refuse an unknown body or flank."""
    for column, known_texts in (("body", BODIES), ("flank", SIDES)):
        if texts[column] not in known_texts:
            raise CsvFault(
                f"line {line}: {column} = {texts[column][:40]!r} must be {' or '.join(known_texts)}"
            )


def _tooth(line: int, text: str) -> int | None:
    """Return the number of a tooth, None for `all`."""
    if text == "all":
        return None
    if not (text.isascii() and text.isdigit() and int(text) > 0):
        raise CsvFault(f"line {line}: tooth = {text[:40]!r} must be all, or a number from 1")
    return int(text)


def _check_unit(grids: Mapping[Any, Mapping[Any, _Point]]) -> None:
    """Refuse deviations so small that they must be in mm."""
    largest = max(abs(point.deviation) for grid in grids.values() for point in grid.values())
    if 0.0 < largest < SMALLEST:
        raise CsvFault(
            f"its largest deviation_um = {largest:g} must be 0 or above {SMALLEST:g}: are they in mm?"
        )


def _grid(tooth: int | None, flank: str, points: Mapping[tuple[float, float], _Point]) -> dict[str, Any]:
    """Return the grid section of one tooth's flank from its points by (face, profile), mm.

    Both axes rise. Raises CsvFault where a place is missing.
    """
    faces, profiles = (sorted({at[axis] for at in points}) for axis in (0, 1))
    for face in faces:
        for profile in profiles:
            if (face, profile) not in points:
                flank_name = f"tooth {tooth or 'all'}, {flank} flank"
                grid_point = f"face_mm = {face:g}, profile_mm = {profile:g}"
                raise CsvFault(f"{flank_name}: no row at {grid_point}; the places must fill a grid")
    rows = [[points[face, profile] for profile in profiles] for face in faces]
    nominal = [[point.nominal for point in row] for row in rows] if rows[0][0].nominal else []
    return {
        "tooth": tooth,
        "flank": flank,
        "face_mm": faces,
        "profile_mm": profiles,
        "deviation_um": [[point.deviation for point in row] for row in rows],
        "nominal": nominal,
    }
