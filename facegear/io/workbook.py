"""Write and read tables as sheets of an Excel workbook; units stand in the column names.

A workbook keeps 15 significant digits of a number.
"""

from collections.abc import Mapping
from pathlib import Path
from zipfile import BadZipFile

import pandas as pd

from facegear.errors import FacegearError, file_path, plain_reason
from facegear.io.atomic import atomic_path
from facegear.io.tables import NAMES

LONGEST_NAME = 31
"""Letters that Excel allows in the name of a sheet."""
MAX_ROWS = 1_048_575
"""Rows that Excel allows below the header."""


def write(path: str | Path, tables: Mapping[str, pd.DataFrame]) -> Path:
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


def read(path: str | Path) -> dict[str, pd.DataFrame]:
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
    """One sheet; an empty cell in a column of NAMES is an empty text."""
    texts = dict.fromkeys(NAMES, str)
    frame = pd.read_excel(book, name, converters=texts, keep_default_na=False, na_values=[""])
    return frame.fillna({column: "" for column in frame.columns if column in texts})
