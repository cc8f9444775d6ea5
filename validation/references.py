"""References that tests compare with, as a table: what was checked, against what, and how well.

Tests record the rows (`tests/helpers/references.py`), `make verification` stores them, and the pages
"Verification" and "Comparisons" of the documentation show them (`validation/pages.py`).
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import pandas as pd

from facegear.pipeline.table import STAGES

ROOT = Path(__file__).parents[1]
REFERENCES = Path(__file__).with_suffix(".csv")
TESTS = ("tests", "validation/tests", "paper/tests")


class Kind(StrEnum):
    """Basis of an expected value, from the real world to our own numbers."""

    MEASUREMENT = "measured"
    EXTERNAL = "external source"
    THIRD_PARTY = "third-party program"
    ANALYTIC = "analytic"
    MANUFACTURED = "manufactured"
    SECOND = "second implementation"
    CONVERGENCE = "own convergence"


INDEPENDENT = tuple(kind for kind in Kind if kind is not Kind.CONVERGENCE)
DECLARED_COLUMNS = ("kind", "source", "capability", "module")
"""Columns that a test declares in its decorator `against`."""
METHOD_TITLES = {
    "displaced_contact": "Contact of two displaced bodies",
    "export": "Exact teeth for other programs",
    "loosest_tolerances": "Loosest tolerances",
}
"""Methods of the Gearbox that are no stage of their own."""
EQUAL, NO_LESS = "equal", "at least"
"""Relations of a computed value to the expected one."""
COLUMNS = (
    *("capability", "quantity", "kind", "source", "relation", "expected", "computed", "error", "tolerance"),
    *("module", "test", "date", "commit"),
)


@dataclass(frozen=True)
class Declaration:
    """Declaration of a test's reference in the decorator `against`.

    Attributes
    ----------
    test
        File inside the repository and name of the function, as pytest writes them.
    kind, source
        Where the expected value is from: a Kind, and the formula, book, program or study.
    capability
        Stages of the pipeline or methods of the Gearbox whose results the reference checks, with spaces
        between them.
    module
        The module under test.
    """

    test: str
    kind: str
    source: str
    capability: str
    module: str


def declarations(root: Path = ROOT) -> dict[str, Declaration]:
    """Read all tests of the repository that compare with a reference from their source.

    Parameters
    ----------
    root : Path
        Root of the repository.

    Returns
    -------
    dict[str, Declaration]
        Declarations by name of the test.
    """
    files = [file for folder in TESTS for file in sorted((root / folder).rglob("test_*.py"))]
    return {
        declaration.test: declaration
        for file in files
        for declaration in _declared_in(file, file.relative_to(root).as_posix())
    }


def _declared_in(file: Path, name: str) -> Iterator[Declaration]:
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if not isinstance(node, ast.FunctionDef):
            continue
        for call in node.decorator_list:
            if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "against":
                keywords = dict(zip(DECLARED_COLUMNS, call.args, strict=False))
                keywords |= {str(keyword.arg): keyword.value for keyword in call.keywords}
                texts = {key: ast.literal_eval(value) for key, value in keywords.items()}
                yield Declaration(f"{name}::{node.name}", **texts)


def read(path: Path = REFERENCES) -> pd.DataFrame:
    """Read the stored references.

    Parameters
    ----------
    path : Path
        Path of the table.

    Returns
    -------
    DataFrame
        Columns as COLUMNS, one row for each quantity that a test compares.
    """
    return pd.read_csv(path, dtype={"commit": str}, keep_default_na=False)


def write(rows: pd.DataFrame, path: Path = REFERENCES) -> None:
    """Store references, ordered by test and quantity.

    Parameters
    ----------
    rows : DataFrame
        References, COLUMNS.
    path : Path
        Path of the table.
    """
    sorted_rows = rows[list(COLUMNS)].sort_values(["test", "quantity"])
    sorted_rows.to_csv(path, index=False, lineterminator="\n")


def merge_rows(old_rows: pd.DataFrame, fresh: pd.DataFrame, declared_tests: set[str]) -> pd.DataFrame:
    """Replace the rows of tests by fresh ones, and leave out rows of tests that are gone.

    Parameters
    ----------
    old_rows : DataFrame
        Stored references, COLUMNS.
    fresh : DataFrame
        References of the tests that ran, COLUMNS.
    declared_tests : set[str]
        Names of all tests that declare references.

    Returns
    -------
    DataFrame
        Both together, COLUMNS.
    """
    unchanged_rows = old_rows[~old_rows["test"].isin(fresh["test"]) & old_rows["test"].isin(declared_tests)]
    return pd.concat([unchanged_rows, fresh], ignore_index=True) if len(unchanged_rows) else fresh


def shares_table(rows: pd.DataFrame) -> str:
    """Write how many references there are of each kind.

    Parameters
    ----------
    rows : pd.DataFrame
        Stored references, COLUMNS.

    Returns
    -------
    str
        A table as Markdown: kind, rows, and their share in tenths of a percent, which add up to 100 %.

    Raises
    ------
    ValueError
        For a row whose kind is none of Kind.
    """
    if other_kinds := sorted(set(rows["kind"]) - set(Kind)):
        raise ValueError(f"kinds of references: {', '.join(other_kinds)}; known are {', '.join(Kind)}")
    counts = [int((rows["kind"] == kind).sum()) for kind in Kind]
    total = sum(counts)
    tenths = [1000 * count // total for count in counts]
    # Whole tenths lose up to one each; the largest remainders take them back, so that the shares add up.
    by_remainder = sorted(range(len(counts)), key=lambda i: -(1000 * counts[i] % total))
    for i in by_remainder[: 1000 - sum(tenths)]:
        tenths[i] += 1
    lines = ["| kind | rows | share |", "|---|---|---|"]
    for kind, count, tenth in zip(Kind, counts, tenths, strict=True):
        lines.append(f"| {kind} | {count or 'none'} | {tenth / 10:.1f} % |")
    return "\n".join([*lines, f"| all | {total} | 100.0 % |"])


def _capabilities(rows: pd.DataFrame) -> pd.Series:
    """Names of the capabilities that each row checks, a list each."""
    return rows["capability"].str.split()


def counts_table(rows: pd.DataFrame) -> str:
    """Write how many references of each kind check a capability.

    Parameters
    ----------
    rows : pd.DataFrame
        Stored references, COLUMNS.

    Returns
    -------
    str
        A table as Markdown, one row a stage or method; a reference that checks several counts for each.
    """
    capabilities = _capabilities(rows)
    lines = ["| capability | " + " | ".join(Kind) + " |", "|---" * (len(Kind) + 1) + "|"]
    for name in [*STAGES, *sorted({name for names in capabilities for name in names} - set(STAGES))]:
        by_kind = rows[[name in names for names in capabilities]]["kind"].value_counts()
        lines.append(f"| {name} | " + " | ".join(str(by_kind.get(kind, "-")) for kind in Kind) + " |")
    return "\n".join(lines)


def comparison_tables(rows: pd.DataFrame) -> str:
    """Write every comparison, one table a capability.

    Parameters
    ----------
    rows : pd.DataFrame
        Stored references, COLUMNS.

    Returns
    -------
    str
        Headings and tables as Markdown; a row that checks several capabilities stands below the first.
    """
    titles = {name: stage.title for name, stage in STAGES.items()}
    first = _capabilities(rows).str[0]
    lines: list[str] = []
    for name in [*titles, *sorted(set(first) - set(titles))]:
        references = rows[first == name]
        if len(references):
            title = titles.get(name, METHOD_TITLES.get(name, name))
            lines += ["", f"## {title} (`{name}`)", "", *_rows(references)]
    return "\n".join(lines)


def _rows(rows: pd.DataFrame) -> Iterator[str]:
    yield "| quantity | kind: source | expected | computed | error | tolerance | module and test |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows.sort_values(["module", "test", "quantity"]).itertuples():
        sign = "at least " if row.relation == NO_LESS else ""
        module, test = row.module.removeprefix("facegear."), row.test.partition("::")[2].removeprefix("test_")
        yield (
            f"| {row.quantity} | {row.kind}: {row.source} | {sign}{row.expected:.6g} | {row.computed:.6g} "
            f"| {row.error:.1e} | {row.tolerance:.1e} | `{module}`: {test.replace('_', ' ')} |"
        )
