"""The pair at a pose, by CalculiX and Kratos on displaced bodies: the table of `validation.poses.peer`."""

import numpy as np
import pandas as pd
import pytest

from validation.contact.kratos import VERSION
from validation.poses.peer import OFFSETS, TABLE

PEERS = {"CalculiX 2.20": ("facegear", 1e-3, 0.01), f"Kratos {VERSION}": ("facegear, 8-node", 0.01, 0.005)}
"""Ours on the elements of each, and how near stiffness and root stress of the gear come to it."""


@pytest.fixture(scope="module")
def rows():
    """By program, a row an offset."""
    table = pd.read_csv(TABLE)
    by_program = {name: part.set_index("offset_um") for name, part in table.groupby("program")}
    assert set(by_program) == {*PEERS, *(own for own, _, _ in PEERS.values())}
    for part in by_program.values():
        np.testing.assert_allclose(part.index, 1e6 * np.array(OFFSETS))
    return by_program


@pytest.mark.parametrize("peer", PEERS)
def test_stiffness_path_and_root_stress_at_a_pose_are_those_of_another_program_to_its_error(rows, peer):
    name, stiffness, root = PEERS[peer]
    other, own = rows[peer], rows[name]
    np.testing.assert_allclose(other["stiffness_n_per_um"], own["stiffness_n_per_um"], rtol=stiffness)
    np.testing.assert_allclose(other["path_mm"], own["path_mm"], atol=0.1)
    np.testing.assert_allclose(other["gear_root_mpa"], own["gear_root_mpa"], rtol=root)


@pytest.mark.parametrize("peer", PEERS)
def test_a_pose_takes_the_stiffness_that_another_program_says(rows, peer):
    stiffness = {name: part["stiffness_n_per_um"].to_numpy() for name, part in rows.items()}
    own, other = (stiffness[name][1] / stiffness[name][0] for name in (PEERS[peer][0], peer))
    assert own < 0.97
    assert other == pytest.approx(own, abs=2e-3)
