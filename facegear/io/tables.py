"""Read and write tables as csv and as sheets of an Excel workbook; units stand in the column names.

A csv table has full double precision, a workbook keeps 15 significant digits of a number.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
import pandas as pd

from facegear.errors import CorruptFile, FacegearError, file_path, plain_reason
from facegear.io.atomic import atomic_path, verify

NAMES = ("body", "mesh", "body_or_mesh", "pinion", "group", "study", "point", "label", "reason", "caveat")
"""Columns of names that a user has given, or of sentences that may be empty."""


def write(path: str | Path, frame: pd.DataFrame) -> None:
    """Write a table with full double precision.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    frame : pd.DataFrame
        The table.
    """
    with atomic_path(path) as temporary:
        frame.to_csv(temporary, index=False)


def read(
    path: str | Path, columns: Sequence[str] = (), allow_empty: bool = False, text: Sequence[str] = ()
) -> pd.DataFrame:
    """Read a csv table that must hold some columns, whose numbers there must be finite.

    Columns of NAMES and `text` stay text, so that a body may be called 12, NA or nan. An empty cell is
    nan elsewhere. The file is checked against its manifest first.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    columns : Sequence[str]
        Columns that the table must hold; all others are read as well and may hold nan.
    allow_empty : bool
        Whether the table may have no rows.
    text : Sequence[str]
        Further columns that stay text.

    Returns
    -------
    pd.DataFrame
        The table.

    Raises
    ------
    CorruptFile
        If it is missing, altered, truncated, lacks a column or holds a number not finite.
    """
    verify(path)
    try:
        frame = pd.read_csv(
            path, converters=dict.fromkeys((*NAMES, *text), str), keep_default_na=False, na_values=[""]
        )
    except (ValueError, UnicodeDecodeError) as error:
        raise CorruptFile(path, f"not a readable table ({str(error).splitlines()[0]})") from None
    missing_columns = [name for name in columns if name not in frame.columns]
    if missing_columns:
        raise CorruptFile(path, f"column {missing_columns[0]!r} is missing")
    if frame.empty and not allow_empty:
        raise CorruptFile(path, "the table is empty")
    numbers = frame[list(columns)].select_dtypes("number")
    bad = [name for name in numbers.columns if not np.isfinite(numbers[name].to_numpy(float)).all()]
    if bad:
        raise CorruptFile(path, f"column {bad[0]!r} holds a value that is not finite")
    return frame


LONGEST_NAME = 31
"""Letters that Excel allows in the name of a sheet."""
MAX_ROWS = 1_048_575
"""Rows that Excel allows below the header."""


def write_workbook(path: str | Path, tables: Mapping[str, pd.DataFrame]) -> Path:
    """Write each table to a sheet of its name.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    tables : Mapping[str, pd.DataFrame]
        Tables by name of the sheet.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    FacegearError
        For what a workbook cannot hold.
    """
    path = file_path(path)
    if path.suffix != ".xlsx":
        raise FacegearError(f"path = {str(path)!r}: must end in .xlsx")
    if not tables:
        raise FacegearError(f"{path}: there is no table to write")
    for name, table in tables.items():
        if len(name) > LONGEST_NAME or len(table) > MAX_ROWS:
            limits = f"at most {MAX_ROWS} rows and {LONGEST_NAME} letters in its name"
            raise FacegearError(f"{path}: table {name!r} must have {limits}")
    with atomic_path(path) as temporary, pd.ExcelWriter(temporary, engine="openpyxl") as book:
        for name, table in tables.items():
            table.to_excel(book, sheet_name=name, index=False, freeze_panes=(1, 0))
    return path


def read_workbook(path: str | Path) -> dict[str, pd.DataFrame]:
    """Read all sheets of a workbook.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    dict[str, pd.DataFrame]
        Sheets by name.

    Raises
    ------
    FacegearError
        If there is no such workbook.
    """
    try:
        with pd.ExcelFile(path, engine="openpyxl") as book:
            return {str(name): _sheet(book, str(name)) for name in book.sheet_names}
    except (OSError, ValueError, KeyError, BadZipFile) as error:
        raise FacegearError(f"{path}: not a readable workbook ({plain_reason(error)})") from None


def _sheet(book: pd.ExcelFile, name: str) -> pd.DataFrame:
    """Read one sheet of a workbook; an empty cell is an empty text in a column of NAMES, else nan."""
    texts = dict.fromkeys(NAMES, str)
    frame = pd.read_excel(book, name, converters=texts, keep_default_na=False, na_values=[""])
    return frame.fillna({column: "" for column in frame.columns if column in texts})
