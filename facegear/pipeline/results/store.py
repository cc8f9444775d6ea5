"""Where the results of a machine come from: known in this session, stored and current, or computed."""

import hashlib
import json
import os
import shutil
import time
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from facegear.errors import CorruptFile, FacegearError, extras_named
from facegear.io import documents
from facegear.io.atomic import require_writable
from facegear.io.files import write_part
from facegear.pipeline.needs import stage_needs, stages_before
from facegear.pipeline.outcome import Outcome
from facegear.pipeline.provenance.fingerprint import stage_fingerprint
from facegear.pipeline.provenance.manifest import current_manifest, write_manifest
from facegear.pipeline.results.base import StageOutput
from facegear.pipeline.stage import File, Wildcards
from facegear.pipeline.table import STAGES

ROOT = Path(__file__).parents[3]
"""Folder of the packages, whose code fingerprints are taken from."""
MANIFEST = "partial.provenance.json"
"""Record beside the files of a stage; it is written last."""
COMMAND = "facegear report"
"""Command that makes a damaged file again."""


@dataclass(frozen=True)
class PartialResults:
    """Results of stages that are kept in a folder until a report is complete, so that a stopped report
    goes on from there.

    Each stage has a subfolder whose name is a hash of all that decides its results: config values and
    code.

    Attributes
    ----------
    folder
        Where the files are; made when the first stage is kept.
    """

    folder: Path

    def require_usable(self) -> None:
        """Check, before work is done, that files can be written to the folder where it exists.

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
        """Return a stage's output from its subfolder, or compute it and write it there.

        Parameters
        ----------
        stages : list of str
            Name of the stage first, then of all stages before it; their code is part of the subfolder's
            name.
        key : str
            Config values on which they depend, as text (`Store._key`).
        compute : callable
            Function without arguments that computes the stage.

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
        """Return the content of one file of a stage with wildcards from its subfolder, or compute it
        and write it there.

        Parameters
        ----------
        stages : list of str
            Name of the stage first, then of all stages before it.
        key : str
            The part of the config that they depend on, and the wildcards, as text.
        file : File
            The file.
        compute : callable
            Function without arguments that computes the file's content.

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
        """Remove the folder with all that was kept."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _subfolder(self, stages: list[str], key: str) -> Path:
        """Return the subfolder of a stage: its name and a hash of `key` and of the code of all
        `stages`.
        """
        codes = [stage_fingerprint(STAGES[stage].functions, ROOT) for stage in stages]
        digest = hashlib.sha256("\n".join([key, *codes]).encode()).hexdigest()
        return self.folder / f"{stages[0]}_{digest[:16]}"

    def _keep(self, subfolder: Path, name: str, parts: Mapping[str, Any], summary: str, start: float) -> None:
        """Write the parts of a stage (content by file name), and last their manifest, which shows that
        they are complete.

        `start` is the value of time.perf_counter (s) at which the computation began.
        """
        for file, content in parts.items():
            write_part(str(subfolder / file), content)
        seconds = time.perf_counter() - start
        paths = [subfolder / file for file in parts]
        write_manifest(subfolder / MANIFEST, paths, [], {}, name, seconds, summary, COMMAND)


def _name(part: str, file: File) -> str:
    """Return the file name of a part: its name with the ending of the stage's file."""
    return part + Path(file.path).suffix


Value = TypeVar("Value")
Values = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Store:
    """Memory of results by the part of the config that they depend on, in front of files and of
    computation.

    - folder: the case's folder in the workflow's results, None to read nothing
    - outputs: results of this session, by `_key`
    - other_cases: folders of cases of the same config, with which this case may share files
    - partial: folder that keeps what is computed for a report, None to keep nothing
    - failures: errors by `_key`, so that no stage fails twice; None to keep none

    Changed copies of a machine share a store: what a change does not touch is found again.
    """

    folder: Path | None = None
    outputs: dict[str, Any] = field(default_factory=dict)
    other_cases: tuple[Path, ...] = ()
    partial: "PartialResults | None" = None
    failures: dict[str, FacegearError] | None = None

    @property
    def folders(self) -> tuple[Path, ...]:
        """All folders in which a stored file may lie, the case's own first; none if nothing is read."""
        return () if self.folder is None else (self.folder, *self.other_cases)

    def output(self, name: str, values: Values, compute: Callable[[], "Outcome"]) -> StageOutput:
        """Return all files of a stage: those of this session, else stored and up to date, else
        computed.

        Parameters
        ----------
        name : str
            Name of the stage.
        values : Values
            Plain values of a whole config.
        compute : Callable[[], 'Outcome']
            Function without arguments that computes the stage; it is not called where results are
            found.

        Returns
        -------
        StageOutput
            Content by file name, summary, and whether it was computed or stored.
        """

        def find() -> StageOutput:
            """Return the output from a folder of the workflow, from the partial results, or by
            computing it.
            """
            for folder in self.folders:
                stored_output = self._read_stored(name, values, folder)
                if stored_output is not None:
                    return stored_output
            if self.partial is not None:
                stages, key = stages_before(name, values), self._key(name, (), values)
                content, summary, is_kept = self.partial.output(stages, key, compute)
                return StageOutput(content, summary, "stored" if is_kept else "computed")
            outcome = compute()
            return StageOutput(outcome.content, outcome.summary, "computed")

        return self._once(name, (), values, find)

    def part(
        self, name: str, file: str, wildcards: Wildcards, values: Values, compute: Callable[[], Any]
    ) -> Any:
        """Return one file of a stage that has wildcards: that of this session, else stored and up to
        date, else computed.

        Parameters
        ----------
        name : str
            Name of the stage.
        file : str
            Name of the file.
        wildcards : Wildcards
            Text of each wildcard by name.
        values : Values
            Plain values of a whole config.
        compute : Callable[[], Any]
            Function without arguments that computes the file's content.

        Returns
        -------
        Any
            A table, arrays or a record.
        """

        def find() -> Any:
            """Return the content from a folder of the workflow, from the partial results, or by
            computing it.
            """
            kept_content = STAGES[name].files[file]
            for path in (folder / kept_content.at(wildcards) for folder in self.folders):
                if self._current_manifest(path, values):
                    stored_content = _unless_corrupt(partial(kept_content.read, path))
                    if stored_content is not None:
                        return stored_content
            if self.partial is not None:
                key = self._key(name, (file, *wildcards.values()), values)
                return self.partial.part(stages_before(name, values), key, kept_content, compute)
            return compute()

        return self._once(name, (file, *wildcards.values()), values, find)

    def _once(self, name: str, part: tuple[str, ...], values: Values, find: Callable[[], Value]) -> Value:
        """Return what `find` gives, called once for each part of the config on which it depends.

        `part` is empty for all of a stage, else name of the file and wildcards. An error is raised
        again where `failures` keeps it.
        """
        key = self._key(name, part, values)
        if self.failures is not None and key in self.failures:
            raise self.failures[key]
        if key not in self.outputs:
            try:
                with extras_named():
                    self.outputs[key] = find()
            except FacegearError as error:
                if self.failures is not None:
                    self.failures[key] = error
                raise
        return self.outputs[key]

    def _key(self, name: str, part: tuple[str, ...], values: Values) -> str:
        """Return, as JSON text, stage, part, and all config values on which these depend: its own needs
        and those before it.
        """
        needs = [stage_needs(stage, values) for stage in stages_before(name, values)]
        return json.dumps([name, part, needs])

    def _read_stored(self, name: str, values: Values, folder: Path) -> StageOutput | None:
        """Return the output of a stage from files below a case's folder; None unless all are there,
        undamaged and up to date.
        """
        summary, files = "", STAGES[name].readable
        for file in files.values():
            manifest = self._current_manifest(folder / file.path, values)
            if manifest is None:
                return None
            summary = manifest["summary"]
        content = _unless_corrupt(lambda: {key: file.read(folder / file.path) for key, file in files.items()})
        return None if content is None else StageOutput(content, summary, "stored")

    def _current_manifest(self, path: Path, values: Values) -> Mapping[str, Any] | None:
        """Return the manifest of a stored file if its config values, code and inputs are those of now,
        else None.
        """
        return current_manifest(
            path,
            lambda rule: stage_needs(rule, values) if rule in STAGES else None,
            lambda rule: stage_fingerprint(STAGES[rule].functions, ROOT),
        )


def case_folder(folders: Iterable[Path], results: str | Path, case: str) -> Path | None:
    """Return the first folder `<folder>/<results>/<case>` that exists and may be entered.

    Parameters
    ----------
    folders : Iterable[Path]
        Folders in which relative results are looked for.
    results : str or Path
        Folder of the results, relative to each of `folders` or absolute.
    case : str
        Id of the case.

    Returns
    -------
    Path or None
        The folder; None where there is none that may be entered.
    """
    case_path = [folder / results / case for folder in folders]
    return next((folder for folder in case_path if os.access(folder, os.R_OK | os.X_OK)), None)


def _unless_corrupt(read: Callable[[], Value]) -> Value | None:
    """Return what `read` gives; None, with a warning, if the stored file is damaged."""
    try:
        return read()
    except CorruptFile as error:
        warnings.warn(f"{error}; computed anew", stacklevel=7)
        return None
