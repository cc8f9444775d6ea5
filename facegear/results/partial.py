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
"""What makes a damaged file again."""


@dataclass(frozen=True)
class PartialResults:
    """A folder of stages' files, each below a name made of all that decides them: config and code.

    Attributes
    ----------
    folder
        Where the files are; made when the first stage is kept.
    """

    folder: Path

    def output(
        self, stages: list[str], key: str, compute: Callable[[], "Outcome"]
    ) -> tuple[Mapping[str, Any], str, bool]:
        """Content and summary of a stage, and whether they were kept; computed and kept otherwise.

        `stages`: the stage and all before it; `key`: the part of the config that they depend on.
        """
        name = stages[0]
        files, place = STAGES[name].readable, self._place(stages, key)
        try:
            content = {part: file.read(place / _name(part, file)) for part, file in files.items()}
            return content, documents.read(place / MANIFEST, ["summary"])["summary"], True
        except CorruptFile:
            pass  # not kept, or not to its end
        start = time.perf_counter()
        outcome = compute()
        parts = {_name(part, file): outcome.content[part] for part, file in files.items()}
        self._keep(place, name, parts, outcome.summary, start)
        return outcome.content, outcome.summary, False

    def part(self, stages: list[str], key: str, file: File, compute: Callable[[], Any]) -> Any:
        """The content of one file of a stage with wildcards, which `key` must hold."""
        place, name = self._place(stages, key), _name("part", file)
        try:
            return file.read(place / name)
        except CorruptFile:
            pass
        start = time.perf_counter()
        content = compute()
        self._keep(place, stages[0], {name: content}, "", start)
        return content

    def remove(self) -> None:
        """Remove what was kept."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _place(self, stages: list[str], key: str) -> Path:
        codes = [stage_fingerprint(STAGES[stage].modules, ROOT) for stage in stages]
        digest = hashlib.sha256("\n".join([key, *codes]).encode()).hexdigest()
        return self.folder / f"{stages[0]}_{digest[:16]}"

    def _keep(self, place: Path, name: str, parts: Mapping[str, Any], summary: str, start: float) -> None:
        for file, content in parts.items():
            write_part(str(place / file), content)
        seconds = time.perf_counter() - start
        paths = [place / file for file in parts]
        write_manifest(place / MANIFEST, paths, [], {}, name, seconds, summary, COMMAND)


def _name(part: str, file: File) -> str:
    return part + Path(file.path).suffix
