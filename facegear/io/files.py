"""Read and write one part of what a stage gives, in the format that the ending of its file names."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from facegear.io import arrays, documents, tables
from facegear.io.atomic import atomic_path


def read_part(
    path: Path,
    holds: Mapping[str, tuple[int | None, ...]] | Sequence[str] = (),
    may_be_empty: bool = False,
    text: Sequence[str] = (),
) -> Any:
    """Read a file of a stage by its suffix: arrays (npz), a columnar table (parquet), a record (json) or
    else csv.

    Parameters
    ----------
    path : Path
        Path of the file.
    holds : Mapping[str, tuple[int | None, ...]] | Sequence[str]
        What must be there: columns of a table, shapes of arrays by name, or keys of a record.
    may_be_empty : bool
        Whether a csv table may have no rows.
    text : Sequence[str]
        Columns of a csv table that stay text.

    Returns
    -------
    Any
        A DataFrame, a dictionary of arrays, or a dictionary.

    Raises
    ------
    CorruptFile
        If the file is missing, altered or lacks something.
    """
    if path.suffix == ".npz":
        return arrays.read(path, holds if isinstance(holds, Mapping) else {})
    if path.suffix == ".parquet":
        # Imported here: only the results of many samples need its library.
        from facegear.io import columnar

        return columnar.read(path, tuple(holds))
    if path.suffix == ".json":
        return documents.read(path, tuple(holds))
    return tables.read(path, tuple(holds), may_be_empty, text)


def write_part(path: str | Path, part: Any) -> None:
    """Write a part of a stage's results in the format of the path's suffix: csv, parquet, npz, vtu or
    else json.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    part : Any
        A DataFrame (csv, parquet), a mapping of arrays (npz), the arguments of `write_vtu` after the path
        (vtu) or a dictionary (json). Bytes are written as they are, whatever the suffix.
    """
    path = Path(path)
    if isinstance(part, bytes):
        with atomic_path(path) as temporary:
            temporary.write_bytes(part)
    elif path.suffix == ".csv":
        tables.write(path, part)
    elif path.suffix == ".parquet":
        from facegear.io import columnar  # pyarrow, a library of an extra

        columnar.write(path, part)
    elif path.suffix == ".npz":
        arrays.write(path, **part)
    elif path.suffix == ".vtu":
        from facegear.io.meshes import write_vtu  # meshio, a library of an extra

        write_vtu(path, *part)
    else:
        documents.write(path, part)
