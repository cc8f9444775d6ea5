"""How far the numbers of the reference tests move between platforms: `python -m validation.platforms`.

The same tests run in processes of their own: with and without MKL, on one and two threads, with the newest
kernels of NumPy and OpenBLAS and with old ones. Every number compared is set beside that of the first run.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from validation.references import ROOT, declarations

MEASURED = ROOT / "docs" / "measured" / "platforms.csv"
STORED = ROOT / "results" / "platforms"
"""Numbers and messages of each platform, written as soon as its process has ended."""
OLD_KERNELS = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "Nehalem",
    "MKL_ENABLE_INSTRUCTIONS": "SSE4_2",
}
"""NumPy 2.4 names its kernels by levels of x86-64; without X86_V3 and later it has those of SSE 4.2."""
PLATFORMS: dict[str, tuple[bool, int, dict[str, str]]] = {
    "MKL, one thread": (True, 1, {}),
    "MKL, two threads": (True, 2, {}),
    "without MKL, one thread": (False, 1, {}),
    "without MKL, two threads": (False, 2, {}),
    "MKL, one thread, old kernels": (True, 1, OLD_KERNELS),
    "without MKL, one thread, old kernels": (False, 1, OLD_KERNELS),
}
"""Whether PARDISO solves sparse systems, threads, further environment; all are compared with the first."""
CASES = (
    "tests/unit/geometry/test_separation.py",
    "tests/unit/contact/test_manufactured_solutions.py",
    "tests/unit/contact/test_contact_hertz.py",
    "tests/unit/contact/test_contact_patch.py",
    "tests/unit/contact/test_contact_solver.py",
    "tests/unit/contact/test_gauges.py",
    "tests/unit/transmission/test_modes.py",
    "tests/unit/transmission/test_geometric_statics.py",
    "tests/unit/dynamics/test_dynamics_oracles.py",
    "tests/unit/load_sharing/test_hunting_cycle.py",
    "tests/unit/lubrication",
    "tests/unit/strength/test_spur_rating.py",
    "tests/unit/scenarios/test_statistics.py",
)
"""Small cases of all stages that compute."""
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
START = "import sys{without}; import pytest; sys.exit(pytest.main(sys.argv[1:]))"
COLUMNS = ("platform", "end", "capability", "numbers", "largest_relative", "largest_of_tolerance")
Numbers = dict[str, list[tuple[str, list[float], list[float], list[float]]]]


def run_on(name: str) -> None:
    """Run the tests on a platform; store their numbers, and how the process ended, at once."""
    with_mkl, threads, environment = PLATFORMS[name]
    start = START.format(without="" if with_mkl else "; sys.modules['pypardiso'] = None")
    own = {**os.environ, **environment, **dict.fromkeys(THREADS, str(threads)), "PYTHONPATH": str(ROOT)}
    STORED.mkdir(parents=True, exist_ok=True)
    path = numbers_of(name)
    for stored in (path, path.with_suffix(".end")):
        stored.unlink(missing_ok=True)
    options = ["-q", "-n", "0", "-p", "faulthandler", "-m", "reference", f"--numbers={path}", "--tb=line"]
    with path.with_suffix(".log").open("w", encoding="utf-8") as log:
        done = subprocess.run(
            [sys.executable, "-c", start, *options, *CASES],
            cwd=ROOT,
            env=own,
            stdout=log,
            stderr=log,
            check=False,
        )
    path.with_suffix(".end").write_text(end_of(done.returncode), encoding="utf-8")


def numbers_of(name: str) -> Path:
    """The file of a platform's numbers; its log and how it ended stand beside it."""
    return STORED / f"{name.replace(', ', '-').replace(' ', '_')}.json"


def end_of(code: int) -> str:
    """How a process of pytest ended, in words."""
    if code < 0:
        return f"ended by {signal.Signals(-code).name}"
    return {0: "all passed", 1: "some failed"}.get(code, f"exit code {code}")


def differences(base: Numbers, other: Numbers) -> pd.DataFrame:
    """How far each comparison moved, over its largest value and over its tolerance."""
    capability = {test: declared.capability.split()[0] for test, declared in declarations().items()}
    rows = [
        (capability[test.partition("[")[0]], *moved)
        for test in base
        if test in other
        for moved in _moved(base[test], other[test])
    ]
    return pd.DataFrame(rows, columns=["capability", "numbers", "relative", "of_tolerance"])


def _moved(base: list, other: list) -> Iterator[tuple[int, float, float]]:
    for (_, first, expected, allowed), (_, second, _, _) in zip(base, other, strict=True):
        apart = np.abs(np.subtract(first, second))
        scale = np.abs(expected).max()
        largest = np.divide(
            apart, allowed, out=np.where(apart == 0.0, 0.0, np.nan), where=np.array(allowed) > 0.0
        )
        yield len(first), apart.max() / scale if scale > 0.0 else np.nan, np.nanmax(largest)


def table_of_platforms() -> pd.DataFrame:
    """COLUMNS, a row for each platform that has run, but the first, and each capability."""
    first, *others = PLATFORMS
    base = json.loads(numbers_of(first).read_text(encoding="utf-8"))
    tables = []
    for name in others:
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


def platforms_table(measured: pd.DataFrame) -> str:
    """Markdown: a row a platform, with the largest differences of all its numbers."""
    lines = [
        "| platform | tests | numbers | largest difference | in tolerances | in the references of |",
        "|---|---|---|---|---|---|",
    ]
    for name, rows in measured.groupby("platform", sort=False):
        part = rows["largest_of_tolerance"]
        where = rows.loc[part.idxmax(), "capability"] if part.notna().any() else "-"
        moved = f"{rows['largest_relative'].max():.1e} | {part.max():.1e} | {where}"
        lines.append(f"| {name} | {rows['end'].iloc[0]} | {rows['numbers'].sum()} | {moved} |")
    return "\n".join(lines)


def main(names: list[str]) -> None:
    """Run on the platforms named, or on all; the table is written after each."""
    for name in names or PLATFORMS:
        run_on(name)
        print(f"{name}: {numbers_of(name).with_suffix('.end').read_text(encoding='utf-8')}", flush=True)
        if numbers_of(next(iter(PLATFORMS))).exists():
            table_of_platforms().to_csv(MEASURED, index=False, float_format="%.3g", lineterminator="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
