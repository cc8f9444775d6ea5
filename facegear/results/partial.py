"""Results of a report that was stopped: each stage's files are kept until the page is complete."""

import hashlib
import shutil
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.errors import CorruptFile
from facegear.io import documents
from facegear.io.atomic import require_writable
from facegear.io.files import write_part
from facegear.pipeline.stage import File
from facegear.pipeline.table import STAGES
from facegear.provenance.fingerprint import stage_fingerprint
from facegear.provenance.manifest import write_manifest

if TYPE_CHECKING:
    from facegear.stages.outcome import Outcome

ROOT = Path(__file__).parents[2]
MANIFEST = "partial.provenance.json"
"""Record beside the files of a stage; it is written last."""
COMMAND = "facegear report"
"""Command that makes a damaged file again."""


@dataclass(frozen=True)
class PartialResults:
    """A folder of stages' files, each below a name made of all that decides them: config and code.

    Attributes
    ----------
    folder
        Where the files are; made when the first stage is kept.
    """

    folder: Path

    def require_usable(self) -> None:
        """Check before work is done that stages can be kept.

        Raises
        ------
        FacegearError
            Where a file stands in the place of the folder, or nothing can be written to it.
        """
        if self.folder.exists():
            require_writable(self.folder)

    def output(
        self, stages: list[str], key: str, compute: Callable[[], "Outcome"]
    ) -> tuple[Mapping[str, Any], str, bool]:
        """Find what a stage gave, or compute and keep it.

        Parameters
        ----------
        stages : list of str
            The stage and all before it.
        key : str
            The part of the config that they depend on, as text.
        compute : callable
            Computes the stage.

        Returns
        -------
        content : mapping
            Parts of the stage by name.
        summary : str
            Its line.
        is_kept : bool
            Whether it was kept.
        """
        name = stages[0]
        files, subfolder = STAGES[name].readable, self._subfolder(stages, key)
        try:
            content = {part: file.read(subfolder / _name(part, file)) for part, file in files.items()}
            return content, documents.read(subfolder / MANIFEST, ["summary"])["summary"], True
        except CorruptFile:
            pass  # not kept, or not to its end
        start = time.perf_counter()
        outcome = compute()
        parts = {_name(part, file): outcome.content[part] for part, file in files.items()}
        self._keep(subfolder, name, parts, outcome.summary, start)
        return outcome.content, outcome.summary, False

    def part(self, stages: list[str], key: str, file: File, compute: Callable[[], Any]) -> Any:
        """Find the content of one file of a stage with wildcards, or compute and keep it.

        Parameters
        ----------
        stages : list of str
            The stage and all before it.
        key : str
            The part of the config that they depend on, and the wildcards, as text.
        file : File
            The file.
        compute : callable
            Computes its content.

        Returns
        -------
        Any
            The content.
        """
        subfolder, name = self._subfolder(stages, key), _name("part", file)
        try:
            return file.read(subfolder / name)
        except CorruptFile:
            pass
        start = time.perf_counter()
        content = compute()
        self._keep(subfolder, stages[0], {name: content}, "", start)
        return content

    def remove(self) -> None:
        """Remove what was kept."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _subfolder(self, stages: list[str], key: str) -> Path:
        codes = [stage_fingerprint(STAGES[stage].functions, ROOT) for stage in stages]
        digest = hashlib.sha256("\n".join([key, *codes]).encode()).hexdigest()
        return self.folder / f"{stages[0]}_{digest[:16]}"

    def _keep(self, subfolder: Path, name: str, parts: Mapping[str, Any], summary: str, start: float) -> None:
        for file, content in parts.items():
            write_part(str(subfolder / file), content)
        seconds = time.perf_counter() - start
        paths = [subfolder / file for file in parts]
        write_manifest(subfolder / MANIFEST, paths, [], {}, name, seconds, summary, COMMAND)


def _name(part: str, file: File) -> str:
    return part + Path(file.path).suffix
