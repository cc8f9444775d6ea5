"""The times on the page about speed are those of the stored ratios."""

import re
from pathlib import Path

import pandas as pd
import pytest

from validation.ratios.points import POINTS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "speed.md").read_text()
RATIOS = pd.read_csv(ROOT / "docs" / "measured" / "ratios.csv").set_index("point")
TABLE = re.search(r"<!-- stored: docs/measured/ratios.csv -->(.*?)<!-- end -->", PAGE, re.DOTALL)[1]
ROWS = [line.strip("| ").split(" | ") for line in TABLE.splitlines() if line.startswith("| ")][1:]
LIMITS = {"contact": 2.0, "sample_with_law": 9.0, "fresh_response": 3.0, "fresh_contact": 4.0}
"""Times that were asked for, in the unit of the point."""
SPREAD = 0.01
"""Part by which two measurements of one code differ; the face gear is 0.7 % beside its time before C++."""
GAINS = {"example_up": 2.5, "example_down": 2.5}
"""Gains over the last version before C++ that were asked for."""


def test_every_point_has_its_row_in_the_order_of_the_points():
    assert len(ROWS) == len(POINTS) and list(RATIOS.index) == list(POINTS)


@pytest.mark.parametrize(("point", "row"), list(zip(POINTS, ROWS, strict=False)))
def test_measured_time_is_stored_and_a_missed_bound_is_named(point, row):
    stored = RATIOS.loc[point]
    _, bound, measured, *_ = row
    unit = stored["unit"].split()[0]
    assert measured.split(",")[0] == f"{stored['now']:.3g} {unit}"
    limit = LIMITS.get(point, stored["before"] / GAINS.get(point, 1.0))
    assert bound.startswith(f"{limit:.3g} " if point not in LIMITS else f"{limit:g}")
    assert ("missed" in measured) == (stored["now"] > limit * (1.0 + SPREAD))
