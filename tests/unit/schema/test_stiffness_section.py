"""Given harmonics: one rule for a table and a csv, and every fault told when the config is read."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.build.checks import check_pitch
from facegear.build.plans import stiffness_request
from facegear.errors import ConfigError, ConfigErrors
from facegear.harmonics import Harmonics
from facegear.meshing.stiffness_source import stiffness_given
from facegear.schema.base import parse
from facegear.schema.stiffness import MeshStiffness

HEADER = "order,sin_n_per_m,cos_n_per_m\n"


def section(tmp_path, text, **changes):
    path = tmp_path / "own.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return parse(MeshStiffness, {"source": "harmonics", "csv": str(path), **changes})


def message(tmp_path, text, **changes):
    with pytest.raises(ConfigErrors) as refused:
        section(tmp_path, text, **changes)
    (line,) = refused.value.lines
    return line


def test_order_0_of_a_csv_is_the_mean_in_the_config_and_in_the_series(tmp_path):
    """Without this rule a mean in the config and order 0 of a csv gave modes and dynamics different means."""
    own = section(tmp_path, HEADER + "0,0,4.1e8\n1,2e7,-1e7\n")
    assert own.mean == 4.1e8
    assert stiffness_given(stiffness_request(own)).harmonics["cos_n_per_m"][0] == 4.1e8


def test_a_csv_without_order_0_takes_the_mean_of_the_config(tmp_path):
    """It was dropped in silence, and the dynamics ran on a mean of zero."""
    own = section(tmp_path, HEADER + "1,2e7,-1e7\n", mean_n_per_m=4.1e8)
    assert stiffness_given(stiffness_request(own)).harmonics["cos_n_per_m"].to_list() == [4.1e8, -1e7]


def test_table_and_csv_follow_the_same_rule(tmp_path):
    rows = [{"order": 0, "cos_n_per_m": 4e8}, {"order": 2, "sin_n_per_m": 1e7}]
    table = parse(MeshStiffness, {"source": "harmonics", "table": rows})
    own = section(tmp_path, HEADER + "2,1e7,0\n\n0,0,4e8\n")
    assert own == table


def test_a_dumped_section_no_longer_needs_its_csv(tmp_path):
    own = section(tmp_path, HEADER + "0,0,4.1e8\n1,2e7,-1e7\n")
    (tmp_path / "own.csv").unlink()
    assert parse(MeshStiffness, own.model_dump(mode="json")) == own


@pytest.mark.parametrize(
    ("text", "changes", "line"),
    [
        (HEADER + "1,2e7,0\n", {}, "mean_n_per_m = null: must be given, as the harmonics have no order 0"),
        (HEADER + "0,0,4e8\n", {"mean_n_per_m": 4.1e8}, "the same as order 0 of the harmonics, 400000000"),
        (HEADER + "0,1,4e8\n", {}, "must be 0 for sin_n_per_m of order 0"),
        (HEADER + "0,0,4e8\n1,5e8,0\n", {}, "k(t) falls to -1"),
        (HEADER + "0,0,4e8\n1,soft,0\n", {}, "line 3: sin_n_per_m = 'soft' is not a finite number"),
        (HEADER + "0,0,4e8\n1,,0\n", {}, "line 3: sin_n_per_m = '' is not"),
        (HEADER + "0,0,nan\n", {}, "line 2: cos_n_per_m = 'nan'"),
        (HEADER + "0,0,4e8\n1,1,1\n1,2,2\n", {}, "line 4: order 1 already stands in line 3"),
        (HEADER + "0,0,4e8\n1.5,1,1\n", {}, "line 3: order = 1.5 is not a whole number from 0 to 512"),
        (HEADER + "0,0,4e8\n-1,1,1\n", {}, "line 3: order = -1"),
        (HEADER + "0,0,4e8\n1e18,1,1\n", {}, "line 3: order = 1e+18"),
        (HEADER + "0,0,4e8\n1,1e300,1\n", {}, "line 3: sin_n_per_m = 1e+300 is beyond 1e12"),
        (HEADER + "0,0\n", {}, "line 2: 2 values under 3 column names"),
        (HEADER, {}, "it holds no numbers"),
        ("", {}, "column order must stand once"),
        ("order;sin_n_per_m;cos_n_per_m\n0;0;4e8\n", {}, "separated by commas; it has order;sin_n_per_m"),
        ("order,sin_n_per_m\n0,0\n", {}, "column cos_n_per_m must stand once"),
        ("order,a_n_per_m,b_n_per_m\n0,0,4e8\n", {}, "`a_n_per_m` is now `sin_n_per_m`, `b_n_per_m` is now"),
        (HEADER.encode() + b"0,0,4e8\n# \xfc\n", {}, "line 3: byte 0xfc is not UTF-8"),
        (HEADER + "0,0,4e8\n", {"source": "fem"}, "left out unless source is harmonics"),
        (
            HEADER + "0,0,4e8\n",
            {"table": [{"order": 0, "cos_n_per_m": 4e8}]},
            "either csv or table, not both",
        ),
    ],
)
def test_a_fault_of_a_csv_is_one_line_without_advice_to_rebuild_the_users_file(tmp_path, text, changes, line):
    found = message(tmp_path, text, **changes)
    assert line in found
    assert "snakemake" not in found


def test_a_csv_of_any_length_is_refused_at_once(tmp_path):
    assert "longer than 2000000 bytes" in message(tmp_path, HEADER + "0,0,4e8\n" * 300_000)


def test_a_missing_csv_and_a_directory_are_reported(tmp_path):
    for path, line in ((tmp_path / "none.csv", "no such file"), (tmp_path, "a directory")):
        with pytest.raises(ConfigErrors, match=line):
            parse(MeshStiffness, {"source": "harmonics", "csv": str(path)})


def test_orders_of_a_table_rise():
    rows = [{"order": 0, "cos_n_per_m": 4e8}, {"order": 2}, {"order": 2}]
    with pytest.raises(ConfigErrors, match=r"table\[2\].order = 2: must be above the order before it"):
        parse(MeshStiffness, {"source": "harmonics", "table": rows})


def test_the_stored_table_of_harmonics_is_read_back_as_it_was_written(tmp_path):
    """Its further columns are known, so that they are no mistake of the user's."""
    own = section(tmp_path, HEADER + "0,0,4.1e8\n1,2e7,-1e7\n")
    stored = stiffness_given(stiffness_request(own)).harmonics
    assert len(stored.columns) > 3
    assert section(tmp_path, stored.to_csv(index=False)) == own


def test_the_sine_and_cosine_of_a_table_are_those_of_k_over_the_mesh_phase():
    """The peak of 5 cos - 12 sin lies at the phase -atan(12 / 5); exchanged it would lie elsewhere."""
    rows = [{"order": 0, "cos_n_per_m": 4e8}, {"order": 1, "sin_n_per_m": -12e6, "cos_n_per_m": 5e6}]
    series = stiffness_request(parse(MeshStiffness, {"source": "harmonics", "table": rows})).given_series
    peak = np.arctan2(-12.0, 5.0) / (2.0 * np.pi)
    assert series(peak) == pytest.approx(4e8 + 13e6, rel=1e-14)


CELLS = st.sampled_from(
    ["0", "1", "2", "1.5", "-1", "600", "4e8", "1e7", "", "x", "1e400", "inf", '"', "é", ",", "\x00"]
)


@given(st.lists(st.lists(CELLS, max_size=4).map(",".join), max_size=5).map("\n".join), st.booleans())
def test_any_csv_is_used_or_refused_in_one_line(tmp_path_factory, text, headed):
    folder = tmp_path_factory.mktemp("any")
    try:
        own = section(folder, HEADER + text if headed else text)
    except ConfigErrors as error:
        assert len(error.lines) == 1
    else:
        assert stiffness_request(own).given_series.truncate(own.harmonics_kept).minimum > 0.0


@given(st.integers(2, 40), st.integers(0, 2**32 - 1))
def test_a_curve_over_the_pinions_angle_that_was_written_is_read_as_the_same_series(orders, seed):
    """Simulink and spreadsheets hold k over an angle; what `over_angle` gives comes back to rounding."""
    chance = np.random.default_rng(seed)
    a, b = chance.normal(size=(2, orders + 1)) * 1e6
    a[0], b[0] = 0.0, 4e8
    teeth, count = 23, 2 * orders + 2
    cycles = np.arange(count) / count
    curve = pd.DataFrame({"pinion_angle_deg": 360.0 / teeth * cycles, "k_n_per_m": Harmonics(a, b)(cycles)})
    with TemporaryDirectory() as folder:
        read = section(Path(folder), curve.to_csv(index=False))
    found = stiffness_request(read).given_series
    np.testing.assert_allclose(found.sine, a, atol=1e-6 * 4e8 * 1e-6)
    np.testing.assert_allclose(found.cosine, b, atol=1e-6 * 4e8 * 1e-6)
    assert read.csv_pitch_deg == pytest.approx(360.0 / teeth) and "csv_pitch_deg" not in read.model_dump()


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("0,4e8\n1,4e8\n2,4e8\n", "must have from 4 to 1024 rows over the pitch, not 3"),
        ("0,4e8\n1,4e8\n2,4e8\n4,4e8\n", "must rise in even steps from 0, the end of the pitch left out"),
        ("1,4e8\n2,4e8\n3,4e8\n4,4e8\n", "must rise in even steps from 0, the end of the pitch left out"),
        ("0,4e8\n1,soft\n2,4e8\n3,4e8\n", "line 3: k_n_per_m = 'soft' is not a finite number"),
        ("0,4e8\n1,4e8\n2,-4e8\n3,4e8\n", "line 4: k_n_per_m = -4e+08 must be above 0"),
        ("0,4e8\n1,0\n2,4e8\n3,4e8\n", "line 3: k_n_per_m = 0 must be above 0"),
    ],
)
def test_a_curve_that_is_no_pitch_is_refused_with_its_line(tmp_path, rows, words):
    with pytest.raises(ConfigErrors) as refused:
        section(tmp_path, "pinion_angle_deg,k_n_per_m\n" + rows)
    assert words in str(refused.value)


def test_a_curve_over_another_angle_than_the_pinions_pitch_is_refused_with_the_pitch(tmp_path):
    angles = np.arange(8) * 360.0 / 25 / 8
    text = pd.DataFrame({"pinion_angle_deg": angles, "k_n_per_m": 4e8}).to_csv(index=False)
    stiffness = section(tmp_path, text)
    check_pitch(stiffness, 25)
    with pytest.raises(
        ConfigError, match=r"14\.4 deg of pinion_angle_deg': must be over one pitch.*15\.652174"
    ):
        check_pitch(stiffness, 23)
