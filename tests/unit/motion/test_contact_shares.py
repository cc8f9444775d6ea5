"""Shares of the time open, on the drive and on the back flank, with wedged teeth and with rounding alone."""

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine

from facegear.machine.kinematics import GEOMETRIC
from facegear.motion.plan import Settings
from facegear.motion.steady_state.mesh_samples import each_deflection, mesh_fractions
from facegear.motion.steady_state.simulate import build_model, simulate


@pytest.mark.parametrize("error", [10e-6, 25e-6])
def test_a_mesh_is_open_while_neither_flank_touches_though_both_do_at_other_times(error):
    """With 5 um of backlash and 10 um of e(t): 0.000 / 0.011 were written, 0.127 / 0.260 are true."""
    layout = make_layout(kinematics=GEOMETRIC)
    model = build_model(make_machine(layout, 800.0, backlash=5e-6, error=error, tail_share=0.05))
    found = simulate(model, 6000.0, Settings(samples=1024, settle=64, window=32))
    each = each_deflection(found.system, found.coordinates, found.per_period)
    touching = each > found.system.upper[: found.system.contacts]
    drive, back = np.split(touching, 2, axis=1)
    assert (drive & back).mean(axis=0).max() > 0.02, "this machine wedges"
    counted = np.stack([~drive & ~back, drive, back]).mean(axis=1)
    np.testing.assert_allclose(found.fractions, counted, atol=4.0 / 1024)


def test_a_flank_that_rounding_alone_presses_is_open():
    layout = make_layout(kinematics=GEOMETRIC)
    system = build_model(make_machine(layout, 800.0)).system
    depths = np.zeros((16, 20)) - 1e-6
    depths[:, 0] = 40e-6  # the drive flank of the first mesh carries the load
    depths[:, 1] = 1e-19
    shares = np.zeros((3, 20))
    shares[1, :2] = 1.0
    shares[0] = 1.0 - shares[1]
    found = mesh_fractions(system, shares, depths + system.upper[:20])
    np.testing.assert_array_equal(found[:, 0], [0.0, 1.0, 0.0])
    np.testing.assert_array_equal(found[:, 1], [1.0, 0.0, 0.0])
    shares[:, 2] = [1.0 - 1e-3, 1e-3, 0.0]  # a touch between two samples counts
    assert mesh_fractions(system, shares, depths + system.upper[:20])[1, 2] == 1e-3
