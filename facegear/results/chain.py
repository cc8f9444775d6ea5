"""The stages one after the other in one process: each finds or computes what it needs of those before it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from facegear.pipeline.needs import resolved_needs
from facegear.pipeline.run import call
from facegear.pipeline.stage import NONE, Case, From, Wildcards
from facegear.pipeline.table import STAGES
from facegear.results.base import Result
from facegear.results.store import Store

if TYPE_CHECKING:
    from facegear.stages.outcome import Outcome

Kind = TypeVar("Kind", bound=Result)


@dataclass(frozen=True, eq=False)
class Chain:
    """What the workflow's rules do, without files: `values` of a whole config, and the store of results.

    A stage is imported where it runs, so that modes load no mesh and no compiler.
    """

    values: Mapping[str, Any]
    store: Store

    def result(self, kind: type[Kind], **more: Any) -> Kind:
        """What the stage of a kind of result gives; `more`: arguments that decide no number, as threads."""
        stored = self.store.output(kind.STAGE, self.values, lambda: self.compute(kind.STAGE, **more))
        beside = {name: self.part(*source) for name, source in kind.BESIDE.items()}
        return kind({**stored.content, **beside}, stored.summary, stored.source, self.values)

    def arguments(self, name: str) -> dict[str, Any]:
        """All that a stage is given from the config and from earlier stages."""
        stage, case = STAGES[name], Case(self.values)
        given = {key: self._given(source) for key, source in stage.upstream.items() if source.wanted(case)}
        return {**given, **resolved_needs(stage.needs, case)}

    def compute(self, name: str, wildcards: Wildcards = NONE, **more: Any) -> "Outcome":
        """A stage computed now."""
        stage = STAGES[name]
        return call(stage, self.arguments(name), **stage.typed(wildcards), **more)

    def part(self, name: str, file: str, wildcards: Wildcards = NONE) -> Any:
        """The content of one file of a stage."""
        if not STAGES[name].wildcards:
            return self.store.output(name, self.values, lambda: self.compute(name)).content[file]
        return self.store.part(
            name, file, wildcards, self.values, lambda: self.compute(name, wildcards).content[file]
        )

    def _given(self, source: From) -> Any:
        places = source.places(Case(self.values))
        parts = [self.part(source.stage, source.file, wildcards) for wildcards in places]
        return parts if source.each else parts[0]
