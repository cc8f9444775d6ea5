"""Measure what moves between processors and threads: `python -m validation.platforms [PLATFORM ...]`.

Processes of their own run the same tests natively and with lowered levels of instructions in NumPy, OpenBLAS
and the kernels, on one and two threads. A level can only be lower than that of the machine. Every number of
the reference tests is set beside that of the first run. Tests of notebooks, stored answers, dynamics, load
sharing and contact must pass on each.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pandas as pd

from validation.references import ROOT, declarations

DIFFERENCES = ROOT / "docs" / "measured" / "platforms.csv"
RUN_FOLDER = ROOT / "results" / "platforms"
"""Numbers and messages of each platform, written as soon as its process has ended."""
OUTCOMES = ROOT / "docs" / "measured" / "platform_tests.csv"
AVX2 = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "Haswell",
}
"""Level x86-64-v3 without AVX-512."""
SSE = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "Nehalem",
    "FACEGEAR_INSTRUCTIONS": "baseline",
}
"""Level x86-64-v2 without AVX and fused multiplication. NumPy 2.4 names its kernels by these levels."""


@dataclass(frozen=True)
class Platform:
    """Threads of the libraries, and the environment that lowers their instructions."""

    threads: int
    environment: Mapping[str, str] = field(default_factory=dict)


PLATFORMS: Mapping[str, Platform] = {
    "native, one thread": Platform(1),
    "native, two threads": Platform(2),
    "AVX2, two threads": Platform(2, AVX2),
    "SSE4.2, one thread": Platform(1, SSE),
}
"""All are compared with the first."""
CASES = (
    "tests/unit/teeth/test_separation.py",
    "tests/unit/contact/test_manufactured_solutions.py",
    "tests/unit/contact/test_contact_hertz.py",
    "tests/unit/contact/test_contact_patch.py",
    "tests/unit/contact/test_contact_solver.py",
    "tests/unit/contact/test_gauges.py",
    "tests/unit/machine/test_modes.py",
    "tests/unit/machine/test_geometric_statics.py",
    "tests/unit/motion/test_dynamics_oracles.py",
    "tests/unit/sharing/test_hunting_cycle.py",
    "tests/unit/lubrication",
    "tests/unit/strength/test_spur_rating.py",
    "tests/unit/studies/test_statistics.py",
)
"""Small cases of all stages that compute."""
TESTS = (
    "tests/stage/test_example_notebook.py",
    "tests/unit/test_front_door.py",
    "tests/unit/report/compare",
    "tests/unit/contact/test_contact_solver.py",
    "tests/unit/contact/test_interfering_teeth.py",
    "tests/unit/motion/branches/test_dynamics_survey.py",
    "tests/unit/motion/test_clean_folds.py",
    "tests/unit/motion/test_dynamics_labels.py",
    "tests/unit/motion/test_dynamics_settling.py",
    "tests/unit/motion/test_dynamics_sweep.py",
    "tests/unit/motion/test_dynamics_symmetries.py",
    "tests/unit/sharing/test_load_sharing_run.py",
    "tests/workflow/test_stored_answers.py",
)
"""Tests whose labels, notebooks and stored answers a processor might decide."""
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
COLUMNS = ("platform", "end", "capability", "numbers", "largest_relative", "largest_of_tolerance")
OUTCOME_COLUMNS = ("platform", "passed", "failed", "failed_tests")
Numbers = dict[str, list[tuple[str, list[float], list[float], list[float]]]]


def run_on(name: str) -> None:
    """Run the tests on a platform; store their numbers, outcomes and how the process ended, at once.

    Parameters
    ----------
    name : str
        Name of the platform.
    """
    RUN_FOLDER.mkdir(parents=True, exist_ok=True)
    path = numbers_of(name)
    for old_file in (path, path.with_suffix(".end"), path.with_suffix(".xml")):
        old_file.unlink(missing_ok=True)
    code = _pytest(name, ".log", "-n", "0", "-m", "reference", f"--numbers={path}", *CASES)
    path.with_suffix(".end").write_text(end_of(code), encoding="utf-8")
    _pytest(name, ".tests.log", f"--junitxml={path.with_suffix('.xml')}", *TESTS)


def _pytest(name: str, ending: str, *options: str) -> int:
    """Exit code of pytest on a platform; what it prints goes to a file."""
    platform = PLATFORMS[name]
    environment = {**os.environ, **platform.environment, **dict.fromkeys(THREADS, str(platform.threads))}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "faulthandler", "--tb=short", *options]
    with numbers_of(name).with_suffix(ending).open("w", encoding="utf-8") as log:
        process = subprocess.run(
            command,
            cwd=ROOT,
            env={**environment, "PYTHONPATH": str(ROOT)},
            stdout=log,
            stderr=log,
            check=False,
        )
    return process.returncode


def numbers_of(name: str) -> Path:
    """Return the file of a platform's numbers; logs, outcomes of tests and how it ended stand beside it.

    Parameters
    ----------
    name : str
        Name of the platform.

    Returns
    -------
    Path
        Path of the file.
    """
    return RUN_FOLDER / f"{name.replace(', ', '-').replace(' ', '_')}.json"


def end_of(code: int) -> str:
    """Say how a process of pytest ended, in words.

    Parameters
    ----------
    code : int
        Exit code of the process.

    Returns
    -------
    str
        The words.
    """
    if code < 0:
        return f"ended by {signal.Signals(-code).name}"
    return {0: "all passed", 1: "some failed"}.get(code, f"exit code {code}")


def differences(base: Numbers, other_numbers: Numbers) -> pd.DataFrame:
    """Measure how far each comparison moved, over its largest value and over its tolerance.

    Parameters
    ----------
    base : Numbers
        Numbers of the first platform by test.
    other_numbers : Numbers
        Numbers of another platform by test.

    Returns
    -------
    DataFrame
        Columns capability, numbers, relative and of_tolerance.
    """
    capability = {test: declaration.capability.split()[0] for test, declaration in declarations().items()}
    rows = [
        (capability[test.partition("[")[0]], *change)
        for test in base
        if test in other_numbers
        for change in _changed_numbers(base[test], other_numbers[test])
    ]
    return pd.DataFrame(rows, columns=["capability", "numbers", "relative", "of_tolerance"])


def _changed_numbers(base: list, other_numbers: list) -> Iterator[tuple[int, float, float]]:
    for (_, first, reference, tolerance), (_, second, _, _) in zip(base, other_numbers, strict=True):
        apart = np.abs(np.subtract(first, second))
        scale = np.abs(reference).max()
        largest = np.divide(
            apart, tolerance, out=np.where(apart == 0.0, 0.0, np.nan), where=np.array(tolerance) > 0.0
        )
        yield len(first), apart.max() / scale if scale > 0.0 else np.nan, np.nanmax(largest)


def table_of_platforms() -> pd.DataFrame:
    """Tabulate the largest differences of each platform that has run, but the first, and each capability.

    Returns
    -------
    DataFrame
        Columns as COLUMNS.
    """
    first, *other_platforms = PLATFORMS
    base = json.loads(numbers_of(first).read_text(encoding="utf-8"))
    tables = []
    for name in other_platforms:
        path = numbers_of(name)
        if not path.with_suffix(".end").exists():
            continue
        numbers = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        by = differences(base, numbers).groupby("capability", sort=False)
        table = by.agg(
            numbers=("numbers", "sum"),
            largest_relative=("relative", "max"),
            largest_of_tolerance=("of_tolerance", "max"),
        ).reset_index()
        if table.empty:
            table = pd.DataFrame({"capability": ["none"], "numbers": [0]})
        tables.append(table.assign(platform=name, end=path.with_suffix(".end").read_text(encoding="utf-8")))
    return pd.concat(tables).reindex(columns=list(COLUMNS)) if tables else pd.DataFrame(columns=list(COLUMNS))


def outcomes(name: str, report: Path) -> dict[str, object]:
    """Count the tests that passed on a platform, and name those that did not.

    Parameters
    ----------
    name : str
        The platform.
    report : Path
        File in JUnit's format.

    Returns
    -------
    dict
        One row, OUTCOME_COLUMNS; numbers of tests.
    """
    cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    failures = [case for case in cases if case.find("failure") is not None or case.find("error") is not None]
    skipped = sum(case.find("skipped") is not None for case in cases)
    names = " ".join(f"{case.get('classname')}::{case.get('name')}" for case in failures)
    return {
        "platform": name,
        "passed": len(cases) - len(failures) - skipped,
        "failed": len(failures),
        "failed_tests": names,
    }


def table_of_outcomes() -> pd.DataFrame:
    """Collect the outcomes of all platforms that have run.

    Returns
    -------
    DataFrame
        OUTCOME_COLUMNS, a row for each platform; numbers of tests.
    """
    reports = {name: numbers_of(name).with_suffix(".xml") for name in PLATFORMS}
    rows = [outcomes(name, report) for name, report in reports.items() if report.exists()]
    return pd.DataFrame(rows, columns=list(OUTCOME_COLUMNS))


def platforms_table(table: pd.DataFrame) -> str:
    """Write the largest differences of each platform in Markdown.

    Parameters
    ----------
    table : DataFrame
        Table of `table_of_platforms`.

    Returns
    -------
    str
        A table of Markdown, a row a platform.
    """
    lines = [
        "| platform | tests | numbers | largest difference | in tolerances | in the references of |",
        "|---|---|---|---|---|---|",
    ]
    for name, rows in table.groupby("platform", sort=False):
        part = rows["largest_of_tolerance"]
        capability = rows.loc[part.idxmax(), "capability"] if part.notna().any() else "-"
        differences_text = f"{rows['largest_relative'].max():.1e} | {part.max():.1e} | {capability}"
        lines.append(f"| {name} | {rows['end'].iloc[0]} | {rows['numbers'].sum()} | {differences_text} |")
    return "\n".join(lines)


def outcomes_table(table: pd.DataFrame) -> str:
    """Write in Markdown how many tests passed on each platform, and the names of those that did not.

    Parameters
    ----------
    table : DataFrame
        OUTCOME_COLUMNS; numbers of tests.

    Returns
    -------
    str
        A table of Markdown.
    """
    lines = ["| platform | passed | failed | names |", "|---|---|---|---|"]
    for row in table.fillna("").itertuples():
        lines.append(f"| {row.platform} | {row.passed} | {row.failed} | {row.failed_tests or '-'} |")
    return "\n".join(lines)


def main(names: list[str]) -> int:
    """Run on the platforms named, or on all, and write the tables after each.

    Parameters
    ----------
    names : list[str]
        Names of platforms, none for all.

    Returns
    -------
    int
        Exit code: 1 where a test failed, else 0.
    """
    for name in names or PLATFORMS:
        run_on(name)
        table = table_of_outcomes()
        row = table.set_index("platform").loc[name]
        end = numbers_of(name).with_suffix(".end").read_text(encoding="utf-8")
        print(f"{name}: references {end}; {row['passed']} tests passed, {row['failed']} failed", flush=True)
        if row["failed"]:
            print(f"  {row['failed_tests']}", flush=True)
        if numbers_of(next(iter(PLATFORMS))).exists():
            table_of_platforms().to_csv(DIFFERENCES, index=False, float_format="%.3g", lineterminator="\n")
        table.to_csv(OUTCOMES, index=False, lineterminator="\n")
    ends = [numbers_of(name).with_suffix(".end").read_text(encoding="utf-8") for name in names or PLATFORMS]
    return int(bool(table_of_outcomes()["failed"].sum()) or any(end != end_of(0) for end in ends))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
