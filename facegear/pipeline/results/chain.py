"""The stages one after the other in one process, and the machine in short for the terminal."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Never, TypeVar

from facegear.pipeline.needs import resolved_needs, shared_sources
from facegear.pipeline.outcome import Outcome
from facegear.pipeline.report_tables import REPORT_TABLES, asked_for, table_name
from facegear.pipeline.results.base import Result, StageOutput
from facegear.pipeline.results.store import Store
from facegear.pipeline.run import call
from facegear.pipeline.stage import NO_WILDCARDS, Case, From, Wildcards
from facegear.pipeline.table import STAGES
from facegear.report.data_sheet import DATA_SHEET, data_sheet_table
from facegear.report.first_screen import found_in_words, key_cards
from facegear.report.verdicts import status_line, verdicts

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd

Kind = TypeVar("Kind", bound=Result)


@dataclass(frozen=True, eq=False)
class Chain:
    """Stages of one case, computed in this process without files, each with the stages that it takes
    from.

    - values: plain values of the whole config
    - store: memory and files in which results are looked for before they are computed
    - cases: all cases of the config by their id, for stages that set those of its studies side by side

    A stage is imported where it runs, so that modes load no mesh and no compiler.
    """

    values: Mapping[str, Any]
    store: Store
    cases: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @cached_property
    def case(self) -> Case:
        """The case among those of its config. It does not hold the chain: results are freed with it."""
        cases = self.cases
        return Case(self.values, cases, lambda stage, case: shared_sources(cases, stage)[case])

    def result(self, kind: type[Kind], **extra_arguments: Any) -> Kind:
        """Return the stage's output as an object of the class of results, computed if it is not known.

        Parameters
        ----------
        kind : type[Kind]
            Class of the result; its STAGE and BESIDE say what is read.
        **extra_arguments : Any
            Arguments of the stage's function that decide no number, such as `threads`.

        Returns
        -------
        Kind
            The result.
        """
        output = self.output(kind.STAGE, **extra_arguments)
        beside = {name: self.part(*source) for name, source in kind.BESIDE.items()}
        return kind({**output.content, **beside}, output.summary, output.source, self.values)

    def output(self, name: str, **extra_arguments: Any) -> StageOutput:
        """Return all files of a stage, computed if they are not known, and where they came from.

        Parameters
        ----------
        name : str
            Name of the stage.
        **extra_arguments : Any
            Arguments of the stage's function that decide no number, such as `threads`.

        Returns
        -------
        StageOutput
            Output of the stage.
        """
        return self.store.output(name, self.values, lambda: self.compute(name, **extra_arguments))

    def arguments(self, name: str) -> dict[str, Any]:
        """Return all arguments of a stage, from the config and from earlier stages, which are computed
        if they are not known.

        Parameters
        ----------
        name : str
            Name of the stage.

        Returns
        -------
        dict[str, Any]
            Arguments by name.
        """
        stage = STAGES[name]
        return {**self.upstream_arguments(stage.upstream), **resolved_needs(stage.needs, self.case)}

    def upstream_arguments(self, upstream: Mapping[str, From]) -> dict[str, Any]:
        """Return the arguments that are files of earlier stages, which are computed if they are not
        known.

        Parameters
        ----------
        upstream : Mapping[str, From]
            Source of each argument by name.

        Returns
        -------
        dict[str, Any]
            Tables, arrays or records by name of the argument, a list where a source stands for several
            files; arguments that the case does not need are left out.
        """
        needed_sources = {key: source for key, source in upstream.items() if source.is_needed(self.case)}
        return {key: self._read_source(source) for key, source in needed_sources.items()}

    def compute(self, name: str, wildcards: Wildcards = NO_WILDCARDS, **extra_arguments: Any) -> "Outcome":
        """Compute a stage now, without a look into the store; earlier stages still come from it.

        Parameters
        ----------
        name : str
            Name of the stage.
        wildcards : Wildcards
            Text of each wildcard by name.
        **extra_arguments : Any
            Arguments of the stage's function that decide no number, such as `threads`.

        Returns
        -------
        Outcome
            Content of the stage's files by name, and one line about it.
        """
        stage = STAGES[name]
        return call(stage, self.arguments(name), **stage.typed_wildcards(wildcards), **extra_arguments)

    def part(self, name: str, file: str, wildcards: Wildcards = NO_WILDCARDS) -> Any:
        """Return the content of one file of a stage, computed if it is not known.

        Parameters
        ----------
        name : str
            Name of the stage.
        file : str
            Name of the file.
        wildcards : Wildcards
            Text of each wildcard by name, for stages that write such a file more than once.

        Returns
        -------
        Any
            A table, arrays or a record.
        """
        if not STAGES[name].wildcards:
            return self.store.output(name, self.values, lambda: self.compute(name)).content[file]
        return self.store.part(
            name, file, wildcards, self.values, lambda: self.compute(name, wildcards).content[file]
        )

    def _read_source(self, source: From) -> Any:
        """Return the content of the file of an earlier stage, of another case if its wildcards name
        one; a list for several files.
        """
        parts = [
            self._of(wildcards.get("case")).part(source.stage, source.file, _without_case(wildcards))
            for wildcards in source.file_wildcards(self.case)
        ]
        return parts if source.each_wildcards else parts[0]

    def _of(self, case: str | None) -> "Chain":
        """Return the chain of another case of the same config, with its own folder in the store; this
        chain for None.
        """
        chain = self.values["case"]
        if case is None or case == chain:
            return self
        folder = self.store.folder
        if folder is None:
            return Chain(self.cases[case], replace(self.store, folder=None, other_cases=()))
        folders = [folder / Path(name).relative_to(chain) for name in self.cases if name != case]
        below = folder / Path(case).relative_to(chain)
        return Chain(self.cases[case], replace(self.store, folder=below, other_cases=tuple(folders)))


def _without_case(wildcards: Wildcards) -> dict[str, str]:
    """Return wildcards without `case`, which names a case and is no wildcard of a stage."""
    return {name: text for name, text in wildcards.items() if name != "case"}


def summary_text(chain: Chain) -> str:
    """Write what is known of a machine as lines for the terminal.

    Parameters
    ----------
    chain : Chain
        The stages of the machine. The geometry of the teeth is computed if it is not known, nothing else is.

    Returns
    -------
    str
        Status, key numbers, verdicts with their reasons, and gear data.
    """
    has_bodies = chain.values["tooth_pair"]["pinion"] is not None
    pair = chain.part("geometry", "pair") if has_bodies else None
    tables = dict(_known_tables(chain))
    judgements = verdicts(chain.values, tables, pair)
    _, first, sentence = status_line(judgements, found_in_words(tables))
    keys = [
        (card.name, card.value, f"({card.beside})" if card.beside else "")
        for card in key_cards(chain.values, tables, pair)
    ]
    reasons = [
        (
            verdict.colour,
            verdict.subject,
            " ".join([verdict.reason, *(f"[{mark}]" for mark in verdict.caveats)]),
        )
        for verdict in judgements
    ]
    head = f"{chain.values['case']}. {first} {sentence}"
    parts = [head, "\n".join(_align_columns(keys)), "\n".join(_align_columns(reasons))]
    if pair is not None:
        rows = data_sheet_table(pair)
        sheet = [tuple(rows.columns), *rows.itertuples(index=False, name=None)]
        parts.append("\n".join([f"{DATA_SHEET}:", *_align_columns(sheet)]))
    return "\n\n".join(parts)


def _known_tables(chain: Chain) -> "Iterator[tuple[str, pd.DataFrame]]":
    """Yield name and content of each table of the report that is known in this session, or stored and
    up to date.
    """
    for name, files in REPORT_TABLES.items():
        if not asked_for(name, chain.case):
            continue
        try:
            content: Mapping[str, Any] = chain.store.output(name, chain.values, _refuse_to_compute).content
        except _NotKnownError:
            continue
        for file in files:
            yield table_name(STAGES[name].files[file].path), content[file].reset_index(drop=True)


class _NotKnownError(Exception):
    """Raised for a stage whose results are not known."""


def _refuse_to_compute() -> Never:
    """Raise _NotKnownError; it stands in the place of a computation where only known results are
    wanted.
    """
    raise _NotKnownError


def _align_columns(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Return rows of texts as lines, each column padded to its widest cell, two spaces between columns."""
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]
