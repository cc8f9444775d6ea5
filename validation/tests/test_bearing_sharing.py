"""Which rolling bearings give which load sharing: rows that are stored follow from the config."""

import numpy as np
import pandas as pd
import pytest

from validation.bearing_sharing import SETS, SPRINGS, TABLE, TORQUES, machines, page_table, sharing_row

STORED = pd.read_csv(TABLE)


@pytest.mark.parametrize("words", ["6210 and NU 210, 45 and 70 um", "two 7208, preload 8 um", SPRINGS])
def test_stored_rows_are_those_of_the_config(words):
    torque = TORQUES[1]
    row = STORED[(STORED["bearings"] == words) & (STORED["torque_n_m"] == torque)].iloc[0]
    found = sharing_row(words, machines()[words], torque)
    np.testing.assert_allclose(found[2:], row.to_numpy()[2:].astype(float), rtol=1e-5)


def test_every_set_of_bearings_stands_in_the_table_at_every_torque():
    assert STORED["bearings"].unique().tolist() == [*SETS, SPRINGS]
    assert STORED.groupby("bearings")["torque_n_m"].apply(list).map(tuple).unique().tolist() == [TORQUES]


def test_inputs_on_softer_seats_share_more_evenly_where_idlers_carry():
    for torque in TORQUES[1:]:
        rows = STORED[STORED["torque_n_m"] == torque].sort_values("input_stiffness_n_per_um")
        assert (np.diff(rows["k_gamma_inputs"]) > 0.0).all()


def test_no_life_is_written_for_springs():
    lines = page_table(STORED).splitlines()
    assert len(lines) == 2 + len(STORED)
    assert all(line.endswith("|  |") == (SPRINGS in line) for line in lines[2:])
