"""The passes over the instants of a motion give what the formulas give instant by instant."""

import numpy as np
import pytest

from facegear.machine.flanks import NO_LOAD, significant_forces
from facegear.meshing.law import beyond_edges
from facegear.motion.track import add_ring_forces, press_in, split_loads


def test_loads_of_both_flanks_are_the_forces_of_either_sign_without_rounding():
    forces = np.random.default_rng(1).normal(size=(3, 40))
    forces[0, :5] *= 0.5 * NO_LOAD
    loads = np.full((6, 40), np.nan)
    split_loads(forces, NO_LOAD, loads)
    drive, back = np.split(loads, 2)
    assert (loads >= 0.0).all() and not (drive * back).any()
    assert np.array_equal(drive - back, significant_forces(forces)) and not loads[0, :5].any()


def test_contacts_are_pressed_in_by_what_lies_beyond_their_edges_without_the_error_of_the_instant():
    random = np.random.default_rng(2)
    deflections, errors = random.normal(size=(3, 2, 50)), 0.1 * random.normal(size=(50, 3))
    lower, upper = np.array([-0.5, -np.inf, 0.3]), np.array([0.5, 0.2, 0.1])
    each = np.moveaxis(deflections - errors.T[:, None], 0, -1)
    expected = np.moveaxis(beyond_edges(each, lower, upper), -1, 0)
    press_in(deflections, errors, lower, upper)
    assert np.array_equal(deflections, expected)


def test_the_spring_of_a_bearing_acts_beyond_its_clearance_and_its_damper_by_the_rate_of_that_force():
    """Damping is lag times dF/dt, here by differences of the springs' forces."""
    time, step = np.linspace(0.0, 1.0, 200), 1e-6
    stiffness, clearance, body = np.array([3.0, 5.0]), np.array([0.4, 0.7]), np.array([2, 0])

    def places(at):
        return np.array([[np.sin(6.0 * at), np.cos(5.0 * at)], [np.cos(7.0 * at), np.sin(4.0 * at)]])

    def forces(at, lag):
        written = np.zeros((3, 3, at.size))
        rates = (places(at + step) - places(at - step)) / (2.0 * step)
        add_ring_forces(places(at), rates, stiffness, clearance, lag, body, written)
        return written

    springs = forces(time, 0.0)
    distance = np.hypot(*places(time)[0])
    size = 3.0 * np.maximum(distance - 0.4, 0.0)
    assert np.hypot(*springs[2, :2]) == pytest.approx(size, rel=1e-12, abs=1e-12)
    assert not springs[1].any() and not springs[:, 2].any()
    lag = 0.01
    rate = (forces(time + step, 0.0) - forces(time - step, 0.0)) / (2.0 * step)
    assert forces(time, lag) - springs == pytest.approx(lag * rate, abs=1e-6)
