"""Read and write csv tables; units stand in the column names."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.errors import CorruptFile
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
    """Read a table that must hold some columns, whose numbers there must be finite.

    Columns of NAMES and `text` stay text, so that a body may be called 12, NA or nan.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    columns : Sequence[str]
        Columns that the table must hold.
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
