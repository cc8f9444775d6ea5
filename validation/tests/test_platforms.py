"""How far numbers move between platforms."""

import signal

import pandas as pd
import pytest

from validation.platforms import CASES, MEASURED, PLATFORMS, differences, end_of, platforms_table
from validation.references import ROOT

TEST = "tests/unit/geometry/test_limits.py::test_undercut_and_pointing_radii_match_the_table"


def test_a_number_that_moved_is_measured_by_the_largest_expected_value_and_by_its_tolerance():
    base = {
        f"{TEST}[23]": [("radius, mm", [2.0, 4.0], [2.0, 4.0], [0.1, 0.2]), ("zero", [0.0], [0.0], [0.5])]
    }
    other = {
        f"{TEST}[23]": [("radius, mm", [2.0, 4.04], [2.0, 4.0], [0.1, 0.2]), ("zero", [0.1], [0.0], [0.5])]
    }
    moved = differences(base, other)
    assert moved["capability"].tolist() == ["geometry", "geometry"] and moved["numbers"].tolist() == [2, 1]
    assert moved["relative"].tolist() == pytest.approx([0.01, float("nan")], nan_ok=True)
    assert moved["of_tolerance"].tolist() == pytest.approx([0.2, 0.2])


def test_cases_of_platforms_exist():
    assert all((ROOT / case).exists() for case in CASES)


def test_a_process_that_a_signal_ended_says_which():
    assert end_of(-signal.SIGILL) == "ended by SIGILL"
    assert end_of(0) == "all passed" and end_of(3) == "exit code 3"


def test_the_page_has_a_row_for_each_platform_that_was_measured():
    measured = pd.read_csv(MEASURED)
    _, *others = PLATFORMS
    names = measured["platform"].drop_duplicates().tolist()
    assert names == [name for name in others if name in names]
    assert platforms_table(measured).count("\n| ") == len(names) > 0
