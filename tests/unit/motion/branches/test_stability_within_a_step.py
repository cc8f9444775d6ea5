"""Bands of instability that begin and end within one step, against multipliers that are known otherwise."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from oscillators import mathieu, two_coordinates
from references import against, agrees
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from whole_branches import branch_at

from facegear.motion.branches.continuation import BranchEnd, ContinuationSettings
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind

BEARINGS = np.array([0.2, 1.1])
MESH = np.array([1.0, 0.8])
LEVELS = (1.4, 0.6)


def piecewise_multipliers(speeds, damping):
    """Multipliers (speeds, 4) of two_coordinates() from the exponentials of its two linear halves."""
    matrices = np.eye(4)
    for stiffness in LEVELS:
        rates = np.zeros((4, 4))
        rates[:2, 2:] = np.eye(2)
        rates[2:, :2] = -np.diag(BEARINGS) - stiffness * np.outer(MESH, MESH)
        rates[2:, 2:] = -damping * np.eye(2)
        values, vectors = np.linalg.eig(rates)
        growth = np.exp(values * np.pi / np.asarray(speeds)[:, None])
        matrices = ((vectors * growth[:, None, :]) @ np.linalg.inv(vectors)) @ matrices
    return np.linalg.eigvals(matrices)


def edges_of_bands(begin_speed, end_speed, damping):
    """Speeds at which the largest multiplier passes the unit circle."""

    def outside(speed):
        return float(np.abs(piecewise_multipliers([speed], damping)).max() - 1.0)

    speeds = np.geomspace(begin_speed, end_speed, 10_001)
    largest = np.abs(piecewise_multipliers(speeds, damping)).max(axis=1)
    return [
        brentq(outside, speeds[i], speeds[i + 1], xtol=1e-13)
        for i in np.flatnonzero(np.diff((largest > 1.0).astype(int)))
    ]


def branch_of(system, begin_speed, end_speed, begin, **steps):
    period_map = PeriodMap(Family("W", lambda speed: (system, speed)), 1, 1e-12)
    return branch_at(period_map, np.zeros(4), begin, ContinuationSettings(begin_speed, end_speed, **steps))


def changes_of_stability(branch):
    """Speeds of the special points between whose neighbours stability differs, rising."""
    found = [
        special.point.value
        for special in branch.specials
        if branch.points[int(special.after)].stable != branch.points[int(special.after) + 1].stable
    ]
    return np.sort(found)


@against(
    "analytic",
    "multipliers of a linear system in two pieces, by matrix exponentials",
    capability="branches",
    module="facegear.motion.branches.special",
)
@pytest.mark.parametrize("damping", [0.02, 0.003, 0.0003])
def test_every_unstable_band_of_a_linear_machine_is_met_at_the_default_step(damping):
    """Down to damping where multipliers stay within a thousandth of the circle between the bands."""
    unloaded = replace(two_coordinates(), damping=np.full(2, damping), load=np.zeros((2, 2, 1)))
    branch = branch_of(unloaded, 0.7, 5.0, 5.0)
    expected = edges_of_bands(0.7, 5.0, damping)
    assert len(expected) >= 14
    agrees("edge of an unstable band", changes_of_stability(branch), expected, relative=1e-9)


@against(
    "analytic",
    "multipliers of a linear system in two pieces, by matrix exponentials",
    capability="branches",
    module="facegear.motion.branches.special",
)
@pytest.mark.parametrize("largest", [0.3, 1.2, 0.1])
def test_doublings_of_the_loaded_oscillator_with_two_modes_do_not_depend_on_the_step(largest):
    """At 0.3 both doublings lay within one step."""
    branch = branch_of(two_coordinates(), 1.9, 4.0, 2.0, ds_max=largest)
    assert branch.ends == (BranchEnd.LIMIT, BranchEnd.LIMIT)
    kinds = [special.kind for special in branch.specials]
    assert kinds == [Kind.TORUS, Kind.TORUS, Kind.DOUBLING, Kind.DOUBLING]
    expected = edges_of_bands(1.9, 4.0, 0.04)
    agrees("edge of an unstable band", changes_of_stability(branch), expected, relative=1e-9)


def parametric_pair(depth, damping):
    """y'' + d y' + diag(.2, 1.1) y + g (1 + depth cos W t) (g . y) = 0, Mathieu in two coordinates."""
    one = mathieu(depth)
    return replace(two_coordinates(), law=one.law, damping=np.full(2, damping), load=np.zeros((2, 2, 1)))


@cache
def scipy_multipliers(speed, depth, damping):
    def rates(time, columns):
        place, velocity = columns.reshape(2, 2, 4)
        stiffness = 1.0 + depth * np.cos(speed * time)
        force = -BEARINGS[:, None] * place - stiffness * np.outer(MESH, MESH @ place) - damping * velocity
        return np.concatenate([velocity, force]).ravel()

    run = solve_ivp(
        rates, (0.0, 2.0 * np.pi / speed), np.eye(4).ravel(), method="DOP853", rtol=1e-10, atol=1e-11
    )
    return np.linalg.eigvals(run.y[:, -1].reshape(4, 4))


@against(
    "third-party program",
    "multipliers of Mathieu's equation in two coordinates by SciPy's DOP853",
    capability="branches",
    module="facegear.motion.branches.special",
)
def test_stability_of_mathieus_equation_in_two_coordinates_is_that_of_scipy():
    depth, damping = 0.4, 0.01
    branch = branch_of(parametric_pair(depth, damping), 0.9, 4.0, 4.0)
    edges = changes_of_stability(branch)
    assert len(edges) >= 6
    largest = [np.abs(scipy_multipliers(float(speed), depth, damping)).max() for speed in edges]
    agrees(
        "modulus of the largest multiplier at an edge of a band", largest, np.ones(edges.size), absolute=1e-7
    )
    stable_below = branch.points[int(np.argmin(branch.values))].stable
    for speed in np.geomspace(0.91, 3.99, 48):
        stable = stable_below == (np.searchsorted(edges, speed) % 2 == 0)
        assert stable == (np.abs(scipy_multipliers(float(speed), depth, damping)).max() <= 1.0)
