"""Two pairs that take over from each other, each a contact with a table of its own, against exact answers.

A pair's clearance changes with the phase, as (1 -+ cos(theta / 2)) / 2 of the two; its force depends on how
far it is pressed in alone. Where a table has the sum of both at fixed levels, its corners move through the
levels (test_load_dependent_motion.py); here they are edges. The mesh cycle is that of a pair, two pitches
long: multipliers are squares of those over a pitch, and a period doubling is a branch point.

Places and rates are exact to 11 digits (Taylor series of high order). Multipliers of the power law were made
with DOP853 at a relative tolerance of 1e-13, restarted wherever a pair comes into contact or leaves it, with
the variational equations; the determinant of their monodromy matrix is off by less than 1e-13.
"""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import linear_table, power_table
from law_oscillators import orbit
from oscillators import one_degree
from scipy.optimize import brentq
from whole_branches import branch_at

from facegear.meshing.load_dependent import load_dependent_law
from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind
from facegear.motion.integrator.integrator import Integrator

LOAD = 0.3


def two_pairs(table, damping=0.03):
    """x'' + 2 z x' + sum F(x - (1 -+ cos(theta / 2)) / 2) = 0.3 for F of the table."""
    clearance = np.zeros((2, 2, 2))
    clearance[:, 1, 1] = -0.5, 0.5
    return replace(
        one_degree(2.0 * damping, load=((0.0,), (LOAD,))),
        mesh_jacobian=np.ones((2, 1)),
        mesh_damping=np.zeros(2),
        lower=np.full(2, -np.inf),
        upper=np.full(2, 0.5),
        law=load_dependent_law([table, table]),
        error=clearance,
        error_kind=np.arange(2),
    )


def period_map(table, tolerance=1e-13):
    """Over two pitches at a frequency of pitches W."""
    system = two_pairs(table)
    return PeriodMap(Family("W", lambda speed: (system, 0.5 * speed)), 1, tolerance)


def error_of(table, speed, place, rate, squared):
    over_two = period_map(table)
    found = orbit(over_two, speed, place, rate)
    state = over_two.state(found.z, found.u)
    off = max(abs(state.displacement[0] - place), abs(state.velocity[0] - rate))
    return off, np.abs(found.multipliers - squared).min()


def test_the_unstable_orbit_of_linear_pairs_is_exact_with_a_single_interval():
    off, multiplier = error_of(linear_table(1, 4.0), 0.8, -0.45595237096, -0.17884962094, 2.23132244**2)
    assert off < 1e-10
    assert multiplier < 5e-8  # of 4.98: the exact one is known to 8 decimals


def test_linear_pairs_fold_and_double_their_period_where_the_exact_law_does():
    over_two = period_map(linear_table(1, 4.0), 1e-12)
    near = branch_at(over_two, np.array([-0.456, -0.179]), 0.8, ContinuationSettings(0.69, 0.9))
    assert sorted(one.point.value for one in near.of(Kind.FOLD)) == pytest.approx(
        [0.6911446203, 0.8953096496], abs=1e-9
    )
    above = branch_at(over_two, np.array([0.45, 0.0]), 1.72, ContinuationSettings(1.7, 1.99))
    assert sorted(one.point.value for one in above.of(Kind.BRANCH)) == pytest.approx(
        [1.7049485888, 1.9797237238], abs=1e-9
    )


@pytest.mark.parametrize(
    ("speed", "place", "rate", "squared"),
    [
        (0.8, 0.225049594966, -0.024427649766, -0.40845123245945 + 0.47204737906026j),
        (1.3, 0.779768783813, -0.030364658620, -0.25012922645361 + 0.70522435232780j),
    ],
)
def test_orbits_and_multipliers_of_pairs_with_a_power_law_converge_with_the_number_of_levels(
    speed, place, rate, squared
):
    off, multiplier = np.transpose(
        [error_of(power_table(n, last=3.0), speed, place, rate, squared) for n in (200, 400, 1600)]
    )
    assert off[-1] < 1e-11
    assert multiplier[-1] < 1e-9
    assert (off[:-1] > 10.0 * off[1:]).all()
    assert (multiplier[:-1] > 4.0 * multiplier[1:]).all()


def resting_place(phase):
    """Where the pairs with x^1.5 carry the load at a phase of the pitch."""
    clearances = 0.5 * (1.0 + np.array([-1.0, 1.0]) * np.cos(0.5 * phase))
    return brentq(lambda x: (np.maximum(x - clearances, 0.0) ** 1.5).sum() - LOAD, 0.0, 3.0, xtol=1e-14)


@pytest.mark.parametrize(("speed", "largest"), [(0.1, 0.00829), (0.05, 0.00488)])
def test_a_slow_motion_stays_as_near_to_the_loaded_transmission_error_as_the_exact_one(speed, largest):
    phases = 4.0 * np.pi * np.arange(400) / 400
    resting = np.array([resting_place(phase) for phase in phases])
    integrator = Integrator(two_pairs(power_table(200, last=3.0)), 0.5 * speed, 1e-10)
    start = integrator.run(np.array([[resting[0]], [0.0]]), 12).state
    moved = integrator.run(start, 1, samples=400).samples[:, 0]
    assert np.abs(moved - resting).max() == pytest.approx(largest, rel=1e-2)
