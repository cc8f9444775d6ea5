"""Where the results of a machine come from: known in this session, else stored and current, else computed."""

import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from facegear.errors import CorruptFile, FacegearError, extras_named
from facegear.pipeline.needs import stage_needs, stages_before
from facegear.pipeline.stage import Wildcards
from facegear.pipeline.table import STAGES
from facegear.results.base import StageOutput

if TYPE_CHECKING:
    from facegear.results.partial import PartialResults
    from facegear.stages.outcome import Outcome

Value = TypeVar("Value")
Values = Mapping[str, Any]
ROOT = Path(__file__).parents[2]


@dataclass(frozen=True, eq=False)
class Store:
    """Results by the part of the config that they depend on; `values` are those of a whole config.

    `folder` is that of the case in the workflow's results, None to read nothing; `other_cases` are folders of
    cases of the same config, with which this case may share files. `partial` keeps what is computed for a
    report, None to keep nothing; `failures` keeps errors, so that no stage fails twice. Changed copies of a
    machine share a store: what a change does not touch is found again.
    """

    folder: Path | None = None
    outputs: dict[str, Any] = field(default_factory=dict)
    other_cases: tuple[Path, ...] = ()
    partial: "PartialResults | None" = None
    failures: dict[str, FacegearError] | None = None

    @property
    def folders(self) -> tuple[Path, ...]:
        """All folders in which a file may lie."""
        return () if self.folder is None else (self.folder, *self.other_cases)

    def output(self, name: str, values: Values, compute: Callable[[], "Outcome"]) -> StageOutput:
        """Return all that a stage gives: known already, else stored and current, else computed.

        Parameters
        ----------
        name : str
            Name of the stage.
        values : Values
            Plain values of a whole config.
        compute : Callable[[], 'Outcome']
            Function that computes the stage.

        Returns
        -------
        StageOutput
            Output of the stage.
        """

        def find() -> StageOutput:
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
        """Return one file of a stage that has wildcards: known already, else stored and current, else
        computed.

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
            Function that computes the file's content.

        Returns
        -------
        Any
            A table, arrays or a record.
        """

        def find() -> Any:
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
        """Return what `find` gives; it is kept under the part of the config that it depends on."""
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
        """Everything of the config that a part of a stage depends on, as text."""
        needs = [stage_needs(stage, values) for stage in stages_before(name, values)]
        return json.dumps([name, part, needs])

    def _read_stored(self, name: str, values: Values, folder: Path) -> StageOutput | None:
        summary, files = "", STAGES[name].readable
        for file in files.values():
            manifest = self._current_manifest(folder / file.path, values)
            if manifest is None:
                return None
            summary = manifest["summary"]
        content = _unless_corrupt(lambda: {key: file.read(folder / file.path) for key, file in files.items()})
        return None if content is None else StageOutput(content, summary, "stored")

    def _current_manifest(self, path: Path, values: Values) -> Mapping[str, Any] | None:
        from facegear.provenance.current import current_manifest
        from facegear.provenance.fingerprint import stage_fingerprint

        return current_manifest(
            path,
            lambda rule: stage_needs(rule, values) if rule in STAGES else None,
            lambda rule: stage_fingerprint(STAGES[rule].functions, ROOT),
        )


def case_folder(folders: Iterable[Path], results: str | Path, case: str) -> Path | None:
    """Return the folder of a case below the results.

    Parameters
    ----------
    folders : Iterable[Path]
        Folders in which relative results are looked for.
    results : str or Path
        Folder of the results.
    case : str
        Name of the case.

    Returns
    -------
    Path or None
        The folder; None where there is none that may be entered.
    """
    case_path = [folder / results / case for folder in folders]
    return next((folder for folder in case_path if os.access(folder, os.R_OK | os.X_OK)), None)


def _unless_corrupt(read: Callable[[], Value]) -> Value | None:
    """Return the stored content; None, with a warning, if it is damaged."""
    try:
        return read()
    except CorruptFile as error:
        warnings.warn(f"{error}; computed anew", stacklevel=7)
        return None
