"""Write what a stage found, each file in the format that its ending names."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from facegear.io import arrays, documents, tables


def write_all(content: Mapping[str, Any], paths: Mapping[str, str | Path]) -> None:
    """Write every part of `content` to the path of the same name: csv, parquet, npz or json."""
    for name, part in content.items():
        path = Path(paths[name])
        if path.suffix == ".csv":
            tables.write(path, part)
        elif path.suffix == ".parquet":
            # Imported here: only the results of many samples need its library.
            from facegear.io import columnar

            columnar.write(path, part)
        elif path.suffix == ".npz":
            arrays.write(path, **part)
        else:
            documents.write(path, part)
