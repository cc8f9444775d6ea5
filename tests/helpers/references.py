"""Comparisons with independent answers that are kept: a plugin of pytest with a decorator and an assertion.

    @against("analytic", "Hertz", capability="contact", module="facegear.contact.hertz")
    def test_...():
        agrees("largest pressure, Pa", computed, expected, relative=1e-3)

`pytest -m reference --references=FILE` stores all comparisons that were made (`make verification`), and
`--numbers=FILE` every number that was compared (`make platforms`).
"""

import json
import subprocess
from datetime import date
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from validation.references import EQUAL, NO_LESS, ROOT, Kind, declarations, merge_rows, read, write

ROWS = "reference"
"""Name of the rows in what a worker of xdist reports of a test."""
_rows: dict[str, dict[str, float | str]] = {}
"""Quantities that the running test has compared, each at its largest error relative to the tolerance."""
_numbers: list[tuple[str, list[float], list[float], list[float]]] = []
"""All comparisons of the running test: quantity, computed and expected values, tolerances."""


def against(kind: str, source: str, *, capability: str, module: str) -> pytest.MarkDecorator:
    """Mark a test that compares results with a reference; arguments as in Declaration, all literal texts."""
    return pytest.mark.reference(kind=Kind(kind).value, source=source, capability=capability, module=module)


def agrees(
    quantity: str,
    computed: object,
    expected: object,
    *,
    relative: float = 0.0,
    absolute: float = 0.0,
    at_least: bool = False,
) -> None:
    """Assert that numbers or arrays agree, and record the element that agrees worst.

    `quantity`: name and unit; shapes broadcast; the larger of both tolerances holds for each element.
    `at_least`: a computed value may exceed the expected one by any amount. Of complex numbers the record
    holds the magnitude of the difference.
    """
    values, references = (np.ravel(given) for given in np.broadcast_arrays(computed, expected))
    assert values.size, f"{quantity}: nothing was compared"
    allowed = np.maximum(relative * np.abs(references), absolute)
    if np.iscomplexobj(values) or np.iscomplexobj(references):
        values, references = np.abs(values - references), np.zeros(values.shape)
    error = np.maximum(references - values, 0.0) if at_least else np.abs(values - references)
    parts = np.divide(error, allowed, out=np.where(error == 0.0, 0.0, np.inf), where=allowed > 0.0)
    worst = int(np.argmax(np.where(np.isnan(parts), np.inf, parts)))
    shown = f"computed {values[worst]:.12g}, expected {references[worst]:.12g} +- {allowed[worst]:.3g}"
    assert error[worst] <= allowed[worst], f"{quantity}: {shown}"
    _numbers.append((quantity, values.tolist(), references.tolist(), allowed.tolist()))
    if quantity not in _rows or parts[worst] > float(_rows[quantity]["part"]):
        _rows[quantity] = {
            "relation": NO_LESS if at_least else EQUAL,
            "expected": float(references[worst]),
            "computed": float(values[worst]),
            "error": float(f"{error[worst]:.3g}"),
            "tolerance": float(f"{allowed[worst]:.6g}"),
            "part": float(parts[worst]),
        }


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--references", type=Path, help="file that takes the comparisons with references")
    parser.addoption("--numbers", type=Path, help="file that takes all numbers compared, without xdist")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "reference: compares a result with a reference")
    path = config.getoption("--references")
    if path and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Collector(path))
    if config.getoption("--numbers"):
        config.pluginmanager.register(Numbers(config.getoption("--numbers")))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item):
    """Hand what a test compared to its report, which xdist passes on; a reference unused is a failure."""
    _rows.clear()
    _numbers.clear()
    result = yield
    mark = item.get_closest_marker("reference")
    if mark is None:
        assert not _rows, "a test that calls `agrees` must be decorated by `against`"
        return result
    assert _rows, "a test that is decorated by `against` must call `agrees`"
    test = f"{item.nodeid.partition('::')[0]}::{item.originalname}"
    for quantity, row in _rows.items():
        item.user_properties.append((ROWS, {**row, **mark.kwargs, "quantity": quantity, "test": test}))
    return result


class Collector:
    """Gathers the rows of all workers and stores those of tests that passed at the end of a session."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.rows: list[dict[str, object]] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" and report.passed:
            self.rows += [row for name, row in report.user_properties if name == ROWS]

    def pytest_sessionfinish(self) -> None:
        if not self.rows:
            return
        fresh = pd.DataFrame(self.rows).sort_values("part", ascending=False)
        fresh = fresh.drop_duplicates(["test", "quantity"])
        fresh = fresh.assign(date=date.today().isoformat(), commit=_commit())
        stored = read(self.path) if self.path.exists() else fresh.iloc[:0]
        write(merge_rows(stored, fresh, set(declarations())), self.path)


class Numbers:
    """Stores all numbers compared, by test and quantity, but for those of random examples."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.tests: dict[str, list[tuple[str, list[float], list[float], list[float]]]] = {}

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_call(self, item: pytest.Item):
        result = yield
        if not item.get_closest_marker("hypothesis"):
            self.tests[item.nodeid] = list(_numbers)
        return result

    def pytest_sessionfinish(self) -> None:
        self.path.write_text(json.dumps(self.tests), encoding="utf-8")


def _commit() -> str:
    command = ["git", "-C", str(ROOT), "rev-parse", "--short=7", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
