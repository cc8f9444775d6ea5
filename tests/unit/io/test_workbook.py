"""Tables go to Excel and come back."""

import numpy as np
import pandas as pd
import pytest

from facegear.errors import FacegearError
from facegear.io.tables import read_workbook, write_workbook

TABLES = {
    "forces": pd.DataFrame(
        {"mesh": ["12", "NA", "left/upper"], "force_n": [np.pi, np.nan, -1e-300], "cycle": [1, 2, 3]}
    ),
    "labels": pd.DataFrame({"label": ["", "80 um"], "periodic": [True, False]}),
}


def test_a_workbook_gives_back_its_tables_to_the_digits_that_excel_keeps(tmp_path):
    read = read_workbook(write_workbook(tmp_path / "own.xlsx", TABLES))
    assert list(read) == list(TABLES)
    for name, table in TABLES.items():
        pd.testing.assert_frame_equal(read[name], table, rtol=1e-15, atol=0)


@pytest.mark.parametrize(
    ("path", "tables", "line"),
    [
        ("own.xls", TABLES, "must end in .xlsx"),
        ("own.xlsx", {}, "there is no table"),
        ("own.xlsx", {"n" * 32: TABLES["labels"]}, "31 letters"),
    ],
)
def test_what_no_workbook_can_hold_is_refused_and_nothing_written(tmp_path, path, tables, line):
    with pytest.raises(FacegearError, match=line):
        write_workbook(tmp_path / path, tables)
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_no_workbook_is_named(tmp_path):
    (tmp_path / "own.xlsx").write_text("mesh,force_n\n")
    with pytest.raises(FacegearError, match="not a readable workbook"):
        read_workbook(tmp_path / "own.xlsx")
