"""Cost of load sharing, and error of its means."""

import numpy as np
import pytest
from lumped_machines import make_machine

from facegear.motion.plan import Settings
from facegear.sharing.groups import SharingOptions, SpeedRange
from validation.dynamics.sharing_costs import random_machines, sharing_costs, sharing_summary

OPTIONS = SharingOptions(64, 24, 2, 2e-5, 0, 0.95, 60.0, SpeedRange(2000.0, 9000.0, 3))


def test_random_machines_are_the_same_each_time_and_whole():
    first, second = (list(random_machines(make_machine(), 3)) for _ in range(2))
    assert [case.speed_rpm for case in first] == [case.speed_rpm for case in second]
    for case in first:
        np.testing.assert_allclose(case.machine.torques, case.torque_factor * make_machine().torques)
        assert case.machine.error.cosine[1] == pytest.approx(case.error_factor * 50e-6)


def test_mean_coefficients_of_periodic_motions_are_those_of_a_far_finer_run():
    table = sharing_costs(make_machine(), Settings(tolerance=1e-6), OPTIONS, count=3)
    assert (table["seconds"] > 0.0).all()
    periodic = table["motion"].str.startswith("period-")
    assert periodic.any()
    assert (table["error"][periodic] < 1e-3).all() and (table["chance"][periodic] == 0.0).all()
    assert f"{periodic.sum()} periodic" in sharing_summary(table)
