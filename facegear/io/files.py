"""Read and write one part of what a stage gives, in the format that the ending of its file names."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from facegear.io import arrays, documents
from facegear.io.atomic import atomic_path


def read_part(
    path: Path,
    holds: Mapping[str, tuple[int | None, ...]] | Sequence[str] = (),
    may_be_empty: bool = False,
    text: Sequence[str] = (),
) -> Any:
    """A table, a mapping of arrays or a record.

    `holds`: columns of a table, shapes of arrays, keys of a record; `text`: columns that stay text. Raises
    CorruptFile if the file is missing, altered or lacks something.
    """
    if path.suffix == ".npz":
        return arrays.read(path, holds if isinstance(holds, Mapping) else {})
    if path.suffix == ".parquet":
        # Imported here: only the results of many samples need its library.
        from facegear.io import columnar

        return columnar.read(path, tuple(holds))
    if path.suffix == ".json":
        return documents.read(path, tuple(holds))
    # Imported here: pandas takes half a second, which jobs without a table would pay as well.
    from facegear.io import tables

    return tables.read(path, tuple(holds), may_be_empty, text)


def write_part(path: str | Path, part: Any) -> None:
    """Write csv, parquet, npz, json or vtu; bytes are written as they are."""
    path = Path(path)
    if isinstance(part, bytes):
        with atomic_path(path) as temporary:
            temporary.write_bytes(part)
    elif path.suffix == ".csv":
        from facegear.io import tables

        tables.write(path, part)
    elif path.suffix == ".parquet":
        from facegear.io import columnar

        columnar.write(path, part)
    elif path.suffix == ".npz":
        arrays.write(path, **part)
    elif path.suffix == ".vtu":
        from facegear.io.meshes import write_vtu

        write_vtu(path, *part)
    else:
        documents.write(path, part)
