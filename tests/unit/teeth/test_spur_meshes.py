"""Meshes of spur teeth at ninety degrees are what they were while both sides were mirrored by construction.

`spur_meshes.npz` was written by `tests/helpers/spur_meshes.py` at that time.
"""

import numpy as np
import pytest
from spur_meshes import BUILDERS, STORED, mesh_values, meshed_designs, spur_mesh

NAMES = sorted({key.split("/")[0] for key in np.load(STORED).files})


@pytest.mark.parametrize("body", BUILDERS)
@pytest.mark.parametrize("name", NAMES)
def test_a_spur_mesh_has_its_former_nodes_and_numbers(name, body):
    values = mesh_values(spur_mesh(meshed_designs()[name], body))
    with np.load(STORED) as stored:
        for quantity, value in values.items():
            expected = stored[f"{name}/{body}/{quantity}"]
            if quantity == "numbers":
                np.testing.assert_array_equal(value, expected)
            else:
                # parameters come from Newton's method, whose steps end at 1e-14 rad
                limit = 1e-15 if quantity == "nodes" else 3e-14
                assert np.abs(value - expected).max() <= limit, quantity
