"""Change of numbers between platforms."""

import signal

import pandas as pd
import pytest

from facegear._kernels import VARIABLE
from validation.platforms import (
    CASES,
    DIFFERENCES,
    OUTCOMES,
    PLATFORMS,
    TESTS,
    differences,
    end_of,
    outcomes,
    outcomes_table,
    platforms_table,
)
from validation.references import ROOT

TEST = "tests/unit/teeth/test_limits.py::test_undercut_and_pointing_radii_match_the_table"


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
    assert all((ROOT / case).exists() for case in CASES + TESTS)


def test_a_process_that_a_signal_ended_says_which():
    assert end_of(-signal.SIGILL) == "ended by SIGILL"
    assert end_of(0) == "all passed" and end_of(3) == "exit code 3"


def test_the_page_has_a_row_for_each_platform_that_was_measured():
    measured = pd.read_csv(DIFFERENCES)
    _, *others = PLATFORMS
    names = measured["platform"].drop_duplicates().tolist()
    assert names == [name for name in others if name in names]
    assert platforms_table(measured).count("\n| ") == len(names) > 0


def test_platforms_lower_the_level_twice_and_have_one_and_two_threads():
    first, *others = PLATFORMS.values()
    assert not first.environment
    assert {platform.threads for platform in PLATFORMS.values()} == {1, 2}
    lowered = [platform.environment for platform in others if platform.environment]
    assert {level.get(VARIABLE) for level in lowered} == {None, "baseline"}
    for library in ("OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES"):
        assert len({level[library] for level in lowered}) == len(lowered) == 2


def test_a_test_that_fails_on_a_platform_is_named(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text(
        "<testsuites><testsuite>"
        '<testcase classname="tests.a" name="kept"/>'
        '<testcase classname="tests.a" name="left"><skipped/></testcase>'
        '<testcase classname="tests.a" name="moved"><failure message="1 != 2"/></testcase>'
        "</testsuite></testsuites>"
    )
    row = outcomes("SSE4.2, one thread", report)
    assert (row["passed"], row["failed"], row["failed_tests"]) == (1, 1, "tests.a::moved")
    assert "| SSE4.2, one thread | 1 | 1 | tests.a::moved |" in outcomes_table(pd.DataFrame([row]))


def test_the_page_says_how_many_tests_pass_on_each_platform_that_was_measured():
    measured = pd.read_csv(OUTCOMES)
    names = measured["platform"].to_list()
    assert names == [name for name in PLATFORMS if name in names]
    assert (measured["passed"] > 0).all()
    assert outcomes_table(measured).count("\n| ") == len(names) > 0
