"""Where the results of a machine come from: known in this session, else stored and current, else computed."""

import json
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from facegear.config.needs import NEEDS, stage_needs, stages_before
from facegear.errors import CorruptFile, extras_named
from facegear.results.base import Result

if TYPE_CHECKING:
    from facegear.stages.outcome import Outcome

Found = TypeVar("Found", bound=Result)
Value = TypeVar("Value")
Values = Mapping[str, Any]
ROOT = Path(__file__).parents[2]


@dataclass(frozen=True, eq=False)
class Store:
    """Results by the part of the config that they depend on; `values` are those of a whole config.

    `folder` is that of the case in the workflow's results, None to read nothing. Changed copies of a machine
    share a store: what a change does not touch is found again.
    """

    folder: Path | None = None
    known: dict[str, Any] = field(default_factory=dict)

    def result(self, rule: str, values: Values, kind: type[Found], compute: Callable[[], "Outcome"]) -> Found:
        """A stage's result: known already, else stored and current, else computed."""

        def find() -> Found:
            stored = self._stored(kind, values)
            if stored is not None:
                return stored
            found = compute()
            return kind(found.content, found.summary, "computed", values)

        return self._once((rule,), values, find)

    def part(
        self,
        rule: str,
        name: str,
        values: Values,
        path: str,
        read: Callable[[Path], Value],
        compute: Callable[[], Value],
    ) -> Value:
        """As `result`, for the part of a stage's results that is kept in the single file `path`."""

        def find() -> Value:
            if self.folder is not None and self._current_manifest(file := self.folder / path, values):
                stored = _unless_corrupt(lambda: read(file))
                if stored is not None:
                    return stored
            return compute()

        return self._once((rule, name), values, find)

    def _once(self, name: tuple[str, ...], values: Values, find: Callable[[], Value]) -> Value:
        """What `find` gives, kept under the part of the config that it depends on."""
        rules = stages_before(name[0], values)
        key = json.dumps([name, [stage_needs(rule, values) for rule in rules]])
        if key not in self.known:
            with extras_named():
                self.known[key] = find()
        return self.known[key]

    def _stored(self, kind: type[Found], values: Values) -> Found | None:
        if self.folder is None:
            return None
        folder, summary = self.folder, ""
        for kept in kind.FILES.values():
            manifest = self._current_manifest(folder / kept.path, values)
            if manifest is None:
                return None
            summary = manifest["summary"]
        content = _unless_corrupt(lambda: {name: kept.read(folder) for name, kept in kind.FILES.items()})
        return None if content is None else kind(content, summary, "stored", values)

    def _current_manifest(self, path: Path, values: Values) -> Mapping[str, Any] | None:
        from facegear.provenance.current import current_manifest
        from facegear.provenance.fingerprint import stage_fingerprint

        return current_manifest(
            path,
            lambda rule: stage_needs(rule, values) if rule in NEEDS else None,
            lambda rule: stage_fingerprint(f"facegear.stages.{rule}", ROOT),
        )


def case_folder(config: str | Path, results: str | Path, case: str) -> Path | None:
    """The case's folder below `results`, looked for here and beside the folder of the config file."""
    places = [Path(results), Path(config).resolve().parents[1] / results]
    return next((place / case for place in places if (place / case).is_dir()), None)


def _unless_corrupt(read: Callable[[], Value]) -> Value | None:
    """What is stored; None, with a warning, if it is damaged."""
    try:
        return read()
    except CorruptFile as error:
        warnings.warn(f"{error}; computed anew", stacklevel=7)
        return None
