"""The linear law of contacts: stiffness times deflection."""

import numpy as np

from facegear.harmonics.series import Harmonics
from facegear.mesh_law.linear import linear_law


def test_scratch_space_of_contacts_alike_holds_contacts_that_all_differ():
    """Machines of one family share it: five kinds once ran in the space of one, past its end."""
    swings = [Harmonics(np.array([0.0, swing]), np.array([4e8, 0.0])) for swing in range(5)]
    different, alike = linear_law(swings), linear_law(5 * swings[:1])
    assert [len(law.fourier) for law in (different, alike)] == [5, 1]
    shapes = [[part.shape for part in law.series(rows=7, width=8)] for law in (different, alike)]
    assert shapes[0] == shapes[1]
