"""Base of all results: their content, where it came from, and the files they are kept in."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

import pandas as pd

from facegear.errors import FacegearError, extras_named, file_path
from facegear.pipeline.run import write_stage
from facegear.pipeline.table import STAGES

Source = Literal["computed", "stored"]


@dataclass(frozen=True, eq=False)
class StageOutput:
    """Output of a stage: parts by name, one line, whether it was computed now or stored by the workflow."""

    content: Mapping[str, Any]
    summary: str
    source: Source


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """One stage's results; `source` says whether they were computed now or stored by the workflow.

    Its tables are pandas frames; the unit of a column stands at the end of its name (`_um`, `_n_per_m`), and
    a column without one is a name, a count, a fraction or a ratio.

    - STAGE: name of the stage
    - BESIDE: parts that are shown with them, each from a file of another stage
    """

    STAGE: ClassVar[str]
    BESIDE: ClassVar[Mapping[str, tuple[str, str]]] = {}

    content: Mapping[str, Any]
    summary: str
    source: Source
    values: Mapping[str, Any] = field(repr=False)

    def __post_init__(self) -> None:
        """Keep a copy of the config, so that no change of it by a user reaches later answers."""
        object.__setattr__(self, "values", deepcopy(self.values))

    def save(self, folder: str | Path) -> list[Path]:
        """Write the files that the workflow writes for this stage, below a folder.

        Parameters
        ----------
        folder : str or Path
            The folder.

        Returns
        -------
        list[Path]
            Paths of the files.
        """
        stage, folder = STAGES[self.STAGE], file_path(folder, "folder")
        paths = {name: str(folder / file.path) for name, file in stage.files.items()}
        return write_stage(stage, self.content, paths)

    def to_excel(self, path: str | Path) -> Path:
        """Write every table as a sheet of one workbook (.xlsx).

        Parameters
        ----------
        path : str or Path
            File to write.

        Returns
        -------
        Path
            The path. Raises MissingExtra where openpyxl is not installed.
        """
        from facegear.io.workbook import write

        with extras_named():
            return write(path, self._sheets())

    def _sheets(self) -> dict[str, pd.DataFrame]:
        """Return the tables of a workbook by the names of its sheets."""
        return {name: part for name, part in self.content.items() if isinstance(part, pd.DataFrame)}

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.source}: {self.summary})"


def require_answers(beside: object, kind: type[Result]) -> None:
    """Refuse what is not answers of one kind by label, as figures of several gearboxes take them.

    Parameters
    ----------
    beside : mapping of str to Result
        Answers of other gearboxes by label.
    kind : type
        Class of the answers.

    Raises
    ------
    FacegearError
        For anything else.
    """
    if not isinstance(beside, Mapping) or not all(isinstance(answer, kind) for answer in beside.values()):
        raise FacegearError(
            f"beside = {beside!r}: must be answers of other gearboxes of the same kind by label"
        )
