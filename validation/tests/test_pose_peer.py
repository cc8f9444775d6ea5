"""The pair at a pose, by CalculiX on displaced bodies: the stored table of `validation.poses.peer`."""

import numpy as np
import pandas as pd
import pytest

from validation.poses.peer import OFFSETS, TABLE


@pytest.fixture(scope="module")
def programs():
    """Rows of ours and of CalculiX, by offset."""
    table = pd.read_csv(TABLE).set_index("offset_um")
    np.testing.assert_allclose(table.index.unique(), 1e6 * np.array(OFFSETS))
    own = table["program"] == "facegear"
    return table[own].select_dtypes("number"), table[~own].select_dtypes("number")


def test_stiffness_and_path_at_a_pose_are_calculix_s_to_its_error(programs):
    own, peer = programs
    np.testing.assert_allclose(peer["stiffness_n_per_um"], own["stiffness_n_per_um"], rtol=1e-3)
    np.testing.assert_allclose(peer["path_mm"], own["path_mm"], atol=0.1)
    np.testing.assert_allclose(peer["gear_root_mpa"], own["gear_root_mpa"], rtol=0.01)


def test_a_pose_takes_the_stiffness_that_calculix_says(programs):
    own, peer = (rows["stiffness_n_per_um"].iloc[1] / rows["stiffness_n_per_um"].iloc[0] for rows in programs)
    assert own < 0.97
    assert peer == pytest.approx(own, abs=2e-3)
