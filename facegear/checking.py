"""The check of a config file: what would fail later, what is implausible and what has no effect."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from facegear.build.cases import expand_cases
from facegear.build.config import Config
from facegear.build.early_checks import EarlyFindings, machine_findings, pair_findings
from facegear.build.notes import notes
from facegear.pipeline.needs import idle_keys

MOST_PAIRS = 4
"""Different tooth pairs of a config whose geometry is analysed, at about 0.3 s each."""


@dataclass(frozen=True)
class CheckedConfig:
    """Result of the check of a config without mistakes.

    Attributes
    ----------
    cases
        Ids of all cases: the config's own first, then those of its studies.
    failures
        What would end a stage of a run, one line each.
    remarks
        What is worth a look: loads, implausible values, keys without effect; one line each.
    """

    cases: tuple[str, ...]
    failures: tuple[str, ...]
    remarks: tuple[str, ...]


def check_config(config: Config, file_values: Mapping[str, Any]) -> CheckedConfig:
    """Check a config without mistakes, computing nothing that takes long.

    Parameters
    ----------
    config : Config
        The whole config.
    file_values : mapping
        Values as they stand in its file, without those of a file that it extends.

    Returns
    -------
    CheckedConfig
        Cases, failures and remarks, as lines for the user.

    Raises
    ------
    ConfigErrors
        With one line for every mistake in the points of its studies.
    """
    cases = expand_cases(config)
    base = next(iter(cases.values()))
    parts_by_case = {
        case: [*_geometry(case, cases), machine_findings(values)] for case, values in cases.items()
    }
    by_case = {
        case: [line for part in parts for line in part.failures] for case, parts in parts_by_case.items()
    }
    remarks = {
        case: [line for part in parts for line in part.remarks] for case, parts in parts_by_case.items()
    }
    facts = [f for part in parts_by_case[base["case"]] for f in part.facts]
    reproduction = {"reproduction": base["reproduction"]}  # studies of a reproduction are part of it
    note_lines = {case: notes({**values, **reproduction}) for case, values in cases.items()}
    idle = [f"without effect: {line}" for line in idle_keys(file_values, cases)]
    pairs = len({_pair(values) for values in cases.values()})
    left = [f"geometry: {pairs - MOST_PAIRS} more tooth pairs of the studies are not looked at"]
    lines = (*facts, *_lines(remarks), *_lines(note_lines, "note: "), *idle, *left * (pairs > MOST_PAIRS))
    return CheckedConfig(tuple(cases), tuple(_lines(by_case)), lines)


def _geometry(case: str, cases: Mapping[str, Mapping[str, Any]]) -> Iterator[EarlyFindings]:
    """Yield the findings on the tooth pair of a case, or none: if an earlier case has the same pair
    (`_pair`), or it is not among the first MOST_PAIRS different ones. `cases`: plain values of all
    cases by id.
    """
    pairs = list(dict.fromkeys(_pair(values) for values in cases.values()))[:MOST_PAIRS]
    pair = _pair(cases[case])
    first = next(name for name, values in cases.items() if _pair(values) == pair)
    if first == case and pair in pairs:
        yield pair_findings(cases[case])


def _pair(values: Mapping[str, Any]) -> str:
    """Return a key for the findings about a case's pair, which is looked at once for each key: JSON of the
    config's `tooth_pair`, `strength` and `mesh_stiffness.source`.
    """
    return json.dumps([values["tooth_pair"], values["strength"], values["mesh_stiffness"]["source"]])


def _lines(by_case: Mapping[str, Sequence[str]], opening: str = "") -> Iterator[str]:
    """Yield all lines of the first case, the config's own, and those of other cases whose subject is
    new; these end in `(case ID)`. `by_case`: lines by id of the case; `opening` stands before each
    line.
    """
    base = next(iter(by_case))
    subjects: set[str] = set()
    for case, lines in by_case.items():
        new = [line for line in lines if _subject(line) not in subjects]
        subjects |= {_subject(line) for line in new}
        suffix = "" if case == base else f" (case {case.removeprefix(f'{base}/')})"
        yield from (f"{opening}{line}{suffix}" for line in dict.fromkeys(new))


def _subject(line: str) -> str:
    """Return the beginning of a line up to its first colon or ` = `: the key or subject without its value."""
    return line.partition(":")[0].partition(" = ")[0]
