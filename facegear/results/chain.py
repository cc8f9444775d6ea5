"""The stages one after the other in one process: each finds or computes what it needs of those before it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from facegear.pipeline.needs import resolved_needs, shared_sources
from facegear.pipeline.run import call
from facegear.pipeline.stage import NO_WILDCARDS, Case, From, Wildcards
from facegear.pipeline.table import STAGES
from facegear.results.base import Result, StageOutput
from facegear.results.store import Store

if TYPE_CHECKING:
    from facegear.stages.outcome import Outcome

Kind = TypeVar("Kind", bound=Result)


@dataclass(frozen=True, eq=False)
class Chain:
    """What the workflow's rules do, without files: `values` of a whole config, and the store of results.

    `cases`: all cases of the config by their id, for the stages that set those of its studies side by side. A
    stage is imported where it runs, so that modes load no mesh and no compiler.
    """

    values: Mapping[str, Any]
    store: Store
    cases: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @cached_property
    def case(self) -> Case:
        """The case among those of its config. It does not hold the chain: results are freed with it."""
        cases = self.cases
        return Case(self.values, cases, lambda stage, case: shared_sources(cases, stage)[case])

    def result(self, kind: type[Kind], **more: Any) -> Kind:
        """What the stage of a kind of result gives; `more`: arguments that decide no number, as threads."""
        stored = self.output(kind.STAGE, **more)
        beside = {name: self.part(*source) for name, source in kind.BESIDE.items()}
        return kind({**stored.content, **beside}, stored.summary, stored.source, self.values)

    def output(self, name: str, **more: Any) -> StageOutput:
        """All that a stage gives, and where it came from."""
        return self.store.output(name, self.values, lambda: self.compute(name, **more))

    def arguments(self, name: str) -> dict[str, Any]:
        """All that a stage is given from the config and from earlier stages."""
        stage = STAGES[name]
        return {**self.given(stage.upstream), **resolved_needs(stage.needs, self.case)}

    def given(self, upstream: Mapping[str, From]) -> dict[str, Any]:
        """Arguments that come from earlier stages."""
        wanted = {key: source for key, source in upstream.items() if source.is_needed(self.case)}
        return {key: self._given(source) for key, source in wanted.items()}

    def compute(self, name: str, wildcards: Wildcards = NO_WILDCARDS, **more: Any) -> "Outcome":
        """A stage computed now."""
        stage = STAGES[name]
        return call(stage, self.arguments(name), **stage.typed_wildcards(wildcards), **more)

    def part(self, name: str, file: str, wildcards: Wildcards = NO_WILDCARDS) -> Any:
        """The content of one file of a stage."""
        if not STAGES[name].wildcards:
            return self.store.output(name, self.values, lambda: self.compute(name)).content[file]
        return self.store.part(
            name, file, wildcards, self.values, lambda: self.compute(name, wildcards).content[file]
        )

    def _given(self, source: From) -> Any:
        parts = [
            self._of(where.get("case")).part(source.stage, source.file, _without_case(where))
            for where in source.file_wildcards(self.case)
        ]
        return parts if source.each_wildcards else parts[0]

    def _of(self, case: str | None) -> "Chain":
        """The chain of another case of the same config; its own without a name."""
        own = self.values["case"]
        if case is None or case == own:
            return self
        folder = self.store.folder
        if folder is None:
            return Chain(self.cases[case], replace(self.store, folder=None, others=()))
        folders = [folder / Path(name).relative_to(own) for name in self.cases if name != case]
        below = folder / Path(case).relative_to(own)
        return Chain(self.cases[case], replace(self.store, folder=below, others=tuple(folders)))


def _without_case(where: Wildcards) -> dict[str, str]:
    return {name: text for name, text in where.items() if name != "case"}
