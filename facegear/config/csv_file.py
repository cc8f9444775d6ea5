"""Reading of the csv files that a user gives: comma separated, one line of column names, values below."""

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

LARGEST_FILE = 2_000_000
"""Bytes that are read at most."""


class CsvRow(NamedTuple):
    """One line of the file, counted from 1, and its numbers by column."""

    line: int
    values: dict[str, float]


class CsvTable(NamedTuple):
    """What stands in lines that begin with # before the column names, and the lines below these, each with
    its numbers and its texts by column.
    """

    remarks: list[str]
    rows: list[tuple[CsvRow, dict[str, str]]]


class CsvFault(Exception):
    """Why a file cannot be used, with the line where there is one; the text is one line."""


def read_numbers(path: str | Path, columns: Sequence[str]) -> list[CsvRow]:
    """The finite numbers of the named columns; other columns may stand beside them and are left alone.

    Raises CsvFault naming the line.
    """
    return [row for row, _ in read_table(path, columns).rows]


def read_table(
    path: str | Path, columns: Sequence[str], texts: Sequence[str] = (), optional: Sequence[str] = ()
) -> CsvTable:
    """Finite numbers of `columns`, texts of others, and numbers of the `optional` ones where all stand there.

    Raises CsvFault naming the line.
    """
    content = _text(Path(path)).splitlines()
    first = next((number for number, line in enumerate(content) if not line.startswith("#")), len(content))
    lines = csv.reader(content[first:])
    try:
        header = [name.strip() for name in next(lines, [])]
        missing = [name for name in (*texts, *columns) if header.count(name) != 1]
        if missing:
            message = f"column {missing[0]} must stand once in its first line, separated by commas"
            raise CsvFault(f"{message}; it has {', '.join(header)[:200] or 'none'}")
        numbers = [*columns, *(optional if set(optional) <= set(header) else ())]
        rows = []
        for cells in lines:
            if any(cell.strip() for cell in cells):
                rows.append(_row(first + lines.line_num, header, cells, numbers, texts))
    except csv.Error as error:
        raise CsvFault(f"line {first + lines.line_num}: {error}") from None
    if not rows:
        raise CsvFault("it holds no numbers")
    return CsvTable([line.lstrip("# ").strip() for line in content[:first]], rows)


def _row(
    line: int, header: Sequence[str], cells: Sequence[str], columns: Sequence[str], texts: Sequence[str]
) -> tuple[CsvRow, dict[str, str]]:
    if len(cells) != len(header):
        raise CsvFault(f"line {line}: {len(cells)} values under {len(header)} column names")
    by_column = dict(zip(header, cells, strict=True))
    numbers = {name: _number(line, name, by_column[name]) for name in columns}
    return CsvRow(line, numbers), {name: by_column[name].strip() for name in texts}


def _number(line: int, name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or "_" in text:
        raise CsvFault(f"line {line}: {name} = {text.strip()[:40]!r} is not a finite number")
    return value


def _text(path: Path) -> str:
    try:
        if path.is_dir():
            raise CsvFault("it is a directory, not a csv file")
        with open(path, "rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise CsvFault("no such file") from None
    except (OSError, ValueError) as error:
        raise CsvFault(f"it cannot be read ({getattr(error, 'strerror', None) or error})") from None
    if len(content) > LARGEST_FILE:
        raise CsvFault(f"it is longer than {LARGEST_FILE} bytes")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise CsvFault(f"line {line}: byte {content[error.start]:#04x} is not UTF-8") from None
