"""What all results share: their content, where it came from, and the files they are kept in."""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

from facegear.io import arrays, documents, tables
from facegear.io.files import write_all


@dataclass(frozen=True)
class Kept:
    """The file of one part of a result below a case's folder, and what its reader asks of it.

    `holds`: columns of a table, shapes of arrays, keys of a record. `text`: columns that stay text.
    """

    path: str
    holds: Mapping[str, tuple[int | None, ...]] | Sequence[str] = ()
    may_be_empty: bool = False
    text: Sequence[str] = ()

    def read(self, folder: Path) -> Any:
        """The part as stored. Raises CorruptFile if it is missing, altered or lacks something."""
        path = folder / self.path
        if path.suffix == ".npz":
            return arrays.read(path, self.holds if isinstance(self.holds, Mapping) else {})
        if path.suffix == ".parquet":
            from facegear.io import columnar

            return columnar.read(path, tuple(self.holds))
        if path.suffix == ".json":
            return documents.read(path, tuple(self.holds))
        return tables.read(path, tuple(self.holds), self.may_be_empty, self.text)


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """One stage's results; `source` says whether they were computed now or stored by the workflow."""

    FILES: ClassVar[dict[str, Kept]] = {}

    content: Mapping[str, Any]
    summary: str
    source: Literal["computed", "stored"]
    values: Mapping[str, Any] = field(repr=False)

    def __post_init__(self) -> None:
        """Keep a copy of the config, so that no change of it by a user reaches later answers."""
        object.__setattr__(self, "values", deepcopy(self.values))

    def save(self, folder: str | Path) -> list[Path]:
        """Write the files that the workflow writes for this stage, below `folder`; returns their paths."""
        paths = {name: Path(folder) / kept.path for name, kept in self.FILES.items()}
        write_all({name: self.content[name] for name in paths}, paths)
        return list(paths.values())

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.source}: {self.summary})"
