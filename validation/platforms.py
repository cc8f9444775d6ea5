"""How far the numbers of the reference tests move between platforms: `python -m validation.platforms`.

The same tests run in processes of their own: with and without MKL, on one and two threads, with the newest
kernels of NumPy and OpenBLAS and with old ones. Every number compared is set beside that of the first run.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from validation.references import ROOT, declarations

MEASURED = ROOT / "docs" / "measured" / "platforms.csv"
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
"""Whether MKL's PARDISO factorises, threads, further environment; the others are compared with the first."""
CASES = (
    "tests/unit/geometry/test_separation.py",
    "tests/unit/contact/test_elastic_bodies.py",
    "tests/unit/contact/test_manufactured_solutions.py",
    "tests/unit/contact/test_contact_hertz.py",
    "tests/unit/contact/test_contact_patch.py",
    "tests/unit/contact/test_contact_solver.py",
    "tests/unit/contact/test_gauges.py",
    "tests/unit/transmission/test_modes.py",
    "tests/unit/transmission/test_geometric_statics.py",
    "tests/unit/dynamics/test_dynamics_oracles.py",
    "tests/unit/dynamics/branches/test_dynamics_exact_branches.py",
    "tests/unit/load_sharing/test_load_sharing_run.py",
    "tests/unit/load_sharing/test_hunting_cycle.py",
    "tests/unit/lubrication",
    "tests/unit/strength/test_spur_rating.py",
    "tests/unit/scenarios/test_statistics.py",
)
"""Small cases of all stages that compute."""
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
START = "import sys{without}; import pytest; sys.exit(pytest.main(sys.argv[1:]))"
COLUMNS = ("platform", "capability", "numbers", "largest_relative", "largest_of_tolerance", "failures")
Numbers = dict[str, list[tuple[str, list[float], list[float], list[float]]]]


def numbers_on(with_mkl: bool, threads: int, environment: dict[str, str]) -> tuple[Numbers, int]:
    """All numbers that the reference tests compare on a platform, by test, and how many tests failed."""
    start = START.format(without="" if with_mkl else "; sys.modules['pypardiso'] = None")
    own = {**os.environ, **environment, **dict.fromkeys(THREADS, str(threads)), "PYTHONPATH": str(ROOT)}
    with TemporaryDirectory() as folder:
        path = Path(folder) / "numbers.json"
        options = ["-q", "-n", "0", "-m", "reference", f"--numbers={path}", "--tb=no", *CASES]
        command = [sys.executable, "-c", start, *options]
        done = subprocess.run(command, cwd=ROOT, env=own, capture_output=True, text=True, check=False)
        print(done.stdout.splitlines()[-1], flush=True)
        failed = sum(line.startswith("FAILED") for line in done.stdout.splitlines())
        return json.loads(path.read_text(encoding="utf-8")), failed


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


def platforms() -> pd.DataFrame:
    """COLUMNS, a row for each platform but the first and each capability."""
    compared = {}
    for name, platform in PLATFORMS.items():
        print(name, end=": ", flush=True)
        compared[name] = numbers_on(*platform)
    first, *others = compared
    tables = []
    for name in others:
        numbers, failures = compared[name]
        by = differences(compared[first][0], numbers).groupby("capability", sort=False)
        table = by.agg(
            numbers=("numbers", "sum"),
            largest_relative=("relative", "max"),
            largest_of_tolerance=("of_tolerance", "max"),
        )
        tables.append(table.reset_index().assign(platform=name, failures=failures))
    return pd.concat(tables)[list(COLUMNS)]


if __name__ == "__main__":
    platforms().to_csv(MEASURED, index=False, float_format="%.3g", lineterminator="\n")
