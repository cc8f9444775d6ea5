"""The machines whose costs are compared are whole."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_machine

from facegear.motion.steady_state.simulate import build_model
from validation.growth.machines import resized


@pytest.mark.parametrize("count", [1, 5, 12])
@pytest.mark.parametrize("in_step", [True, False])
def test_machines_with_more_or_fewer_pinions_have_phases_and_backlash_for_their_own_meshes(count, in_step):
    machine = make_machine()
    machine = replace(machine, error_lags=np.zeros(10) if in_step else None)
    found = resized(machine, count, 3)
    assert len(found.error_phases) == len(found.half_backlash) == len(found.layout.meshes) == 2 * count
    assert build_model(found).system.size > 0
