"""Read and write columnar tables (parquet) that pandas, polars or DuckDB open."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from facegear.errors import CorruptFile
from facegear.io.atomic import atomic_path, verify


def write(path: str | Path, frame: pd.DataFrame) -> None:
    """Write a table, compressed; the same table gives the same bytes.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    frame : pd.DataFrame
        The table.
    """
    with atomic_path(path) as temporary:
        pq.write_table(pa.Table.from_pandas(frame, preserve_index=False), temporary, compression="zstd")


def read(path: str | Path, columns: Sequence[str] = ()) -> pd.DataFrame:
    """Read a parquet table that must hold some columns, after it is checked against its manifest.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    columns : Sequence[str]
        Columns that the table must hold; all others are read as well.

    Returns
    -------
    pd.DataFrame
        The table.

    Raises
    ------
    CorruptFile
        If it is missing, altered, truncated or lacks a column.
    """
    verify(path)
    try:
        frame = pq.read_table(path).to_pandas()
    except (pa.ArrowException, OSError) as error:
        raise CorruptFile(path, f"not a readable table ({str(error).splitlines()[0]})") from None
    missing_columns = [name for name in columns if name not in frame.columns]
    if missing_columns:
        raise CorruptFile(path, f"column {missing_columns[0]!r} is missing")
    return frame
